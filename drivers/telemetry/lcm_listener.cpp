#include "drivers/telemetry/lcm_listener.h"

#include <stdexcept>
#include <utility>

#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_source.h"
#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/topics.h"
#include "rt/clock.h"

namespace drivers {
namespace {

constexpr int kListen_ms = 50;

void require_hearing(const std::string& url, const std::string& prefix) {
  check_channel_prefix(prefix);
  const SelfTest test = run_lcm_self_test(url, prefix);
  if (!test.heard) throw std::runtime_error(test.message);
}

}  // namespace

struct LcmListener::Handle {
  Handle(const std::string& url, const std::string& prefix, Receive receive)
      : source(url, topics_pattern(prefix),
               [prefix, receive = std::move(receive)](std::string_view channel, const void* data, std::size_t n_bytes) {
                 if (topic_of(prefix, channel)) receive(channel, data, n_bytes);
               }) {}
  LcmSource source;
};

LcmListener::LcmListener(const std::string& url, const std::string& prefix, Receive receive) {
  require_hearing(url, prefix);
  handle_ = std::make_unique<Handle>(url, prefix, std::move(receive));
}

LcmListener::~LcmListener() = default;

std::int64_t LcmListener::now_ns() noexcept { return rt::monotonic_ns(); }

bool LcmListener::poll() { return handle_->source.poll(kListen_ms); }

}  // namespace drivers
