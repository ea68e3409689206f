// The modes of a record under a shaking camera, with turns and shifts followed or not, beside those of a still one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tools/validate/geometry_score.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/trust.h"
#include "tools/validate/trust_shaking.h"

namespace tools {
namespace {

// Ways to follow the camera.
std::vector<Way> ways() {
  return {{"true", {"scale.only=true"}}, {"false", {"scale.only=false"}}, {"auto", {"scale.only=auto"}}};
}

void print_ways(const std::string& key, const char* camera, const TrustFlight& flight, const AnalysedFlight& result,
                const std::vector<Way>& tried) {
  const auto truth = shaken_modes(flight.job.scene());
  for (std::size_t w = 0; w < tried.size(); ++w) {
    const Analysed& way = result.ways[w];
    const Match match = match_modes(way.measured, truth, way.channels);
    const auto found = std::count_if(match.modes.begin(), match.modes.end(),
                                     [](const Found& one) { return one.as == Found::As::kRight; });
    const auto wrong = std::count_if(match.modes.begin(), match.modes.end(),
                                     [](const Found& one) { return one.as == Found::As::kWrongFold; });
    fmt::print("trust-camera\t{}\t{}\t{}\t{}\t{}\t{}\n", key, camera, tried[w].name, truth.size(), found,
               match.n_false + wrong);
  }
}

}  // namespace

void print_trust_camera(const GeometryOptions& options) {
  fmt::print(
      "# trust-camera: what drives the structure, seed, camera (still: the hover alone), scale.only, modes, found, "
      "those "
      "that are no mode\n# trust-shaking: what drives the structure, seed, drawn values\n");
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : 120.0;
  const std::vector<Way> tried = ways();
  for (const Drive drive : kDrives) {
    struct Flown {
      TrustFlight still, shaken;
      AnalysedFlight of_still, of_shaken;
      std::string words;
    };
    const auto records = for_each_seed(options, [&](std::uint64_t seed) {
      Flown out;
      out.still = out.shaken = trust_flight(drive, seed, duration_s, options);
      out.words = shake_camera(out.shaken, drive, seed);
      out.still.job.file.scene.camera.alpha_px = out.shaken.job.scene().camera.alpha_px;
      out.of_still = analyse_flight(out.still.job, out.still.setup, tried);
      out.of_shaken = analyse_flight(out.shaken.job, out.shaken.setup, tried);
      return out;
    });
    for (std::size_t i = 0; i < records.size(); ++i) {
      const std::string key =
          fmt::format("{}\t{}", word_for(drive), static_cast<std::uint64_t>(options.first_seed) + i);
      fmt::print("trust-shaking\t{}\t{}\n", key, records[i].words);
      print_ways(key, "still", records[i].still, records[i].of_still, tried);
      print_ways(key, "shaken", records[i].shaken, records[i].of_shaken, tried);
    }
  }
}

}  // namespace tools
