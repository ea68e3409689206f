#pragma once

#include <linux/videodev2.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drivers {

// Identifies a camera independently of the present number of its node.
struct V4l2Identity {
  std::string driver;    // uvcvideo
  std::string card;      // the device's own name
  std::string bus_info;  // the port it is connected to
  std::string serial;    // USB; empty where there is none

  // Same kind and same serial number; without serial numbers, the same port.
  [[nodiscard]] bool is_same_camera(const V4l2Identity& other) const noexcept;
};

// The image format of a node.
struct V4l2Picture {
  std::uint32_t width = 0, height = 0, fourcc = 0, field = V4L2_FIELD_NONE;
  std::uint32_t stride_bytes = 0;  // of the first plane
};

// A buffer as the driver has filled it.
struct V4l2Filled {
  std::uint32_t index = 0, flags = 0, sequence = 0;
  timeval stamp{};
  const std::uint8_t* bytes = nullptr;  // of the first plane, which holds the luma where there are several
  std::size_t n_bytes = 0;
};

// An open V4L2 capture node, of the single- or the multi-planar interface: a difference that ends here. Calls return 0
// or the errno and do not throw, except `open`. One thread at a time.
class V4l2Device {
 public:
  V4l2Device() = default;
  ~V4l2Device() { close(); }
  V4l2Device(V4l2Device&& other) noexcept;
  V4l2Device& operator=(V4l2Device&& other) noexcept;
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;

  // Opens a node that captures video by streaming. Returns 0 or the errno; ENOTTY: no such node.
  [[nodiscard]] int open(const std::string& path);
  void close() noexcept;

  [[nodiscard]] bool is_open() const noexcept { return fd_ >= 0; }
  [[nodiscard]] int fd() const noexcept { return fd_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const V4l2Identity& identity() const noexcept { return identity_; }

  template <class T>
  [[nodiscard]] int call(unsigned long request, T& argument) const noexcept {
    return call_raw(request, &argument);
  }

  [[nodiscard]] std::uint32_t buffer_type() const noexcept {  // for requests that name it
    return is_multiplanar_ ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  }
  [[nodiscard]] int picture(V4l2Picture& out) const noexcept;          // the present one
  [[nodiscard]] int set_picture(V4l2Picture& picture) const noexcept;  // changed to what the device makes of it

  // Buffers of the driver, their first planes mapped here. `map` requests `n` and accepts the number it is given (at
  // least two).
  [[nodiscard]] int map_buffers(std::uint32_t n);
  void unmap_buffers() noexcept;
  [[nodiscard]] std::uint32_t buffer_flags() const noexcept { return buffer_flags_; }  // of the last one, once mapped

  [[nodiscard]] int queue(std::uint32_t index) const noexcept;
  [[nodiscard]] int dequeue(V4l2Filled& out) const noexcept;  // EAGAIN: no buffer is full
  [[nodiscard]] int stream_on() const noexcept;               // queue all buffers first
  void stream_off() const noexcept;

 private:
  struct Mapping {
    const std::uint8_t* bytes = nullptr;
    std::size_t n_bytes = 0;
  };
  // A buffer's description as the kernel wants it; refers to itself.
  struct Request {
    Request(const V4l2Device& device, std::uint32_t index) noexcept;
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;
    v4l2_buffer buffer{};
    std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  };
  [[nodiscard]] int call_raw(unsigned long request, void* argument) const noexcept;

  int fd_ = -1;
  bool is_multiplanar_ = false;
  std::string path_;
  V4l2Identity identity_;
  std::vector<Mapping> buffers_;
  std::uint32_t buffer_flags_ = 0;
};

// Nodes that capture video, in the order of their numbers.
[[nodiscard]] std::vector<std::string> capture_nodes();

// The present node of that camera; empty: it is not attached, or two are alike and neither is at the former port.
[[nodiscard]] std::string find_node(const V4l2Identity& wanted);

}  // namespace drivers
