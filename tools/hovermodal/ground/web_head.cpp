#include "tools/hovermodal/ground/web_head.h"

#include <algorithm>
#include <charconv>

namespace tools {
namespace {

constexpr int kBadRequest = 400, kTooLarge = 413, kHeadTooLarge = 431, kNotImplemented = 501;

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [&](char x, char y) { return lower(x) == lower(y); });
}

HeadProgress refused(int status) { return {HeadProgress::kRefused, status, 0, 0}; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// Parses one header line into `out`; returns 0 or the status of a refusal.
int take_line(std::string_view line, HeadProgress& out, bool& has_length) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || colon == 0) return kBadRequest;
  const std::string_view name = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
  if (name.find(' ') != name.npos || name.find('\t') != name.npos) return kBadRequest;
  if (equals_ignoring_case(name, "transfer-encoding") || equals_ignoring_case(name, "content-encoding")) {
    return kNotImplemented;
  }
  if (!equals_ignoring_case(name, "content-length")) return 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), out.n_body);
  const bool is_number = !value.empty() && error == std::errc{} && end == value.data() + value.size();
  if (has_length || !is_number) return kBadRequest;
  has_length = true;
  return 0;
}

}  // namespace

HeadProgress look_at_head(std::string_view bytes, std::size_t max_head, std::size_t max_body) noexcept {
  const std::string_view head = bytes.substr(0, std::min(bytes.size(), max_head));
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\r' && c != '\n' && c != '\t') || c == 0x7f;
  };
  const std::size_t end = head.find("\r\n\r\n");
  const std::string_view looked_at = head.substr(0, end);
  if (std::any_of(looked_at.begin(), looked_at.end(), is_control)) return refused(kBadRequest);
  if (end == std::string_view::npos) return bytes.size() >= max_head ? refused(kHeadTooLarge) : HeadProgress{};
  HeadProgress out;
  out.n_head = end + 4;
  bool has_length = false;
  std::size_t begin = head.find("\r\n") + 2;  // after the request line
  while (begin < end) {
    const std::size_t line_end = std::min(head.find("\r\n", begin), end);
    if (const int status = take_line(head.substr(begin, line_end - begin), out, has_length); status != 0) {
      return refused(status);
    }
    begin = line_end + 2;
  }
  if (out.n_body > max_body) return refused(kTooLarge);
  out.state = bytes.size() >= out.n_head + out.n_body ? HeadProgress::kWhole : HeadProgress::kNeedsMore;
  return out;
}

}  // namespace tools
