#include "tools/hovermodal/closeloop/reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/reference_modes.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

using core::structure::DeclaredFrame;
using core::structure::ReferenceMode;
using Modes = std::vector<ReferenceMode>;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw drivers::FileError(path + ": " + what);
}

// With the file's name before the words of the one that refuses.
template <class Make>
auto of_file(const std::string& path, const Make& make) {
  try {
    return make();
  } catch (const std::invalid_argument& e) {
    refuse(path, e.what());
  }
}

Modes from_modal_json(const std::string& path, const DeclaredFrame& declared) {
  const app::ModalReport report = app::read_modal_json(path);
  return of_file(path, [&] { return app::reference_modes(report.estimate, report.channel_names, declared); });
}

class Table {
 public:
  explicit Table(const std::string& path) : path_(path), file_(drivers::read_foreign_series(path)) {}

  [[nodiscard]] Modes modes(const DeclaredFrame& declared) const {
    const auto [frequencies, per_hz] = frequency_column();
    const int numbers = file_.column("mode"), sigmas = file_.column("sigma_hz");
    const std::vector<std::size_t> floors =
        file_.has_names && has_any_floor(declared)
            ? of_file(path_, [&] { return app::floor_channels(declared, file_.names); })
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
      app::normalise(mode);
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
