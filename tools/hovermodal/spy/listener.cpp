#ifdef HOVERMODAL_WITH_LCM
#include "tools/hovermodal/spy/listener.h"

#include <fmt/format.h>
#include <lcm/lcm.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>

#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/topics.h"

namespace tools {
namespace {

constexpr int kPoll_ms = 50;
// LCM keeps 30 messages by default and drops the rest while we draw.
constexpr int kQueuedMessages = 20000;
constexpr const char* kReceiveBuffer = "recv_buf_size=4194304";  // bytes; the kernel cuts it to net.core.rmem_max

extern "C" void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* monitor) {
  static_cast<drivers::StreamMonitor*>(monitor)->receive(channel, buffer->data, buffer->data_size, listener_now_ns());
}

std::string with_receive_buffer(const std::string& url) {
  if (!drivers::is_udpm(url) || drivers::parse_udpm(url).has_recv_buf_size) return url;
  return url + (url.find('?') == url.npos ? "?" : "&") + kReceiveBuffer;
}

}  // namespace

struct Listener::Lcm {
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> handle{nullptr, &lcm_destroy};
};

std::int64_t listener_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

Listener::Listener(const std::string& url, const std::string& prefix, drivers::StreamMonitor& monitor)
    : lcm_(std::make_unique<Lcm>()) {
  drivers::check_channel_prefix(prefix);
  const auto test = drivers::run_lcm_self_test(url, prefix);
  if (!test.heard) throw std::runtime_error(test.message);
  lcm_->handle.reset(lcm_create(with_receive_buffer(url).c_str()));
  if (!lcm_->handle) {
    throw std::runtime_error(fmt::format("LCM cannot open \"{}\" (its own words are on stderr). The usual URL is {}",
                                         url, drivers::kDefaultLcmUrl));
  }
  const std::string pattern = drivers::topics_pattern(prefix);
  lcm_subscription_t* subscription = lcm_subscribe(lcm_->handle.get(), pattern.c_str(), &on_message, &monitor);
  if (subscription == nullptr) throw std::runtime_error(fmt::format("LCM cannot listen on \"{}\"", url));
  lcm_subscription_set_queue_capacity(subscription, kQueuedMessages);
}

Listener::~Listener() = default;

bool Listener::poll() {
  constexpr int kMaxBatch = 1000;
  for (int i = 0; i < kMaxBatch; ++i) {
    errno = 0;
    const int n = lcm_handle_timeout(lcm_->handle.get(), i == 0 ? kPoll_ms : 0);
    if (n < 0) return errno == EINTR;
    if (n == 0) return true;
  }
  return true;
}

}  // namespace tools
#endif
