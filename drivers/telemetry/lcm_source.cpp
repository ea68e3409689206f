#include "drivers/telemetry/lcm_source.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/log_player.h"

namespace drivers {
namespace {

constexpr int kMaxBatch = 1000;                // limits the time during which display and signals wait
constexpr int kReceiveBuffer_bytes = 1 << 22;  // the kernel limits it to net.core.rmem_max
constexpr int kQueuedMessages = 20000;         // LCM keeps 30 by default
constexpr std::size_t kLongestDatagram = 65536;

[[noreturn]] void fail(const std::string& url, const char* what) {
  throw std::runtime_error(
      fmt::format("LCM URL \"{}\": {}: {}; `hovermodal inspect lcm` says more", url, what, std::strerror(errno)));
}

extern "C" void on_library_message(const lcm_recv_buf_t* buffer, const char* channel, void* receive) {
  (*static_cast<LcmDatagrams::Receive*>(receive))(channel, buffer->data, buffer->data_size);
}

}  // namespace

struct LcmSource::Way {
  virtual ~Way() = default;
  virtual bool poll(int timeout_ms) = 0;
};

// As LCM's own socket: several programs may listen on the port.
struct LcmSource::Multicast : LcmSource::Way {
  Multicast(const std::string& text, LcmDatagrams::Receive receive)
      : datagrams(std::move(receive)), fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    const UdpmUrl url = parse_udpm(text);
    const int on = 1;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(url.port);
    inet_pton(AF_INET, url.group.c_str(), &address.sin_addr);
    ip_mreq membership{};
    membership.imr_multiaddr = address.sin_addr;
    membership.imr_interface.s_addr = htonl(INADDR_ANY);
    const void* where = &address;
    setsockopt(fd.get, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer_bytes, sizeof kReceiveBuffer_bytes);
    if (setsockopt(fd.get, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
        setsockopt(fd.get, SOL_SOCKET, SO_REUSEPORT, &on, sizeof on) != 0 ||
        bind(fd.get, static_cast<const sockaddr*>(where), sizeof address) != 0) {
      fail(text, "cannot listen");
    }
    if (setsockopt(fd.get, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0)
      fail(text, "cannot join the group");
  }

  bool poll(int timeout_ms) override {
    pollfd waiting{fd.get, POLLIN, 0};
    if (::poll(&waiting, 1, timeout_ms) <= 0) return true;
    for (int i = 0; i < kMaxBatch; ++i) {
      sockaddr_in from{};
      socklen_t size = sizeof from;
      void* sender = &from;
      const ssize_t n = recvfrom(fd.get, buffer.data(), buffer.size(), 0, static_cast<sockaddr*>(sender), &size);
      if (n < 0) break;
      datagrams.take(buffer.data(), static_cast<std::size_t>(n),
                     std::uint64_t{from.sin_addr.s_addr} << 16U | from.sin_port);
    }
    return true;
  }

  struct Socket {
    explicit Socket(int fd) : get(fd) {}
    ~Socket() {
      if (get >= 0) close(get);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    int get;
  };
  LcmDatagrams datagrams;
  Socket fd;
  std::array<std::uint8_t, kLongestDatagram> buffer{};
};

struct LcmSource::Library : LcmSource::Way {
  Library(const std::string& url, const std::string& pattern, LcmDatagrams::Receive take)
      : receive(std::move(take)), lcm(lcm_create(url.c_str()), &lcm_destroy) {
    if (!lcm) {
      throw std::runtime_error(fmt::format("LCM cannot open \"{}\" (its own words are on stderr). The usual URL is {}",
                                           url, kDefaultLcmUrl));
    }
    lcm_subscription_t* subscription = lcm_subscribe(lcm.get(), pattern.c_str(), &on_library_message, &receive);
    if (subscription == nullptr) throw std::runtime_error(fmt::format("LCM cannot listen on \"{}\"", url));
    lcm_subscription_set_queue_capacity(subscription, kQueuedMessages);
  }

  bool poll(int timeout_ms) override {
    for (int i = 0; i < kMaxBatch; ++i) {
      errno = 0;
      const int n = lcm_handle_timeout(lcm.get(), i == 0 ? timeout_ms : 0);
      if (n < 0) return errno == EINTR;
      if (n == 0) return true;
    }
    return true;
  }

  LcmDatagrams::Receive receive;
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm;
};

struct LcmSource::Log : LcmSource::Way {
  Log(const std::string& url, LcmDatagrams::Receive receive) : player(parse_log(url), std::move(receive)) {}
  bool poll(int timeout_ms) override { return player.poll(timeout_ms); }
  LogPlayer player;
};

LcmSource::LcmSource(const std::string& url, const std::string& pattern, LcmDatagrams::Receive receive) {
  check_lcm_url(url);
  if (is_udpm(url)) {
    way_ = std::make_unique<Multicast>(url, std::move(receive));
  } else if (is_log(url)) {
    way_ = std::make_unique<Log>(url, std::move(receive));
  } else {
    way_ = std::make_unique<Library>(url, pattern, std::move(receive));
  }
}

LcmSource::~LcmSource() = default;

bool LcmSource::poll(int timeout_ms) { return way_->poll(timeout_ms); }

}  // namespace drivers
