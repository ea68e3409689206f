#include "drivers/camera/device/v4l2_device.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace drivers {

namespace {

constexpr int kMaxNodes = 64;  // minors that the kernel gives out by default

template <std::size_t N>
std::string text_of(const unsigned char (&field)[N]) {
  const auto* text = reinterpret_cast<const char*>(field);
  return {text, strnlen(text, N)};
}

// A USB camera's serial number is an attribute two levels above its node.
std::string serial_of(int fd) {
  struct stat node {};
  if (fstat(fd, &node) != 0) return {};
  std::ifstream file(
      fmt::format("/sys/dev/char/{}:{}/device/../serial", gnu_dev_major(node.st_rdev), gnu_dev_minor(node.st_rdev)));
  std::string serial;
  std::getline(file, serial);
  return serial;
}

v4l2_buffer capture_buffer(std::uint32_t index) noexcept {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

template <class Visit>
void for_each_capture_node(Visit visit) {
  for (int n = 0; n < kMaxNodes; ++n) {
    if (V4l2Device device; device.open(fmt::format("/dev/video{}", n)) == 0) visit(device);
  }
}

}  // namespace

bool V4l2Identity::is_same_camera(const V4l2Identity& other) const noexcept {
  if (driver != other.driver || card != other.card || serial != other.serial) return false;
  return !serial.empty() || bus_info == other.bus_info;
}

V4l2Device::V4l2Device(V4l2Device&& other) noexcept { *this = std::move(other); }

V4l2Device& V4l2Device::operator=(V4l2Device&& other) noexcept {
  if (this == &other) return *this;
  close();
  fd_ = std::exchange(other.fd_, -1);
  path_ = std::move(other.path_);
  identity_ = std::move(other.identity_);
  buffers_ = std::exchange(other.buffers_, {});
  buffer_flags_ = other.buffer_flags_;
  return *this;
}

int V4l2Device::open(const std::string& path) {
  close();
  // Non-blocking: poll does the waiting, with a time limit.
  const int fd = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return errno;
  fd_ = fd;
  v4l2_capability capability{};
  if (const int error = call(VIDIOC_QUERYCAP, capability); error != 0) {
    close();
    return error;
  }
  const std::uint32_t can =
      (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0) {
    close();
    return ENOTTY;
  }
  path_ = path;
  identity_ = {text_of(capability.driver), text_of(capability.card), text_of(capability.bus_info), serial_of(fd_)};
  return 0;
}

void V4l2Device::close() noexcept {
  unmap_buffers();
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

int V4l2Device::call_raw(unsigned long request, void* argument) const noexcept {
  while (ioctl(fd_, request, argument) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

int V4l2Device::map_buffers(std::uint32_t n) {
  unmap_buffers();
  v4l2_requestbuffers request{};
  request.count = n;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = call(VIDIOC_REQBUFS, request); error != 0) return error;
  if (request.count < 2) return ENOMEM;
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = capture_buffer(i);
    int error = call(VIDIOC_QUERYBUF, buffer);
    void* bytes = MAP_FAILED;
    if (error == 0) {
      // Writable, although it is only read: some drivers refuse a read-only mapping.
      bytes =
          mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(buffer.m.offset));
      if (bytes == MAP_FAILED) error = errno;
    }
    if (error != 0) {
      unmap_buffers();
      return error;
    }
    buffers_.push_back({static_cast<const std::uint8_t*>(bytes), buffer.length});
    buffer_flags_ = buffer.flags;
  }
  return 0;
}

void V4l2Device::unmap_buffers() noexcept {
  if (buffers_.empty()) return;
  for (const Mapping& buffer : buffers_) munmap(const_cast<std::uint8_t*>(buffer.bytes), buffer.n_bytes);
  buffers_.clear();
  v4l2_requestbuffers none{};  // releases the buffers: as long as the driver has them, its format cannot be changed
  none.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  none.memory = V4L2_MEMORY_MMAP;
  (void)call(VIDIOC_REQBUFS, none);
}

int V4l2Device::queue(std::uint32_t index) const noexcept {
  v4l2_buffer buffer = capture_buffer(index);
  return call(VIDIOC_QBUF, buffer);
}

int V4l2Device::dequeue(v4l2_buffer& buffer) const noexcept {
  buffer = capture_buffer(0);
  return call(VIDIOC_DQBUF, buffer);
}

int V4l2Device::stream_on() const noexcept {
  for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
    if (const int error = queue(i); error != 0) return error;
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return call(VIDIOC_STREAMON, type);
}

void V4l2Device::stream_off() const noexcept {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)call(VIDIOC_STREAMOFF, type);
}

std::vector<std::string> capture_nodes() {
  std::vector<std::string> paths;
  for_each_capture_node([&](const V4l2Device& device) { paths.push_back(device.path()); });
  return paths;
}

std::string find_node(const V4l2Identity& wanted) {
  std::string there, elsewhere;
  int n_alike = 0;
  for_each_capture_node([&](const V4l2Device& device) {
    if (!device.identity().is_same_camera(wanted)) return;
    if (there.empty() && device.identity().bus_info == wanted.bus_info) there = device.path();
    elsewhere = device.path();
    ++n_alike;
  });
  if (!there.empty()) return there;
  return n_alike == 1 ? elsewhere : std::string();
}

}  // namespace drivers
