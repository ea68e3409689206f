#include "drivers/camera/device/v4l2_device.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
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

V4l2Picture picture_of(const v4l2_format& format, bool is_multiplanar) noexcept {
  if (!is_multiplanar) {
    const v4l2_pix_format& f = format.fmt.pix;
    return {f.width, f.height, f.pixelformat, f.field, f.bytesperline};
  }
  const v4l2_pix_format_mplane& f = format.fmt.pix_mp;
  return {f.width, f.height, f.pixelformat, f.field, f.plane_fmt[0].bytesperline};
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
  is_multiplanar_ = other.is_multiplanar_;
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
  is_multiplanar_ = (can & V4L2_CAP_VIDEO_CAPTURE) == 0;
  const bool captures = (can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0;
  if (!captures || (can & V4L2_CAP_STREAMING) == 0) {
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

V4l2Device::Request::Request(const V4l2Device& device, std::uint32_t index) noexcept {
  buffer.type = device.buffer_type();
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  if (!device.is_multiplanar_) return;
  buffer.m.planes = planes.data();
  buffer.length = VIDEO_MAX_PLANES;
}

int V4l2Device::picture(V4l2Picture& out) const noexcept {
  v4l2_format format{};
  format.type = buffer_type();
  const int error = call(VIDIOC_G_FMT, format);
  if (error == 0) out = picture_of(format, is_multiplanar_);
  return error;
}

int V4l2Device::set_picture(V4l2Picture& picture) const noexcept {
  v4l2_format format{};
  format.type = buffer_type();
  if (is_multiplanar_) {
    format.fmt.pix_mp.width = picture.width, format.fmt.pix_mp.height = picture.height;
    format.fmt.pix_mp.pixelformat = picture.fourcc, format.fmt.pix_mp.field = picture.field;
  } else {
    format.fmt.pix.width = picture.width, format.fmt.pix.height = picture.height;
    format.fmt.pix.pixelformat = picture.fourcc, format.fmt.pix.field = picture.field;
  }
  const int error = call(VIDIOC_S_FMT, format);
  if (error == 0) picture = picture_of(format, is_multiplanar_);
  return error;
}

int V4l2Device::map_buffers(std::uint32_t n) {
  unmap_buffers();
  v4l2_requestbuffers request{};
  request.count = n;
  request.type = buffer_type();
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = call(VIDIOC_REQBUFS, request); error != 0) return error;
  if (request.count < 2) return ENOMEM;
  for (std::uint32_t i = 0; i < request.count; ++i) {
    Request one(*this, i);
    int error = call(VIDIOC_QUERYBUF, one.buffer);
    const std::size_t n_bytes = is_multiplanar_ ? one.planes[0].length : one.buffer.length;
    const std::uint32_t offset = is_multiplanar_ ? one.planes[0].m.mem_offset : one.buffer.m.offset;
    void* bytes = MAP_FAILED;
    if (error == 0) {
      // Writable, although it is only read: some drivers refuse a read-only mapping.
      bytes = mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(offset));
      if (bytes == MAP_FAILED) error = errno;
    }
    if (error != 0) {
      unmap_buffers();
      return error;
    }
    buffers_.push_back({static_cast<const std::uint8_t*>(bytes), n_bytes});
    buffer_flags_ = one.buffer.flags;
  }
  return 0;
}

void V4l2Device::unmap_buffers() noexcept {
  if (buffers_.empty()) return;
  for (const Mapping& buffer : buffers_) munmap(const_cast<std::uint8_t*>(buffer.bytes), buffer.n_bytes);
  buffers_.clear();
  v4l2_requestbuffers none{};  // releases the buffers: as long as the driver has them, its format cannot be changed
  none.type = buffer_type();
  none.memory = V4L2_MEMORY_MMAP;
  (void)call(VIDIOC_REQBUFS, none);
}

int V4l2Device::queue(std::uint32_t index) const noexcept {
  Request one(*this, index);
  return call(VIDIOC_QBUF, one.buffer);
}

int V4l2Device::dequeue(V4l2Filled& out) const noexcept {
  Request one(*this, 0);
  const v4l2_buffer& buffer = one.buffer;
  if (const int error = call(VIDIOC_DQBUF, one.buffer); error != 0) return error;
  out = {buffer.index, buffer.flags, buffer.sequence, buffer.timestamp};
  if (buffer.index >= buffers_.size()) return 0;
  const Mapping& mapped = buffers_[buffer.index];
  const std::size_t first = is_multiplanar_ ? one.planes[0].data_offset : 0;  // a header before the picture
  const std::size_t end =
      std::min<std::size_t>(is_multiplanar_ ? one.planes[0].bytesused : buffer.bytesused, mapped.n_bytes);
  if (first < end) out.bytes = mapped.bytes + first, out.n_bytes = end - first;
  return 0;
}

int V4l2Device::stream_on() const noexcept {
  for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
    if (const int error = queue(i); error != 0) return error;
  }
  std::uint32_t type = buffer_type();
  return call(VIDIOC_STREAMON, type);
}

void V4l2Device::stream_off() const noexcept {
  std::uint32_t type = buffer_type();
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
