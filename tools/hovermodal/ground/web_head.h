#pragma once

#include <cstddef>
#include <string_view>

namespace tools {

// How much of a request has arrived, determined from its bytes before they are parsed.
struct HeadProgress {
  enum State { kNeedsMore, kWhole, kRefused };
  State state = kNeedsMore;
  int status = 0;          // if refused: 400, 413, 431, 501
  std::size_t n_head = 0;  // if complete: bytes up to and including the empty line
  std::size_t n_body = 0;
};

// Refuses heads longer than `max_head`, bodies longer than `max_body`, bodies whose length is missing or stated twice,
// and bytes that are not allowed in text.
[[nodiscard]] HeadProgress look_at_head(std::string_view bytes, std::size_t max_head, std::size_t max_body) noexcept;

}  // namespace tools
