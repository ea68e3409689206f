#include "drivers/camera/recording/hevc_references.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace drivers {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr int kSequenceParameters = 33;  // type of the unit
constexpr int kMostPictures = 16;        // of the standard

// The bits of a unit without the bytes that prevent start codes. Beyond its end: zeros, and `ended`.
class Bits {
 public:
  explicit Bits(Bytes bytes) noexcept : bytes_(bytes) {}

  [[nodiscard]] bool ended() const noexcept { return ended_; }

  std::uint32_t take(int n) noexcept {
    std::uint32_t value = 0;
    while (n-- > 0) value = value << 1U | next();
    return value;
  }
  void skip(int n) noexcept {
    while (n-- > 0) (void)next();
  }
  // Exp-Golomb, 9.2
  std::uint32_t number() noexcept {
    int n_zeros = 0;
    while (n_zeros < 32 && !ended_ && next() == 0) ++n_zeros;
    if (n_zeros >= 32) ended_ = true;
    return ended_ ? 0 : (1U << static_cast<unsigned>(n_zeros)) - 1U + take(n_zeros);
  }

 private:
  std::uint32_t next() noexcept {
    if (n_left_ == 0) {
      const bool prevents =
          at_ >= 2 && at_ < bytes_.size() && bytes_[at_] == 3 && bytes_[at_ - 1] == 0 && bytes_[at_ - 2] == 0;
      if (prevents) ++at_;
      if (at_ >= bytes_.size()) {
        ended_ = true;
        return 0;
      }
      byte_ = bytes_[at_++];
      n_left_ = 8;
    }
    return static_cast<std::uint32_t>(byte_) >> static_cast<unsigned>(--n_left_) & 1U;
  }

  Bytes bytes_;
  std::size_t at_ = 0;
  std::uint8_t byte_ = 0;
  int n_left_ = 0;
  bool ended_ = false;
};

// 7.3.3
void skip_profile_and_level(Bits& bits, int n_sub_layers) noexcept {
  bits.skip(96);
  if (n_sub_layers == 0) return;
  std::uint32_t has_profile = 0, has_level = 0;
  for (int i = 0; i < 8; ++i) {
    has_profile = has_profile << 1U | bits.take(1);
    has_level = has_level << 1U | bits.take(1);
  }
  for (int i = 0; i < n_sub_layers; ++i) {
    const unsigned at = 7U - static_cast<unsigned>(i);
    if ((has_profile >> at & 1U) != 0) bits.skip(88);
    if ((has_level >> at & 1U) != 0) bits.skip(8);
  }
}

// sps_max_dec_pic_buffering of the highest sub-layer; empty: the unit is cut off or no such unit.
std::optional<int> kept_pictures(Bytes unit) noexcept {
  Bits bits(unit);
  bits.skip(16);  // head of the unit
  bits.skip(4);
  const auto n_sub_layers = static_cast<int>(bits.take(3));
  bits.skip(1);
  skip_profile_and_level(bits, n_sub_layers);
  (void)bits.number();
  if (bits.number() == 3) bits.skip(1);  // chroma_format_idc: separate planes
  (void)bits.number(), (void)bits.number();
  if (bits.take(1) != 0) {  // conformance window
    for (int i = 0; i < 4; ++i) (void)bits.number();
  }
  for (int i = 0; i < 3; ++i) (void)bits.number();  // bit depths, picture order count
  const int first = bits.take(1) != 0 ? 0 : n_sub_layers;
  std::uint32_t n_kept = 0;
  for (int i = first; i <= n_sub_layers; ++i) {
    n_kept = bits.number() + 1;
    (void)bits.number(), (void)bits.number();
  }
  if (bits.ended() || n_kept > kMostPictures) return {};
  return static_cast<int>(n_kept);
}

bool is_sequence_parameters(Bytes unit) noexcept {
  return unit.size() > 2 && (unit[0] >> 1U & 0x3FU) == kSequenceParameters;
}

std::size_t two_bytes(Bytes bytes, std::size_t at) noexcept {
  return static_cast<std::size_t>(bytes[at]) << 8U | bytes[at + 1];
}

// ISO/IEC 14496-15, 8.3.3.1
template <class Take>
void for_units_of_hvcc(Bytes bytes, Take take) noexcept {
  constexpr std::size_t kHvccHead = 23;
  if (bytes.size() < kHvccHead) return;
  std::size_t at = kHvccHead;
  for (int n_arrays = bytes[kHvccHead - 1]; n_arrays > 0 && at + 3 <= bytes.size(); --n_arrays) {
    std::size_t n_units = two_bytes(bytes, at + 1);
    at += 3;
    for (; n_units > 0 && at + 2 <= bytes.size(); --n_units) {
      const std::size_t n_bytes = std::min(two_bytes(bytes, at), bytes.size() - at - 2);
      take(bytes.subspan(at + 2, n_bytes));
      at += 2 + n_bytes;
    }
  }
}

// Each unit reaches to the end: its parameters say where they end.
template <class Take>
void for_units_after_start_codes(Bytes bytes, Take take) noexcept {
  for (std::size_t at = 3; at < bytes.size(); ++at) {
    if (bytes[at - 3] == 0 && bytes[at - 2] == 0 && bytes[at - 1] == 1) take(bytes.subspan(at));
  }
}

}  // namespace

int hevc_references(Bytes extradata) noexcept {
  int most = 0;
  const auto take = [&](Bytes unit) noexcept {
    if (is_sequence_parameters(unit)) most = std::max(most, kept_pictures(unit).value_or(0));
  };
  if (!extradata.empty() && extradata[0] == 1) {
    for_units_of_hvcc(extradata, take);
  } else {
    for_units_after_start_codes(extradata, take);
  }
  return most;
}

}  // namespace drivers
