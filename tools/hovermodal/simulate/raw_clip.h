#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drivers/storage/csv_writer.h"

namespace tools {

// Writes gray frames uncompressed as YUV4MPEG2 without colour, which ffmpeg, GStreamer and x264 read. The file gets its
// name only after finish() has succeeded. Used by one thread.
class RawClip {
 public:
  // Throws drivers::FileError.
  RawClip(const std::string& path, int width_px, int height_px, double rate_hz);
  // height x width grey levels (full range), row-major. Throws drivers::FileError, as finish() does.
  void write(const std::uint8_t* pixels);
  void finish() { file_.commit(); }

 private:
  drivers::CsvWriter file_;  // writes blocks of any bytes
  std::size_t frame_bytes_;
};

}  // namespace tools
