#pragma once

#include <cstdint>
#include <string>

namespace drivers {

// Writes gray frames to an H.264 MP4 through the `ffmpeg` program, started directly (no shell). Grey levels are
// stored as full-range luma, so that a decoder returns the same 0..255 within the compression loss; at most
// 24 Mbit/s. The file gets its name only after finish() has succeeded; until then it is `<path>.partial`.
class ClipWriter {
 public:
  // Even width and height. crf: x264's constant rate factor, 0 (lossless) .. 51.
  // Throws std::runtime_error when ffmpeg cannot be started, std::invalid_argument for sizes and rates that it cannot
  // encode.
  ClipWriter(std::string path, int width_px, int height_px, double rate_hz, int crf);
  ~ClipWriter();  // an unfinished clip is stopped and its .partial file removed
  ClipWriter(const ClipWriter&) = delete;
  ClipWriter& operator=(const ClipWriter&) = delete;

  // height x width grey levels, row-major. Waits for the encoder. Throws std::runtime_error with ffmpeg's error text.
  void write(const std::uint8_t* pixels);
  // Ends the stream, waits for ffmpeg and moves the file to its name. Throws like write().
  void finish();

 private:
  void start(const std::string& frame_size, double rate_hz, int crf);
  int wait_for_exit() noexcept;  // exit status of ffmpeg as waitpid gives it
  [[noreturn]] void fail(const std::string& what, int status);
  [[nodiscard]] std::string encoder_words() const;

  std::string path_, part_path_;
  std::size_t frame_bytes_;
  int pid_ = -1;
  int input_fd_ = -1;   // this end of the socket that is ffmpeg's standard input
  int errors_fd_ = -1;  // memory file behind ffmpeg's standard error
};

}  // namespace drivers
