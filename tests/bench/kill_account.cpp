// Compares the states left by killed runs of hovermodald (tools/figures/runtime_kill.py) with sums that were never
// saved and restored: one accumulator takes the samples of complete runs, without the frames that are missing in the
// states.
//   kill_account FOLDER
// FOLDER: first.lcm and again.lcm, records of complete runs, without and with a kept keyframe; kills.tsv, a line
// per killed run: its number, seconds from opening the clip to the kill, 1 if a keyframe had been kept before
// it, its record or "-"; NUMBER.state, the state file after it, if there is one. Prints "name<TAB>value".
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "drivers/storage/checkpoint_file.h"
#include "drivers/telemetry/run_record_reader.h"
#include "firmware_app/chain/state/run_head.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/replay/track_analysis.h"

namespace {

// A complete run: the points of each frame, and the samples computed from them.
struct WholeRun {
  std::vector<core::TrackFrame> tracks;
  std::vector<core::DisplacementSample> samples;
  core::WelchConfig welch;
};

WholeRun read_whole(const std::string& path) {
  drivers::RunRecordReader reader(path);
  const app::RecordedConfig recorded(reader.head(), path, {});
  app::TrackAnalysis analysis(recorded.config(), recorded.camera(), reader.head().keyframe);
  WholeRun run;
  const auto n_channels = analysis.channels().size();
  core::RecordedFrame frame;
  frame.tracks = reader.head().keyframe;
  while (reader.next(frame)) {
    run.tracks.push_back(frame.tracks);
    (void)analysis.push(frame.tracks);
    run.samples.push_back(analysis.sample());
  }
  if (reader.end() != "finished") throw std::runtime_error(path + ": the run did not come to its end");
  const std::size_t n_witnesses = run.samples.front().witness_mm.size();
  run.welch =
      app::welch_config(recorded.config().spectrum, n_channels + n_witnesses, recorded.camera().rate_hz, n_witnesses);
  return run;
}

struct Kill {
  std::string number, record;
  double after_s = 0.0;
  bool kept = false;  // a keyframe, before the run
};

std::vector<Kill> read_kills(const std::string& path) {
  std::vector<Kill> kills;
  std::ifstream in(path);
  for (Kill kill; in >> kill.number >> kill.after_s >> kill.kept >> kill.record;) kills.push_back(kill);
  return kills;
}

bool same_points(const core::TrackFrame& a, const core::TrackFrame& b) {
  return a.sequence == b.sequence && a.t_start_ns == b.t_start_ns && a.points.size() == b.points.size() &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), [](const auto& p, const auto& q) {
           return p.seen == q.seen && std::memcmp(&p.u_px, &q.u_px, sizeof p.u_px) == 0 &&
                  std::memcmp(&p.v_px, &q.v_px, sizeof p.v_px) == 0;
         });
}

struct Account {
  std::size_t n_states = 0, n_equal = 0, n_unreadable = 0, n_resumed = 0, n_frames = 0, n_other_frames = 0;
  std::uint64_t n_cells = 0;
  double worst_loss_s = 0.0;
  std::string first_wrong = "none";
};

// One accumulator over all runs.
class Uninterrupted {
 public:
  Uninterrupted(const WholeRun& first, const WholeRun& again)
      : first_(first),
        again_(again),
        welch_(first.welch),
        grid_(first.welch.rate_hz),
        room_(welch_.state_bytes() + 256) {}

  void account(const Kill& kill, const std::string& state_path, Account& out) {
    compare_record(kill, out);
    double kept_s = 0.0;
    const drivers::CheckpointRead read = drivers::read_checkpoint(state_path);
    if (read.exists && !read.refused.empty()) ++out.n_unreadable;
    if (read.exists && read.refused.empty()) kept_s = take(kill, app::run_state_of(read.bytes).spectrum, out);
    out.worst_loss_s = std::max(out.worst_loss_s, kill.after_s - kept_s);
  }

 private:
  const WholeRun& run_of(const Kill& kill) const { return kill.kept ? again_ : first_; }

  // Continues to the state's last cell, and compares. Returns the killed run's seconds in it; 0: an earlier run's
  // state.
  double take(const Kill& kill, const std::vector<std::uint8_t>& state, Account& out) {
    if (state == last_) return 0.0;
    core::WelchCpsd saved(first_.welch);
    core::TimeGrid saved_grid(first_.welch.rate_hz);
    core::StateReader in(state);
    saved_grid.restore(in);
    ++out.n_states;
    const bool readable = saved.restore(in);
    const std::uint64_t n_cells = readable ? saved.sums().n_samples : 0;
    const std::uint64_t before = welch_.sums().n_samples;
    // A file's time stamps start again with each run: one masked segment lies between two runs.
    if (!last_.empty()) {
      for (int k = 0; k < welch_.sums().n_fft / 2; ++k) (void)welch_.push_missing();
    }
    grid_ = core::TimeGrid(first_.welch.rate_hz);
    const WholeRun& run = run_of(kill);
    std::size_t n = 0;
    for (; welch_.sums().n_samples < n_cells && n < run.samples.size(); ++n) push(run.samples[n]);
    last_ = state;
    core::StateWriter writer(room_);
    grid_.save(writer);
    welch_.save(writer);
    const bool equal = writer.ok() && writer.n_used() == state.size() && welch_.sums().n_samples > before &&
                       std::memcmp(room_.data(), state.data(), state.size()) == 0;
    out.n_equal += equal ? 1U : 0U;
    if (!equal && out.first_wrong == "none") out.first_wrong = kill.number;
    out.n_cells = welch_.sums().n_samples;
    return static_cast<double>(n) / first_.welch.rate_hz;
  }

  void push(const core::DisplacementSample& sample) {
    const core::TimeGrid::Placement place = grid_.place(sample.t_start_ns);
    if (!place.accepted) return;
    for (std::uint64_t k = 0; k < place.n_missing_before; ++k) (void)welch_.push_missing();
    (void)welch_.push(sample);
  }

  // The killed run's own record, as far as it had reached the disk, must equal the frames of the complete run.
  void compare_record(const Kill& kill, Account& out) const {
    std::optional<drivers::RunRecordReader> reader;
    try {
      if (kill.record != "-") reader.emplace(kill.record);
    } catch (const std::exception&) {  // killed before its head was written
    }
    if (!reader) return;
    out.n_resumed += reader->head().continues ? 1U : 0U;
    core::RecordedFrame frame;
    frame.tracks = reader->head().keyframe;
    const WholeRun& run = run_of(kill);
    for (std::size_t n = 0; reader->next(frame); ++n) {
      ++out.n_frames;
      out.n_other_frames += n < run.tracks.size() && same_points(frame.tracks, run.tracks[n]) ? 0U : 1U;
    }
  }

  const WholeRun& first_;
  const WholeRun& again_;
  core::WelchCpsd welch_;
  core::TimeGrid grid_;
  std::vector<std::uint8_t> room_, last_;  // last_: the state compared last
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: kill_account FOLDER\n");
    return 2;
  }
  try {
    const std::string folder = argv[1];
    const WholeRun first = read_whole(folder + "/first.lcm"), again = read_whole(folder + "/again.lcm");
    const std::vector<Kill> kills = read_kills(folder + "/kills.tsv");
    Account account;
    Uninterrupted sums(first, again);
    for (const Kill& kill : kills) sums.account(kill, folder + "/" + kill.number + ".state", account);
    std::printf("kills\t%zu\nresumed\t%zu\nstates\t%zu\nequal\t%zu\nunreadable\t%zu\n", kills.size(), account.n_resumed,
                account.n_states, account.n_equal, account.n_unreadable);
    std::printf("worst_loss_s\t%.3f\nframes\t%zu\nother_frames\t%zu\ncells\t%" PRIu64 "\nfirst_wrong\t%s\n",
                account.worst_loss_s, account.n_frames, account.n_other_frames, account.n_cells,
                account.first_wrong.c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "kill_account: %s\n", e.what());
    return 1;
  }
  return 0;
}
