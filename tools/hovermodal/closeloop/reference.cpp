#include "tools/hovermodal/closeloop/reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/planning/hover_time.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

using core::structure::DeclaredFrame;
using core::structure::ReferenceMode;
using Modes = std::vector<ReferenceMode>;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw drivers::FileError(path + ": " + what);
}

// Scales the largest component to 1, and the sigmas accordingly.
void normalise(ReferenceMode& mode) {
  double largest = 0.0;
  for (const double component : mode.shape) {
    if (std::abs(component) > std::abs(largest)) largest = component;
  }
  if (largest == 0.0) {
    mode.shape.clear();
    mode.shape_sigma.clear();
    return;
  }
  for (double& component : mode.shape) component /= largest;
  for (double& sigma : mode.shape_sigma) sigma /= std::abs(largest);
}

std::vector<std::size_t> floor_channels(const std::string& path, const DeclaredFrame& declared,
                                        const std::vector<std::string>& names) {
  std::vector<std::size_t> out;
  for (const std::string& floor : declared.floors) {
    const auto found = std::find(names.begin(), names.end(), floor);
    if (found == names.end()) {
      refuse(path, fmt::format("no channel `{}` (structure.floors); there are: {}", drivers::printable(floor),
                               drivers::printable(fmt::format("{}", fmt::join(names, ", ")), 200)));
    }
    out.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  return out;
}

// The stated one. Where the record was too short to estimate it: the declared share; undeclared, at least what the
// duration allows.
double sigma_hz_of(const core::Mode& mode, double duration_s, const DeclaredFrame& declared) {
  if (mode.frequency_std_hz.value_or(0.0) > 0.0) return *mode.frequency_std_hz;
  const bool is_declared = declared.frequency_sigma != DeclaredFrame{}.frequency_sigma;
  double share = declared.frequency_sigma;
  if (!is_declared && duration_s > 0.0 && mode.damping_ratio > 0.0) {
    share =
        std::max(share, core::planning::relative_frequency_sigma(mode.frequency_hz, mode.damping_ratio, duration_s));
  }
  return share * mode.frequency_hz;
}

Modes from_modal_json(const std::string& path, const DeclaredFrame& declared) {
  const app::ModalReport report = app::read_modal_json(path);
  const std::vector<std::size_t> channels = floor_channels(path, declared, report.channel_names);
  Modes out;
  for (const core::Mode& mode : report.estimate.modes) {
    ReferenceMode reference;
    reference.number = static_cast<int>(out.size()) + 1;
    reference.frequency_hz = mode.frequency_hz;
    reference.sigma_hz = sigma_hz_of(mode, report.estimate.duration_s, declared);
    reference.damping_ratio = mode.damping_ratio, reference.damping_sigma = mode.damping_std.value_or(0.0);
    for (const std::size_t c : channels) {
      if (c >= mode.shape.size()) break;
      reference.shape.push_back(mode.shape[c].real());
      // At least a tenth of the declared sigma: the component that scales the shape has none of its own.
      const double stated = c < mode.shape_std.size() ? mode.shape_std[c] : declared.shape_sigma;
      reference.shape_sigma.push_back(std::max(stated, 0.1 * declared.shape_sigma));
    }
    normalise(reference);
    out.push_back(std::move(reference));
  }
  return out;
}

class Table {
 public:
  explicit Table(const std::string& path) : path_(path), file_(drivers::read_foreign_series(path)) {}

  [[nodiscard]] Modes modes(const DeclaredFrame& declared) const {
    const auto [frequencies, per_hz] = frequency_column();
    const int numbers = file_.column("mode"), sigmas = file_.column("sigma_hz");
    const std::vector<std::size_t> floors = file_.has_names && has_any_floor(declared)
                                                ? floor_channels(path_, declared, file_.names)
                                                : std::vector<std::size_t>{};
    Modes out;
    for (std::size_t row = 0; row < file_.columns.front().size(); ++row) {
      ReferenceMode mode;
      mode.frequency_hz = at(frequencies, row) / per_hz;
      mode.number = numbers < 0 ? static_cast<int>(row) + 1 : whole(at(numbers, row), row);
      const double sigma_hz = sigmas < 0 ? std::nan("") : file_.columns[static_cast<std::size_t>(sigmas)][row];
      mode.sigma_hz = std::isnan(sigma_hz) ? declared.frequency_sigma * mode.frequency_hz : sigma_hz;
      if (const auto damping = optional_at("damping_ratio", row)) mode.damping_ratio = *damping;
      mode.damping_sigma = optional_at("damping_sigma", row).value_or(0.0);
      for (const std::size_t c : floors) {
        mode.shape.push_back(at(static_cast<int>(c), row));
        mode.shape_sigma.push_back(declared.shape_sigma);
      }
      normalise(mode);
      for (std::size_t i = 0; i < mode.shape.size(); ++i) mode.shape_sigma[i] = declared.shape_sigma;
      out.push_back(std::move(mode));
    }
    return out;
  }

 private:
  [[nodiscard]] std::pair<int, double> frequency_column() const {
    if (const int c = file_.column("frequency_hz"); c >= 0) return {c, 1.0};
    if (const int c = file_.column("frequency_rad_s"); c >= 0) return {c, 2.0 * std::numbers::pi};
    if (!file_.has_names && file_.columns.size() == 1) return {0, 1.0};
    refuse(path_, fmt::format("no column frequency_hz or frequency_rad_s; the columns are: {}",
                              drivers::printable(fmt::format("{}", fmt::join(file_.names, ", ")), 200)));
  }
  [[nodiscard]] bool has_any_floor(const DeclaredFrame& declared) const {
    return std::any_of(declared.floors.begin(), declared.floors.end(),
                       [&](const std::string& floor) { return file_.column(floor) >= 0; });
  }
  [[nodiscard]] std::optional<double> optional_at(const char* name, std::size_t row) const {
    const int column = file_.column(name);
    if (column < 0 || std::isnan(file_.columns[static_cast<std::size_t>(column)][row])) return std::nullopt;
    return at(column, row);
  }
  [[nodiscard]] double at(int column, std::size_t row) const {
    const auto c = static_cast<std::size_t>(column);
    const double value = file_.columns[c][row];
    if (!std::isfinite(value)) {
      refuse(path_, fmt::format("mode {} has no number in column {}; fill it in, or leave the line out", row + 1,
                                drivers::printable(file_.names[c])));
    }
    return value;
  }
  [[nodiscard]] int whole(double value, std::size_t row) const {
    if (!(value >= 1.0 && value <= 1e6) || value != std::floor(value))
      refuse(path_, fmt::format("line {} of the modes: mode {:g} is no number from 1 on", row + 1, value));
    return static_cast<int>(value);
  }

  const std::string& path_;
  drivers::SeriesFile file_;
};

}  // namespace

Modes read_reference(const std::string& path, const DeclaredFrame& declared) {
  return path.ends_with(".json") ? from_modal_json(path, declared) : Table(path).modes(declared);
}

}  // namespace tools
