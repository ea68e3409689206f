#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "firmware_app/report/page/page_parts.h"
#include "firmware_app/report/plot/mode_plot.h"

namespace app {
namespace {

constexpr double kCardPx = 316.0;                 // a phone's width: one drawing serves every page
constexpr double kSwingPx = 17.0;                 // displacement of the largest component in the picture
constexpr double kAirShare = 0.08;                // margin at both ends, as a share of the structure's length
constexpr std::size_t kMaxPictureCharacters = 9;  // room between picture and plot
constexpr std::size_t kMaxPatches = 40;           // moving parts of the frame; further regions are outlines only

// Motion of one region in the picture, in pixels of the page: real and imaginary part, and the real part's sigma.
struct Motion {
  Box at_rest;
  double re_x = 0.0, re_y = 0.0, im_x = 0.0, im_y = 0.0, std_x = 0.0, std_y = 0.0;
  std::string via;  // "channel x y ...": page pixels per unit of each channel's component
};

// The part of the image shown on a card, and its position there.
struct Crop {
  Box panel;                                   // on the card
  double u_px = 0.0, v_px = 0.0, scale = 1.0;  // image position at the panel's corner; page px per image px

  [[nodiscard]] Box placed(const core::Region& region) const {
    return {(region.u_px - u_px) * scale, (region.v_px - v_px) * scale, region.width_px * scale,
            region.height_px * scale};
  }
};

Box structure_box(const PictureInputs& inputs) {
  Box out;
  bool first = true;
  for (const core::ChannelInfo& channel : inputs.channels) {
    const core::Region& r = inputs.regions[channel.region];
    const double left = first ? r.u_px : std::min(out.x, r.u_px), top = first ? r.v_px : std::min(out.y, r.v_px);
    const double right = first ? r.u_px + r.width_px : std::max(out.right(), r.u_px + r.width_px);
    const double bottom = first ? r.v_px + r.height_px : std::max(out.bottom(), r.v_px + r.height_px);
    out = {left, top, right - left, bottom - top};
    first = false;
  }
  return out;
}

Crop crop_of(const PictureInputs& inputs, const ModeLayout& layout) {
  Crop crop;
  crop.panel = layout.upright ? Box{0.0, 0.0, 128.0, 300.0} : Box{40.0, 0.0, 266.0, 130.0};
  const Box all = structure_box(inputs);
  const double room = 2.0 * kSwingPx;  // room for the motion
  const double across_x = layout.upright ? room : 8.0, across_y = layout.upright ? 8.0 : room;
  const double wide = std::max(1.0, all.width * (1.0 + 2.0 * kAirShare)),
               high = std::max(1.0, all.height * (1.0 + 2.0 * kAirShare));
  crop.scale = std::min((crop.panel.width - across_x) / wide, (crop.panel.height - across_y) / high);
  crop.u_px = all.x + all.width / 2.0 - crop.panel.width / 2.0 / crop.scale;
  crop.v_px = all.y + all.height / 2.0 - crop.panel.height / 2.0 / crop.scale;
  return crop;
}

// The extreme of the motion that the plot shows: positive to the right, or upwards.
double shown_extreme(const PictureInputs& inputs, bool upright) {
  const core::ChannelInfo& first = inputs.channels.front();
  return (upright ? first.direction_u : -first.direction_v) < 0.0 ? -1.0 : 1.0;
}

std::vector<Motion> motions_of(const PictureInputs& inputs, const core::Mode& mode, const Crop& crop, bool upright) {
  const double swing_px = kSwingPx * shown_extreme(inputs, upright);
  std::map<std::size_t, Motion> by_region;
  for (std::size_t c = 0; c < inputs.channels.size() && c < mode.shape.size(); ++c) {
    const core::ChannelInfo& channel = inputs.channels[c];
    const std::complex<double> value = mode.shape[c];
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) continue;
    Motion& motion = by_region[channel.region];
    motion.at_rest = crop.placed(inputs.regions[channel.region]);
    const double x = swing_px * channel.direction_u, y = swing_px * channel.direction_v;
    motion.re_x += value.real() * x, motion.re_y += value.real() * y;
    motion.im_x += value.imag() * x, motion.im_y += value.imag() * y;
    motion.via += fmt::format("{}{} {:.2f} {:.2f}", motion.via.empty() ? "" : " ", c, x, y);
    if (c >= mode.shape_std.size() || !std::isfinite(mode.shape_std[c])) continue;
    const double deviation = std::min(mode.shape_std[c], 2.0);
    motion.std_x += deviation * x, motion.std_y += deviation * y;
  }
  std::vector<Motion> out;
  for (const auto& [region, motion] : by_region) out.push_back(motion);
  return out;
}

// The structure on its picture, drawn at one extreme of the motion; the page's script moves the elements with
// data-move.
class ModeOnFrame {
 public:
  // is_live: the script can compute the motion for another shape of the same channels.
  ModeOnFrame(SvgDocument& svg, const PictureInputs& inputs, const core::Mode& mode, const Crop& crop, bool upright,
              bool is_live)
      : svg_(svg),
        has_frame_(has_frame(inputs)),
        is_live_(is_live),
        crop_(crop),
        motions_(motions_of(inputs, mode, crop, upright)) {
    const auto along = [&](const Motion& m) {
      return upright ? m.at_rest.y + m.at_rest.height / 2.0 : m.at_rest.x + m.at_rest.width / 2.0;
    };
    std::stable_sort(motions_.begin(), motions_.end(),
                     [&](const Motion& a, const Motion& b) { return along(a) < along(b); });
  }

  void draw() {
    svg_.begin_clip(crop_.panel);
    const Box whole{0.0, 0.0, crop_.panel.width, crop_.panel.height};
    svg_.rect(whole, "blank");
    if (has_frame_) use_frame(0.0, 0.0);
    if (has_frame_) svg_.rect(whole, "dim");
    for (const Motion& motion : motions_) svg_.rect(motion.at_rest, "rest");
    draw_line("sway halo");
    for (const Motion& motion : motions_) draw_region(motion);
    draw_line("sway");
    svg_.end_clip();
  }

 private:
  void use_frame(double x, double y) {
    svg_.use(kFrameId, -crop_.u_px * crop_.scale - x, -crop_.v_px * crop_.scale - y, crop_.scale);
  }

  void draw_region(const Motion& m) {
    svg_.begin_group(
        fmt::format("class=\"move\"{} data-move=\"{:.2f} {:.2f} {:.2f} {:.2f}\" transform=\"translate({:.2f} {:.2f})\"",
                    is_live_ ? fmt::format(" data-via=\"{}\"", m.via) : std::string(), m.re_x, m.re_y, m.im_x, m.im_y,
                    m.re_x, m.re_y));
    if (has_frame_ && motions_.size() <= kMaxPatches) {
      svg_.begin_clip(m.at_rest);
      use_frame(m.at_rest.x, m.at_rest.y);
      svg_.end_clip();
    }
    svg_.rect(m.at_rest, "halo");
    svg_.rect(m.at_rest, "r0");
    if (m.std_x != 0.0 || m.std_y != 0.0) {
      const double x = m.at_rest.x + m.at_rest.width / 2.0, y = m.at_rest.y + m.at_rest.height / 2.0;
      svg_.line(x - m.std_x, y - m.std_y, x + m.std_x, y + m.std_y, "whisker");
    }
    svg_.end_group();
  }

  // A line through the centres of the regions.
  void draw_line(const char* css_class) {
    std::vector<PlotPoint> line;
    std::string facts;
    for (const Motion& m : motions_) {
      const double x = m.at_rest.x + m.at_rest.width / 2.0, y = m.at_rest.y + m.at_rest.height / 2.0;
      line.push_back({x + m.re_x, y + m.re_y});
      facts += fmt::format("{}{:.1f} {:.1f} {:.2f} {:.2f} {:.2f} {:.2f}", facts.empty() ? "" : " ", x, y, m.re_x,
                           m.re_y, m.im_x, m.im_y);
    }
    svg_.path(line, css_class, fmt::format("data-line=\"{}\"", facts));
  }

  SvgDocument& svg_;
  bool has_frame_, is_live_;
  const Crop& crop_;
  std::vector<Motion> motions_;
};

std::string card_without_image(const core::Mode& mode, const ModeLayout& layout) {
  double names = 46.0;
  for (const ModePlace& place : layout.every_place())
    names = std::max(names, text_width_px(place.name, kSmallTextPx) + 14.0);
  const auto n = static_cast<double>(layout.every_place().size());
  const double height = layout.upright ? std::clamp(26.0 * n, 110.0, 320.0) : 150.0;
  const double left = layout.upright ? names : 46.0;
  SvgDocument svg(kCardPx, height + 26.0, "Mode shape", true);
  draw_mode_plot(svg, {{left, 4.0, kCardPx - left - 12.0, height}, layout.low_px, layout.high_px, true}, layout, mode);
  return svg.text_of();
}

}  // namespace

bool has_shape(const PictureInputs& inputs, const core::Mode& mode) {
  return !inputs.channels.empty() && !mode.shape.empty();
}

std::string moving_svg(const PictureInputs& inputs, const core::Mode& shape) {
  if (!has_shape(inputs, shape)) return {};
  const ModeLayout layout = mode_layout(inputs);
  if (!layout.in_image) return {};
  const Crop crop = crop_of(inputs, layout);
  SvgDocument svg(crop.panel.width, crop.panel.height, "The regions displaced by the operating deflection shape", true);
  Crop placed = crop;
  placed.panel.x = 0.0;
  ModeOnFrame(svg, inputs, shape, placed, layout.upright, true).draw();
  return svg.text_of();
}

std::string mode_svg(const PictureInputs& inputs, const core::Mode& mode) {
  if (!has_shape(inputs, mode)) return {};
  ModeLayout layout = mode_layout(inputs);
  if (!layout.in_image) return card_without_image(mode, layout);
  for (auto& line : layout.lines) {
    for (ModePlace& place : line) place.name = shortened_inside(place.name, kMaxPictureCharacters);
  }
  const Crop crop = crop_of(inputs, layout);
  const double height = layout.upright ? crop.panel.height : crop.panel.height + 14.0 + 120.0;
  SvgDocument svg(kCardPx, height + 22.0, "Mode shape: the regions displaced, and their components", true);
  ModeOnFrame(svg, inputs, mode, crop, layout.upright, false).draw();
  // The plot lies beside the picture, at the same height.
  const Box& panel = crop.panel;
  ModePlotSpec spec;
  if (layout.upright) {
    spec.box = {194.0, panel.y, kCardPx - 194.0 - 8.0, panel.height};
    spec.low_px = crop.v_px, spec.high_px = crop.v_px + panel.height / crop.scale;
  } else {
    spec.box = {panel.x, panel.bottom() + 14.0, panel.width, 120.0};
    spec.low_px = crop.u_px, spec.high_px = crop.u_px + panel.width / crop.scale;
  }
  draw_mode_plot(svg, spec, layout, mode);
  return svg.text_of();
}

}  // namespace app
