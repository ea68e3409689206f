#include "drivers/telemetry/stream_monitor.h"

#include <algorithm>
#include <utility>

#include "drivers/telemetry/decode.h"
#include "hovermodal/tracks_t.hpp"

namespace drivers {

StreamMonitor::StreamMonitor(const std::string& channel_prefix) : prefix_(channel_prefix) {
  for (std::size_t i = 0; i < kTopics; ++i) names_[i] = topic_channel(channel_prefix, static_cast<Topic>(i));
}

void StreamMonitor::receive(std::string_view lcm_channel, const void* data, std::size_t n_bytes,
                            std::int64_t now_ns) noexcept {
  const auto found = topic_of(prefix_, lcm_channel);
  if (!found) return;
  const Topic topic = found->topic;
  counts_[topic].n_bytes += n_bytes;
  if (found->layout != kTopicLayouts[topic]) {
    ++counts_[topic].undecodable;
    layouts_.note_layout(topic, found->layout);
    return;
  }
  try {
    dispatch(topic, data, n_bytes, now_ns);
  } catch (...) {  // out of memory: the message is lost
    ++counts_[topic].undecodable;
  }
}

void StreamMonitor::dispatch(Topic topic, const void* data, std::size_t n_bytes, std::int64_t now_ns) {
  switch (topic) {
    case kModal:
      if (auto m = open<hovermodal::modal_estimate_t>(topic, data, n_bytes, now_ns)) take(std::move(*m));
      break;
    case kDisplacement:
      if (const auto m = open<hovermodal::displacement_t>(topic, data, n_bytes, now_ns)) take(*m);
      break;
    case kHealth:
      if (auto m = open<hovermodal::health_t>(topic, data, n_bytes, now_ns)) take(std::move(*m), now_ns);
      break;
    case kSpectrum:
      if (auto m = open<hovermodal::spectrum_t>(topic, data, n_bytes, now_ns)) take(std::move(*m));
      break;
    case kTracks:
      static_cast<void>(open<hovermodal::tracks_t>(topic, data, n_bytes, now_ns));
      break;
    case kClosure:
      if (auto m = open<hovermodal::closure_report_t>(topic, data, n_bytes, now_ns))
        (m->level == "structure" ? structure_ : closure_) = std::move(*m);
      break;
    case kPreview:
      if (auto m = open<hovermodal::preview_t>(topic, data, n_bytes, now_ns)) preview_ = std::move(*m);
      break;
    case kTopics:
      break;
  }
}

bool StreamMonitor::follows(std::int64_t run_id, std::int64_t now_ns) noexcept {
  const SenderWatch::Whose whose = senders_.note(run_id, now_ns);
  if (whose == SenderWatch::Whose::kNextRun) {
    for (ChannelCount& count : counts_) count.begin_run();
  }
  return whose != SenderWatch::Whose::kOther;
}

std::vector<std::string> StreamMonitor::sender_warnings() const {
  std::vector<std::string> out = layouts_.words(prefix_);
  for (std::string& words : senders_.words(stream_id_)) out.push_back(std::move(words));
  return out;
}

// Decodes and counts. Empty if not usable: undecodable, of another stream, or older than the newest known.
template <class Message>
std::optional<Message> StreamMonitor::open(Topic topic, const void* data, std::size_t n_bytes, std::int64_t now_ns) {
  ChannelCount& count = counts_[topic];
  auto message = decode_message<Message>(data, n_bytes);
  if (!message || message->sequence < 0) {
    ++count.undecodable;
    if (const auto heard = fingerprint_of(data, n_bytes); heard && *heard != Message::getHash())
      layouts_.note_fingerprint(topic, *heard, Message::getHash());
    return std::nullopt;
  }
  if (!is_following_) {
    is_following_ = true;
    stream_id_ = message->stream_id;
  } else if (message->stream_id != stream_id_) {
    ++count.foreign;
    return std::nullopt;
  }
  if (!follows(message->run_id, now_ns)) {
    ++count.foreign;
    return std::nullopt;
  }
  last_received_ns_ = now_ns;
  if (!count.note(message->sequence, message->utc_ns, now_ns)) return std::nullopt;
  config_hash_ = message->config_hash;
  // A spectrum's time counts from the first sample: a clock different from the others'.
  if (topic != kSpectrum) stream_time_ns_ = message->stream_time_ns;
  return message;
}

void StreamMonitor::take(hovermodal::modal_estimate_t message) {
  const bool is_same = estimate_ && estimate_->number == message.number && estimate_->n_parts == message.n_parts &&
                       estimate_->stream_time_ns == message.stream_time_ns &&
                       n_modal_restarts_ == counts_[kModal].restarts;
  n_modal_restarts_ = counts_[kModal].restarts;  // the same file played again has the same numbers and times
  if (!is_same) {
    parts_.clear();
    n_modes_ = 0;
  }
  std::vector<hovermodal::mode_t> modes = std::move(message.modes);
  message.modes.clear();
  message.n_modes = 0;
  if (n_modes_ + modes.size() > kMaxModes) modes.resize(kMaxModes - n_modes_);
  const std::size_t n_added = modes.size();
  if (parts_.emplace(message.part, std::move(modes)).second) n_modes_ += n_added;
  estimate_ = std::move(message);
}

void StreamMonitor::take(const hovermodal::displacement_t& message) {
  const std::size_t n = std::min(message.value_mm.size(), kMaxChannels);
  if (history_.size() != n) {
    history_.assign(n, {});
    history_ns_.clear();
  }
  ++n_samples_;
  history_ns_.push_back(message.stream_time_ns);
  if (history_ns_.size() > kHistory) history_ns_.pop_front();
  for (std::size_t i = 0; i < n; ++i) {
    history_[i].push_back(message.value_mm[i]);
    if (history_[i].size() > kHistory) history_[i].pop_front();
  }
}

void StreamMonitor::take(hovermodal::spectrum_t message) {
  const auto n = static_cast<std::size_t>(std::max<std::int16_t>(message.n_channels, 0));
  const auto i = static_cast<std::size_t>(std::max<std::int16_t>(message.channel_index, 0));
  spectra_.resize(std::min(n, kMaxSpectra));
  if (i < spectra_.size()) spectra_[i] = std::move(message);
}

void StreamMonitor::take(hovermodal::health_t message, std::int64_t now_ns) {
  const std::string_view state = message.state;
  is_finished_ = state.substr(0, 8) == "finished" || state.substr(0, 5) == "fault";
  if (is_finished_) finished_at_ns_ = now_ns, senders_.followed_run_ended();
  const bool same_run = health_ && message.sequence > health_->sequence;
  previous_health_ = same_run ? std::move(health_) : std::nullopt;
  health_ = std::move(message);
}

std::vector<const hovermodal::mode_t*> StreamMonitor::modes() const {
  std::vector<const hovermodal::mode_t*> out;
  for (const auto& [part, modes] : parts_) {
    for (const auto& mode : modes) out.push_back(&mode);
  }
  return out;
}

std::string StreamMonitor::channel_name(std::size_t i_channel) const {
  if (estimate_ && i_channel < estimate_->channel_names.size()) return estimate_->channel_names[i_channel];
  if (health_ && i_channel < health_->channels.size()) return health_->channels[i_channel].name;
  return "channel " + std::to_string(i_channel);
}

}  // namespace drivers
