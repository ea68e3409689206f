#include "drivers/telemetry/lcm_listener.h"

#include <fmt/format.h>
#include <lcm/lcm.h>

#include <cerrno>
#include <stdexcept>

#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/topics.h"

namespace drivers {
namespace {

constexpr int kPoll_ms = 50;
constexpr int kMaxBatch = 1000;  // screen and signals wait meanwhile
// LCM keeps 30 messages by default and drops the rest while the caller draws.
constexpr int kQueuedMessages = 20000;
constexpr const char* kReceiveBuffer = "recv_buf_size=4194304";  // bytes; the kernel cuts it to net.core.rmem_max

std::string with_receive_buffer(const std::string& url) {
  if (!is_udpm(url) || parse_udpm(url).has_recv_buf_size) return url;
  return url + (url.find('?') == url.npos ? "?" : "&") + kReceiveBuffer;
}

extern "C" void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* receive) {
  (*static_cast<LcmListener::Receive*>(receive))(channel, buffer->data, buffer->data_size);
}

}  // namespace

struct LcmListener::Handle {
  Receive receive;
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm{nullptr, &lcm_destroy};
};

LcmListener::LcmListener(const std::string& url, const std::string& prefix, Receive receive)
    : handle_(std::make_unique<Handle>()) {
  handle_->receive = std::move(receive);
  check_channel_prefix(prefix);
  const SelfTest test = run_lcm_self_test(url, prefix);
  if (!test.heard) throw std::runtime_error(test.message);
  handle_->lcm.reset(lcm_create(with_receive_buffer(url).c_str()));
  if (!handle_->lcm) {
    throw std::runtime_error(
        fmt::format("LCM cannot open \"{}\" (its own words are on stderr). The usual URL is {}", url, kDefaultLcmUrl));
  }
  lcm_subscription_t* subscription =
      lcm_subscribe(handle_->lcm.get(), topics_pattern(prefix).c_str(), &on_message, &handle_->receive);
  if (subscription == nullptr) throw std::runtime_error(fmt::format("LCM cannot listen on \"{}\"", url));
  lcm_subscription_set_queue_capacity(subscription, kQueuedMessages);
}

LcmListener::~LcmListener() = default;

bool LcmListener::poll() {
  for (int i = 0; i < kMaxBatch; ++i) {
    errno = 0;
    const int n = lcm_handle_timeout(handle_->lcm.get(), i == 0 ? kPoll_ms : 0);
    if (n < 0) return errno == EINTR;
    if (n == 0) return true;
  }
  return true;
}

}  // namespace drivers
