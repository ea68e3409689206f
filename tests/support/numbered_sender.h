#pragma once

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/numbered_picture.h"

// A sender of live video on the loopback, whose pictures carry their numbers.
namespace test_support {

// A UDP port of 127.0.0.1 that nobody had a moment ago.
inline int free_udp_port() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  const bool ok = bind(fd, any, size) == 0 && getsockname(fd, any, &size) == 0;
  close(fd);
  if (!ok) throw std::runtime_error("no free UDP port");
  return ntohs(address.sin_port);
}

// `coding`, `format`, `target`: arguments of ffmpeg. In real time, for a minute at most.
inline std::vector<std::string> numbered_sender(double rate_hz, const std::vector<std::string>& coding,
                                                const std::string& format, const std::string& target) {
  const std::string picture = fmt::format(
      "color=black:s={}x{}:r={:g}:d=60,format=gray,geq=lum='32+192*mod(floor(N/pow(2\\,floor(X/"
      "{})))\\,2)',format=yuv420p",
      kNumberedWidth_px, kNumberedHeight_px, rate_hz, kBitWidth_px);
  std::vector<std::string> out{"/usr/bin/ffmpeg", "-v", "error", "-nostdin", "-re", "-f", "lavfi", "-i", picture};
  out.insert(out.end(), coding.begin(), coding.end());
  for (const char* one : {"-threads", "1", "-f"}) out.emplace_back(one);
  out.push_back(format);
  out.push_back(target);
  return out;
}

constexpr double kSentRate_hz = 50.0;

// MPEG-TS with a key frame in every five, to a UDP port of this computer.
inline std::vector<std::string> sender_to(int port) {
  return numbered_sender(kSentRate_hz, {"-c:v", "libx264", "-preset", "ultrafast", "-g", "5", "-bf", "0", "-crf", "10"},
                         "mpegts", fmt::format("udp://127.0.0.1:{}?pkt_size=1316", port));
}

// Such a sender while it lives.
class Sent {
 public:
  Sent() : port_(free_udp_port()), sender_(sender_to(port_)) {}
  [[nodiscard]] std::string source() const { return fmt::format("udp://127.0.0.1:{}", port_); }

 private:
  int port_;
  tests::ChildProcess sender_;
};

}  // namespace test_support
