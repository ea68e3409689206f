#include "drivers/camera/network/stream_camera.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <array>
#include <atomic>

#include <fstream>
#include <thread>

#include "drivers/camera/device_missing.h"
#include "tests/support/camera_drain.h"
#include "tests/support/folder_test.h"
#include "tests/support/numbered_sender.h"

namespace test_support {
namespace {

using drivers::CaptureStatus;
using drivers::StreamCamera;

// Hands datagrams on, all but each `every`-th.
class LossyPath {
 public:
  LossyPath(int to_port, int every) : every_(every), fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sockaddr_in own = to_;
    to_.sin_port = htons(static_cast<std::uint16_t>(to_port));
    socklen_t size = sizeof own;
    auto* any = reinterpret_cast<sockaddr*>(&own);
    if (bind(fd_, any, size) != 0 || getsockname(fd_, any, &size) != 0) throw std::runtime_error("no socket");
    port_ = ntohs(own.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~LossyPath() {
    ends_ = true;
    thread_.join();
    close(fd_);
  }
  [[nodiscard]] int port() const { return port_; }

 private:
  void run() {
    std::array<char, 2048> bytes{};
    for (int n = 0; !ends_;) {
      pollfd waiting{fd_, POLLIN, 0};
      if (poll(&waiting, 1, 50) <= 0) continue;
      const auto size = recv(fd_, bytes.data(), bytes.size(), 0);
      if (size <= 0 || ++n % every_ == 0) continue;
      (void)sendto(fd_, bytes.data(), static_cast<std::size_t>(size), 0, reinterpret_cast<sockaddr*>(&to_), sizeof to_);
    }
  }

  int every_, fd_, port_ = 0;
  sockaddr_in to_{};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

struct Received {
  std::uint64_t sequence;
  std::optional<unsigned> number;
  std::int64_t t_ns;
};

std::vector<Received> receive(drivers::Camera& camera, std::size_t n) {
  core::Frame slot = make_slot(camera.info());
  std::vector<Received> out;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (out.size() < n && std::chrono::steady_clock::now() < until) {
    if (camera.capture(slot, std::chrono::milliseconds(100)) == CaptureStatus::kFrame)
      out.push_back({slot.sequence, number_in(slot), slot.t_start_ns});
  }
  return out;
}

// Every missing picture is a jump of the numbers.
void expect_counted(const std::vector<Received>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_TRUE(frames[i].number) << "a damaged picture, the " << i << "th";
    EXPECT_EQ(frames[i].sequence - frames[0].sequence, *frames[i].number - *frames[0].number) << i;
    EXPECT_NEAR(static_cast<double>(frames[i].t_ns - frames[0].t_ns) * 1e-9,
                static_cast<double>(frames[i].sequence - frames[0].sequence) / kSentRate_hz, 1e-4);
  }
}

TEST(StreamCamera, DeliversThePicturesOfAPathThatLosesNone) {
  const Sent sent;
  StreamCamera camera({.source = sent.source()});
  EXPECT_NEAR(camera.info().rate_hz, kSentRate_hz, 1e-6);
  EXPECT_FALSE(camera.info().lossless);
  camera.start();
  const auto frames = receive(camera, 100);
  ASSERT_EQ(frames.size(), 100U);
  expect_counted(frames);
  // A busy computer may be late by more than the ring holds, once.
  EXPECT_LE(frames.back().sequence - frames.front().sequence, 110U);
  EXPECT_LE(camera.trouble().n_damaged, 10U);
}

TEST(StreamCamera, WhatIsLostOnTheWayIsCountedAndNoDamagedPictureDelivered) {
  const int port = free_udp_port();
  const LossyPath path(port, 23);
  const tests::ChildProcess sender(sender_to(path.port()));
  StreamCamera camera({.source = fmt::format("udp://127.0.0.1:{}", port)});
  camera.start();
  const auto frames = receive(camera, 100);
  ASSERT_EQ(frames.size(), 100U);
  expect_counted(frames);
  EXPECT_GT(frames.back().sequence - frames.front().sequence, 99U);
  EXPECT_GT(camera.trouble().n_damaged, 0U);
}

TEST(StreamCamera, ASenderThatComesBackIsReceivedAgain) {
  const int port = free_udp_port();
  auto sender = std::make_unique<tests::ChildProcess>(sender_to(port));
  StreamCamera camera({.source = fmt::format("udp://127.0.0.1:{}", port)});
  camera.start();
  const auto before = receive(camera, 20);
  ASSERT_EQ(before.size(), 20U);
  sender.reset();
  core::Frame slot = make_slot(camera.info());
  while (!camera.trouble().is_lost)
    ASSERT_EQ(camera.capture(slot, std::chrono::milliseconds(50)), CaptureStatus::kTimeout) << camera.fault();
  sender = std::make_unique<tests::ChildProcess>(sender_to(port));
  const auto after = receive(camera, 20);
  ASSERT_EQ(after.size(), 20U);
  expect_counted(after);
  const double elapsed_s = static_cast<double>(after.front().t_ns - before.back().t_ns) * 1e-9;
  EXPECT_NEAR(static_cast<double>(after.front().sequence - before.back().sequence) / kSentRate_hz, elapsed_s, 0.02);
  EXPECT_EQ(camera.trouble().n_interruptions, 1U);
  EXPECT_FALSE(camera.trouble().is_lost);
}

class StreamSession : public tests::FolderTest {};

TEST_F(StreamSession, RtpIsReceivedAsItsDescriptionSays) {
  const int port = free_udp_port();
  const std::string description = (folder_ / "camera.sdp").string();
  auto arguments = numbered_sender(kSentRate_hz, {"-c:v", "mjpeg", "-q:v", "2", "-huffman", "0"}, "rtp",
                                   fmt::format("rtp://127.0.0.1:{}", port));
  arguments.insert(arguments.end() - 3, {"-sdp_file", description});
  const tests::ChildProcess sender(arguments);
  for (int i = 0; i < 100 && !std::ifstream(description).good(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  StreamCamera camera({.source = description, .rate_hz = kSentRate_hz});
  camera.start();
  const auto frames = receive(camera, 30);
  ASSERT_EQ(frames.size(), 30U);
  expect_counted(frames);
}

TEST(StreamCamera, NobodyThereIsAMissingDevice) {
  EXPECT_THROW(StreamCamera({.source = "tcp://127.0.0.1:9"}), drivers::DeviceMissing);
  EXPECT_THROW(StreamCamera({.source = "rtsp://user:secret@127.0.0.1:9/live"}), drivers::DeviceMissing);
  EXPECT_THROW(StreamCamera({.source = "http://127.0.0.1/"}), std::invalid_argument);
  EXPECT_THROW(StreamCamera({.source = "/no/such/camera.sdp"}), drivers::DeviceMissing);
}

}  // namespace
}  // namespace test_support
