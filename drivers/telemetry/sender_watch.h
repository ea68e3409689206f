#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace drivers {

// Distinguishes the runs that send with one stream_id on one group, by the run_id of their messages. The first one is
// followed until it has ended or falls silent; then a message of another one is that of the next run. What others send
// meanwhile is left out and counted. Another run is a second sender once the followed one is heard after it: a run that
// was restarted is not heard again. `now_ns`: any monotonic clock of the caller.
class SenderWatch {
 public:
  static constexpr std::int64_t kSilence_ns = 3'000'000'000;  // health comes once a second
  static constexpr std::int64_t kOverlap_ns = 200'000'000;    // more than messages under way overtake each other
  static constexpr std::size_t kMost = 8;                     // others that are kept; surplus ones are left out as well

  enum class Whose { kFollowed, kNextRun, kOther };
  [[nodiscard]] Whose note(std::int64_t run_id, std::int64_t now_ns) noexcept;
  void followed_run_ended() noexcept { has_ended_ = true; }

  struct Other {
    std::int64_t run_id = 0, first_ns = 0;
    std::uint64_t n_messages = 0;
    bool is_beside = false;  // a second sender
  };
  [[nodiscard]] std::size_t n_senders() const noexcept;  // 0: none yet; others only where they are second senders
  [[nodiscard]] std::span<const Other> others() const noexcept { return {others_.data(), n_others_}; }
  [[nodiscard]] std::int64_t run_id() const noexcept { return run_id_; }  // followed

  // One statement for an operator, where there is more than one sender; else none.
  [[nodiscard]] std::vector<std::string> words(const std::string& stream_id) const;

 private:
  [[nodiscard]] Other* other(std::int64_t run_id, std::int64_t now_ns) noexcept;

  std::array<Other, kMost> others_{};
  std::size_t n_others_ = 0;
  std::int64_t run_id_ = 0, last_ns_ = 0;
  bool is_following_ = false, has_ended_ = false;
};

}  // namespace drivers
