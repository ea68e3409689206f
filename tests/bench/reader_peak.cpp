// Calls one reader on one file and ends: for the peak of its memory (getrusage). Exit code 0: read; 2: refused, in
// words.
//   reader_peak KIND FILE
// Each result is kept until the end, as its users keep it.
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "drivers/camera/recording/clip_telemetry.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/camera/recording/timestamp_file.h"
#include "drivers/camera/recording/video_decoder.h"
#include "drivers/images/image_reader.h"
#include "drivers/storage/attitude_file.h"
#include "drivers/storage/calibration_file.h"
#include "drivers/storage/checkpoint_file.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/scene/scene_file.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "drivers/storage/timed_columns.h"
#include "drivers/storage/tracks_file.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/modal_json.h"
#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/event_log_reader.h"
#include "drivers/telemetry/run_record_reader.h"
#endif

namespace {

using Path = const std::string&;
template <class Read>
std::function<void(Path)> keeping(Read read) {
  return [read](Path path) { [[maybe_unused]] const auto kept = read(path); };
}

void tracks(Path path) {
  const drivers::TracksFile file = drivers::read_tracks_csv(path);
  drivers::TracksPass pass(file);
  core::TrackFrame frame;
  while (pass.next(frame)) {
  }
}

// Without the slot of the ring into which the pixels are converted.
void image(Path path) {
  const cv::Mat stored = drivers::read_image(path, cv::IMREAD_UNCHANGED);
  if (stored.empty()) throw drivers::FileError(path + ": cannot be decoded");
}

void video(Path path) {
  drivers::silence_media_libraries();
  drivers::VideoDecoder decoder(path, drivers::kDecoderMb);
  int n_pictures = 0;
  for (auto status = decoder.next(); status != drivers::DecodeStatus::kEnd; status = decoder.next())
    n_pictures += status == drivers::DecodeStatus::kPicture ? 1 : 0;
  if (const std::string fault = decoder.fault(); !fault.empty()) throw drivers::FileError(fault);
  if (n_pictures == 0) throw drivers::FileError(path + ": no picture can be decoded");
}

void flight_log(Path path) {
  drivers::TimedColumnsWish wish;
  wish.time = {{"t_s"}, "times"};
  wish.columns = {{{"roll"}, "roll"}, {{"pitch"}, "pitch"}, {{"yaw"}, "yaw"}, {{"u"}, "u"}, {{"v"}, "v"}, {{"w"}, "w"}};
  wish.to_s = 1999.0;
  (void)drivers::read_timed_columns(path, wish);
}

void state(Path path) {
  if (const drivers::CheckpointRead read = drivers::read_checkpoint(path); !read.refused.empty())
    throw drivers::FileError(path + ": " + read.refused);
}

const std::map<std::string, std::function<void(Path)>>& readers() {
  static const std::map<std::string, std::function<void(Path)>> out{
      {"timestamps", keeping(drivers::read_timestamp_file)},
      {"telemetry", keeping(drivers::read_telemetry)},
      {"attitude", keeping(drivers::read_attitude_csv)},
      {"calibration", keeping(drivers::read_calibration)},
      {"series", keeping(drivers::read_series_csv)},
      {"foreign", keeping([](Path path) { return drivers::read_foreign_series(path); })},
      {"structure", keeping(drivers::read_structure)},
      {"scene", keeping([](Path path) { return drivers::read_scene_file(path); })},
      {"configuration", keeping([](Path path) { return app::load_config(path); })},
      {"result", keeping(app::read_modal_json)},
      {"tracks", tracks},
      {"image", image},
      {"video", video},
      {"flight_log", flight_log},
      {"state", state},
#ifdef HOVERMODAL_WITH_LCM
      {"events",
       [](Path path) {
         drivers::EventLogReader reader(path);
         drivers::EventLogReader::Event event;
         int n_events = 0;
         while (reader.next(event)) ++n_events;
         if (n_events == 0) throw drivers::FileError(path + ": no event");
       }},
      {"record",
       [](Path path) {
         drivers::RunRecordReader reader(path);
         core::RecordedFrame frame;
         while (reader.next(frame)) {
         }
       }},
#endif
  };
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const auto found = argc == 3 ? readers().find(argv[1]) : readers().end();
  if (found == readers().end()) {
    std::fputs("reader_peak KIND FILE, KIND one of:", stderr);
    for (const auto& [name, read] : readers()) std::fprintf(stderr, " %s", name.c_str());
    std::fputs("\n", stderr);
    return 64;
  }
  try {
    found->second(argv[2]);
    return 0;
  } catch (const std::exception& e) {
    std::puts(e.what());
    return 2;
  }
}
