#include "drivers/telemetry/sender_watch.h"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/storage/printable.h"

namespace drivers {

SenderWatch::Whose SenderWatch::note(std::int64_t run_id, std::int64_t now_ns) noexcept {
  if (is_following_ && run_id == run_id_) {
    last_ns_ = now_ns;
    for (std::size_t i = 0; i < n_others_; ++i)
      others_[i].is_beside = others_[i].is_beside || now_ns - others_[i].first_ns > kOverlap_ns;
    return Whose::kFollowed;
  }
  const bool is_free = !is_following_ || has_ended_ || now_ns - last_ns_ > kSilence_ns;
  if (!is_free) {
    if (Other* one = other(run_id, now_ns)) ++one->n_messages;
    return Whose::kOther;
  }
  const bool is_next = is_following_;
  const auto end = others_.begin() + static_cast<std::ptrdiff_t>(n_others_);
  n_others_ = static_cast<std::size_t>(
      std::remove_if(others_.begin(), end, [&](const Other& one) { return one.run_id == run_id; }) - others_.begin());
  run_id_ = run_id, last_ns_ = now_ns;
  is_following_ = true, has_ended_ = false;
  return is_next ? Whose::kNextRun : Whose::kFollowed;
}

SenderWatch::Other* SenderWatch::other(std::int64_t run_id, std::int64_t now_ns) noexcept {
  for (std::size_t i = 0; i < n_others_; ++i) {
    if (others_[i].run_id == run_id) return &others_[i];
  }
  if (n_others_ == kMost) return nullptr;
  others_[n_others_] = {run_id, now_ns};
  return &others_[n_others_++];
}

std::size_t SenderWatch::n_senders() const noexcept {
  const auto is_beside = [](const Other& one) { return one.is_beside; };
  const auto all = others();
  return is_following_ ? 1 + static_cast<std::size_t>(std::count_if(all.begin(), all.end(), is_beside)) : 0;
}

std::vector<std::string> SenderWatch::words(const std::string& stream_id) const {
  if (n_senders() < 2) return {};
  std::string left_out;
  for (const Other& one : others()) {
    if (one.is_beside)
      left_out += fmt::format("{}{} messages of run {:016x}", left_out.empty() ? "" : ", ", one.n_messages,
                              static_cast<std::uint64_t>(one.run_id));
  }
  return {
      fmt::format("{} runs send as `{}`: run {:016x} is shown, {} are left out; give each service a "
                  "telemetry.stream_id or telemetry.channel_prefix of its own",
                  n_senders(), printable(stream_id), static_cast<std::uint64_t>(run_id_), left_out)};
}

}  // namespace drivers
