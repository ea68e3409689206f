#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// A remedy for a mistyped `path` in a file of keys: the key or section most like it, "did you mean `...`?", or the
// names that stand beside it. `keys` are all keys: "section.key", members of a list "list[].key". The user sees them
// with `help_option`, e.g. "--help-config".
[[nodiscard]] std::string suggest_key(const std::string& path, const std::vector<std::string>& keys,
                                      std::string_view help_option);

}  // namespace drivers
