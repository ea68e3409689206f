#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace tools {

// Pieces of a terminal line from data of the network: whatever the data, the result has no control
// characters and the requested width. A column is one code point.

enum class Charset { kUnicode, kAscii };

// Control characters and malformed UTF-8 become '?'.
[[nodiscard]] std::string printable(std::string_view text);

// `printable`, wrapped between words to lines of at most `columns`; every line but the first begins with two spaces.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t columns);

// `printable`, cut or padded with spaces to exactly `columns`.
[[nodiscard]] std::string fit(std::string_view text, std::size_t columns);

// Fixed-point with `decimals`, "-" for NaN; few digits and an exponent for large values.
[[nodiscard]] std::string number(double value, int decimals);

// The last `columns` values scaled between their minimum and maximum; a space where not seen.
[[nodiscard]] std::string sparkline(const std::deque<float>& values, std::size_t columns, Charset charset);

// Root mean square about the mean of the last `n` values seen; NaN if there are none.
[[nodiscard]] double rms(const std::deque<float>& values, std::size_t n);

// A mode shape as sign and height per channel; "~" as sign where the component is more imaginary than real.
[[nodiscard]] std::string shape_bars(const std::vector<float>& re, const std::vector<float>& im, std::size_t columns,
                                     Charset charset);

}  // namespace tools
