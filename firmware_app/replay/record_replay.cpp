#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <list>
#include <memory>
#include <stdexcept>

#include "firmware_app/chain/state/run_head.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/replay/track_replay.h"

#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/run_record_reader.h"

namespace app {

namespace {

// One recorded run and the configuration it is replayed with.
class Record {
 public:
  Record(const std::string& path, const RecordOverrides& overrides)
      : path_(path), reader_(path), recorded_(reader_.head(), path + ": its configuration", overrides.overrides) {
    config_ =
        overrides.config_path.empty() ? recorded_.config() : load_config(overrides.config_path, overrides.overrides);
    take_axes_of(config_, recorded_.config().regions);
    if (overrides.skips_closure_reports && config_.closure.adopt == ClosureAdopt::kReport)
      config_.closure.adopt = ClosureAdopt::kOff;
  }

  // `read`: called after every frame.
  [[nodiscard]] TrackSource source(const std::function<void()>& read) {
    return {config_,
            recorded_.camera(),
            reader_.head().keyframe,
            path_,
            [this, read](core::RecordedFrame& out) {
              if (!reader_.next(out)) return false;
              if (read) read();
              return true;
            },
            [this]() -> const core::AircraftBatch& { return reader_.aircraft(); },
            recorded_.image() ? &*recorded_.image() : nullptr,
            resumed(),
            [this] {
              return RunAccount{reader_.counts(), reader_.times()};
            }};
  }

  [[nodiscard]] const drivers::RunRecordReader& reader() const noexcept { return reader_; }

  // is_first: first of the records that are replayed together.
  void remark(std::vector<std::string>& remarks, bool is_first) const {
    const auto say = [&](const std::string& what) { remarks.push_back(path_ + ": " + what); };
    if (reader_.starts_late()) say("its first files are missing: the estimate is based on the remaining files");
    if (reader_.head().continues && is_first && resumed() == nullptr)
      say("the run resumed from a state that this replay cannot use: give the record of the earlier run too, before "
          "this "
          "one");
    if (reader_.n_damaged() > 0) say(fmt::format("{} damaged messages were left out", reader_.n_damaged()));
    if (reader_.n_attitudes_left_out() > 0)
      say(fmt::format("{} attitudes are not in the record: the run had them", reader_.n_attitudes_left_out()));
    if (reader_.counts() && reader_.counts()->snapshots_skipped > 0)
      say(
          fmt::format("the run was too busy for {} of its estimates, which this replay makes: its modes have a longer "
                      "history",
                      reader_.counts()->snapshots_skipped));
    if (reader_.end().empty()) say("the record was cut off");
    if (reader_.end().starts_with("fault")) say("the run ended with a " + reader_.end());
  }

 private:
  // A later file of the record alone lacks the samples after that state.
  [[nodiscard]] const RunState* resumed() const noexcept {
    return reader_.starts_late() ? nullptr : recorded_.resumed(config_);
  }

  std::string path_;
  drivers::RunRecordReader reader_;
  RecordedConfig recorded_;
  AppConfig config_;  // used for the replay
};

}  // namespace

RecordsResult replay_records(const std::vector<std::string>& paths, const RecordOverrides& overrides,
                             const std::string& report_directory, const ByteProgress& progress) {
  std::list<Record> records;
  const auto tell = [&] {
    std::uint64_t done = 0, total = 0;
    for (const Record& record : records) done += record.reader().bytes_read(), total += record.reader().bytes();
    progress(std::min(done, total), total);
  };
  std::vector<TrackSource> sources;
  for (const std::string& path : paths) {
    records.emplace_back(path, overrides);
    sources.push_back(records.back().source(progress ? tell : std::function<void()>()));
  }
  if (sources.empty()) throw std::invalid_argument("no record to replay");
  RecordsResult result{replay(sources, report_directory), {}};
  for (const Record& record : records) record.remark(result.remarks, &record == &records.front());
  return result;
}

}  // namespace app

#else

namespace app {

RecordsResult replay_records(const std::vector<std::string>&, const RecordOverrides&, const std::string&,
                             const ByteProgress&) {
  throw std::runtime_error("this build has no LCM, and reads no record; a tracks.csv can be replayed");
}

}  // namespace app

#endif
