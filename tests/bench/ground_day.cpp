// Messages of many hours for the ground page, without a network.
//   ground_day log FILE      a short LCM event log, for a page fed from a log
//   ground_day feed HOURS    through LiveStream at the rate of 30 frames/s; prints resident bytes after the
//   first
//                            hour and at the end, and how many times faster than real time that was
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/lcm_publisher.h"
#include "tests/support/telemetry_samples.h"
#include "tools/hovermodal/ground/live_stream.h"

namespace {

constexpr std::int64_t kFrame_ns = 33'333'333;
constexpr int kChannels = 12;

class Day {
 public:
  // One frame's messages, as sent by the service.
  void frame(std::int64_t n) {
    now_ns_ = n * kFrame_ns;
    const auto number = static_cast<std::uint64_t>(n);
    send("DAY_DISPLACEMENT", drivers::to_message(tests::sample_displacement(kChannels, number), kIdentity), n);
    if (n % 30 == 0) {
      send("DAY_HEALTH", drivers::to_message(tests::sample_health("running", number / 30), channels_, kIdentity),
           n / 30);
    }
    if (n % 300 == 0) {
      for (const auto& m :
           drivers::to_messages(tests::sample_estimate(kChannels, 10, number / 300), channels_, kIdentity))
        send("DAY_MODAL", m, n_modal_++);
      for (const auto& m : drivers::to_messages(tests::sample_sums(kChannels, 1024), channels_, kIdentity))
        send("DAY_SPECTRUM", m, n_spectra_++);
    }
    if (n % 6 == 0) n_bytes_ += stream_.news(now_ns_).value_or("").size();
  }
  [[nodiscard]] std::size_t n_bytes() const { return n_bytes_; }

 private:
  template <class Message>
  void send(std::string_view lcm_channel, Message message, std::int64_t sequence) {
    message.sequence = sequence;
    message.utc_ns = now_ns_ + 1;
    bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
    stream_.receive(lcm_channel, bytes_.data(), bytes_.size(), now_ns_);
  }

  inline static const drivers::StreamIdentity kIdentity{"day", 1};
  tools::LiveStream stream_{"DAY"};
  std::vector<core::ChannelInfo> channels_ = tests::sample_channels(kChannels);
  std::vector<std::uint8_t> bytes_;
  std::int64_t now_ns_ = 0, n_modal_ = 0, n_spectra_ = 0;
  std::size_t n_bytes_ = 0;
};

long resident_bytes() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

int feed(double hours) {
  Day day;
  const auto n = static_cast<std::int64_t>(hours * 3600.0 * 30.0);
  const auto begin = std::chrono::steady_clock::now();
  long after_one_hour = 0;
  for (std::int64_t i = 0; i < n; ++i) {
    day.frame(i);
    if (i == 3600 * 30) after_one_hour = resident_bytes();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::printf("%ld %ld %.0f\n", after_one_hour, resident_bytes(), hours * 3600.0 / took.count());
  return day.n_bytes() > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  if (std::string_view(argv[1]) == "feed") return feed(std::atof(argv[2]));
  drivers::LcmPublisher publisher({"", "HOVERMODAL", argv[2], {"day", 1}});
  return publisher.publish(tests::sample_health("running", 0)) ? 0 : 1;
}
