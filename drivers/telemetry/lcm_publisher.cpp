#include "drivers/telemetry/lcm_publisher.h"

#include <fmt/format.h>
#include <lcm/eventlog.h>
#include <lcm/lcm.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"

namespace drivers {
namespace {

std::int64_t utc_now_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

struct LcmPublisher::Ways {
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> network{nullptr, &lcm_destroy};
  std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log{nullptr, &lcm_eventlog_destroy};

  // Returns the self-test's warning.
  std::string open_network(const LcmOptions& options) {
    const SelfTest test = run_lcm_self_test(options.url, options.channel_prefix);
    // With ttl=0 nobody but this computer could hear: deaf is as lost as mute.
    const bool stays_here = is_udpm(options.url) && parse_udpm(options.url).ttl == 0;
    if (!test.can_send || (stays_here && !test.heard)) throw std::runtime_error(test.message);
    network.reset(lcm_create(options.url.c_str()));
    if (!network) {
      throw std::runtime_error(
          fmt::format("LCM cannot open \"{}\" (its own words are on stderr). The usual URL is {}; to run without "
                      "telemetry leave telemetry.lcm_url empty.",
                      options.url, kDefaultLcmUrl));
    }
    return test.message;
  }

  void open_log(const std::string& path) {
    log.reset(lcm_eventlog_create(path.c_str(), "w"));
    if (!log) {
      throw std::runtime_error(fmt::format(
          "LCM event log \"{}\": cannot be written: {}. Check telemetry.log_file, its folder and its permissions.",
          path, std::strerror(errno)));
    }
  }

  bool write_log(std::string& channel, std::vector<std::uint8_t>& bytes, std::int64_t utc_ns) {
    lcm_eventlog_event_t event{};
    event.timestamp = utc_ns / 1000;
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.channel = channel.data();
    event.data = bytes.data();
    return lcm_eventlog_write_event(log.get(), &event) == 0 && std::ferror(log->f) == 0;
  }
};

LcmPublisher::LcmPublisher(const LcmOptions& options) : identity_(options.identity), ways_(std::make_unique<Ways>()) {
  check_channel_prefix(options.channel_prefix);
  for (std::size_t i = 0; i < kTopics; ++i) channels_[i].name = options.channel_prefix + kTopicSuffixes[i];
  if (!options.url.empty()) warning_ = ways_->open_network(options);
  if (!options.log_file.empty()) ways_->open_log(options.log_file);
}

LcmPublisher::~LcmPublisher() = default;

template <class Message>
bool LcmPublisher::send(Topic topic, Message& message) {
  Channel& channel = channels_[topic];
  message.sequence = channel.next_sequence++;
  message.utc_ns = utc_now_ns();
  const int size = message.getEncodedSize();
  buffer_.resize(static_cast<std::size_t>(size));
  bool ok = message.encode(buffer_.data(), 0, size) == size;
  if (ok && ways_->network) {
    ok = lcm_publish(ways_->network.get(), channel.name.c_str(), buffer_.data(), static_cast<unsigned>(size)) == 0;
  }
  if (ways_->log) {
    ok = ways_->write_log(channel.name, buffer_, message.utc_ns) && ok;
    // Health comes about once a second: a crash takes no more than that from the log, and a full disk shows.
    if (topic == kHealth) ok = std::fflush(ways_->log->f) == 0 && ok;
  }
  if (ok) {
    channel.n_sent.fetch_add(1, std::memory_order_relaxed);
  } else {
    n_failed_.fetch_add(1, std::memory_order_relaxed);
  }
  return ok;
}

template <class Messages>
bool LcmPublisher::send_all(Topic topic, Messages& messages) {
  if (messages.empty()) n_failed_.fetch_add(1, std::memory_order_relaxed);
  bool ok = !messages.empty();
  for (auto& message : messages) ok = send(topic, message) && ok;
  return ok;
}

// Encoding allocates: out of memory is a failed send, not the end of the service.
template <class Body>
bool LcmPublisher::guarded(Body&& body) noexcept {
  try {
    return body();
  } catch (...) {
    n_failed_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
}

void LcmPublisher::remember(const std::vector<core::ChannelInfo>& channels) {
  if (channel_infos_.size() != channels.size()) channel_infos_ = channels;  // fixed over a run
}

bool LcmPublisher::publish(const core::ModalEstimate& estimate,
                           const std::vector<core::ChannelInfo>& channels) noexcept {
  return guarded([&] {
    remember(channels);
    auto messages = to_messages(estimate, channels, identity_);
    return send_all(kModal, messages);
  });
}

bool LcmPublisher::publish(const core::DisplacementSample& sample,
                           const std::vector<core::ChannelInfo>& channels) noexcept {
  return guarded([&] {
    remember(channels);
    auto message = to_message(sample, identity_);
    return send(kDisplacement, message);
  });
}

bool LcmPublisher::publish(const core::TrackFrame& tracks) noexcept {
  return guarded([&] {
    auto message = to_message(tracks, identity_);
    return send(kTracks, message);
  });
}

bool LcmPublisher::publish(const core::CpsdSums& spectrum, const std::vector<core::ChannelInfo>& channels) noexcept {
  return guarded([&] {
    remember(channels);
    auto messages = to_messages(spectrum, channels, identity_);
    return send_all(kSpectrum, messages);
  });
}

bool LcmPublisher::publish(const core::closure::ClosureReport& report) noexcept {
  return guarded([&] {
    auto message = to_message(report, identity_);
    return send(kClosure, message);
  });
}

bool LcmPublisher::publish(const core::Health& health) noexcept {
  return guarded([&] {
    auto message = to_message(health, channel_infos_, identity_);
    for (std::size_t i = 0; i < kTopics; ++i) {
      const std::int64_t with_this = i == kHealth ? 1 : 0;
      message.counts.push_back({channels_[i].name, channels_[i].n_sent.load(std::memory_order_relaxed) + with_this});
    }
    message.n_counts = static_cast<std::int16_t>(message.counts.size());
    return send(kHealth, message);
  });
}

bool LcmPublisher::publish(const core::Preview& preview, const std::vector<core::Region>& regions) noexcept {
  return guarded([&] {
    auto message = to_message(preview, regions, identity_);
    return send(kPreview, message);
  });
}

std::uint64_t LcmPublisher::messages_sent() const noexcept {
  std::int64_t n = 0;
  for (const auto& channel : channels_) n += channel.n_sent.load(std::memory_order_relaxed);
  return static_cast<std::uint64_t>(n);
}

}  // namespace drivers
