#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drivers {

// One sensor's values in one payload of GoPro's metadata (GPMF: keys of four letters, type, size, count, big-endian,
// nested).
struct GpmfStream {
  std::string key;  // "GYRO", "SHUT", "CORI", ...
  std::size_t n_columns = 1;
  std::vector<double> values;                   // scaled; rows after one another
  std::optional<double> first_s;                // STMP: the camera's clock at the first row
  std::optional<std::uint64_t> n_so_far;        // TSMP: rows up to the end of this payload, since recording started
  std::string orientation_in, orientation_out;  // ORIN, ORIO: axes of the columns, and the axes to be used
  [[nodiscard]] std::size_t n_rows() const noexcept { return values.size() / n_columns; }
};

struct GpmfPayload {
  std::string device;  // DVNM, printable
  std::vector<GpmfStream> streams;
};

// Accepts any bytes. Streams whose values are text, compressed or of mixed types have no values and are left out.
// Throws std::runtime_error "byte N: what" if lengths are inconsistent, or there is no content.
[[nodiscard]] GpmfPayload parse_gpmf(std::span<const std::uint8_t> bytes);

}  // namespace drivers
