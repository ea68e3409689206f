#include "drivers/storage/clip_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "drivers/storage/partial_file.h"

extern char** environ;

namespace drivers {
namespace {

constexpr int kMaxKilobitsPerSecond = 24000;  // 180 MB a minute at most, whatever the scene

std::size_t checked_frame_bytes(int width_px, int height_px, double rate_hz, int crf) {
  if (width_px < 2 || height_px < 2 || width_px > 16384 || height_px > 16384 || width_px % 2 != 0 ||
      height_px % 2 != 0) {
    throw std::invalid_argument(
        fmt::format("clip size {}x{}: H.264 needs an even width and height, 2 to 16384", width_px, height_px));
  }
  if (!(rate_hz >= 0.1 && rate_hz <= 1e4)) {
    throw std::invalid_argument(fmt::format("clip frame rate {} Hz: give 0.1 to 10000", rate_hz));
  }
  if (crf < 0 || crf > 51) throw std::invalid_argument(fmt::format("clip crf {}: give 0 to 51", crf));
  return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
}

void close_fd(int& fd) noexcept {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

// Arguments of ffmpeg. A gray source and a full-range target make the conversion a copy of the luma plane.
// The encoder's settings were chosen for the error of tracked displacements at a given file size, not for appearance:
// without bidirectional frames and with a narrow dead zone, fewer blocks are predicted with a slightly wrong motion
// whose small residual is then dropped. This halves the displacement error of the plain preset at the same size.
std::vector<std::string> encoder_arguments(const std::string& part_path, const std::string& frame_size, double rate_hz,
                                           int crf) {
  const std::string limit = fmt::format("{}k", kMaxKilobitsPerSecond);
  return {"ffmpeg",
          "-hide_banner",
          "-nostdin",
          "-nostats",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "gray",
          "-s",
          frame_size,
          "-framerate",
          fmt::format("{:.9g}", rate_hz),
          "-color_range",
          "pc",
          "-i",
          "pipe:0",
          "-c:v",
          "libx264",
          "-preset",
          "superfast",
          "-tune",
          "psnr",
          "-crf",
          std::to_string(crf),
          "-maxrate",
          limit,
          "-bufsize",
          limit,
          "-x264-params",
          "subme=4:bframes=0:no-dct-decimate=1:deadzone-inter=8:deadzone-intra=8",
          "-pix_fmt",
          "yuvj420p",
          "-color_range",
          "pc",
          "-f",
          "mp4",
          "file:" + part_path};
}

// A program that cannot be started is reported by posix_spawn or, as POSIX also allows, by the child's exit code.
constexpr int kNotStarted = 127;

std::runtime_error not_started(const std::string& path, const std::string& why) {
  return std::runtime_error(
      fmt::format("{}: cannot start the program `ffmpeg` ({}); install it: apt-get install ffmpeg", path, why));
}

}  // namespace

ClipWriter::ClipWriter(std::string path, int width_px, int height_px, double rate_hz, int crf)
    : path_(std::move(path)),
      part_path_(partial_path(path_)),
      frame_bytes_(checked_frame_bytes(width_px, height_px, rate_hz, crf)) {
  start(fmt::format("{}x{}", width_px, height_px), rate_hz, crf);
}

void ClipWriter::start(const std::string& frame_size, double rate_hz, int crf) {
  // A socket instead of a pipe, because send() can suppress SIGPIPE, whatever the program does with that signal.
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::runtime_error(fmt::format("{}: cannot make a channel to ffmpeg: {}", path_, std::strerror(errno)));
  }
  input_fd_ = ends[0];
  errors_fd_ = ::memfd_create("ffmpeg-errors", MFD_CLOEXEC);

  std::vector<std::string> arguments = encoder_arguments(part_path_, frame_size, rate_hz, crf);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (errors_fd_ >= 0) posix_spawn_file_actions_adddup2(&actions, errors_fd_, STDERR_FILENO);
  const int error = posix_spawnp(&pid_, "ffmpeg", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (error != 0) {
    pid_ = -1;
    close_fd(input_fd_);
    close_fd(errors_fd_);
    throw not_started(path_, std::strerror(error));
  }
}

ClipWriter::~ClipWriter() {
  if (pid_ >= 0) {
    ::kill(pid_, SIGKILL);
    wait_for_exit();
    std::remove(part_path_.c_str());
  }
  close_fd(input_fd_);
  close_fd(errors_fd_);
}

int ClipWriter::wait_for_exit() noexcept {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

void ClipWriter::write(const std::uint8_t* pixels) {
  std::size_t done = 0;
  while (done < frame_bytes_) {
    const ssize_t n = ::send(input_fd_, pixels + done, frame_bytes_ - done, MSG_NOSIGNAL);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno != EINTR) {
      close_fd(input_fd_);
      fail("ffmpeg stopped reading frames", pid_ >= 0 ? wait_for_exit() : 0);
    }
  }
}

void ClipWriter::finish() {
  close_fd(input_fd_);
  if (pid_ < 0) throw std::runtime_error(path_ + ": the clip is already finished or has failed");
  const int status = wait_for_exit();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("ffmpeg could not finish the clip", status);
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0) {
    throw std::runtime_error(fmt::format("{}: cannot rename {}: {}", path_, part_path_, std::strerror(errno)));
  }
}

void ClipWriter::fail(const std::string& what, int status) {
  std::remove(part_path_.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted) throw not_started(path_, "it ended at once");
  throw std::runtime_error(fmt::format("{}: {}: {}", path_, what, encoder_words()));
}

std::string ClipWriter::encoder_words() const {
  std::string words(2000, '\0');
  const ssize_t n = errors_fd_ >= 0 ? ::pread(errors_fd_, words.data(), words.size(), 0) : 0;
  words.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  while (!words.empty() && words.back() == '\n') words.pop_back();
  if (words.empty()) return "no message; is the disk full?";
  return words;
}

}  // namespace drivers
