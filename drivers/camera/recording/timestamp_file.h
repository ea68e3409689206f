#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drivers {

// True start-of-exposure times beside a recording: header `frame,t_s`, then one line per frame, counted from 0.
//   frame,t_s
//   0,4.438000
//   1,4.495000
// Returned in ns, finite and strictly increasing. Lines that are empty or begin with # are skipped. Throws
// std::runtime_error naming file, line, value and remedy.
[[nodiscard]] std::vector<std::int64_t> read_timestamp_file(const std::string& path);

// File with the times of `source`: <video without extension>.timestamps.csv, for a folder
// <folder>/timestamps.csv or <folder>.timestamps.csv. Empty: no such file. Throws when both exist.
[[nodiscard]] std::string find_timestamp_file(const std::string& source);

// (n - 1) / (last - first), Hz. At least two stamps.
[[nodiscard]] double mean_rate_hz(const std::vector<std::int64_t>& stamps_ns) noexcept;

}  // namespace drivers
