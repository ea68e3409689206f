#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/plot/svg_plot.h"

namespace app {

// Where a picture is shown. On the page, headings, legends and remarks are in the surrounding HTML, and every picture
// is drawn twice, wide and narrow: one drawing scaled to a phone would have unreadable text.
struct PictureFormat {
  double width_px = 1000.0;
  bool on_page = false;
};
inline constexpr PictureFormat kFileFormat{1000.0, false};
inline constexpr PictureFormat kWideFormat{760.0, true};
inline constexpr PictureFormat kNarrowFormat{328.0, true};  // a phone of 360 px, less the page's margins
[[nodiscard]] constexpr bool is_narrow(const PictureFormat& format) noexcept { return format.width_px < 500.0; }

// The text of each picture; empty where there is nothing to draw.
[[nodiscard]] std::string frame_png(const PictureInputs& inputs);
[[nodiscard]] std::string displacements_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string scale_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string scale_unit(const PictureInputs& inputs);
[[nodiscard]] std::string scale_range_text(
    const PictureInputs& inputs);  // with a history: "0.925 … 0.981 mm/px: 6.05 %"
[[nodiscard]] std::string points_seen_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string point_sigma_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string spectra_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::vector<LegendEntry> spectra_legend(const PictureInputs& inputs);  // one entry a channel
[[nodiscard]] std::string cross_label(const PictureInputs& inputs);  // label of the last curve; empty: none
[[nodiscard]] std::string spectra_remark(const PictureInputs& inputs);
// Both on the page only. The first needs `inputs.lines`.
[[nodiscard]] std::string singular_values_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string mac_svg(const PictureInputs& inputs, const PictureFormat& format);
inline constexpr std::size_t kMaxMacModes = 16;  // drawn; the table holds as many
// MAC of two found modes over the channels that both know.
[[nodiscard]] double mac_of(const core::Mode& a, const core::Mode& b);
[[nodiscard]] std::string fold_map_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string stabilisation_svg(const PictureInputs& inputs, const PictureFormat& format);
// Relative to the last estimate, over the record of each estimate; for runs of three estimates or more.
[[nodiscard]] std::string frequency_convergence_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string damping_convergence_svg(const PictureInputs& inputs, const PictureFormat& format);
[[nodiscard]] std::string modes_svg(const PictureInputs& inputs);
// On the page only: the first frame (an element of the page) under the regions and points.
[[nodiscard]] std::string frame_svg(const PictureInputs& inputs, const PictureFormat& format);
// One mode: the regions displaced on the frame, and the components with their sigma. One drawing for every width.
[[nodiscard]] std::string mode_svg(const PictureInputs& inputs, const core::Mode& mode);

// For all curves of one picture together: keeps the file below 500 kB.
inline constexpr std::size_t kMaxPicturePoints = 45'000;
inline constexpr std::size_t kMaxCurvePoints = 1'500;
[[nodiscard]] std::size_t curve_points(std::size_t n_curves, const PictureFormat& format) noexcept;

// Numbers formatted for readers; a dash stands for a value that is not finite.
[[nodiscard]] std::string decimals_text(double value, int n_decimals);
[[nodiscard]] std::string four_digits_text(double value);
// "1.657 ± 0.003 Hz"; for an aliased mode "12.93 Hz, seen at 12.07".
[[nodiscard]] std::string frequency_text(const core::Mode& mode, bool with_deviation);
[[nodiscard]] bool is_folded(const core::Mode& mode) noexcept;

}  // namespace app
