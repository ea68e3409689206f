#include "drivers/exchange/mat_layout.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "drivers/storage/limits.h"
#include "drivers/storage/regular_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kMatHeader = 128, kMatTag = 8, kMatPadding = 8, kFlagBytes = 8;
constexpr std::uint32_t kInt32 = 5, kUint32 = 6, kMatrix = 14, kCompressed = 15;  // types of elements
constexpr std::uint32_t kCell = 1, kStruct = 2, kObject = 3, kSparse = 5;         // classes of arrays
constexpr std::uint32_t kLastClass = 15, kOpaque = 17;  // between: function handles; another layout
constexpr std::uint8_t kVersion73 = 2;                  // the higher byte of the version
constexpr int kDeepest = 16;

struct MatElement {
  std::uint32_t type = 0;
  Bytes data;
};

class MatLayout {
 public:
  explicit MatLayout(const std::string& path) : path_(path) {}

  void check() {
    const FileHandle file = open_regular_file(path_, "name a MAT file", Limits::kExchangeBytes);
    std::vector<std::uint8_t> all(bytes_of(file.get()));
    all.resize(read_bytes(file.get(), all.data(), all.size(), path_));
    const bool is_whole = all.size() >= kMatHeader;
    const bool is_little = is_whole && all[126] == 'I' && all[127] == 'M';
    const bool is_big = is_whole && all[126] == 'M' && all[127] == 'I';
    if (!is_little && !is_big) return check_version_4(all);
    if (all[is_little ? 125 : 124] == kVersion73) refuse("version 7.3 (HDF5) is not read; save it with -v7");
    is_swapped_ = is_little != (std::endian::native == std::endian::little);
    Bytes rest = Bytes(all).subspan(kMatHeader);
    while (const auto element = next(rest)) {
      if (element->type == kCompressed)
        check_compressed(element->data);
      else if (element->type == kMatrix && element->data.size() % kMatPadding == 0)
        check_array(element->data, 0);
      else
        refuse(fmt::format("an element of type {} and {} bytes where a variable should begin: damaged", element->type,
                           element->data.size()));
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw FileError(path_ + ": " + what); }

  [[nodiscard]] std::uint32_t number(Bytes at) const {
    std::uint32_t out = 0;
    std::memcpy(&out, at.data(), sizeof(out));
    return is_swapped_ ? __builtin_bswap32(out) : out;
  }

  // The first element of the bytes, which it takes from them; empty: none.
  [[nodiscard]] std::optional<MatElement> next(Bytes& rest) const {
    if (rest.size() < kMatTag) return std::nullopt;
    const std::uint32_t first = number(rest);
    if (first >> 16U != 0) {  // small: at most four bytes beside their type and number
      const MatElement out{first & 0xFFFFU, rest.subspan(4, std::min<std::size_t>(first >> 16U, 4))};
      rest = rest.subspan(kMatTag);
      return out;
    }
    const std::size_t n = number(rest.subspan(4)), left = rest.size() - kMatTag;
    if (n > left) refuse(fmt::format("an element announces {} bytes, {} are left: cut off or damaged", n, left));
    const MatElement out{first, rest.subspan(kMatTag, n)};
    const std::size_t padded = out.type == kCompressed ? n : (n + kMatPadding - 1) / kMatPadding * kMatPadding;
    rest = rest.subspan(kMatTag + std::min(padded, left));
    return out;
  }

  // Variables one after another: type, rows, columns, is it complex, length of the name; the name; the values.
  void check_version_4(Bytes rest) {
    constexpr std::array<double, 6> kSizes{8, 4, 4, 2, 2, 1};  // of a value, by the tens of the type
    constexpr std::size_t kHead = 20;
    constexpr std::uint32_t kLargestType = 4052;
    is_swapped_ = rest.size() >= kHead && number(rest) > kLargestType;
    while (rest.size() >= kHead) {
      std::array<std::uint32_t, 5> head{};
      for (std::size_t i = 0; i < head.size(); ++i) head[i] = number(rest.subspan(4 * i));
      const auto [type, n_rows, n_columns, is_complex, name_bytes] = head;
      const std::size_t of_size = type / 10 % 10;
      if (type > kLargestType || of_size >= kSizes.size())
        refuse("no MAT file that can be read; save it with -v7 or -v6");
      const double n = name_bytes + kSizes[of_size] * n_rows * n_columns * (is_complex != 0 ? 2.0 : 1.0);
      rest = rest.subspan(kHead);
      if (n > static_cast<double>(rest.size()))
        refuse(fmt::format("a variable announces {:.0f} bytes, {} are left: cut off or damaged", n, rest.size()));
      rest = rest.subspan(static_cast<std::size_t>(n));
    }
  }

  void check_compressed(Bytes data) {
    std::vector<std::uint8_t> out(std::min<std::size_t>(8 * data.size() + 4096, Limits::kExchangeBytes));
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) refuse("no memory to inflate it");
    stream.next_in = const_cast<Bytef*>(data.data());  // zlib's signature; it does not write there
    stream.avail_in = static_cast<uInt>(data.size());
    std::size_t n = 0;
    int state = Z_OK;
    while (state == Z_OK) {
      if (n == out.size()) {
        if (n >= Limits::kExchangeBytes) break;
        out.resize(std::min<std::size_t>(2 * n, Limits::kExchangeBytes));
      }
      stream.next_out = out.data() + n;
      stream.avail_out = static_cast<uInt>(out.size() - n);
      state = inflate(&stream, Z_NO_FLUSH);
      n = out.size() - stream.avail_out;
    }
    inflateEnd(&stream);
    if (state == Z_OK) refuse("its variables are larger than 96 MiB; save only the series");
    Bytes rest(out.data(), n);
    if (const auto element = next(rest); element && element->type == kMatrix) check_array(element->data, 0);
  }

  // Flags, dimensions, name; then values, or an array per cell or field.
  void check_array(Bytes rest, int depth) const {
    if (depth > kDeepest) refuse(fmt::format("arrays nested deeper than {}", kDeepest));
    if (rest.empty()) return;  // an empty array
    const auto flags = next(rest);
    if (!flags || flags->type != kUint32 || flags->data.size() != kFlagBytes)
      refuse("an array does not begin with its flags: damaged");
    const std::uint32_t array_class = number(flags->data) & 0xFFU;
    if (array_class == 0 || array_class > kOpaque) refuse(fmt::format("an array of class {}: damaged", array_class));
    if (array_class > kLastClass) return;
    const auto dimensions = next(rest), name = next(rest);
    if (!dimensions || !name) return;
    if (dimensions->type != kInt32) refuse("an array's second element is not its dimensions: damaged");
    double n = 1.0;
    for (std::size_t at = 0; at + 4 <= dimensions->data.size(); at += 4) n *= number(dimensions->data.subspan(at));
    if (array_class > kObject && array_class != kSparse && n > static_cast<double>(rest.size()))
      refuse(fmt::format("an array announces {:.0f} values in {} bytes: damaged", n, rest.size()));
    if (array_class <= kObject) {
      if (array_class == kObject) (void)next(rest);  // the name of its class
      if (array_class != kCell) n *= n_fields(rest);
      if (n > static_cast<double>(rest.size() / kMatTag + 1))
        refuse(fmt::format("a cell or struct announces {:.0f} arrays in {} bytes: damaged", n, rest.size()));
    }
    while (const auto inner = next(rest)) {
      if (inner->type == kMatrix) check_array(inner->data, depth + 1);
    }
  }
  // From the length and the names of the fields.
  [[nodiscard]] double n_fields(Bytes& rest) const {
    const auto length = next(rest), names = next(rest);
    if (!length || !names || length->data.size() < 4) return 0.0;
    const std::uint32_t each = number(length->data);
    return each == 0 ? 0.0 : static_cast<double>(names->data.size() / each);
  }

  const std::string& path_;
  bool is_swapped_ = false;
};

}  // namespace

void check_mat_layout(const std::string& path) { MatLayout(path).check(); }

}  // namespace drivers
