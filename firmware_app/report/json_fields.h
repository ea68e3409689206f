#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace app {

// The fields of a JSON file that may be missing or, from another program, of any kind. Each throws drivers::FileError
// "FILE: KEY: ..." for a value of the wrong kind.
class JsonFields {
 public:
  using Json = nlohmann::ordered_json;

  explicit JsonFields(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const;
  // nullptr: missing or null.
  [[nodiscard]] static const Json* find(const Json& object, const char* key);
  [[nodiscard]] double finite(const Json& value, const std::string& key) const;
  [[nodiscard]] std::optional<double> optional_number(const Json& object, const char* key) const;
  [[nodiscard]] std::uint64_t count(const Json& object, const char* key) const;  // 0: missing
  [[nodiscard]] std::string text(const Json& object, const char* key) const;     // empty: missing
  [[nodiscard]] std::vector<std::string> texts(const Json& object, const char* key) const;

 private:
  std::string path_;
};

}  // namespace app
