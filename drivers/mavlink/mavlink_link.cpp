#include "drivers/mavlink/mavlink_link.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace drivers {
namespace {

constexpr const char* kForms = "udpin:ADDRESS:PORT, udpout:HOST:PORT, tcp:HOST:PORT or serial:DEVICE:BAUD";

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const noexcept { return fd_; }
  [[nodiscard]] bool is_open() const noexcept { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

struct Address {
  sockaddr_storage bytes{};
  socklen_t size = 0;
  friend bool operator==(const Address& a, const Address& b) noexcept {
    return a.size == b.size && std::memcmp(&a.bytes, &b.bytes, a.size) == 0;
  }
};

bool is_ready(int fd, short events, int timeout_ms) {
  pollfd one{fd, events, 0};
  return ::poll(&one, 1, timeout_ms) > 0 && (one.revents & events) != 0;
}

// The first socket of this kind that can be had for HOST:PORT.
template <class Use>
Descriptor socket_for(const std::string& host, const std::string& port, int type, bool passive, const Use& use) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC, hints.ai_socktype = type, hints.ai_flags = passive ? AI_PASSIVE : 0;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found); error != 0)
    throw std::runtime_error(host + ":" + port + ": " + ::gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, &::freeaddrinfo);
  int error = EADDRNOTAVAIL;
  for (const addrinfo* one = all.get(); one != nullptr; one = one->ai_next) {
    Descriptor fd(::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol));
    if (fd.is_open() && use(fd.get(), *one)) return fd;
    error = errno;
  }
  throw std::runtime_error(host + ":" + port + ": " + std::generic_category().message(error));
}

class UdpLink final : public MavlinkLink {
 public:
  UdpLink(const std::string& host, const std::string& port, bool listens) {
    fd_ = socket_for(host, port, SOCK_DGRAM, listens, [&](int fd, const addrinfo& to) {
      if (listens) return ::bind(fd, to.ai_addr, to.ai_addrlen) == 0;
      std::memcpy(&peer_.bytes, to.ai_addr, to.ai_addrlen);
      peer_.size = to.ai_addrlen;
      return true;
    });
  }
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> bytes, int timeout_ms) override {
    if (!is_ready(fd_.get(), POLLIN, timeout_ms)) return 0;
    Address from;
    from.size = sizeof(from.bytes);
    const ssize_t n =
        ::recvfrom(fd_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from.bytes), &from.size);
    if (n <= 0) return 0;
    if (peer_.size == 0) peer_ = from;
    if (!(from == peer_)) {
      ++from_others_;
      return 0;
    }
    return static_cast<std::size_t>(n);
  }
  bool send(std::span<const std::uint8_t> bytes) override {
    return peer_.size != 0 &&
           ::sendto(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                    reinterpret_cast<const sockaddr*>(&peer_.bytes), peer_.size) == static_cast<ssize_t>(bytes.size());
  }
  [[nodiscard]] bool is_datagrams() const noexcept override { return true; }
  [[nodiscard]] std::uint64_t from_others() const noexcept override { return from_others_; }

 private:
  Descriptor fd_;
  Address peer_;  // size 0: nobody has sent yet
  std::uint64_t from_others_ = 0;
};

// A stream of bytes: what does not fit into the system's buffer at once is not sent at all if nothing of it was, else
// to its end.
bool write_whole(int fd, std::span<const std::uint8_t> bytes) {
  constexpr int kPatience_ms = 200;
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno != EAGAIN || done == 0 || !is_ready(fd, POLLOUT, kPatience_ms)) {
      return false;
    }
  }
  return true;
}

class TcpLink final : public MavlinkLink {
 public:
  TcpLink(std::string host, std::string port) : host_(std::move(host)), port_(std::move(port)) { connect(); }
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> bytes, int timeout_ms) override {
    if (!fd_.is_open() && !try_again(timeout_ms)) return 0;
    if (!is_ready(fd_.get(), POLLIN, timeout_ms)) return 0;
    const ssize_t n = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
    if (n > 0) return static_cast<std::size_t>(n);
    if (n == 0 || errno != EAGAIN) fd_ = Descriptor();
    return 0;
  }
  bool send(std::span<const std::uint8_t> bytes) override {
    if (!fd_.is_open()) return false;
    const ssize_t n = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n == static_cast<ssize_t>(bytes.size())) return true;
    if (n >= 0 || errno != EAGAIN) fd_ = Descriptor();  // a part of a message would spoil the next
    return false;
  }
  [[nodiscard]] bool is_datagrams() const noexcept override { return false; }

 private:
  void connect() noexcept {
    constexpr int kPatience_ms = 500;
    tried_ = std::chrono::steady_clock::now();
    try {
      fd_ = socket_for(host_, port_, SOCK_STREAM, false, [&](int fd, const addrinfo& to) {
        if (::connect(fd, to.ai_addr, to.ai_addrlen) == 0) return true;
        int error = errno;
        if (error == EINPROGRESS && is_ready(fd, POLLOUT, kPatience_ms)) {
          socklen_t size = sizeof(error);
          ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
        }
        errno = error;
        return error == 0;
      });
    } catch (const std::runtime_error&) {
      fd_ = Descriptor();
    }
  }
  [[nodiscard]] bool try_again(int timeout_ms) {
    constexpr std::chrono::seconds kBetween{1};
    if (std::chrono::steady_clock::now() - tried_ >= kBetween) connect();
    if (!fd_.is_open()) std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return fd_.is_open();
  }

  std::string host_, port_;
  std::chrono::steady_clock::time_point tried_;
  Descriptor fd_;
};

struct Baud {
  int baud = 0;
  speed_t constant = B0;
};
constexpr std::array kBauds{Baud{9600, B9600},       Baud{19200, B19200},     Baud{38400, B38400},
                            Baud{57600, B57600},     Baud{115200, B115200},   Baud{230400, B230400},
                            Baud{460800, B460800},   Baud{500000, B500000},   Baud{921600, B921600},
                            Baud{1000000, B1000000}, Baud{1500000, B1500000}, Baud{2000000, B2000000},
                            Baud{3000000, B3000000}};

class SerialLink final : public MavlinkLink {
 public:
  SerialLink(const std::string& device, speed_t speed)
      : fd_(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    if (!fd_.is_open()) throw std::runtime_error(device + ": " + std::generic_category().message(errno));
    termios line{};
    if (::tcgetattr(fd_.get(), &line) != 0) throw std::runtime_error(device + ": no serial line");
    ::cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    line.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
    if (::cfsetspeed(&line, speed) != 0 || ::tcsetattr(fd_.get(), TCSANOW, &line) != 0)
      throw std::runtime_error(device + ": " + std::generic_category().message(errno));
  }
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> bytes, int timeout_ms) override {
    if (!is_ready(fd_.get(), POLLIN, timeout_ms)) return 0;
    const ssize_t n = ::read(fd_.get(), bytes.data(), bytes.size());
    return n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  bool send(std::span<const std::uint8_t> bytes) override { return write_whole(fd_.get(), bytes); }
  [[nodiscard]] bool is_datagrams() const noexcept override { return false; }

 private:
  Descriptor fd_;
};

// Kind, place, number: the place may hold colons (an IPv6 address in brackets).
struct Parts {
  std::string kind, place, number;
};
Parts parts_of(const std::string& way) {
  const std::size_t first = way.find(':'), last = way.rfind(':');
  if (first == std::string::npos || last == first || last + 1 == way.size() || last == first + 1)
    throw std::invalid_argument("\"" + way + "\" is no way to MAVLink; write " + kForms);
  Parts out{way.substr(0, first), way.substr(first + 1, last - first - 1), way.substr(last + 1)};
  if (out.place.size() > 2 && out.place.front() == '[' && out.place.back() == ']')
    out.place = out.place.substr(1, out.place.size() - 2);
  return out;
}

int number_in(const std::string& way, const std::string& text, int low, int high, const char* what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) {
    throw std::invalid_argument("\"" + way + "\": the " + what + " is a number of " + std::to_string(low) + " to " +
                                std::to_string(high));
  }
  return value;
}

speed_t speed_of(const std::string& way, const std::string& text) {
  const int baud = number_in(way, text, kBauds.front().baud, kBauds.back().baud, "speed");
  std::string all;
  for (const Baud& one : kBauds) {
    if (one.baud == baud) return one.constant;
    all += (all.empty() ? "" : ", ") + std::to_string(one.baud);
  }
  throw std::invalid_argument("\"" + way + "\": a speed of serial lines is one of " + all);
}

}  // namespace

std::unique_ptr<MavlinkLink> MavlinkLink::open(const std::string& way) {
  const Parts parts = parts_of(way);
  if (parts.kind == "serial") return std::make_unique<SerialLink>(parts.place, speed_of(way, parts.number));
  if (parts.kind != "udpin" && parts.kind != "udpout" && parts.kind != "tcp")
    throw std::invalid_argument("\"" + way + "\" is no way to MAVLink; write " + kForms);
  (void)number_in(way, parts.number, 1, 65535, "port");
  if (parts.kind == "tcp") return std::make_unique<TcpLink>(parts.place, parts.number);
  return std::make_unique<UdpLink>(parts.place, parts.number, parts.kind == "udpin");
}

}  // namespace drivers
