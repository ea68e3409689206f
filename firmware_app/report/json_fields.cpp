#include "firmware_app/report/json_fields.h"

#include <fmt/format.h>

#include <cmath>

#include "drivers/storage/text_file.h"

namespace app {

void JsonFields::refuse(const std::string& key, const std::string& what) const {
  throw drivers::FileError(fmt::format("{}: {}: {}", path_, key, what));
}

const JsonFields::Json* JsonFields::find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

double JsonFields::finite(const Json& value, const std::string& key) const {
  if (!value.is_number()) refuse(key, "is no number");
  const double number = value.get<double>();
  if (!std::isfinite(number)) refuse(key, "is not finite");
  return number;
}

std::optional<double> JsonFields::optional_number(const Json& object, const char* key) const {
  const Json* value = find(object, key);
  return value == nullptr ? std::nullopt : std::optional<double>(finite(*value, key));
}

std::uint64_t JsonFields::count(const Json& object, const char* key) const {
  const Json* value = find(object, key);
  if (value == nullptr) return 0;
  if (!value->is_number_unsigned()) refuse(key, "is no whole number, 0 or more");
  return value->get<std::uint64_t>();
}

std::string JsonFields::text(const Json& object, const char* key) const {
  const Json* value = find(object, key);
  if (value == nullptr) return {};
  if (!value->is_string()) refuse(key, "is no text");
  return value->get<std::string>();
}

std::vector<std::string> JsonFields::texts(const Json& root, const char* key) const {
  std::vector<std::string> out;
  const Json* list = find(root, key);
  if (list == nullptr) return out;
  for (const Json& item : *list) out.push_back(item.is_string() ? item.get<std::string>() : "");
  return out;
}

}  // namespace app
