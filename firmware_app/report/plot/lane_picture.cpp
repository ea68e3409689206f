#include "firmware_app/report/plot/lane_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {
namespace {

constexpr double kBelowPx = 46.0;  // tick labels and the axis label
constexpr std::size_t kMaxLaneCharacters = 20;
constexpr double kHeadingPx = 18.0;  // on the page a lane's name is written above it

class LanePicture {
 public:
  LanePicture(const std::vector<Lane>& lanes, double duration_s, const LanesText& text, const PictureFormat& format)
      : lanes_(lanes), time_(time_axis(duration_s)), text_(text), format_(format) {
    const double n = static_cast<double>(lanes.size());
    if (format.on_page) {
      left_px_ = 50.0, right_px_ = 14.0, top_px_ = 2.0, gap_px_ = 8.0, heading_px_ = kHeadingPx;
      step_px_ = std::clamp(std::floor(900.0 / n), 62.0, text.range ? 84.0 : 112.0);
    } else {
      step_px_ = std::clamp(std::floor(720.0 / n), 16.0, 160.0);
      gap_px_ = tall() ? 10.0 : 2.0;  // room for tick labels at both edges
    }
    for (const Lane& lane : lanes) {
      if (lane.empty) continue;
      span_ = std::max(span_, lane.high - lane.low);
      largest_ = std::max({largest_, std::abs(lane.low), std::abs(lane.high)});
      if (!format.on_page) right_px_ = std::max(right_px_, text_width_px(name_of(lane), kTextPx) + 20.0);
    }
    span_ = std::max(1.08 * span_, std::max(1e-9, 1e-9 * largest_));
  }

  [[nodiscard]] std::string draw() {
    const double height = top_px_ + step_px_ * static_cast<double>(lanes_.size()) - gap_px_ + kBelowPx;
    SvgDocument svg(format_.width_px, height, text_.title, format_.on_page);
    if (!format_.on_page) {
      svg.text(left_px_, 24.0, text_.title, Anchor::kStart, "h");
      svg.text(format_.width_px - 14.0, 24.0,
               fmt::format("every lane spans {} {}", four_digits_text(span_), text_.unit), Anchor::kEnd, "t q");
      if (tall()) svg.text_upwards(20.0, top_px_ + (height - top_px_ - kBelowPx) / 2.0, text_.quantity);
    }
    for (std::size_t i = 0; i < lanes_.size(); ++i) draw_lane(svg, i);
    return svg.text_of();
  }

 private:
  [[nodiscard]] bool tall() const noexcept { return step_px_ >= 40.0; }
  [[nodiscard]] static std::string name_of(const Lane& lane) { return shortened(lane.name, kMaxLaneCharacters); }

  [[nodiscard]] PlotAxis axis_of(const Lane& lane) const {
    if (text_.range) return *text_.range;
    const double middle = lane.empty ? 0.0 : lane.low + (lane.high - lane.low) / 2.0;
    return {middle - span_ / 2.0, middle + span_ / 2.0, false, {}};
  }

  void draw_lane(SvgDocument& svg, std::size_t i) const {
    const Lane& lane = lanes_[i];
    const Box box{left_px_, top_px_ + step_px_ * static_cast<double>(i) + heading_px_,
                  format_.width_px - left_px_ - right_px_, step_px_ - gap_px_ - heading_px_};
    PlotPanel panel(svg, box, time_, axis_of(lane));
    panel.draw_x_axis(i + 1 == lanes_.size(), is_narrow(format_) ? 5 : 10);
    if (tall() && !lane.empty) panel.draw_y_axis(false, box.height < 72.0 ? 2 : 4);
    panel.draw_frame();
    for (const auto& curve : lane.behind) panel.curve(curve, "behind");
    panel.curve(lane.points, line_class(0));
    const double y = box.y + box.height / 2.0;
    if (lane.empty) svg.text(box.x + box.width / 2.0, y + 4.0, "no sample", Anchor::kMiddle, "s q");
    format_.on_page ? draw_heading(svg, lane, box) : draw_name(svg, lane, box.right() + 8.0, y);
  }

  void draw_heading(SvgDocument& svg, const Lane& lane, const Box& box) const {
    const double room_px = box.width - text_width_px(lane.remark, kSmallTextPx) - 8.0;
    const auto most = static_cast<std::size_t>(std::max(4.0, room_px / (0.62 * kTextPx)));
    svg.text(box.x, box.y - 5.0, shortened(lane.name, std::min(most, 3 * kMaxLaneCharacters)), Anchor::kStart, "t e");
    svg.text(box.right(), box.y - 5.0, lane.remark, Anchor::kEnd, "s q");
  }

  void draw_name(SvgDocument& svg, const Lane& lane, double x, double y) const {
    svg.text(x, tall() ? y : y + 4.0, name_of(lane));
    if (tall() && !lane.empty) svg.text(x, y + 15.0, lane.remark, Anchor::kStart, "s q");
  }

  const std::vector<Lane>& lanes_;
  PlotAxis time_;
  const LanesText& text_;
  PictureFormat format_;
  double left_px_ = 72.0, right_px_ = 110.0, top_px_ = 40.0, heading_px_ = 0.0;
  double step_px_ = 0.0, gap_px_ = 0.0, span_ = 0.0, largest_ = 0.0;
};

}  // namespace

PlotAxis time_axis(double duration_s) {
  return {0.0, std::isfinite(duration_s) && duration_s > 0.0 ? duration_s : 1.0, false,
          "time since the first sample, s"};
}

std::string lanes_svg(const std::vector<Lane>& lanes, double duration_s, const LanesText& text,
                      const PictureFormat& format) {
  return LanePicture(lanes, duration_s, text, format).draw();
}

}  // namespace app
