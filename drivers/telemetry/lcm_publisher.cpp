#include "drivers/telemetry/lcm_publisher.h"

#include <fmt/format.h>
#include <lcm/lcm.h>

#include <stdexcept>
#include <type_traits>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/event_log.h"
#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"
#include "rt/clock.h"

namespace drivers {
struct LcmPublisher::Ways {
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> network{nullptr, &lcm_destroy};
  std::shared_ptr<EventLog> log_file, record;  // null: not requested

  // Returns the self-test's warning.
  std::string open_network(const LcmOptions& options) {
    const SelfTest test = run_lcm_self_test(options.url, options.channel_prefix);
    // With ttl=0 only this computer could receive: if it cannot, every message is lost.
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
};

LcmPublisher::LcmPublisher(const LcmOptions& options)
    : identity_(options.identity), ways_(std::make_unique<Ways>()), budget_(options.max_kbit_s) {
  check_channel_prefix(options.channel_prefix);
  for (std::size_t i = 0; i < kTopics; ++i)
    channel_names_[i] = topic_channel(options.channel_prefix, static_cast<Topic>(i));
  if (!options.url.empty()) warning_ = ways_->open_network(options);
  if (!options.log_file.empty()) ways_->log_file = std::make_shared<EventLogFile>(options.log_file);
  ways_->record = options.record;
}

LcmPublisher::~LcmPublisher() = default;

// Stores the bytes in buffer_; empty if the message cannot be encoded.
template <class Message>
void LcmPublisher::encode(Topic topic, Message& message, const WayNumbers& numbers) {
  message.sequence = numbers[topic].next_sequence;
  if constexpr (std::is_same_v<Message, hovermodal::health_t>) {
    for (std::size_t i = 0; i < kTopics; ++i) message.counts[i].n_sent = numbers[i].n_sent + (i == kHealth ? 1 : 0);
  }
  const int size = message.getEncodedSize();
  buffer_.resize(static_cast<std::size_t>(size));
  if (message.encode(buffer_.data(), 0, size) != size) buffer_.clear();
}

template <class Message>
bool LcmPublisher::send_over_network(Topic topic, Message& message) {
  encode(topic, message, network_numbers_);
  Numbers& numbers = network_numbers_[topic];
  ++numbers.next_sequence;
  const bool ok = !buffer_.empty() && lcm_publish(ways_->network.get(), channel_names_[topic].c_str(), buffer_.data(),
                                                  static_cast<unsigned>(buffer_.size())) == 0;
  numbers.n_sent += ok ? 1 : 0;
  return ok;
}

template <class Message>
bool LcmPublisher::write_to_log(Topic topic, Message& message) {
  encode(topic, message, log_numbers_);
  Numbers& numbers = log_numbers_[topic];
  ++numbers.next_sequence;
  bool ok = !buffer_.empty();
  const auto write_to = [&](EventLog& log) {
    const bool is_written = log.write(channel_names_[topic], buffer_, message.utc_ns);
    // Health comes about once a second: flushing then limits what a crash loses from the log, and shows a full disk.
    return topic == kHealth ? log.flush() && is_written : is_written;
  };
  if (ways_->record) (void)write_to(*ways_->record);  // it counts its own losses
  if (ways_->log_file) ok = write_to(*ways_->log_file) && ok;
  numbers.n_sent += ok ? 1 : 0;
  return ok;
}

bool LcmPublisher::may_send(Topic topic, int n_bytes) {
  const std::size_t n = wire_bytes(channel_names_[topic].size(), static_cast<std::size_t>(n_bytes));
  return budget_.admit(topic, n, rt::monotonic_ns());
}

void LcmPublisher::send_waiting_spectra(bool whatever_the_budget) {
  while (!waiting_spectra_.empty()) {
    hovermodal::spectrum_t& spectrum = waiting_spectra_.front();
    if (!may_send(kSpectrum, spectrum.getEncodedSize()) && !whatever_the_budget) return;
    spectrum.utc_ns = rt::utc_ns();
    (send_over_network(kSpectrum, spectrum) ? n_sent_ : n_failed_).fetch_add(1, std::memory_order_relaxed);
    waiting_spectra_.pop_front();
  }
}

template <class Message>
bool LcmPublisher::send(Topic topic, Message& message) {
  constexpr bool kMayWait = std::is_same_v<Message, hovermodal::spectrum_t>;
  message.utc_ns = rt::utc_ns();
  bool ok = true;
  bool is_held_back = false;
  if (ways_->network) {
    send_waiting_spectra(false);
    is_held_back = (kMayWait && !waiting_spectra_.empty()) || !may_send(topic, message.getEncodedSize());
    if (!is_held_back) {
      ok = send_over_network(topic, message);
    } else if constexpr (kMayWait) {
      waiting_spectra_.push_back(message);
    } else {
      ++n_held_back_[topic];
    }
  }
  if (ways_->log_file || ways_->record) ok = write_to_log(topic, message) && ok;
  if (!ok) {
    n_failed_.fetch_add(1, std::memory_order_relaxed);
  } else if (!is_held_back) {
    n_sent_.fetch_add(1, std::memory_order_relaxed);
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

// Encoding allocates: out of memory is a failed send and does not end the service.
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
  if (channel_infos_.size() != channels.size()) channel_infos_ = channels;  // constant over a run
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
    n_held_back_[kSpectrum] += static_cast<std::int64_t>(waiting_spectra_.size());
    waiting_spectra_.clear();
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
    const bool is_last = health.state.rfind("finished", 0) == 0 || health.state.rfind("fault", 0) == 0;
    if (is_last) send_waiting_spectra(true);
    auto message = to_message(health, channel_infos_, identity_);
    for (std::size_t i = 0; i < kTopics; ++i) message.counts.push_back({channel_names_[i], 0, n_held_back_[i]});
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

}  // namespace drivers
