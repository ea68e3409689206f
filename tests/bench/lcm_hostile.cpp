// Malformed messages for every subscriber of this project, for tools/figures/ground_link.sh:
//   lcm_hostile decode FIRST_SEED SEEDS N   N of each seed into a StreamMonitor, an AttitudeInbox and the decoders
//   lcm_hostile send SEED URL N PER_SECOND messages|datagrams
//                                           N of the seed over the socket: malformed messages in LCM's frame, or with
//                                           damaged heads and fragments among them
//   lcm_hostile end URL                     a well-formed status "finished", after which listeners end
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/sample_inbox.h"
#include "drivers/telemetry/stream_monitor.h"
#include "tests/support/hostile_messages.h"

namespace {

using tests::Bytes;
using tests::HostileMessages;

struct Tally {
  std::uint64_t n = 0, taken = 0, refused = 0;
};

// Every message must be counted exactly once, as accepted or as rejected.
Tally decode(std::uint32_t seed, std::uint64_t n) {
  HostileMessages hostile(seed);
  drivers::StreamMonitor monitor("HOVERMODAL");
  drivers::AttitudeInbox attitudes;
  drivers::AircraftInbox states;
  Tally tally;
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto message = hostile.next();
    if (message.channel == "ATTITUDE") {
      attitudes.receive(message.bytes.data(), message.bytes.size());
    } else if (message.channel == "AIRCRAFT") {
      states.receive(message.bytes.data(), message.bytes.size());
    } else {
      monitor.receive(message.channel, message.bytes.data(), message.bytes.size(), static_cast<std::int64_t>(i));
    }
  }
  for (std::size_t i = 0; i < drivers::kTopics; ++i) {
    const auto& count = monitor.count(static_cast<drivers::Topic>(i));
    tally.taken += count.received + count.foreign;
    tally.refused += count.undecodable;
  }
  for (const drivers::ListenerCounts& counts : {attitudes.counts(), states.counts()}) {
    tally.taken += counts.received + counts.dropped;
    tally.refused += counts.undecodable;
  }
  tally.n = n;
  return tally;
}

void put32(Bytes& out, std::uint32_t value) {
  for (unsigned shift = 32; shift > 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> (shift - 8)));
}
void put16(Bytes& out, std::size_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 8U));
  out.push_back(static_cast<std::uint8_t>(value));
}

Bytes whole_datagram(const tests::HostileMessage& message, std::uint32_t number) {
  Bytes out{'L', 'C', '0', '2'};
  put32(out, number);
  out.insert(out.end(), message.channel.begin(), message.channel.end());
  out.push_back(0);
  out.insert(out.end(), message.bytes.begin(), message.bytes.end());
  return out;
}

// A fragment with an impossible size, offset, index or count.
Bytes bad_fragment(HostileMessages& hostile, const tests::HostileMessage& message, std::uint32_t number) {
  constexpr std::array<std::uint32_t, 6> kSizes{0, 1, 5000, 0x10000001U, 0x7FFFFFFFU, 0xFFFFFFFFU};
  Bytes out{'L', 'C', '0', '3'};
  put32(out, number);
  put32(out, kSizes[hostile.below(kSizes.size())]);
  put32(out, kSizes[hostile.below(kSizes.size())]);
  put16(out, hostile.below(4) == 0 ? 0xFFFFU : hostile.below(3));
  put16(out, hostile.below(4) == 0 ? 0U : hostile.below(4));
  if (hostile.below(2) == 0) out.insert(out.end(), message.channel.begin(), message.channel.end());
  if (hostile.below(2) == 0) out.push_back(0);
  out.insert(out.end(), message.bytes.begin(), message.bytes.end());
  return out;
}

Bytes bad_head(HostileMessages& hostile, const tests::HostileMessage& message, std::uint32_t number) {
  Bytes out = whole_datagram(message, number);
  switch (hostile.below(3)) {
    case 0:
      out.resize(hostile.below(12));  // shorter than LCM's head
      break;
    case 1:
      for (std::size_t i = 0; i < 4; ++i) out[i] = hostile.byte();
      break;
    default:
      for (std::size_t i = 8; i < out.size(); ++i) out[i] |= 1U;  // no zero ends the channel's name
      break;
  }
  return out;
}

class Mouth {
 public:
  explicit Mouth(const std::string& url_text) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const auto url = drivers::parse_udpm(url_text);
    const auto ttl = static_cast<unsigned char>(url.ttl);
    to_.sin_family = AF_INET;
    to_.sin_port = htons(url.port);
    inet_pton(AF_INET, url.group.c_str(), &to_.sin_addr);
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~Mouth() { close(fd_); }
  Mouth(const Mouth&) = delete;
  Mouth& operator=(const Mouth&) = delete;
  [[nodiscard]] bool send(const Bytes& bytes) const {
    const void* to = &to_;
    return sendto(fd_, bytes.data(), bytes.size(), 0, static_cast<const sockaddr*>(to), sizeof to_) >= 0;
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

int send(std::uint32_t seed, const std::string& url, std::uint64_t n, double per_second, bool damages_datagrams) {
  const Mouth mouth(url);
  HostileMessages hostile(seed);
  std::uint64_t n_fragments = 0, n_heads = 0, n_failed = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto message = hostile.next();
    const auto number = static_cast<std::uint32_t>(i);
    const std::size_t how = damages_datagrams ? hostile.below(3) : 2;
    n_fragments += how == 0 ? 1 : 0;
    n_heads += how == 1 ? 1 : 0;
    const bool ok = mouth.send(how == 0   ? bad_fragment(hostile, message, number)
                               : how == 1 ? bad_head(hostile, message, number)
                                          : whole_datagram(message, number));
    n_failed += ok ? 0 : 1;
    if (i % 50 == 49)
      std::this_thread::sleep_until(begin + std::chrono::duration<double>(static_cast<double>(i) / per_second));
  }
  fmt::print("sent {} messages {} fragments {} heads {} failed {}\n", n, n - n_fragments - n_heads, n_fragments,
             n_heads, n_failed);
  return n_failed == 0 ? 0 : 1;
}

int end(const std::string& url) {
  const Mouth mouth(url);
  auto health = drivers::to_message(tests::sample_health("finished", 1), tests::sample_channels(4), {"hostile", 1});
  health.sequence = 1;
  bool ok = true;
  for (std::uint32_t i = 0; i < 5; ++i)
    ok = mouth.send(whole_datagram({0, "HOVERMODAL_HEALTH", tests::encoded_bytes(health)}, i)) && ok;
  return ok ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i) { return static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)); };
  if (argc == 5 && std::string_view(argv[1]) == "decode") {
    Tally sum;
    for (std::uint32_t seed = number(2); seed < number(2) + number(3); ++seed) {
      const Tally tally = decode(seed, std::strtoull(argv[4], nullptr, 10));
      sum.n += tally.n;
      sum.taken += tally.taken;
      sum.refused += tally.refused;
    }
    fmt::print("fed {} taken {} refused {}\n", sum.n, sum.taken, sum.refused);
    return sum.n == sum.taken + sum.refused ? 0 : 1;
  }
  if (argc == 7 && std::string_view(argv[1]) == "send") {
    return send(number(2), argv[3], std::strtoull(argv[4], nullptr, 10), std::atof(argv[5]),
                std::string_view(argv[6]) == "datagrams");
  }
  if (argc == 3 && std::string_view(argv[1]) == "end") return end(argv[2]);
  fmt::print(stderr,
             "lcm_hostile decode FIRST_SEED SEEDS N | send SEED URL N PER_SECOND messages|datagrams | end URL\n");
  return 2;
}
