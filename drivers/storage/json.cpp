#include "drivers/storage/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "drivers/storage/csv_writer.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMaxDepth = 32;

class JsonPrinter {
 public:
  [[nodiscard]] JsonText print(const Json& value) {
    append(value, 0);
    out_.text += '\n';
    return std::move(out_);
  }

 private:
  void append(const Json& value, std::size_t level) {
    if (value.is_object()) return append_object(value, level);
    if (value.is_array()) return append_array(value, level);
    if (!value.is_number_float()) {
      // Texts from outside may contain invalid UTF-8, at which strict writing would throw.
      out_.text += value.dump(-1, ' ', false, Json::error_handler_t::replace);
      return;
    }
    const double number = value.get<double>();
    if (std::isfinite(number)) {
      fmt::format_to(std::back_inserter(out_.text), "{}", number == 0.0 ? 0.0 : number);  // avoids "-0"
    } else {
      out_.text += "null";
      ++out_.n_not_finite;
    }
  }

  void new_line(std::size_t level) { out_.text.append("\n").append(2 * level, ' '); }

  void append_object(const Json& value, std::size_t level) {
    out_.text += '{';
    const char* separator = "";
    for (const auto& [key, item] : value.items()) {
      out_.text += separator;
      separator = ",";
      new_line(level + 1);
      out_.text += Json(key).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
      append(item, level + 1);
    }
    if (!value.empty()) new_line(level);
    out_.text += '}';
  }

  void append_array(const Json& value, std::size_t level) {
    const bool one_line = std::all_of(value.begin(), value.end(), [](const Json& item) { return item.is_number(); });
    out_.text += '[';
    const char* separator = "";
    for (const Json& item : value) {
      out_.text += separator;
      separator = one_line ? ", " : ",";
      if (!one_line) new_line(level + 1);
      append(item, level + 1);
    }
    if (!one_line) new_line(level);
    out_.text += ']';
  }

  JsonText out_;
};

// Before the parser: objects keep their keys in a list that is searched for each key, and the parser's own callback
// takes time with the square of the number of objects in a list.
void require_bounded(std::string_view text, const std::string& path) {
  std::array<std::size_t, kMaxDepth + 1> n_keys{};  // of the open object, by depth
  std::size_t depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_text) {
      if (c == '\\') ++i;
      is_text = c != '"';
      continue;
    }
    is_text = c == '"';
    if (c == '[' || c == '{') {
      if (++depth > kMaxDepth) throw FileError(fmt::format("{}: is nested deeper than {}", path, kMaxDepth));
      n_keys[depth] = 0;
    } else if (c == ']' || c == '}') {
      depth -= depth > 0 ? 1 : 0;
    } else if (c == ':' && ++n_keys[depth] > Limits::kJsonKeys) {
      throw FileError(fmt::format("{}: an object has more than {} keys", path, Limits::kJsonKeys));
    }
  }
}

}  // namespace

JsonText to_json_text(const Json& value) { return JsonPrinter().print(value); }

Json read_json_file(const std::string& path, std::size_t max_bytes) {
  const std::string text = read_text_file(path, max_bytes);
  require_bounded(text, path);
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ...": the library's number says
    // nothing.
    std::string_view words = error.what();
    if (const std::size_t end = words.find("] "); words.starts_with('[') && end != std::string_view::npos)
      words.remove_prefix(end + 2);
    throw FileError(fmt::format("{}: is no valid JSON: {}; name a file that is", path, printable(words, 200)));
  }
}

void write_file_atomically(const std::string& path, const std::string& text) {
  CsvWriter writer(path, OldFile::kKeepUntilCommit);
  writer.buffer().append(text);
  writer.commit();
}

}  // namespace drivers
