#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// A remedy for a mistyped `path` in a file of keys: the most similar key or section ("did you mean `...`?"), or the
// names at that level. `keys` are all keys: "section.key", members of a list "list[].key". `help_option`, e.g.
// "--help-config", is the option that lists them.
[[nodiscard]] std::string suggest_key(const std::string& path, const std::vector<std::string>& keys,
                                      std::string_view help_option);

}  // namespace drivers
