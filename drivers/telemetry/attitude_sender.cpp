#include "drivers/telemetry/attitude_sender.h"

#include <lcm/lcm.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "drivers/telemetry/lcm_url.h"
#include "hovermodal/attitude_t.hpp"

namespace drivers {

struct AttitudeSender::Handle {
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm;
};

AttitudeSender::AttitudeSender(const std::string& url, const std::string& channel) : channel_(channel) {
  check_lcm_url(url);
  check_channel_prefix(channel);
  handle_ = std::make_unique<Handle>(Handle{{lcm_create(url.c_str()), &lcm_destroy}});
  if (!handle_->lcm) throw std::runtime_error("LCM cannot use " + url);
}

AttitudeSender::~AttitudeSender() = default;

bool AttitudeSender::send(const core::AttitudeSample& sample) {
  hovermodal::attitude_t message;
  message.time_ns = std::llround(1e9 * sample.t_s);
  std::copy(sample.wxyz.begin(), sample.wxyz.end(), std::begin(message.wxyz));
  std::array<std::uint8_t, 64> bytes{};
  const int size = message.getEncodedSize();
  const bool sent = size <= static_cast<int>(bytes.size()) && message.encode(bytes.data(), 0, size) == size &&
                    lcm_publish(handle_->lcm.get(), channel_.c_str(), bytes.data(), static_cast<unsigned>(size)) == 0;
  n_failed_ += sent ? 0 : 1;
  return sent;
}

}  // namespace drivers
