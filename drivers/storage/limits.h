#pragma once

#include <cstddef>
#include <cstdint>

// The bounds of everything that is read from files, in one place. A reader refuses what exceeds its bound, with file,
// number and bound in words, before it takes the memory. Files are opened by open_regular_file() (regular_file.h).
namespace drivers {

struct Limits {
  static constexpr std::size_t kKiB = 1U << 10U, kMiB = 1U << 20U;

  static constexpr std::size_t kLineBytes = 64 * kKiB;      // of any text that is read line by line
  static constexpr std::uint64_t kImagePixels = 1U << 26U;  // 8192 x 8192: of a still image or a frame of a video
  static constexpr std::uint64_t kImageBytes = 192 * kMiB;  // of its decoded pixels: 8192 x 8192 of 8-bit colour
  static constexpr std::size_t kJpegBytes =
      104'000'000;  // of libjpeg beside the pixels: 17 to 52 megapixels of a progressive image
  static constexpr std::size_t kSubtitleBytes = 96 * kMiB;       // of a .SRT
  static constexpr std::size_t kSubtitleBlocks = 500'000;        // of it: two hours at 60 fps
  static constexpr std::size_t kRawTelemetryBytes = 16 * kMiB;   // of GPMF, in a clip or a file: 45 minutes
  static constexpr std::size_t kTimestamps = 5'000'000;          // frames with a time of their own: two days at 25 fps
  static constexpr std::size_t kAttitudes = 3'000'000;           // of a file: four hours at 200 Hz
  static constexpr std::size_t kGyroRows = 3'000'000;            // of a gyro's file: 50 minutes at 1 kHz
  static constexpr std::size_t kFlightLogRows = 2'000'000;       // of the stretch of a flight log that is asked for
  static constexpr std::uint64_t kRecordEventBytes = 64 * kMiB;  // of one event in a record or log of messages
  static constexpr std::uint64_t kStateBytes = 240'000'000;      // of a checkpoint
  static constexpr std::size_t kYamlBytes = kMiB;                // of a configuration, scene or structure
  static constexpr std::size_t kCalibrationBytes = 4 * kMiB;     // calibration programs also write the corners used
  static constexpr std::size_t kJsonBytes = 8 * kMiB;            // of a result or a simulated truth
  static constexpr std::size_t kPageBytes = 64 * kMiB;           // of a report's page
  static constexpr std::size_t kJsonKeys = 4096;                 // of one object in it
  static constexpr std::size_t kColumns = 4096;                  // of a table
  static constexpr std::size_t kFlights = 2000;                  // whose modes are compared over time
  static constexpr std::size_t kSeriesCells = 30'000'000;        // of all columns: 20 hours of 8 channels at 50 Hz
  static constexpr std::size_t kExchangeBytes = 512 * kMiB;      // of a universal or MAT file, and of the series in it
  static constexpr std::size_t kCommentBytes = kMiB;             // above a table
  static constexpr std::size_t kPointsPerRegion = 4096;          // of one frame in tracks
  static constexpr std::size_t kRegions = 4096;                  // in tracks
  static constexpr std::size_t kPointsPerFrame = 1U << 16U;      // in tracks
  static constexpr std::size_t kTrackedPoints = 400'000;         // in tracks: different ones of a whole run
  static constexpr std::uint64_t kMatrixBytes = 512 * kMiB;      // of a stiffness or mass matrix as text
  static constexpr std::uint64_t kMatrixRows = 200'000;          // of it
  static constexpr std::uint64_t kMatrixEntries = 12'000'000;    // of it, as written: 300 MB with the other triangle
};

}  // namespace drivers
