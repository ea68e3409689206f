#include "drivers/telemetry/lcm_datagrams.h"

#include <algorithm>
#include <cstring>
#include <optional>

namespace drivers {
namespace {

constexpr std::size_t kShortHead = 8;      // "LC02", number
constexpr std::size_t kFragmentHead = 20;  // "LC03", number, size, offset: 32 bits each; index, count: 16 bits each

std::uint32_t big_endian32(const std::uint8_t* bytes, std::size_t n) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < n; ++i) value = value << 8U | bytes[i];
  return value;
}

// The channel's name before the data, without its terminating zero; empty if there is none.
std::optional<std::string_view> channel_at(const std::uint8_t* bytes, std::size_t n) {
  const std::size_t reach = std::min(n, LcmDatagrams::kLongestChannel + 1);
  const void* zero = reach > 0 ? std::memchr(bytes, 0, reach) : nullptr;
  if (zero == nullptr) return std::nullopt;
  const void* begin = bytes;
  const auto length = static_cast<std::size_t>(static_cast<const std::uint8_t*>(zero) - bytes);
  return std::string_view(static_cast<const char*>(begin), length);
}

}  // namespace

void LcmDatagrams::take(const void* datagram, std::size_t n_bytes, std::uint64_t sender) {
  const auto* bytes = static_cast<const std::uint8_t*>(datagram);
  if (n_bytes >= kShortHead && std::memcmp(bytes, "LC02", 4) == 0) {
    take_whole(bytes + kShortHead, n_bytes - kShortHead);
  } else if (n_bytes >= kFragmentHead && std::memcmp(bytes, "LC03", 4) == 0) {
    take_fragment(bytes, n_bytes, sender);
  } else {
    ++n_malformed_;
  }
}

void LcmDatagrams::take_whole(const std::uint8_t* bytes, std::size_t n) {
  const auto channel = channel_at(bytes, n);
  if (!channel) {
    ++n_malformed_;
    return;
  }
  const std::size_t head = channel->size() + 1;
  receive_(*channel, bytes + head, n - head);
}

std::deque<LcmDatagrams::Open>::iterator LcmDatagrams::open_message(std::uint64_t sender, std::uint32_t number,
                                                                    std::size_t size, std::size_t n_fragments) {
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [&](const Open& one) { return one.sender == sender && one.number == number; });
  if (found != open_.end()) {
    const bool is_same = found->data.size() == size && found->has.size() == n_fragments;
    if (is_same) return found;
    ++n_incomplete_;
    open_.erase(found);
  }
  if (open_.size() >= kMostOpen) {
    ++n_incomplete_;
    open_.pop_front();
  }
  Open one;
  one.sender = sender;
  one.number = number;
  one.data.resize(size);
  one.has.assign(n_fragments, false);
  one.n_missing = n_fragments;
  return open_.insert(open_.end(), std::move(one));
}

void LcmDatagrams::take_fragment(const std::uint8_t* bytes, std::size_t n, std::uint64_t sender) {
  const std::uint32_t number = big_endian32(bytes + 4, 4);
  const std::size_t size = big_endian32(bytes + 8, 4), offset = big_endian32(bytes + 12, 4);
  const std::size_t index = big_endian32(bytes + 16, 2), n_fragments = big_endian32(bytes + 18, 2);
  const std::uint8_t* data = bytes + kFragmentHead;
  std::size_t n_data = n - kFragmentHead;
  std::optional<std::string_view> channel;
  if (index == 0) {
    channel = channel_at(data, n_data);
    const std::size_t head = channel ? channel->size() + 1 : 0;
    data += head;
    n_data -= head;
  }
  const bool is_possible = size <= kMostBytes && index < n_fragments && n_fragments <= std::max<std::size_t>(size, 1) &&
                           offset <= size && n_data <= size - offset && (index != 0 || channel);
  if (!is_possible) {
    ++n_malformed_;
    return;
  }
  const auto message = open_message(sender, number, size, n_fragments);
  if (message->has[index]) return;  // received twice
  if (channel) message->channel = *channel;
  if (n_data > 0) std::memcpy(message->data.data() + offset, data, n_data);
  message->has[index] = true;
  message->n_bytes += n_data;
  if (--message->n_missing > 0) return;
  const Open whole = std::move(*message);
  open_.erase(message);
  if (whole.n_bytes == size) {
    receive_(whole.channel, whole.data.data(), whole.data.size());
  } else {
    ++n_malformed_;  // fragments that overlap or leave a gap
  }
}

}  // namespace drivers
