// Modes of a record that losses of frames hide.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/identification/mac.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/identification_record.h"
#include "tools/validate/identification_scene.h"
#include "tools/validate/trust.h"

namespace tools {
namespace {

constexpr double kSameMode = 0.02, kSameShape = 0.9;  // relative frequency, MAC
constexpr int kLongestBurst = 10;                     // frames

struct Loss {
  double share;
  bool is_burst;
};
constexpr std::array kLosses{Loss{0.1, false}, Loss{0.2, false}, Loss{0.3, false},
                             Loss{0.1, true},  Loss{0.2, true},  Loss{0.3, true}};

// Frames lost one by one, or in bursts of one to ten, until the share is reached.
void lose_frames(const Loss& loss, std::uint64_t seed, Record& record) {
  Draw draw(seed, loss.is_burst ? "lost_bursts" : "lost_frames");
  const std::size_t n = record.n_samples(), n_channels = record.channels.size();
  const auto wanted = static_cast<std::size_t>(std::lround(loss.share * static_cast<double>(n)));
  for (std::size_t lost = 0; lost < wanted;) {
    const auto first = static_cast<std::size_t>(draw.whole(0, static_cast<int>(n) - 1));
    const auto length = static_cast<std::size_t>(loss.is_burst ? draw.whole(1, kLongestBurst) : 1);
    for (std::size_t k = first; k < std::min(n, first + length) && lost < wanted; ++k) {
      if (record.seen[k * n_channels] == 0) continue;
      for (std::size_t c = 0; c < n_channels; ++c)
        record.seen[k * n_channels + c] = 0, record.value_mm[k * n_channels + c] = std::nan("");
      ++lost;
    }
  }
}

bool is_kept(const core::Mode& mode, const core::ModalEstimate& estimate) {
  return std::any_of(estimate.modes.begin(), estimate.modes.end(), [&](const core::Mode& one) {
    return std::abs(one.frequency_hz / mode.frequency_hz - 1.0) < kSameMode &&
           core::mac(one.shape, mode.shape) > kSameShape;
  });
}

struct LossRecord {
  std::size_t n_modes = 0;
  std::array<std::size_t, kLosses.size()> kept{}, beside{};  // modes of the full record, and further ones
};

LossRecord loss_record(double duration_s, std::uint64_t seed) {
  const StoreysSetup setup = drawn_storeys({.duration_s = duration_s, .rate_hz = 30.0}, seed);
  const Record whole = structure_record(storeys_scene(setup, seed), true);
  const double limit_hz = fold_limit_hz(setup.rate_hz);
  const core::ModalEstimate full = identify_record(whole, limit_hz);
  LossRecord out;
  out.n_modes = full.modes.size();
  for (std::size_t i = 0; i < kLosses.size(); ++i) {
    Record record = whole;
    lose_frames(kLosses[i], seed, record);
    const core::ModalEstimate estimate = identify_record(record, limit_hz);
    for (const core::Mode& mode : full.modes) out.kept[i] += is_kept(mode, estimate) ? 1U : 0U;
    for (const core::Mode& mode : estimate.modes) out.beside[i] += is_kept(mode, full) ? 0U : 1U;
  }
  return out;
}

}  // namespace

void print_trust_losses(const GeometryOptions& options) {
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : 120.0;
  fmt::print("# trust-losses: share of the frames, single or burst, modes of the full records, of them kept, others\n");
  const auto records = for_each_seed(options, [&](std::uint64_t seed) { return loss_record(duration_s, seed); });
  for (std::size_t i = 0; i < kLosses.size(); ++i) {
    std::size_t n = 0, kept = 0, beside = 0;
    for (const LossRecord& record : records) n += record.n_modes, kept += record.kept[i], beside += record.beside[i];
    fmt::print("trust-losses\t{:.1f}\t{}\t{}\t{}\t{}\n", kLosses[i].share, kLosses[i].is_burst ? "burst" : "single", n,
               kept, beside);
  }
}

}  // namespace tools
