#pragma once

#include <cstdint>

namespace drivers {

// Statistics of a receiver on the messages of one LCM channel, from their sequence numbers.
struct ChannelCount {
  std::uint64_t received = 0;      // decoded messages of the stream followed
  std::uint64_t gaps = 0;          // messages missing between those received
  std::uint64_t out_of_order = 0;  // late or repeated ones; a late one also stays counted in `gaps`
  std::uint64_t restarts = 0;      // the sender restarted
  std::uint64_t undecodable = 0;   // includes those of another version (layout_watch.h)
  std::uint64_t n_bytes = 0;       // of every message received, decoded or not, without LCM's header
  std::uint64_t foreign = 0;       // of another stream_id on the same channel, or of a second sender; otherwise ignored
  std::int64_t first_sequence = -1, last_sequence = -1;  // -1 = none yet
  std::int64_t last_utc_ns = 0;                          // the sender's clock
  std::int64_t received_at_ns = 0;                       // the receiver's clock

  static constexpr int kLateUntilRestart = 8;
  int late_in_a_row = 0;
  bool expects_run = false;

  // The messages that follow are those of another run, whatever their numbers.
  void begin_run() noexcept { expects_run = last_sequence >= 0; }

  // False for a message older than the newest one known.
  bool note(std::int64_t sequence, std::int64_t utc_ns, std::int64_t now_ns) noexcept {
    ++received;
    received_at_ns = now_ns;
    if (last_sequence < 0) {
      first_sequence = sequence;
    } else if (expects_run) {
      ++restarts;  // losses before its first received message are unknown and not a gap
    } else if (sequence > last_sequence) {
      gaps += static_cast<std::uint64_t>(sequence - last_sequence - 1);
    } else if (utc_ns > last_utc_ns || late_in_a_row >= kLateUntilRestart) {
      // Sent later, yet numbered lower: a new run.
      // Or only late messages come: the one taken as newest was wrong, and later messages must not be ignored forever.
      ++restarts;
    } else {
      ++out_of_order;
      ++late_in_a_row;
      return false;
    }
    late_in_a_row = 0;
    expects_run = false;
    last_sequence = sequence;
    last_utc_ns = utc_ns;
    return true;
  }
};

}  // namespace drivers
