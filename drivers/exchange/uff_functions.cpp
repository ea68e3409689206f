#include "drivers/exchange/uff_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/exchange/series_file.h"
#include "drivers/storage/ascii.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

std::string stated(std::string_view text) {
  text = trimmed(text);
  return text == "NONE" ? std::string() : std::string(text);
}

// The data sets of a universal file, as text with the lines' numbers.
class UffFile {
 public:
  explicit UffFile(const std::string& path) : path_(path), bytes_(read_text_file(path, Limits::kExchangeBytes)) {}

  bool next(std::string_view& line) {
    if (at_ >= bytes_.size()) return false;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    line = std::string_view(bytes_).substr(at_, end - at_);
    at_ = end + 1;
    ++n_lines_;
    return true;
  }
  std::string_view require_line() {
    std::string_view line;
    if (!next(line)) fail("the file ends within a data set; is it cut off?");
    return line;
  }
  std::string_view take(std::size_t n_bytes) {
    if (n_bytes > bytes_.size() - std::min(at_, bytes_.size())) fail("the file ends within the values; is it cut off?");
    const std::string_view out = std::string_view(bytes_).substr(at_, n_bytes);
    at_ += n_bytes;
    return out;
  }
  [[nodiscard]] std::size_t n_left() const { return bytes_.size() - std::min(at_, bytes_.size()); }
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", path_, n_lines_, what));
  }

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0, n_lines_ = 0;
};

class UffReader {
 public:
  explicit UffReader(const std::string& path) : file_(path) {}

  [[nodiscard]] std::vector<UffResponse> read() {
    std::string_view line;
    while (file_.next(line)) {
      if (trimmed(line) != "-1") continue;
      const std::string_view head = file_.require_line();
      const std::string_view number = trimmed(head.substr(0, 6));
      if (number == "58") {
        read_function(head);
      } else if (number == "164") {
        read_units();
      } else {
        while (trimmed(file_.require_line()) != "-1") {
        }
      }
    }
    for (UffResponse& one : out_) {
      if (one.unit.empty() && quantity_unit(one).has_value()) one.unit = *quantity_unit(one);
    }
    return std::move(out_);
  }

 private:
  struct Form {
    int type = 0;      // of the function
    int ordinate = 0;  // 2 single, 4 double; 5, 6 complex
    std::size_t n_values = 0;
    bool even = false;
    bool binary = false, little = true;
    std::size_t n_bytes = 0;
    int quantity = 0;
  };

  [[nodiscard]] double number(std::string_view field, const char* what) const {
    std::string text(trimmed(field));
    if (text.empty()) return 0.0;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
    if (text.starts_with('+')) text.erase(0, 1);
    const auto value = parse_number(text);
    if (!value) file_.fail(fmt::format("{}: `{}` is no number", what, printable(field)));
    return *value;
  }
  [[nodiscard]] int whole(std::string_view field, const char* what) const {
    const double value = number(field, what);
    if (value != std::floor(value) || std::abs(value) > 2e9)
      file_.fail(fmt::format("{}: `{}` is no whole number", what, printable(field)));
    return static_cast<int>(value);
  }
  static std::string_view field(std::string_view line, std::size_t at, std::size_t width) {
    return at < line.size() ? line.substr(at, width) : std::string_view();
  }

  void read_units() {
    const int code = whole(field(file_.require_line(), 0, 10), "units code");
    length_factor_ = number(field(file_.require_line(), 0, 25), "length factor");
    units_code_ = code;
    while (trimmed(file_.require_line()) != "-1") {
    }
  }

  // The head says 58 or 58b; of a binary one also the order of bytes, the format of numbers and the length.
  void read_function(std::string_view head) {
    Form form;
    form.binary = head.size() > 6 && (head[6] == 'b' || head[6] == 'B');
    if (form.binary) {
      const int order = whole(field(head, 7, 6), "byte order"), format = whole(field(head, 13, 6), "number format");
      const int n_bytes = whole(field(head, 31, 12), "number of bytes");
      if ((order != 1 && order != 2) || format != 2)
        file_.fail("binary numbers of another kind than IEEE 754; export as text (58) instead");
      if (n_bytes < 0) file_.fail("a negative number of bytes");
      form.little = order == 1, form.n_bytes = static_cast<std::size_t>(n_bytes);
    }
    UffResponse out;
    read_head(form, out);
    const bool wanted = form.type == 1 && (form.ordinate == 2 || form.ordinate == 4);
    if (form.type == 1 && !wanted) file_.fail("a complex time response; export it as real values");
    if (!wanted) return form.binary ? skip_binary(form) : skip_text();
    const std::size_t n_numbers = form.n_values * (form.even ? 1 : 2);
    // A value takes four bytes at least, whatever the form: a hostile count allocates nothing.
    if (n_numbers > file_.n_left() / 4)
      file_.fail(fmt::format("{} values are announced and the file is too short for them", form.n_values));
    form.binary ? read_binary(form, n_numbers, out) : read_text(form, n_numbers, out);
    quantity_.push_back(form.quantity);
    out_.push_back(std::move(out));
  }

  void read_head(Form& form, UffResponse& out) {
    out.title = stated(file_.require_line());
    for (int skipped = 0; skipped < 3; ++skipped) (void)file_.require_line();
    out.remark = stated(file_.require_line());
    const std::string_view dof = file_.require_line();
    form.type = whole(field(dof, 0, 5), "function type");
    out.entity = stated(field(dof, 31, 10));
    out.node = whole(field(dof, 41, 10), "response node");
    out.direction = whole(field(dof, 51, 4), "response direction");
    const std::string_view data = file_.require_line();
    form.ordinate = whole(field(data, 0, 10), "ordinate type");
    const int n_values = whole(field(data, 10, 10), "number of values");
    form.even = whole(field(data, 20, 10), "abscissa spacing") == 1;
    if (n_values < 0) file_.fail("a negative number of values");
    form.n_values = static_cast<std::size_t>(n_values);
    out.even = form.even;
    out.first_s = number(field(data, 30, 13), "abscissa minimum");
    out.step_s = number(field(data, 43, 13), "abscissa increment");
    (void)file_.require_line();  // abscissa
    const std::string_view ordinate = file_.require_line();
    form.quantity = whole(field(ordinate, 0, 10), "ordinate quantity");
    out.unit = stated(field(ordinate, 47, 20));
    (void)file_.require_line();  // denominator
    (void)file_.require_line();  // z axis
  }

  void skip_text() {
    while (trimmed(file_.require_line()) != "-1") {
    }
  }
  void skip_binary(const Form& form) {
    (void)file_.take(form.n_bytes);
    skip_text();
  }

  static void add(const Form& form, std::size_t k, double value, UffResponse& out) {
    (form.even || k % 2 == 1 ? out.value : out.t_s).push_back(value);
  }

  // Columns of 13 characters, of 20 for an ordinate of double precision.
  void read_text(const Form& form, std::size_t n_numbers, UffResponse& out) {
    std::size_t k = 0;
    while (k < n_numbers) {
      const std::string_view line = file_.require_line();
      if (trimmed(line) == "-1")
        file_.fail(fmt::format("{} values instead of {}; is the file cut off?", out.value.size(), form.n_values));
      for (std::size_t at = 0; k < n_numbers;) {
        const std::size_t width = form.ordinate == 4 && (form.even || k % 2 == 1) ? 20 : 13;
        const std::string_view cell = field(line, at, width);
        if (trimmed(cell).empty()) break;
        add(form, k++, number(cell, "value"), out);
        at += width;
      }
    }
    if (trimmed(file_.require_line()) != "-1") file_.fail("more values than announced");
  }

  template <class Number, class Bits>
  [[nodiscard]] Number binary_number(std::string_view bytes, bool little) const {
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof(Bits); ++i) {
      const auto byte = static_cast<unsigned char>(bytes[little ? sizeof(Bits) - 1 - i : i]);
      bits = static_cast<Bits>(static_cast<Bits>(bits << 8U) | byte);
    }
    return std::bit_cast<Number>(bits);
  }

  // Abscissas of uneven functions are single, ordinates as announced.
  void read_binary(const Form& form, std::size_t n_numbers, UffResponse& out) {
    const std::string_view all = file_.take(form.n_bytes);
    std::size_t at = 0;
    for (std::size_t k = 0; k < n_numbers; ++k) {
      const bool is_double = form.ordinate == 4 && (form.even || k % 2 == 1);
      const std::size_t width = is_double ? 8 : 4;
      if (at + width > all.size()) file_.fail("fewer bytes than the values need");
      const std::string_view bytes = all.substr(at, width);
      const double value = is_double ? binary_number<double, std::uint64_t>(bytes, form.little)
                                     : static_cast<double>(binary_number<float, std::uint32_t>(bytes, form.little));
      add(form, k, value, out);
      at += width;
    }
    skip_text();
  }

  // From the quantity and the units of the file; empty if either is unknown.
  [[nodiscard]] std::optional<std::string> quantity_unit(const UffResponse& one) const {
    const auto i = static_cast<std::size_t>(&one - out_.data());
    const bool is_metre = units_code_ == 1 || (units_code_ == 9 && length_factor_ == 1.0);
    const bool is_mm = units_code_ == 5;
    if (!is_metre && !is_mm) return std::nullopt;
    const std::string length = is_metre ? "m" : "mm";
    switch (quantity_[i]) {
      case 8:
        return length;
      case 11:
        return length + "/s";
      case 12:
        return length + "/s^2";
      default:
        return std::nullopt;
    }
  }

  UffFile file_;
  std::vector<UffResponse> out_;
  std::vector<int> quantity_;  // per response
  int units_code_ = 0;
  double length_factor_ = 0.0;
};

}  // namespace

std::vector<UffResponse> read_uff_responses(const std::string& path) { return UffReader(path).read(); }

}  // namespace drivers
