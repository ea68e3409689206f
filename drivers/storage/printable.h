#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace drivers {

// Texts from outside (names of files, channels, streams) on a terminal, in a log or in a text file. What would move the
// cursor, change colours or the direction of writing, or hide is shown as '?': control characters (C0, DEL, C1),
// marks and overrides of direction, characters without width, and bytes that are not UTF-8.

// Bytes of the UTF-8 character at `at`, 0 if there is none. Accepts control characters.
[[nodiscard]] std::size_t utf8_length(std::string_view text, std::size_t at = 0) noexcept;
// The same; 0 also for a character that must not be shown.
[[nodiscard]] std::size_t printable_length(std::string_view text) noexcept;

// For one line of a message; text of more than `max_length` bytes is cut between characters.
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_length = 60);
// For a text of several lines, whose line ends stay. Lines after the first get `indent`, so that none of them can be
// taken for another message.
[[nodiscard]] std::string printable_lines(std::string_view text, std::string_view indent = {});

}  // namespace drivers
