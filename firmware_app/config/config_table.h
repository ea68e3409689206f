#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/config_key.h"

namespace app {

// Every key, in the order of --help-config. Built once.
[[nodiscard]] const std::vector<ConfigKey>& config_keys();

// nullptr = no such key. `path` is in the table's form: "regions[].name".
[[nodiscard]] const ConfigKey* find_key(const std::string& path);
[[nodiscard]] bool is_section(const std::string& path);

// Suggestion for a mistyped `path`: the most similar key or section ("did you mean `...`?"), or the names at that
// level.
[[nodiscard]] std::string suggest_key(const std::string& path);

// "path = value" of every key that changes results, one per line, defaults filled in; and its FNV-1a 64-bit hash.
[[nodiscard]] std::string canonical_text(const AppConfig& config);
[[nodiscard]] std::uint64_t canonical_hash(const AppConfig& config);

}  // namespace app
