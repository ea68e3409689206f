#include <nlohmann/json.hpp>

#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/stream_monitor.h"
#include "hovermodal/aircraft_t.hpp"
#include "hovermodal/attitude_t.hpp"
#include "hovermodal/run_file_t.hpp"
#include "hovermodal/run_frame_t.hpp"
#include "hovermodal/run_recording_t.hpp"
#include "hovermodal/run_t.hpp"
#include "hovermodal/tracks_t.hpp"
#include "tests/fuzz/fuzz_target.h"
#include "tools/hovermodal/ground/live_stream.h"

namespace tests::fuzz {
namespace {

constexpr std::int64_t kStep_ns = 100'000'000;  // between two messages, in the listener's clock
constexpr std::uint8_t kRightFingerprint = 0x80;

// All listeners: the monitor of `hovermodal spy` and `inspect`, and the page's stream.
class Listeners {
 public:
  void hear(const std::string& channel, Bytes bytes) {
    const Exact exact(bytes);
    now_ns_ += kStep_ns;
    monitor_.receive(channel, exact.data(), exact.size(), now_ns_);
    stream_.receive(channel, exact.data(), exact.size(), now_ns_);
  }

  void look() {
    for (std::size_t i = 0; i < monitor_.n_channels(); ++i) static_cast<void>(monitor_.channel_name(i));
    require(monitor_.n_channels() <= drivers::StreamMonitor::kMaxChannels, "channels are bounded");
    require(monitor_.modes().size() <= drivers::StreamMonitor::kMaxModes, "modes are bounded");
    static_cast<void>(monitor_.other_versions());
    const std::string snapshot = stream_.snapshot(now_ns_);
    require(nlohmann::json::accept(snapshot), "the page gets JSON");
    require(snapshot.find('\n') == snapshot.npos, "on one line");
    if (const auto news = stream_.news(now_ns_)) require(nlohmann::json::accept(*news), "news are JSON");
    static_cast<void>(stream_.preview_jpeg());
  }

 private:
  drivers::StreamMonitor monitor_{"F"};
  tools::LiveStream stream_{"F"};
  std::int64_t now_ns_ = 0;
};

// LCM's encoder ends a string at a zero within it, so that there may be fewer bytes than announced.
template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int n = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  require(n > 0, "what was decoded can be encoded");
  bytes.resize(static_cast<std::size_t>(n));
  return bytes;
}

// A message that decodes can be encoded, and is then unchanged by another round.
template <class Message>
void check(Bytes bytes) {
  const Exact exact(bytes);
  const auto message = drivers::decode_message<Message>(exact.data(), exact.size());
  if (!message) return;
  const std::vector<std::uint8_t> again = encoded(*message);
  const auto twice = drivers::decode_message<Message>(again.data(), again.size());
  require(twice.has_value(), "and decoded again");
  require(encoded(*twice) == again, "and then stays as it is");
}

struct Kind {
  std::string suffix;
  std::int64_t fingerprint;
  void (*check)(Bytes);
};
template <class Message>
Kind kind(const char* suffix) {
  return {suffix, Message::getHash(), &check<Message>};
}

const std::vector<Kind>& kinds() {
  using namespace hovermodal;
  using namespace drivers;
  static const std::vector<Kind> all{kind<modal_estimate_t>(kTopicSuffixes[kModal]),
                                     kind<displacement_t>(kTopicSuffixes[kDisplacement]),
                                     kind<spectrum_t>(kTopicSuffixes[kSpectrum]),
                                     kind<tracks_t>(kTopicSuffixes[kTracks]),
                                     kind<closure_report_t>(kTopicSuffixes[kClosure]),
                                     kind<health_t>(kTopicSuffixes[kHealth]),
                                     kind<preview_t>(kTopicSuffixes[kPreview]),
                                     kind<attitude_t>("_ATTITUDE"),
                                     kind<aircraft_t>("_AIRCRAFT"),
                                     kind<run_t>("_RUN"),
                                     kind<run_file_t>("_RUN_FILE"),
                                     kind<run_frame_t>("_RUN_FRAME"),
                                     kind<run_recording_t>("_RUN_RECORDING"),
                                     {"_MODAL_V2", 0, &check<attitude_t>}};
  return all;
}

// Messages one after the other: a byte for the kind, a length, the bytes. With kRightFingerprint in the kind, the eight
// bytes of the correct fingerprint are put in front.
void run(Bytes bytes) {
  Input input(bytes);
  Listeners listeners;
  for (int n = 0; !input.empty() && n < 32; ++n) {
    const std::uint8_t which = input.byte();
    const Kind& kind = kinds()[(which & 0x7FU) % kinds().size()];
    std::vector<std::uint8_t> message;
    for (unsigned shift = 64; (which & kRightFingerprint) != 0 && shift > 0; shift -= 8)
      message.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(kind.fingerprint) >> (shift - 8)));
    const Bytes piece = input.piece();
    message.insert(message.end(), piece.begin(), piece.end());
    kind.check(message);
    listeners.hear("F" + kind.suffix, message);
  }
  listeners.look();
}

const Registration kTarget("lcm", &run);

}  // namespace
}  // namespace tests::fuzz
