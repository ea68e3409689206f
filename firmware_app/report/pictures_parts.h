#pragma once

#include <optional>
#include <string>

#include "drivers/storage/csv.h"
#include "firmware_app/report/pictures.h"

namespace app {

// The text of each picture; empty where there is nothing to draw.
[[nodiscard]] std::string frame_png(const PictureInputs& inputs);
[[nodiscard]] std::string displacements_svg(const PictureInputs& inputs, const drivers::SeriesFile& series);
[[nodiscard]] std::string scale_svg(const PictureInputs& inputs, const drivers::SeriesFile& series);
[[nodiscard]] std::string spectra_svg(const PictureInputs& inputs);
[[nodiscard]] std::string modes_svg(const PictureInputs& inputs);

// Shared by them.
inline constexpr double kPictureWidthPx = 1000.0;
// Of all curves of one picture together: keeps the file below 500 kB.
inline constexpr std::size_t kMaxPicturePoints = 45'000;
inline constexpr std::size_t kMaxCurvePoints = 1'500;
[[nodiscard]] std::size_t curve_points(std::size_t n_curves) noexcept;

// Numbers for people; a dash for what is not finite.
[[nodiscard]] std::string decimals_text(double value, int n_decimals);
[[nodiscard]] std::string four_digits_text(double value);
// "1.657 ± 0.003 Hz"; for a folded mode "12.93 Hz, seen at 12.07".
[[nodiscard]] std::string frequency_text(const core::Mode& mode, bool with_deviation);
[[nodiscard]] bool is_folded(const core::Mode& mode) noexcept;

}  // namespace app
