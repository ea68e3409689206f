#include "drivers/telemetry/modes_listener.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/lcm_listener.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/modal_estimate_t.hpp"

namespace drivers {

struct ModesListener::Inbox {
  Inbox(const std::string& url, const std::string& prefix)
      : channel(topic_channel(prefix, kModal)),
        listener(url, prefix, [this](std::string_view name, const void* data, std::size_t n_bytes) {
          if (name == channel) receive(data, n_bytes);
        }) {
    thread = std::jthread([this](const std::stop_token& stop) {
      bool has_more = true;
      while (has_more && !stop.stop_requested()) has_more = listener.poll();
    });
  }

  // An estimate comes in parts; one that lost a part is left out.
  void receive(const void* data, std::size_t n_bytes) {
    const auto message = decode_message<hovermodal::modal_estimate_t>(data, n_bytes);
    if (!message) return;
    if (message->part == 0) {
      gathered.clear();
      number = message->number, next_part = 0;
    }
    if (message->number != number || message->part != next_part) return;
    ++next_part;
    for (const hovermodal::mode_t& mode : message->modes) {
      if (mode.is_structural && std::isfinite(mode.frequency_hz) && gathered.size() < kMost)
        gathered.push_back({mode.frequency_hz, static_cast<double>(mode.damping_ratio)});
    }
    if (next_part != message->n_parts) return;
    std::sort(gathered.begin(), gathered.end(),
              [](const Mode& a, const Mode& b) { return a.frequency_hz < b.frequency_hz; });
    const std::lock_guard lock(mutex);
    newest = gathered;
  }

  std::string channel;
  std::vector<Mode> gathered;
  std::int64_t number = -1;
  int next_part = 0;
  std::mutex mutex;
  std::optional<std::vector<Mode>> newest;
  LcmListener listener;
  std::jthread thread;  // destroyed first, which ends the thread
};

ModesListener::ModesListener(const std::string& url, const std::string& prefix)
    : inbox_(std::make_unique<Inbox>(url, prefix)) {}

ModesListener::~ModesListener() = default;

std::optional<std::vector<ModesListener::Mode>> ModesListener::take() {
  const std::lock_guard lock(inbox_->mutex);
  return std::exchange(inbox_->newest, std::nullopt);
}

}  // namespace drivers
