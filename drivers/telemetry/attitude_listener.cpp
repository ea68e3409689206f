#include "drivers/telemetry/attitude_listener.h"

#include <fmt/format.h>
#include <lcm/lcm.h>

#include <stdexcept>
#include <stop_token>
#include <thread>

#include "drivers/telemetry/attitude_inbox.h"
#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"

namespace drivers {
namespace {

constexpr int kPoll_ms = 50;

extern "C" void on_attitude(const lcm_recv_buf_t* buffer, const char*, void* inbox) {
  static_cast<AttitudeInbox*>(inbox)->receive(buffer->data, buffer->data_size);
}

class LcmAttitudeListener : public AttitudeListener {
 public:
  LcmAttitudeListener(const std::string& url, const std::string& channel) : lcm_(nullptr, &lcm_destroy) {
    check_lcm_url(url);
    check_channel_prefix(channel);
    if (const SelfTest test = run_lcm_self_test(url, channel); !test.heard) throw std::runtime_error(test.message);
    lcm_.reset(lcm_create(url.c_str()));
    std::string pattern;  // LCM takes a regular expression
    for (const char c : channel) pattern += c == '.' ? std::string("\\.") : std::string(1, c);
    if (!lcm_ || lcm_subscribe(lcm_.get(), pattern.c_str(), &on_attitude, &inbox_) == nullptr) {
      throw std::runtime_error(
          fmt::format("camera.attitude_channel: LCM cannot listen for \"{}\" on \"{}\"", channel, url));
    }
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) (void)lcm_handle_timeout(lcm_.get(), kPoll_ms);
    });
  }
  [[nodiscard]] rt::RingReader<core::AttitudeSample> samples() override { return inbox_.samples(); }
  [[nodiscard]] Counts counts() const noexcept override { return inbox_.counts(); }

 private:
  AttitudeInbox inbox_;
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm_;
  std::jthread thread_;  // ends first
};

}  // namespace

std::unique_ptr<AttitudeListener> listen_for_attitude(const std::string& url, const std::string& channel) {
  return std::make_unique<LcmAttitudeListener>(url, channel);
}

}  // namespace drivers
