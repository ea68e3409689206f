#include "firmware_app/run_state.h"

#include <fmt/core.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "core/spectrum/merge_sums.h"

namespace app {

namespace {

constexpr double kMostScaleApart = 0.05, kSameRate = 1e-9;
constexpr std::uint64_t kMostItems = 1'000'000'000;

class Out {
 public:
  std::vector<std::uint8_t> bytes;

  template <class T>
  void value(const T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* at = reinterpret_cast<const std::uint8_t*>(&x);
    bytes.insert(bytes.end(), at, at + sizeof x);
  }
  template <class Container>
  void list(const Container& items) {
    using Item = typename Container::value_type;
    static_assert(std::is_trivially_copyable_v<Item>);
    value(static_cast<std::uint64_t>(items.size()));
    const auto* at = reinterpret_cast<const std::uint8_t*>(items.data());
    bytes.insert(bytes.end(), at, at + items.size() * sizeof(Item));
  }
};

class In {
 public:
  explicit In(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes_.size() < sizeof x) throw std::runtime_error("it ends too early");
    std::memcpy(&x, bytes_.data(), sizeof x);
    bytes_ = bytes_.subspan(sizeof x);
  }
  template <class Container>
  void list(Container& items) {
    using Item = typename Container::value_type;
    static_assert(std::is_trivially_copyable_v<Item>);
    const std::size_t n = count();
    if (bytes_.size() / sizeof(Item) < n) throw std::runtime_error("it ends too early");
    items.resize(n);
    if (n > 0) std::memcpy(items.data(), bytes_.data(), n * sizeof(Item));
    bytes_ = bytes_.subspan(n * sizeof(Item));
  }
  [[nodiscard]] std::size_t count() {
    std::uint64_t n = 0;
    value(n);
    if (n > kMostItems || n > bytes_.size()) throw std::runtime_error("it ends too early");
    return static_cast<std::size_t>(n);
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

template <class Archive, class State>
void describe_numbers(Archive& archive, State& state) {
  archive.value(state.config_hash);
  archive.value(state.rate_hz);
  archive.value(state.scale_mm_per_px);
  archive.list(state.boot_id);
  archive.value(state.keyframe.sequence);
  archive.value(state.keyframe.t_start_ns);
  archive.list(state.keyframe.points);
  archive.list(state.spectrum);
  archive.list(state.modes);
}

template <class Archive, class Channel>
void describe_channel(Archive& archive, Channel& channel) {
  archive.value(channel.region);
  archive.list(channel.name);
  archive.value(channel.direction_u);
  archive.value(channel.direction_v);
  archive.value(channel.row_delay_s);
  archive.value(channel.is_base);
  archive.value(channel.n_integrations);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const RunState& state) {
  Out out;
  out.bytes.reserve(state.spectrum.size() + state.modes.size() + 64 * state.keyframe.points.size() + 4096);
  out.value(static_cast<std::uint64_t>(state.channels.size()));
  for (const core::ChannelInfo& channel : state.channels) describe_channel(out, channel);
  describe_numbers(out, state);
  return std::move(out.bytes);
}

RunState run_state_of(std::span<const std::uint8_t> bytes) {
  In in(bytes);
  RunState state;
  state.channels.resize(in.count());
  for (core::ChannelInfo& channel : state.channels) describe_channel(in, channel);
  describe_numbers(in, state);
  return state;
}

std::string why_foreign(const RunState& saved, const RunState& now) {
  if (saved.config_hash != now.config_hash) {
    return fmt::format("its configuration was another one ({:016x}, now {:016x})", saved.config_hash, now.config_hash);
  }
  if (!(std::abs(saved.rate_hz - now.rate_hz) <= kSameRate * now.rate_hz)) {
    return fmt::format("its frames came at {:g} Hz, now at {:g} Hz", saved.rate_hz, now.rate_hz);
  }
  core::RecordSums theirs, ours;
  theirs.channels = saved.channels, ours.channels = now.channels;
  if (std::string reason = core::why_not_addable(ours, theirs); !reason.empty()) return reason;
  if (!(std::abs(saved.scale_mm_per_px / now.scale_mm_per_px - 1.0) <= kMostScaleApart)) {
    return fmt::format("it was taken at {:.4g} mm a pixel, now it is {:.4g}: another view", saved.scale_mm_per_px,
                       now.scale_mm_per_px);
  }
  return {};
}

}  // namespace app
