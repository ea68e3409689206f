#pragma once

#include <cstddef>
#include <string_view>

namespace tools {

// How far a request has arrived, told from its bytes before any of them is believed.
struct HeadProgress {
  enum State { kNeedsMore, kWhole, kRefused };
  State state = kNeedsMore;
  int status = 0;          // when refused: 400, 413, 431, 501
  std::size_t n_head = 0;  // when whole: bytes up to and with the empty line
  std::size_t n_body = 0;
};

// Refused are heads longer than `max_head`, bodies longer than `max_body`, bodies of unknown length or said twice, and
// bytes that no text holds.
[[nodiscard]] HeadProgress look_at_head(std::string_view bytes, std::size_t max_head, std::size_t max_body) noexcept;

}  // namespace tools
