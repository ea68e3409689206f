// Listens to hovermodald with nothing but LCM and the message types: prints every whole estimate and the service's
// state.
//   subscribe [--url URL] [--prefix PREFIX] [--seconds S]
// For programs of your own: lcm-gen -x --cpp-std=c++11 drivers/telemetry/messages/*.lcm, and link with lcm. Types that
// lcm-gen 1.3 writes trust the lengths in a message; on a network to which others may send, use those that this
// project's build has hardened (build/release/drivers/telemetry/generated).
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <hovermodal/health_t.hpp>
#include <hovermodal/modal_estimate_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <string>

namespace {

struct Options {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "HOVERMODAL";
  double seconds = 0.0;  // 0 = until the service has ended
};

// Text from the network is shown without its control characters.
std::string shown(std::string text) {
  for (char& c : text) c = c >= ' ' && c < 127 ? c : '?';
  return text;
}

class Subscriber {
 public:
  void on_estimate(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    hovermodal::modal_estimate_t message;
    if (!decode(buffer, channel, message)) return;
    if (message.number != number_) parts_.clear();  // an estimate comes in parts of one datagram each
    number_ = message.number;
    parts_[message.part] = message.modes;
    if (message.n_parts < 1 || parts_.size() < static_cast<std::size_t>(message.n_parts)) return;
    std::printf("estimate %lld of %s: %s\n", static_cast<long long>(message.number), shown(message.stream_id).c_str(),
                shown(message.status).c_str());
    for (const auto& [part, modes] : parts_) {
      for (const auto& mode : modes) {
        if (mode.is_structural == 0) continue;
        std::printf("  %9.4f +- %.4f Hz  damping %5.2f +- %.2f %%\n", mode.frequency_hz,
                    static_cast<double>(mode.frequency_std_hz), 100.0 * static_cast<double>(mode.damping_ratio),
                    100.0 * static_cast<double>(mode.damping_std));
      }
    }
  }
  void on_health(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    hovermodal::health_t message;
    if (!decode(buffer, channel, message)) return;
    std::printf("%s: %lld frames in, %lld dropped\n", shown(message.state).c_str(),
                static_cast<long long>(message.frames_in), static_cast<long long>(message.frames_dropped));
    is_over_ = message.state.rfind("finished", 0) == 0 || message.state.rfind("fault", 0) == 0;
  }
  [[nodiscard]] bool is_over() const { return is_over_; }
  void sum_up() const { std::printf("%ld messages read, %ld not understood\n", n_read_, n_not_understood_); }

 private:
  template <class Message>
  bool decode(const lcm::ReceiveBuffer* buffer, const std::string& channel, Message& message) {
    const int size = static_cast<int>(buffer->data_size);
    if (message.decode(buffer->data, 0, size) == size) return ++n_read_, true;
    // The first eight bytes identify the layout: the same unknown ones repeatedly mean a service of another version.
    if (n_not_understood_++ == 0 && size >= 8 && is_other_layout(buffer->data, Message::getHash()))
      std::printf("%s: not the layout that this program was built for; is the service of the same version?\n",
                  channel.c_str());
    return false;
  }
  static bool is_other_layout(const void* data, std::int64_t expected) {
    std::int64_t hash = 0;
    return __int64_t_decode_array(data, 0, 8, &hash, 1) == 8 && hash != expected;
  }

  std::int64_t number_ = -1;
  std::map<std::int16_t, std::vector<hovermodal::mode_t>> parts_;
  long n_read_ = 0, n_not_understood_ = 0;
  bool is_over_ = false;
};

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--url") == 0) {
      options.url = argv[i + 1];
    } else if (std::strcmp(argv[i], "--prefix") == 0) {
      options.prefix = argv[i + 1];
    } else if (std::strcmp(argv[i], "--seconds") == 0) {
      options.seconds = std::atof(argv[i + 1]);
    } else {
      return false;
    }
  }
  return argc % 2 == 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options)) {
    std::fprintf(stderr, "usage: subscribe [--url URL] [--prefix PREFIX] [--seconds S]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  lcm::LCM lcm(options.url);
  if (!lcm.good()) {
    std::fprintf(stderr, "subscribe: LCM cannot open \"%s\"; `hovermodal inspect lcm` says why\n", options.url.c_str());
    return 1;
  }
  Subscriber subscriber;
  lcm.subscribeFunction<Subscriber*>(
      options.prefix + "_MODAL",
      [](const lcm::ReceiveBuffer* b, const std::string& channel, Subscriber* s) { s->on_estimate(b, channel); },
      &subscriber);
  lcm.subscribeFunction<Subscriber*>(
      options.prefix + "_HEALTH",
      [](const lcm::ReceiveBuffer* b, const std::string& channel, Subscriber* s) { s->on_health(b, channel); },
      &subscriber);
  std::printf("listening on %s\n", options.url.c_str());
  const auto begin = std::chrono::steady_clock::now();
  while (!subscriber.is_over()) {
    if (lcm.handleTimeout(100) < 0) break;  // the end of a log
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (options.seconds > 0.0 && passed.count() >= options.seconds) break;
  }
  subscriber.sum_up();
  return 0;
}
