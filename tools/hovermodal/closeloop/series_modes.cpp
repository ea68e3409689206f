#include "tools/hovermodal/closeloop/series_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

using core::closure::ClosureMode;

constexpr double kNear = 0.05;  // relative difference of frequency below which two may be the same mode

struct Pairing {
  const KnownMode* mode = nullptr;
  std::optional<double> mac;
};

// Over the channels named by both; empty with fewer than two.
std::optional<double> mac(const KnownMode& known, const core::Mode& mode,
                          const std::vector<core::ChannelInfo>& channels) {
  std::complex<double> inner = 0.0;
  double a = 0.0, b = 0.0;
  std::size_t n = 0;
  for (std::size_t c = 0; c < channels.size() && c < mode.shape.size(); ++c) {
    const auto found = std::find(known.channels.begin(), known.channels.end(), channels[c].name);
    if (found == known.channels.end()) continue;
    const std::complex<double> x = known.shape[static_cast<std::size_t>(found - known.channels.begin())];
    inner += std::conj(x) * mode.shape[c];
    a += std::norm(x), b += std::norm(mode.shape[c]), ++n;
  }
  if (n < 2 || !(a * b > 0.0)) return std::nullopt;
  return std::norm(inner) / (a * b);
}

Pairing pair_of(const core::Mode& mode, const std::vector<core::ChannelInfo>& channels,
                const std::vector<KnownMode>& reference) {
  Pairing best;
  double least = kNear;
  for (const KnownMode& known : reference) {
    const double off = std::abs(mode.frequency_hz / known.frequency_hz - 1.0);
    if (off < least) least = off, best = {&known, mac(known, mode, channels)};
  }
  return best;
}

}  // namespace

std::vector<KnownMode> read_reference_modes(const std::string& path) {
  std::vector<KnownMode> out;
  if (path.empty()) return out;
  if (path.ends_with(".json")) {
    const app::ModalReport report = app::read_modal_json(path);
    for (const core::Mode& mode : report.estimate.modes)
      out.push_back({mode.frequency_hz, report.channel_names, mode.shape});
    return out;
  }
  const drivers::SeriesFile file = drivers::read_foreign_series(path);
  const int column = file.column("frequency_hz");
  if (column < 0) throw drivers::FileError(path + ": no column frequency_hz");
  for (const double hz : file.columns[static_cast<std::size_t>(column)]) {
    if (!(std::isfinite(hz) && hz > 0.0)) throw drivers::FileError(path + ": a frequency is no positive number");
    out.push_back({hz, {}, {}});
  }
  return out;
}

std::vector<core::Mode> read_known_modes(const std::string& path, const std::vector<std::string>& channels) {
  std::vector<core::Mode> out;
  if (path.empty()) return out;
  if (!path.ends_with(".json")) {
    const drivers::SeriesFile file = drivers::read_foreign_series(path);
    const int column = file.column("frequency_hz");
    if (column < 0) throw drivers::FileError(path + ": no column frequency_hz");
    for (const double hz : file.columns[static_cast<std::size_t>(column)]) {
      if (!(std::isfinite(hz) && hz > 0.0)) throw drivers::FileError(path + ": frequency_hz must be positive numbers");
      out.emplace_back().frequency_hz = hz;
    }
    return out;
  }
  const app::ModalReport report = app::read_modal_json(path);
  for (core::Mode mode : report.estimate.modes) {
    std::vector<std::complex<double>> shape;
    for (const std::string& name : channels) {
      const auto found = std::find(report.channel_names.begin(), report.channel_names.end(), name);
      const auto i = static_cast<std::size_t>(found - report.channel_names.begin());
      if (i < mode.shape.size()) shape.push_back(mode.shape[i]);
    }
    mode.shape = shape.size() == channels.size() ? std::move(shape) : std::vector<std::complex<double>>{};
    out.push_back(std::move(mode));
  }
  return out;
}

std::vector<ClosureMode> modes_of_series(const app::ChannelSeries& series, double max_frequency_hz,
                                         const std::vector<KnownMode>& reference) {
  app::SeriesOptions options;
  options.identifier.max_frequency_hz = max_frequency_hz;
  std::vector<ClosureMode> out;
  app::SeriesResult found;
  try {
    found = app::identify_series(series, options);
  } catch (const std::invalid_argument&) {
    return out;  // too short to identify: no modes are stated
  }
  for (const core::Mode& mode : found.estimate.modes) {
    ClosureMode closed;
    closed.number = static_cast<int>(out.size()) + 1;
    closed.frequency_hz = mode.frequency_hz;
    closed.damping_ratio = mode.damping_ratio;
    if (const Pairing pair = pair_of(mode, found.channels, reference); pair.mode != nullptr) {
      closed.reference_hz = pair.mode->frequency_hz;
      closed.error_percent = 100.0 * (mode.frequency_hz / pair.mode->frequency_hz - 1.0);
      closed.mac = pair.mac;
    }
    out.push_back(closed);
  }
  return out;
}

std::string identified_text(const core::closure::ClosureResult& result) {
  std::string out;
  for (const bool after : {false, true}) {
    for (const ClosureMode& mode : after ? result.modes_after : result.modes_before) {
      out += fmt::format("mode {} {:.4f} Hz", after ? "after " : "before", mode.frequency_hz);
      if (mode.damping_ratio) out += fmt::format(", damping {:.2f} %", 100.0 * *mode.damping_ratio);
      if (mode.error_percent) out += fmt::format(", {:+.2f} % off its reference", *mode.error_percent);
      if (mode.mac) out += fmt::format(", MAC {:.4f}", *mode.mac);
      out += "\n";
    }
  }
  return out;
}

double rms_error_percent(const std::vector<ClosureMode>& modes) {
  double squares = 0.0, n = 0.0;
  for (const ClosureMode& mode : modes) {
    if (mode.error_percent) squares += *mode.error_percent * *mode.error_percent, n += 1.0;
  }
  return n > 0.0 ? std::sqrt(squares / n) : std::nan("");
}

}  // namespace tools
