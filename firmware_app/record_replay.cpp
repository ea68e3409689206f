#include <fmt/format.h>

#include <list>
#include <memory>
#include <optional>
#include <stdexcept>

#include "firmware_app/analysis.h"
#include "firmware_app/run_head.h"
#include "firmware_app/track_replay.h"

#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/run_record_reader.h"

namespace app {

namespace {

// One recorded run and the configuration it is replayed with.
class Record {
 public:
  Record(const std::string& path, const RecordOverrides& overrides)
      : path_(path), reader_(path), recorded_(reader_.head(), path + ": its configuration", overrides.overrides) {
    if (!overrides.config_path.empty()) given_ = load_config(overrides.config_path, overrides.overrides);
  }

  [[nodiscard]] TrackSource source() {
    return {given_ ? *given_ : recorded_.config(),
            recorded_.camera(),
            reader_.head().keyframe,
            path_,
            [this](core::RecordedFrame& out) { return reader_.next(out); },
            recorded_.image() ? &*recorded_.image() : nullptr};
  }

  void remark(std::vector<std::string>& remarks) const {
    const auto say = [&](const std::string& what) { remarks.push_back(path_ + ": " + what); };
    if (reader_.starts_late()) say("its first files are missing: the estimate is based on the remaining files");
    if (reader_.head().continues)
      say("the run resumed from the checkpoint of an earlier run: give that record too, before this one");
    if (reader_.n_damaged() > 0) say(fmt::format("{} damaged messages were left out", reader_.n_damaged()));
    if (reader_.n_attitudes_left_out() > 0)
      say(fmt::format("{} attitudes are not in the record: the run had them", reader_.n_attitudes_left_out()));
    if (reader_.was_thinned())
      say("under overload the service kept every n-th frame and started new spectra; this replay does "
          "not");
    if (reader_.end().empty()) say("the record was cut off");
    if (reader_.end().starts_with("fault")) say("the run ended with a " + reader_.end());
  }

 private:
  std::string path_;
  drivers::RunRecordReader reader_;
  RecordedConfig recorded_;
  std::optional<AppConfig> given_;
};

}  // namespace

RecordsResult replay_records(const std::vector<std::string>& paths, const RecordOverrides& overrides,
                             const std::string& report_directory) {
  std::list<Record> records;
  std::vector<TrackSource> sources;
  for (const std::string& path : paths) {
    records.emplace_back(path, overrides);
    sources.push_back(records.back().source());
  }
  if (sources.empty()) throw std::invalid_argument("no record to replay");
  RecordsResult result{replay(sources, report_directory), {}};
  for (const Record& record : records) record.remark(result.remarks);
  return result;
}

}  // namespace app

#else

namespace app {

RecordsResult replay_records(const std::vector<std::string>&, const RecordOverrides&, const std::string&) {
  throw std::runtime_error("this build has no LCM, and reads no record; a tracks.csv can be replayed");
}

}  // namespace app

#endif
