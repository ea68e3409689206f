#include "drivers/camera/recording/gpmf.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace drivers {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr int kDeepest = 8;
constexpr std::size_t kHead = 8;

std::uint64_t big_endian(Bytes bytes) noexcept {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8U | byte;
  return value;
}

std::string text_of(Bytes bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) break;
    text += byte >= ' ' && byte <= '~' ? static_cast<char>(byte) : '?';
  }
  return text;
}

std::size_t size_of(char type) noexcept {
  switch (type) {
    case 'b':
    case 'B':
      return 1;
    case 's':
    case 'S':
      return 2;
    case 'l':
    case 'L':
    case 'f':
      return 4;
    case 'j':
    case 'J':
    case 'd':
      return 8;
    default:
      return 0;  // not a number
  }
}

double number_of(char type, Bytes bytes) noexcept {
  const std::uint64_t raw = big_endian(bytes);
  switch (type) {
    case 'b':
      return static_cast<std::int8_t>(raw);
    case 's':
      return static_cast<std::int16_t>(raw);
    case 'l':
      return static_cast<std::int32_t>(raw);
    case 'j':
      return static_cast<double>(static_cast<std::int64_t>(raw));
    case 'f':
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
    case 'd':
      return std::bit_cast<double>(raw);
    default:
      return static_cast<double>(raw);
  }
}

// 0 where the number is no count: negative, not finite, or beyond what a double counts.
std::uint64_t count_of(double number) {
  constexpr double kMost = 9007199254740992.0;
  return number > 0.0 && number <= kMost ? static_cast<std::uint64_t>(number) : 0;
}

struct Item {
  std::string key;
  char type = 0;
  std::size_t row_bytes = 0, n_rows = 0;
  Bytes data;

  [[nodiscard]] std::vector<double> numbers() const {
    const std::size_t size = size_of(type);
    std::vector<double> out;
    if (size == 0 || row_bytes % size != 0) return out;
    for (std::size_t at = 0; at + size <= data.size(); at += size)
      out.push_back(number_of(type, data.subspan(at, size)));
    return out;
  }
};

class Walker {
 public:
  explicit Walker(Bytes all) : all_(all) {}

  GpmfPayload walk() {
    walk(all_, 0, nullptr);
    if (n_items_ == 0) throw std::runtime_error("byte 0: no metadata: empty, or zeros only");
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::size_t place_of(Bytes bytes) const noexcept {
    return static_cast<std::size_t>(bytes.data() - all_.data());
  }

  struct Stream {
    std::vector<double> scale;
    GpmfStream found;
  };

  [[nodiscard]] std::string no_key(std::size_t place) const {
    return fmt::format("byte {}: not a key of four letters{}", place,
                       n_items_ > 0 ? ": damaged"
                                    : ": no GPMF, or not from its beginning; name the video itself, or extract its "
                                      "stream whole");
  }

  Item take_item(Bytes& rest) const {
    if (rest.size() < kHead) throw std::runtime_error(fmt::format("byte {}: a head is cut off", place_of(rest)));
    Item item;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint8_t byte = rest[i];
      if (byte < ' ' || byte > '~') throw std::runtime_error(no_key(place_of(rest)));
      item.key += static_cast<char>(byte);
    }
    item.type = static_cast<char>(rest[4]);
    item.row_bytes = rest[5];
    item.n_rows = static_cast<std::size_t>(big_endian(rest.subspan(6, 2)));
    const std::size_t n_bytes = item.row_bytes * item.n_rows;
    const std::size_t n_padded = (n_bytes + 3) / 4 * 4;
    if (n_bytes > rest.size() - kHead) {
      throw std::runtime_error(fmt::format("byte {}: {} announces {} bytes, {} are left: cut off", place_of(rest),
                                           item.key, n_bytes, rest.size() - kHead));
    }
    item.data = rest.subspan(kHead, n_bytes);
    rest = rest.subspan(std::min(kHead + n_padded, rest.size()));
    return item;
  }

  void walk(Bytes rest, int depth, Stream* stream) {
    if (depth > kDeepest) throw std::runtime_error(fmt::format("byte {}: nested too deep", place_of(rest)));
    while (rest.size() >= 4) {
      if (big_endian(rest.first(4)) == 0) {  // padding
        rest = rest.subspan(4);
        continue;
      }
      const Item item = take_item(rest);
      ++n_items_;
      if (item.type == 0) {
        Stream inner;
        walk(item.data, depth + 1, item.key == "STRM" ? &inner : stream);
        if (!inner.found.values.empty()) out_.streams.push_back(std::move(inner.found));
      } else if (item.key == "DVNM" && out_.device.empty()) {
        out_.device = text_of(item.data);
      } else if (stream != nullptr) {
        note(item, *stream);
      }
    }
  }

  static void note(const Item& item, Stream& stream) {
    GpmfStream& found = stream.found;
    if (item.key == "ORIN") return void(found.orientation_in = text_of(item.data));
    if (item.key == "ORIO") return void(found.orientation_out = text_of(item.data));
    const std::vector<double> values = item.numbers();
    if (values.empty()) return;
    if (item.key == "STMP") return void(found.first_s = values.front() * 1e-6);
    if (item.key == "TSMP") return void(found.n_so_far = count_of(values.front()));
    if (item.key == "SCAL") return void(stream.scale = values);
    constexpr const char* kBeside[] = {"TICK", "TOCK", "TMPC", "EMPT", "TIMO", "MTRX", "VPTS", "GPSF", "GPSP"};
    for (const char* key : kBeside) {
      if (item.key == key) return;
    }
    found.key = item.key;  // the last element of a stream contains its data
    found.n_columns = item.row_bytes / size_of(item.type);
    found.values = values;
    for (std::size_t i = 0; i < found.values.size(); ++i) {
      double by = 1.0;
      if (stream.scale.size() == 1) by = stream.scale[0];
      if (stream.scale.size() == found.n_columns) by = stream.scale[i % found.n_columns];
      if (by != 0.0) found.values[i] /= by;
    }
  }

  Bytes all_;
  GpmfPayload out_;
  std::size_t n_items_ = 0;
};

}  // namespace

GpmfPayload parse_gpmf(std::span<const std::uint8_t> bytes) { return Walker(bytes).walk(); }

}  // namespace drivers
