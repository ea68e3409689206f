// A USB camera in user space: attaches itself to the virtual host controller (vhci_hcd) by USB/IP over
// a socket pair, so that the kernel's real uvcvideo driver streams from it. It plays gray frames from a file
// repeatedly, and simulates faults on request. SIGTERM, or the end of --frames, means that the cable is pulled.
// Needs root, and `modprobe vhci-hcd; modprobe uvcvideo`.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/device/played_frames.h"
#include "tests/device/usb_ip.h"
#include "tests/device/uvc_controls.h"
#include "tests/device/uvc_descriptors.h"

namespace {

using usb::Header;
using usb::receive_all;
using usb::send_all;

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

struct Options {
  std::string file;
  std::string luma_file;  // receives the luma after MJPEG; empty = none
  usb::VideoMode mode;
  std::string serial = "0001";
  int port = 0;
  long n_frames = 0;     // then the cable is pulled; 0 = never
  long error_every = 0;  // such frames carry the error bit
  long short_every = 0;  // such frames end half-way
};

class Camera {
 public:
  Camera(const Options& options, int socket)
      : options_(options),
        mode_(options.mode),
        socket_(socket),
        images_(usb::played_frames(options.file, options.mode)) {
    if (!options.luma_file.empty()) usb::write_luma(options.luma_file, images_);
  }

  void run(const volatile std::sig_atomic_t& stop) {
    while (stop == 0 && !(options_.n_frames > 0 && n_sent_ >= options_.n_frames)) {
      if (is_streaming_ && !requests_.empty() && Clock::now() >= next_frame_) {
        begin_frame();
        continue;
      }
      const bool waits_for_time = is_streaming_ && !requests_.empty();
      const auto left = waits_for_time ? next_frame_ - Clock::now() : nanoseconds(std::chrono::milliseconds(200));
      pollfd ready{socket_, POLLIN, 0};
      const auto ns = std::max<long>(0, std::chrono::duration_cast<nanoseconds>(left).count());
      const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
      if (ppoll(&ready, 1, &limit, nullptr) > 0 && !answer()) return;
    }
  }

 private:
  struct Request {
    std::uint32_t number;
    std::uint32_t n_bytes;
  };

  void reply(std::uint32_t number, int status, std::size_t n_actual, const void* head = nullptr, std::size_t n_head = 0,
             const void* body = nullptr, std::size_t n_body = 0) {
    Header header;
    header.set(0, usb::kSubmitted);
    header.set(1, number);
    header.set(5, static_cast<std::uint32_t>(status));
    header.set(6, static_cast<std::uint32_t>(n_actual));
    send_all(socket_, &header, sizeof header);
    if (n_head > 0) send_all(socket_, head, n_head);
    if (n_body > 0) send_all(socket_, body, n_body);
  }

  void begin_frame() {
    const auto every = [this](long n) { return n > 0 && n_sent_ % n == n - 1; };
    parity_ ^= 1;
    head_ = {2, static_cast<std::uint8_t>(0x82 | parity_ | (every(options_.error_every) ? 0x40 : 0))};
    const std::size_t whole = image().size();
    payload_bytes_ = every(options_.short_every) ? whole / 2 : whole;
    sent_bytes_ = 0;
    is_sending_ = true;
    next_frame_ += nanoseconds(1'000'000'000 / mode_.rate_hz);
    if (Clock::now() - next_frame_ > std::chrono::milliseconds(300)) next_frame_ = Clock::now();
    send_frame();
  }

  [[nodiscard]] const usb::Image& image() const { return images_[static_cast<std::size_t>(n_sent_) % images_.size()]; }

  // As much as the host has requested; a frame is a header of two bytes and the image.
  void send_frame() {
    while (is_sending_ && !requests_.empty()) {
      const Request request = requests_.front();
      requests_.pop_front();
      const std::size_t total = payload_bytes_ + head_.size();
      const std::size_t n = std::min<std::size_t>(request.n_bytes, total - sent_bytes_);
      const std::uint8_t* bytes = image().data();
      if (sent_bytes_ == 0) {
        reply(request.number, 0, n, head_.data(), head_.size(), bytes, n - head_.size());
      } else {
        reply(request.number, 0, n, nullptr, 0, bytes + sent_bytes_ - head_.size(), n);
      }
      sent_bytes_ += n;
      if (sent_bytes_ < total) continue;
      if (n == request.n_bytes && payload_bytes_ < mode_.frame_bytes() && !requests_.empty()) {
        reply(requests_.front().number, 0, 0);  // a short packet ends the transfer
        requests_.pop_front();
      }
      is_sending_ = false;
      ++n_sent_;
    }
  }

  [[nodiscard]] bool answer() {
    Header header;
    if (!receive_all(socket_, &header, sizeof header)) return false;
    if (header.word(0) == usb::kUnlink) return unlink(header);
    const std::uint32_t n_bytes = header.word(6);
    std::vector<std::uint8_t> from_host(header.word(3) == 0 ? n_bytes : 0);
    if (!from_host.empty() && !receive_all(socket_, from_host.data(), from_host.size())) return false;
    if (header.word(4) == 0) {
      control(header, from_host);
    } else {
      requests_.push_back({header.word(1), n_bytes});
      send_frame();
    }
    return true;
  }

  [[nodiscard]] bool unlink(const Header& asked) {
    const auto at = std::find_if(requests_.begin(), requests_.end(),
                                 [&](const Request& request) { return request.number == asked.word(5); });
    const bool is_waiting = at != requests_.end();
    if (is_waiting) requests_.erase(at);
    Header header;
    header.set(0, usb::kUnlinked);
    header.set(1, asked.word(1));
    header.set(5, is_waiting ? static_cast<std::uint32_t>(-ECONNRESET) : 0);
    send_all(socket_, &header, sizeof header);
    return true;
  }

  void control(const Header& header, const std::vector<std::uint8_t>& from_host) {
    const auto& s = header.setup;
    const std::size_t wanted = static_cast<std::size_t>(s[6]) | static_cast<std::size_t>(s[7]) << 8U;
    const usb::Answer answer = (s[0] & 0x60) == 0x20 ? of_class(s, from_host) : of_standard(s);
    if (!answer) {
      reply(header.word(1), -EPIPE, 0);
    } else if (header.word(3) == 1) {
      const std::size_t n = std::min(wanted, answer->size());
      reply(header.word(1), 0, n, answer->data(), n);
    } else {
      reply(header.word(1), 0, from_host.size());
    }
  }

  [[nodiscard]] usb::Answer of_standard(const std::array<std::uint8_t, 8>& setup) {
    const int type = setup[0], request = setup[1];
    if (type == 0x80 && request == 6) return descriptor(setup[3], setup[2]);
    if (type == 0x80 && request == 0) return std::vector<std::uint8_t>{0, 0};
    if (type == 0x81 && request == 10) return std::vector<std::uint8_t>{0};
    if ((type & 0x80) != 0) return std::nullopt;
    if (request == 1 || request == 11) is_streaming_ = is_sending_ = false;  // clear halt, set interface
    return std::vector<std::uint8_t>{};
  }
  [[nodiscard]] usb::Answer descriptor(int kind, int index) const {
    if (kind == 1) return usb::device_descriptor().bytes();
    if (kind == 2) return usb::configuration_descriptor(mode_).bytes();
    if (kind == 6) return usb::qualifier_descriptor().bytes();
    if (kind != 3 || index > 3) return std::nullopt;
    if (index == 0) return std::vector<std::uint8_t>{4, 3, 9, 4};
    const std::array<std::string, 3> texts = {"hovermodal", "Playback camera", options_.serial};
    return usb::string_descriptor(texts[static_cast<std::size_t>(index - 1)]).bytes();
  }
  // Class requests: streaming parameters are negotiated (probe) and applied (commit).
  [[nodiscard]] usb::Answer of_class(const std::array<std::uint8_t, 8>& setup,
                                     const std::vector<std::uint8_t>& from_host) {
    constexpr int kProbe = 1, kCommit = 2;
    const int request = setup[1], selector = setup[3], interface = setup[4], entity = setup[5];
    if (interface == 0 && entity == usb::kCameraTerminal) return exposure_.answer(request, selector, from_host);
    if (interface == 0 && entity == 0 && selector == 2 && request == usb::kGet) return std::vector<std::uint8_t>{6};
    if (interface != 1 || (selector != kProbe && selector != kCommit)) return std::nullopt;
    if (request == usb::kLength) return std::vector<std::uint8_t>{34, 0};
    if (request == usb::kInfo) return std::vector<std::uint8_t>{3};
    if (request != usb::kSet) return usb::probe_control(mode_).bytes();
    if (selector == kCommit) {
      is_streaming_ = true;
      is_sending_ = false;
      next_frame_ = Clock::now();
    }
    return std::vector<std::uint8_t>{};
  }

  Options options_;
  usb::VideoMode mode_;
  int socket_;
  usb::ExposureControl exposure_;
  std::vector<usb::Image> images_;
  std::deque<Request> requests_;  // bulk transfers that wait for data
  bool is_streaming_ = false;
  bool is_sending_ = false;
  int parity_ = 0;  // changes from frame to frame
  std::array<std::uint8_t, 2> head_{};
  std::size_t payload_bytes_ = 0, sent_bytes_ = 0;
  long n_sent_ = 0;
  Clock::time_point next_frame_{};
};

int plug_in(const Options& options) {
  std::array<int, 2> pair{};
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()) != 0) throw std::runtime_error("socketpair failed");
  const int room = 4 << 20;
  setsockopt(pair[0], SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
  constexpr int kDevice = 0x10002, kHighSpeed = 3;
  std::array<char, 64> line{};
  const int n = std::snprintf(line.data(), line.size(), "%d %d %d %d", options.port, pair[1], kDevice, kHighSpeed);
  const int attach = open("/sys/devices/platform/vhci_hcd.0/attach", O_WRONLY | O_CLOEXEC);
  if (attach < 0 || write(attach, line.data(), static_cast<std::size_t>(n)) != n)
    throw std::runtime_error("cannot attach to vhci_hcd: is the module loaded, is the port free?");
  close(attach);
  close(pair[1]);  // now used by the kernel
  return pair[0];
}

volatile std::sig_atomic_t stop_asked = 0;

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::string size = "640x480";
  std::string format = "GREY";
  CLI::App app("A USB camera in user space that plays gray frames from a file.");
  app.add_option("file", options.file, "raw gray frames, one after another")->required()->check(CLI::ExistingFile);
  app.add_option("--size", size, "WIDTHxHEIGHT of a frame")->capture_default_str();
  app.add_option("--format", format, "of the frames")
      ->check(CLI::IsMember({"GREY", "YUYV", "MJPG"}))
      ->capture_default_str();
  app.add_option("--luma", options.luma_file, "MJPG: gets the frames as JPEG has left them");
  app.add_option("--rate", options.mode.rate_hz, "frames a second")->check(CLI::Range(1, 240))->capture_default_str();
  app.add_option("--serial", options.serial, "serial number")->capture_default_str();
  app.add_option("--port", options.port, "of the virtual host controller")->capture_default_str();
  app.add_option("--frames", options.n_frames, "pull the cable after so many");
  app.add_option("--error-every", options.error_every, "every n-th frame carries the error bit");
  app.add_option("--short-every", options.short_every, "every n-th frame ends half-way");
  CLI11_PARSE(app, argc, argv);
  if (std::sscanf(size.c_str(), "%dx%d", &options.mode.width_px, &options.mode.height_px) != 2) {
    std::fprintf(stderr, "--size %s: write WIDTHxHEIGHT\n", size.c_str());
    return 2;
  }
  options.mode.format = format == "GREY"   ? usb::VideoFormat::kGray
                        : format == "YUYV" ? usb::VideoFormat::kYuyv
                                           : usb::VideoFormat::kMjpeg;
  struct sigaction action {};
  action.sa_handler = [](int) { stop_asked = 1; };
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  try {
    Camera(options, plug_in(options)).run(stop_asked);
  } catch (const std::exception& thrown) {
    std::fprintf(stderr, "usb_camera: %s\n", thrown.what());
    return 1;
  }
  return 0;
}
