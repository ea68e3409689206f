#pragma once

#include <string>
#include <string_view>

#include "firmware_app/report/page/html_text.h"
#include "firmware_app/report/pictures/parts.h"

namespace app {

// The sections of report.html, in their order. A section without content states why.
[[nodiscard]] std::string headline_html(const PictureInputs& inputs);

[[nodiscard]] std::string modes_section(const PictureInputs& inputs);
[[nodiscard]] std::string mac_section(const PictureInputs& inputs);
[[nodiscard]] std::string shapes_section(const PictureInputs& inputs);
[[nodiscard]] std::string spectra_section(const PictureInputs& inputs);
// Both need `inputs.lines`.
[[nodiscard]] std::string singular_section(const PictureInputs& inputs);
[[nodiscard]] std::string operating_section(const PictureInputs& inputs);
[[nodiscard]] std::string comparison_section(const PictureInputs& inputs);
[[nodiscard]] std::string fold_section(const PictureInputs& inputs);
[[nodiscard]] std::string stabilisation_section(const PictureInputs& inputs);
[[nodiscard]] std::string convergence_section(const PictureInputs& inputs);
[[nodiscard]] std::string displacements_section(const PictureInputs& inputs);
[[nodiscard]] std::string scale_section(const PictureInputs& inputs);
[[nodiscard]] std::string quality_section(const PictureInputs& inputs);
[[nodiscard]] std::string frame_section(const PictureInputs& inputs);
[[nodiscard]] std::string closure_section(const PictureInputs& inputs);
[[nodiscard]] std::string losses_section(const PictureInputs& inputs);
// The only part that differs between two runs with the same input.
[[nodiscard]] std::string timing_section(const PictureInputs& inputs);

// Words that several sections share.
[[nodiscard]] std::string plural(std::size_t n, const char* one, const char* many);  // "2 modes"
[[nodiscard]] std::string modes_sentence(const core::ModalEstimate& estimate);
[[nodiscard]] const core::ModalEstimate& estimate_of(const PictureInputs& inputs);  // an empty one where there is none

// Play and amplitude, for every moving picture of the page; contained in it once.
[[nodiscard]] std::string motion_controls();
// The regions on the frame, displaced by a shape, without a plot beside; the page's script can give them another one.
// Empty without regions.
[[nodiscard]] std::string moving_svg(const PictureInputs& inputs, const core::Mode& shape);
// A key of a legend; the page's script uses it to hide and show its curve.
[[nodiscard]] std::string key_html(std::size_t i_curve, const std::string& label, const std::string& css_class);

// Embedded at build time from page.css and page.js.
[[nodiscard]] std::string_view page_css() noexcept;
[[nodiscard]] std::string_view page_js() noexcept;

// The first frame is contained in the page once, under this id; every picture of it refers to it.
inline constexpr const char* kFrameId = "frame";
struct ImageSize {
  int width_px = 0, height_px = 0;  // 0: unknown
};
[[nodiscard]] bool has_frame(const PictureInputs& inputs);
[[nodiscard]] ImageSize image_size(const PictureInputs& inputs);
[[nodiscard]] std::string frame_jpeg(const core::Frame& frame);  // bytes, at most 260 kB
[[nodiscard]] const char* role_class(core::RegionRole role);

// Whether any component of this mode is known, so that a picture of its shape is possible.
[[nodiscard]] bool has_shape(const PictureInputs& inputs, const core::Mode& mode);

}  // namespace app
