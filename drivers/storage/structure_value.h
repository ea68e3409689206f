#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "drivers/storage/yaml.h"

namespace drivers {

// One map of a structure file, with the path of keys to it. Everything throws FileError "FILE:LINE: key: what; remedy".
class StructureMap {
 public:
  StructureMap(const YamlNode& node, std::string path, const std::string& file);

  // Refuses keys that are not among these.
  void allow(const std::vector<const char*>& keys) const;
  [[nodiscard]] bool has(const std::string& key) const { return node_.find(key) != nullptr; }
  [[nodiscard]] double number(const std::string& key, double low, double high) const;
  [[nodiscard]] double number_or(const std::string& key, double low, double high, double fallback) const;
  [[nodiscard]] std::size_t whole_or(const std::string& key, double low, double high, std::size_t fallback) const;
  [[nodiscard]] std::string text(const std::string& key) const;
  [[nodiscard]] std::string text_or(const std::string& key, const std::string& fallback) const;
  [[nodiscard]] std::string one_of(const std::string& key,
                                   std::initializer_list<const char*> names) const;  // first: default
  // n: how many are expected; 0: any number.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, double low, double high, std::size_t n) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& key) const;
  [[nodiscard]] std::vector<StructureMap> maps(const std::string& key) const;  // empty: not there
  [[nodiscard]] StructureMap map(const std::string& key) const;
  [[noreturn]] void refuse(const std::string& what) const;  // of the whole map
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const;

 private:
  [[nodiscard]] const YamlNode& at(const std::string& key) const;
  [[noreturn]] void refuse_at(int line, const std::string& path, const std::string& what) const;
  [[nodiscard]] double in_range(const YamlNode& node, const std::string& path, double low, double high) const;

  const YamlNode& node_;
  std::string path_;
  const std::string& file_;
};

}  // namespace drivers
