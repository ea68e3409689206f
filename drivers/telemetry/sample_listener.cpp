#include "drivers/telemetry/sample_listener.h"

#include <stdexcept>
#include <stop_token>
#include <string_view>
#include <thread>

#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_source.h"
#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/sample_inbox.h"

namespace drivers {
namespace {

constexpr int kPoll_ms = 50;

void require_hearing(const std::string& url, const std::string& channel) {
  check_lcm_url(url);
  check_channel_prefix(channel);
  if (const SelfTest test = run_lcm_self_test(url, channel); !test.heard) throw std::runtime_error(test.message);
}

template <class Inbox, class Sample>
class LcmSampleListener : public SampleListener<Sample> {
 public:
  LcmSampleListener(const std::string& url, const std::string& channel)
      : source_(url, exact_pattern(channel),
                [this, channel](std::string_view name, const void* data, std::size_t n_bytes) {
                  if (name == channel) inbox_.receive(data, n_bytes);
                }) {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      bool has_more = true;
      while (has_more && !stop.stop_requested()) has_more = source_.poll(kPoll_ms);
    });
  }
  [[nodiscard]] rt::RingReader<Sample> samples() override { return inbox_.samples(); }
  [[nodiscard]] ListenerCounts counts() const noexcept override { return inbox_.counts(); }

 private:
  Inbox inbox_;
  LcmSource source_;
  std::jthread thread_;  // destroyed first, which ends the thread
};

}  // namespace

std::unique_ptr<AttitudeListener> listen_for_attitude(const std::string& url, const std::string& channel) {
  require_hearing(url, channel);
  return std::make_unique<LcmSampleListener<AttitudeInbox, core::AttitudeSample>>(url, channel);
}

std::unique_ptr<AircraftListener> listen_for_aircraft(const std::string& url, const std::string& channel) {
  require_hearing(url, channel);
  return std::make_unique<LcmSampleListener<AircraftInbox, core::AircraftState>>(url, channel);
}

}  // namespace drivers
