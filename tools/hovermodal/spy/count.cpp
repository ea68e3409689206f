#ifdef HOVERMODAL_WITH_LCM
#include "tools/hovermodal/spy/count.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

namespace tools {
namespace {

using drivers::StreamMonitor;

struct ByTheSender {
  std::int64_t n_sent = 0, n_held_back = 0;
};

std::optional<ByTheSender> sent(const StreamMonitor& monitor, const std::string& lcm_channel) {
  if (!monitor.health()) return std::nullopt;
  for (const auto& count : monitor.health()->counts) {
    if (count.lcm_channel == lcm_channel) return ByTheSender{count.n_sent, count.n_held_back};
  }
  return std::nullopt;
}

nlohmann::json channel_json(const drivers::ChannelCount& count, std::optional<ByTheSender> by_sender) {
  nlohmann::json out{{"received", count.received},
                     {"gaps", count.gaps},
                     {"out_of_order", count.out_of_order},
                     {"restarts", count.restarts},
                     {"undecodable", count.undecodable},
                     {"foreign", count.foreign},
                     {"first_sequence", nullptr},
                     {"last_sequence", nullptr},
                     {"bytes", count.n_bytes},
                     {"sent", nullptr},
                     {"held_back", nullptr}};
  if (count.first_sequence >= 0) {
    out["first_sequence"] = count.first_sequence;
    out["last_sequence"] = count.last_sequence;
  }
  if (by_sender) {
    out["sent"] = by_sender->n_sent;
    out["held_back"] = by_sender->n_held_back;
  }
  return out;
}

}  // namespace

bool is_complete(const StreamMonitor& monitor) {
  if (!monitor.is_finished()) return false;
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    const auto topic = static_cast<StreamMonitor::Topic>(i);
    const auto& count = monitor.count(topic);
    const auto by_sender = sent(monitor, monitor.lcm_channel(topic));
    if (!by_sender && count.received == 0) continue;  // a sender without this topic
    if (!by_sender || by_sender->n_sent != static_cast<std::int64_t>(count.received)) return false;
    if (count.gaps + count.out_of_order + count.restarts + count.undecodable != 0) return false;
  }
  return true;
}

std::string count_json(const StreamMonitor& monitor) {
  nlohmann::json out;
  out["stream_id"] = monitor.stream_id();
  out["config_hash"] = fmt::format("{:016x}", static_cast<std::uint64_t>(monitor.config_hash()));
  out["final_health"] = monitor.is_finished();
  out["state"] = monitor.health() ? nlohmann::json(monitor.health()->state) : nlohmann::json(nullptr);
  out["complete"] = is_complete(monitor);
  out["other_versions"] = monitor.other_versions();
  out["senders"] = monitor.senders().n_senders();
  for (const auto& other : monitor.senders().others()) {
    if (other.is_beside)
      out["other_senders"][fmt::format("{:016x}", static_cast<std::uint64_t>(other.run_id))] = other.n_messages;
  }
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    const auto topic = static_cast<StreamMonitor::Topic>(i);
    const std::string& name = monitor.lcm_channel(topic);
    out["channels"][name] = channel_json(monitor.count(topic), sent(monitor, name));
  }
  // Strings come from the network: invalid UTF-8 is replaced.
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace tools
#endif
