#include "drivers/camera/device/v4l2_stream.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "drivers/camera/device_missing.h"

namespace drivers {

namespace {

constexpr std::uint32_t kMappedBuffers = 6;
constexpr std::chrono::milliseconds kTakingAway{300};

std::string only_node() {
  const std::vector<std::string> nodes = capture_nodes();
  if (nodes.size() == 1) return nodes.front();
  if (nodes.empty()) {
    throw DeviceMissing(
        "camera.driver = v4l2: no camera is attached: plug one in (hovermodal inspect cameras lists what is there)");
  }
  std::string list;
  for (const std::string& node : nodes) list += " " + node;
  throw std::invalid_argument("camera.source is empty and there are several cameras: name one of" + list);
}

[[noreturn]] void refuse_open(const std::string& path, int error) {
  if (error == ENOENT || error == ENODEV || error == ENXIO) {
    throw DeviceMissing(
        fmt::format("{}: {}: hovermodal inspect cameras lists what is attached", path, std::strerror(error)));
  }
  if (error == ENOTTY || error == EINVAL || error == ENOSYS) {
    throw std::runtime_error(
        fmt::format("{}: does not capture video: hovermodal inspect cameras lists what does", path));
  }
  const char* remedy = error == EACCES ? "join the group 'video'" : "is another program using it?";
  throw std::runtime_error(fmt::format("{}: {}: {}", path, std::strerror(error), remedy));
}

}  // namespace

V4l2Stream::V4l2Stream(const std::string& node, const WantedMode& wanted) {
  const std::string path = node.empty() ? only_node() : node;
  if (const int error = device_.open(path); error != 0) refuse_open(path, error);
  identity_ = device_.identity();
  made_ = make_mode(device_, choose_mode(list_modes(device_, wanted), wanted, path), wanted.rate_hz);
  if (const int error = device_.map_buffers(kMappedBuffers); error != 0) {
    throw std::runtime_error(
        fmt::format("{}: no buffers: {}: is another program using it?", path, std::strerror(error)));
  }
  stamps_the_start_ = (device_.buffer_flags() & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
}

std::string V4l2Stream::description() const {
  return fmt::format("{} ({}, {}), {} {} x {}", identity_.card, identity_.driver, device_.path(),
                     fourcc_text(made_.mode.fourcc), made_.mode.width_px, made_.mode.height_px);
}

void V4l2Stream::close() noexcept {
  if (!device_.is_open()) return;
  if (is_broken_) {
    std::this_thread::sleep_until(closes_at_);
  } else {
    device_.stream_off();
  }
  device_.close();
  is_broken_ = false;
}

void V4l2Stream::give_up() noexcept {
  if (!is_open()) return;
  is_broken_ = true;
  closes_at_ = std::chrono::steady_clock::now() + kTakingAway;
}

bool V4l2Stream::open_again() {
  if (is_broken_ && std::chrono::steady_clock::now() < closes_at_) return false;
  close();
  const std::string path = find_node(identity_);
  if (path.empty() || device_.open(path) != 0) return false;
  try {
    made_ = make_mode(device_, made_.mode, made_.mode.rate_hz);
    if (device_.map_buffers(kMappedBuffers) == 0) return true;
  } catch (const std::runtime_error&) {  // the device gives another mode, or none yet
  }
  device_.close();
  return false;
}

V4l2Stream::Wait V4l2Stream::wait(Deadline deadline, int stop_fd) const noexcept {
  // poll ignores negative descriptors.
  std::array<pollfd, 2> fds{{{is_open() ? device_.fd() : -1, POLLIN, 0}, {stop_fd, POLLIN, 0}}};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    const int n = poll(fds.data(), fds.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
    if (n == 0) return Wait::kDeadline;
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return Wait::kBroken;
    if (fds[1].revents != 0) return Wait::kStopped;
    return (fds[0].revents & POLLIN) != 0 ? Wait::kReady : Wait::kBroken;
  }
}

bool V4l2Stream::has_signal() const noexcept {
  v4l2_input input{};
  if (device_.call(VIDIOC_G_INPUT, input.index) != 0 || device_.call(VIDIOC_ENUMINPUT, input) != 0) return true;
  return (input.status & (V4L2_IN_ST_NO_POWER | V4L2_IN_ST_NO_SIGNAL | V4L2_IN_ST_NO_SYNC)) == 0;
}

bool V4l2Stream::adjusts_itself() const noexcept {
  for (const int id : {V4L2_CID_EXPOSURE_AUTO, V4L2_CID_AUTOGAIN, V4L2_CID_FOCUS_AUTO}) {
    v4l2_queryctrl query{};
    query.id = static_cast<std::uint32_t>(id);
    if (device_.call(VIDIOC_QUERYCTRL, query) == 0) return true;
  }
  return false;
}

std::int64_t stamp_ns(const V4l2Filled& buffer) noexcept {
  return static_cast<std::int64_t>(buffer.stamp.tv_sec) * 1'000'000'000 +
         static_cast<std::int64_t>(buffer.stamp.tv_usec) * 1'000;
}

}  // namespace drivers
