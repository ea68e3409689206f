#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "firmware_app/report/plot/svg_document.h"

namespace app {

// Range of one axis. `low` < `high`, both finite; a logarithmic one is positive.
struct PlotAxis {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  std::string label;  // with the unit
};

// An axis around the finite values with a small margin; also valid for no value or a single one.
[[nodiscard]] PlotAxis axis_around(double low, double high, const std::string& label);
// Whole decades around the positive range, at most `max_decades`: the lowest ones are cut.
[[nodiscard]] PlotAxis log_axis_around(double low, double high, int max_decades, const std::string& label);

struct PlotTick {
  double value = 0.0;
  std::string label;  // of a linear axis
  int exponent = 0;   // of a logarithmic one: 10^exponent
};
// Round values in the range, steps of 1, 2 or 5 times a power of ten, about `n_wanted` of them; whole decades on a
// logarithmic axis.
[[nodiscard]] std::vector<PlotTick> ticks_of(const PlotAxis& axis, int n_wanted);

// One panel: a frame with two axes in a rectangle of the drawing.
class PlotPanel {
 public:
  PlotPanel(SvgDocument& svg, const Box& box, const PlotAxis& x, const PlotAxis& y);

  [[nodiscard]] double x_px(double x) const noexcept { return position(x_, x, box_.x, box_.right()); }
  [[nodiscard]] double y_px(double y) const noexcept { return position(y_, y, box_.bottom(), box_.y); }
  [[nodiscard]] const Box& box() const noexcept { return box_; }

  void draw_x_axis(bool with_labels, int n_ticks = 10);  // grid, tick labels, label below
  void draw_y_axis(bool with_label, int n_ticks = 5);    // grid, tick labels, label to the left
  void draw_frame();
  // In the axes' units; values beyond the y axis are drawn at its edge.
  void curve(std::span<const PlotPoint> points, const std::string& css_class, std::string_view attributes = {});
  void vertical(double x, const std::string& css_class, std::string_view attributes = {});  // over the whole height
  // Curves drawn between these calls can be read at the cursor by the page's script, which gets the axes from here.
  void begin_readout(std::string_view kind);
  void end_readout() { svg_->end_group(); }

 private:
  [[nodiscard]] static double position(const PlotAxis& axis, double value, double from, double to) noexcept;

  SvgDocument* svg_;
  Box box_;
  PlotAxis x_, y_;
};

// Reduces a long series but keeps its shape: per interval of x its lowest and highest value, in order of occurrence.
// At most about `max_points` points; intervals without a value become a gap.
[[nodiscard]] std::vector<PlotPoint> decimated(std::span<const PlotPoint> points, std::size_t max_points);

struct LegendEntry {
  std::string label;
  std::string css_class;
};
// Entries one below the other in the box; the last line states how many did not fit.
void draw_legend(SvgDocument& svg, const Box& box, std::span<const LegendEntry> entries);

// Labels of vertical lines, moved into higher rows where they would overlap. Row 0 is the lowest; -1 = no room in
// `n_rows`. `x_px` must ascend.
[[nodiscard]] std::vector<int> label_rows(std::span<const double> x_px, std::span<const std::string> labels,
                                          int n_rows);

}  // namespace app
