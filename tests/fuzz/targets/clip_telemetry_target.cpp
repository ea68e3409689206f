#include <cmath>
#include <stdexcept>

#include "drivers/camera/recording/gpmf.h"
#include "drivers/camera/recording/srt_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {
namespace {

void run_srt(Bytes bytes) {
  drivers::SrtFile file;
  try {
    file = drivers::parse_srt(text_of(bytes), "fuzz.SRT");
  } catch (const std::runtime_error& error) {
    require(std::string_view(error.what()).starts_with("fuzz.SRT:"), "a refusal names file and line");
    return;
  }
  require(!file.blocks.empty(), "there are blocks");
  for (const drivers::SrtBlock& block : file.blocks) {
    require(!block.exposure_s || *block.exposure_s > 0.0, "an exposure is positive");
    require(!block.focal_length || *block.focal_length > 0.0, "a focal length is positive");
    require(!block.zoom || *block.zoom > 0.0, "a zoom is positive");
    require(!block.clock_s || std::isfinite(*block.clock_s), "a clock is a number");
    require(!block.cue_s || *block.cue_s >= 0.0, "a cue is not before the video");
  }
}

void run_gpmf(Bytes bytes) {
  const Exact exact(bytes);
  drivers::GpmfPayload payload;
  try {
    payload = drivers::parse_gpmf({exact.data(), exact.size()});
  } catch (const std::runtime_error& error) {
    require(std::string_view(error.what()).starts_with("byte "), "a refusal names the place");
    return;
  }
  for (const drivers::GpmfStream& stream : payload.streams) {
    require(stream.key.size() == 4 && stream.n_columns > 0, "a stream has a key and columns");
    require(!stream.values.empty() && stream.values.size() % stream.n_columns == 0, "rows are whole");
    require(stream.values.size() <= bytes.size(), "no more values than bytes");
  }
}

// The first byte chooses: 's' subtitles, anything else metadata.
void run(Bytes bytes) {
  if (bytes.empty()) return;
  bytes[0] == 's' ? run_srt(bytes.subspan(1)) : run_gpmf(bytes.subspan(1));
}

const Registration kTarget("clip_telemetry", &run);

}  // namespace
}  // namespace tests::fuzz
