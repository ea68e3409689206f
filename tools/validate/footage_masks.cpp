// Regions that are covered, and frames in which one was tracked wrongly.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/identification/mac.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/track_generator.h"
#include "firmware_app/replay/track_analysis.h"
#include "tools/validate/footage.h"
#include "tools/validate/geometry_flight.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

constexpr double kDuration_s = 60.0;
constexpr int kFloors = 6;

// Changes the points of a frame before they are measured.
using Damage = std::function<void(std::size_t i_frame, core::TrackFrame& tracks)>;

struct Outcome {
  core::ModalEstimate estimate;
  std::vector<core::ChannelInfo> channels;
};

// The tracks of a seed, generated once and analysed with every kind of damage.
class Flight {
 public:
  explicit Flight(std::uint64_t seed)
      : setup_{.scene = "preset: paper\n"},
        job_(flight_job(setup_, seed, kDuration_s, GeometryOptions{})),
        generator_(job_.scene()),
        declared_(declared_run(job_, setup_, {}, generator_.motion())) {
    auto timing = generator_.timing();
    for (core::simulation::DeliveredFrame delivered; timing.next(delivered);)
      generator_.generate(delivered, frames_.emplace_back());
  }

  [[nodiscard]] Outcome analyse(const Damage& damage) const {
    app::TrackAnalysis analysis(declared_.config, declared_.camera, frames_.front());
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      core::TrackFrame tracks = frames_[i];
      if (damage) damage(i, tracks);
      (void)analysis.push(tracks);
    }
    return {analysis.finish(), analysis.channels()};
  }
  [[nodiscard]] std::uint16_t region(const std::string& name) const {
    const auto& regions = declared_.config.regions;
    const auto at = std::find_if(regions.begin(), regions.end(), [&](const auto& r) { return r.name == name; });
    return static_cast<std::uint16_t>(at - regions.begin());
  }
  [[nodiscard]] std::vector<core::simulation::TrueMode> truth() const { return modes_of(job_.scene().structure); }
  [[nodiscard]] std::size_t n_frames() const noexcept { return frames_.size(); }

 private:
  FlightSetup setup_;
  SimulateJob job_;
  core::simulation::TrackGenerator generator_;
  DeclaredRun declared_;
  std::vector<core::TrackFrame> frames_;
};

std::string floor_name(int floor) { return fmt::format("floor{}", floor); }

// MAC over all channels but the damaged one.
double mac_of_rest(const core::Mode& a, const core::Mode& b, const std::vector<core::ChannelInfo>& channels,
                   const std::string& left_out) {
  std::vector<std::complex<double>> x, y;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name == left_out) continue;
    x.push_back(a.shape[c]), y.push_back(b.shape[c]);
  }
  return core::mac(x, y);
}

// A damaged run compared with the undamaged one.
struct Comparison {
  std::string false_modes;  // of the damaged run, each with what the whole run says of it
  int n_whole = 0, n_kept = 0, n_false = 0, n_named = 0, n_masked = 0;
  double worst_mac = 1.0, worst_hz = 0.0;
  double worst_mode_hz = 0.0, whole_mac = 1.0,
         damaged_mac = 1.0;  // of the worst MAC: its mode, either shape with the true one
  std::string missing;       // true frequencies of modes that were not kept
};

const core::Mode* near_mode(const std::vector<core::Mode>& modes, double frequency_hz) {
  constexpr double kNear = 0.01;
  for (const core::Mode& mode : modes) {
    if (std::abs(mode.frequency_hz / frequency_hz - 1.0) < kNear) return &mode;
  }
  return nullptr;
}

// Structural modes that no true mode was matched with.
std::string false_modes(const core::ModalEstimate& whole, const core::ModalEstimate& damaged, const Match& match) {
  std::string out;
  for (const core::Mode& mode : damaged.modes) {
    const bool is_matched = std::any_of(match.modes.begin(), match.modes.end(), [&](const Found& found) {
      return found.as == Found::As::kRight && found.mode.frequency_hz == mode.frequency_hz;
    });
    if (is_matched) continue;
    const core::Mode* other = near_mode(whole.rejected, mode.frequency_hz);
    out += fmt::format(" {:.3f} Hz ({}; in the whole record: {})", mode.frequency_hz, mode.reason,
                       other != nullptr                            ? other->reason
                       : near_mode(whole.modes, mode.frequency_hz) ? "structural"
                                                                   : "no pole");
  }
  return out;
}

Comparison compare(const Flight& flight, const Outcome& whole, const Outcome& damaged, const std::string& floor) {
  const Match before = match_modes(whole.estimate, flight.truth(), whole.channels);
  const Match after = match_modes(damaged.estimate, flight.truth(), damaged.channels);
  Comparison out;
  out.n_false = after.n_false;
  out.false_modes = false_modes(whole.estimate, damaged.estimate, after);
  for (std::size_t r = 0; r < before.modes.size(); ++r) {
    out.n_false += after.modes[r].as == Found::As::kWrongFold ? 1 : 0;
    if (before.modes[r].as != Found::As::kRight) continue;
    ++out.n_whole;
    if (after.modes[r].as != Found::As::kRight) {
      out.missing += fmt::format(" {:.2f} Hz", before.modes[r].mode.frequency_hz);
      continue;
    }
    ++out.n_kept;
    const core::Mode &a = before.modes[r].mode, &b = after.modes[r].mode;
    const double mac = mac_of_rest(a, b, whole.channels, floor);
    if (mac < out.worst_mac) {
      core::Mode truth;
      truth.shape = true_shape(flight.truth()[r], whole.channels);
      out.worst_mac = mac, out.worst_mode_hz = b.frequency_hz;
      out.whole_mac = mac_of_rest(a, truth, whole.channels, floor);
      out.damaged_mac = mac_of_rest(b, truth, whole.channels, floor);
    }
    out.worst_hz = std::max(out.worst_hz, std::abs(b.frequency_hz / a.frequency_hz - 1.0));
  }
  for (std::size_t c = 0; c < damaged.estimate.channels.size(); ++c) {
    const core::ChannelRecord& record = damaged.estimate.channels[c];
    if (damaged.channels[c].name != floor) continue;
    out.n_named += record.takes_part ? 0 : 1;
    out.n_masked += static_cast<int>(record.n_outlying);
  }
  return out;
}

// Of each record in which a mode is lost, false or has another shape, so that a reader can look at it.
void print_doubtful(const std::string& what, std::uint64_t seed, std::size_t floor, const Comparison& one) {
  constexpr double kGoodMac = 0.99;
  if (one.n_kept == one.n_whole && one.n_false == 0 && one.worst_mac >= kGoodMac) return;
  fmt::print(
      "# {}, seed {}, floor {}: kept {} of {}{}{}, false {}{}; MAC {:.5f} at {:.3f} Hz, with the true shape: whole "
      "{:.5f}, damaged {:.5f}\n",
      what, seed, floor + 1, one.n_kept, one.n_whole, one.missing.empty() ? "" : ", lost", one.missing, one.n_false,
      one.false_modes, one.worst_mac, one.worst_mode_hz, one.whole_mac, one.damaged_mac);
}

void print_line(const std::string& what, int first_seed, const std::vector<std::vector<Comparison>>& by_seed,
                std::size_t i_case) {
  Comparison sum;
  int n = 0;
  for (std::size_t i_seed = 0; i_seed < by_seed.size(); ++i_seed) {
    for (std::size_t floor = 0; floor < kFloors; ++floor) {
      const Comparison& one = by_seed[i_seed][i_case * kFloors + floor];
      print_doubtful(what, static_cast<std::uint64_t>(first_seed) + i_seed, floor, one);
      ++n;
      sum.n_whole += one.n_whole, sum.n_kept += one.n_kept, sum.n_false += one.n_false;
      sum.n_named += one.n_named, sum.n_masked += one.n_masked > 0 ? 1 : 0;
      sum.worst_mac = std::min(sum.worst_mac, one.worst_mac), sum.worst_hz = std::max(sum.worst_hz, one.worst_hz);
    }
  }
  fmt::print("{}\t{}\t{}\t{}\t{}\t{:.5f}\t{:.3f}\t{}\t{}\n", what, n, sum.n_whole, sum.n_kept, sum.n_false,
             sum.worst_mac, 100.0 * sum.worst_hz, sum.n_named, sum.n_masked);
}

constexpr const char* kColumns =
    "records, modes of the whole records, of them kept, false structural modes; least MAC of the other\n"
    "#   channels with the whole record's shape; worst difference of frequency %; records whose channel is named and "
    "takes no part,\n"
    "#   records with a masked outlier in the channel\n";

template <class MakeDamage>
std::vector<std::vector<Comparison>> all_floors(const FootageOptions& options, std::size_t n_cases, MakeDamage make) {
  return for_each_seed(options, [&](std::uint64_t seed) {
    const Flight flight(seed);
    const Outcome whole = flight.analyse({});
    std::vector<Comparison> out;
    for (std::size_t i = 0; i < n_cases; ++i) {
      for (int floor = 1; floor <= kFloors; ++floor)
        out.push_back(compare(flight, whole, flight.analyse(make(flight, seed, i, floor)), floor_name(floor)));
    }
    return out;
  });
}

}  // namespace

void print_covered(const FootageOptions& options) {
  fmt::print("# covered: from, {}", kColumns);
  const std::vector<std::pair<std::string, double>> starts{{"frame 10", -1.0}, {"20 %", 0.2}, {"60 %", 0.6}};
  const auto results =
      all_floors(options, starts.size(), [&](const Flight& flight, std::uint64_t, std::size_t i, int floor) {
        const double share = starts[i].second;
        const std::size_t first =
            share < 0.0 ? 10 : static_cast<std::size_t>(share * static_cast<double>(flight.n_frames()));
        const std::uint16_t region = flight.region(floor_name(floor));
        return Damage([=](std::size_t i_frame, core::TrackFrame& tracks) {
          for (core::TrackPoint& point : tracks.points)
            point.seen = point.seen && !(point.region == region && i_frame >= first);
        });
      });
  for (std::size_t i = 0; i < starts.size(); ++i)
    print_line("covered\t" + starts[i].first, options.first_seed, results, i);
}

void print_glitches(const FootageOptions& options) {
  fmt::print("# glitch: px, {}", kColumns);
  constexpr std::array kSizes{5.0, 20.0, 100.0};
  const auto results =
      all_floors(options, kSizes.size(), [&](const Flight& flight, std::uint64_t seed, std::size_t i, int floor) {
        core::simulation::RandomStream stream(seed, fmt::format("glitch_{}_{}", i, floor).c_str());
        // Not among the first frames, over which the gate learns how the region moves.
        constexpr double kFirst = 30.0;
        const auto at =
            static_cast<std::size_t>(kFirst + (static_cast<double>(flight.n_frames()) - kFirst) * stream.uniform());
        const std::uint16_t region = flight.region(floor_name(floor));
        return Damage([=](std::size_t i_frame, core::TrackFrame& tracks) {
          if (i_frame != at) return;
          for (core::TrackPoint& point : tracks.points) point.u_px += point.region == region ? kSizes[i] : 0.0;
        });
      });
  for (std::size_t i = 0; i < kSizes.size(); ++i)
    print_line(fmt::format("glitch\t{:.0f}", kSizes[i]), options.first_seed, results, i);
}

}  // namespace tools
