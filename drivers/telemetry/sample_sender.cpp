#include "drivers/telemetry/sample_sender.h"

#include <lcm/lcm.h>

#include <array>
#include <stdexcept>

#include "drivers/telemetry/encode_flight.h"
#include "drivers/telemetry/lcm_url.h"

namespace drivers {

struct SampleSender::Handle {
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm;
};

SampleSender::SampleSender(const std::string& url, const std::string& channel) : channel_(channel) {
  check_lcm_url(url);
  check_channel_prefix(channel);
  handle_ = std::make_unique<Handle>(Handle{{lcm_create(url.c_str()), &lcm_destroy}});
  if (!handle_->lcm) throw std::runtime_error("LCM cannot use " + url);
}

SampleSender::~SampleSender() = default;

template <class Message>
bool SampleSender::send_message(const Message& message) {
  std::array<std::uint8_t, 256> bytes{};
  const int size = message.getEncodedSize();
  const bool sent = size <= static_cast<int>(bytes.size()) && message.encode(bytes.data(), 0, size) == size &&
                    lcm_publish(handle_->lcm.get(), channel_.c_str(), bytes.data(), static_cast<unsigned>(size)) == 0;
  n_failed_ += sent ? 0 : 1;
  return sent;
}

bool SampleSender::send(const core::AttitudeSample& sample) { return send_message(to_message(sample)); }
bool SampleSender::send(const core::AircraftState& state) { return send_message(to_message(state)); }

}  // namespace drivers
