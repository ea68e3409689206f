#include "tools/hovermodal/calibrate/calibration_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "drivers/storage/text_wrap.h"

namespace tools {
namespace {

constexpr double kTiltedDeg = 12.0;
constexpr std::size_t kFewViews = 10;
constexpr std::array<const char*, 9> kNinths{"top left", "top",         "top right", "left",        "centre",
                                             "right",    "bottom left", "bottom",    "bottom right"};

constexpr std::array<const char*, 4> kIntrinsics{"fx", "fy", "cx", "cy"};

const char* coefficient_name(core::LensModel lens, std::size_t i) {
  constexpr std::array<const char*, 5> kRadtan{"k1", "k2", "p1", "p2", "k3"};
  constexpr std::array<const char*, 4> kEquidistant{"k1", "k2", "k3", "k4"};
  return lens == core::LensModel::kEquidistant ? kEquidistant[i] : kRadtan[i];
}

std::size_t worst_view(const CalibrationRun& run) {
  const auto& rms = run.fit.view_rms_px;
  return static_cast<std::size_t>(std::max_element(rms.begin(), rms.end()) - rms.begin());
}

std::string parameter_table(const core::CameraFit& fit) {
  const core::CameraModel& camera = fit.camera;
  std::string out = "                value   standard deviation\n";
  const std::array<double, 4> intrinsics{camera.fx, camera.fy, camera.cx, camera.cy};
  for (std::size_t i = 0; i < 4; ++i) {
    out += fmt::format("  {}      {:11.3f}   {:.3f} px\n", kIntrinsics[i], intrinsics[i], fit.sigma[i]);
  }
  for (std::size_t i = 0; i + 4 < fit.sigma.size(); ++i) {
    const char* name = coefficient_name(camera.lens, i);
    if (static_cast<int>(i) < fit.n_coefficients) {
      out += fmt::format("  {}      {:11.6f}   {:.6f}\n", name, camera.distortion[i], fit.sigma[4 + i]);
    } else {
      out += fmt::format("  {}                0   held: with it the fit would fold the image\n", name);
    }
  }
  return out;
}

}  // namespace

std::vector<int> corners_per_ninth(const CalibrationRun& run) {
  std::vector<int> count(9, 0);
  for (const core::BoardView& view : run.views) {
    for (const core::Vector2& p : view) {
      const int column = std::clamp(static_cast<int>(3.0 * (p.u + 0.5) / run.width_px), 0, 2);
      const int row = std::clamp(static_cast<int>(3.0 * (p.v + 0.5) / run.height_px), 0, 2);
      ++count[static_cast<std::size_t>(3 * row + column)];
    }
  }
  return count;
}

std::vector<std::string> calibration_warnings(const CalibrationRun& run) {
  std::vector<std::string> out;
  const core::CameraFit& fit = run.fit;
  const auto n_tilted =
      std::count_if(fit.tilt_deg.begin(), fit.tilt_deg.end(), [](double t) { return t > kTiltedDeg; });
  if (n_tilted < 3) {
    out.push_back(
        fmt::format("poorly conditioned: the board faces the camera in nearly all views ({} of {} tilted by more "
                    "than {:g} degrees), so focal length and distance cannot be distinguished; film it tilted by "
                    "20 to 40 degrees to all four sides",
                    n_tilted, fit.tilt_deg.size(), kTiltedDeg));
  }
  const double focal_share = std::max(fit.sigma[0] / fit.camera.fx, fit.sigma[1] / fit.camera.fy);
  if (focal_share > 0.005) {
    out.push_back(
        fmt::format("the focal length is known to {:.1f} % only; more views, more tilt", 100.0 * focal_share));
  }
  if (fit.condition < 1e-8) {
    out.push_back(
        fmt::format("poorly conditioned: parameters are nearly indistinguishable (smallest eigenvalue {:.1g}); "
                    "film with more tilt, and with the board in the corners",
                    fit.condition));
  }
  if (run.views.size() < kFewViews) out.push_back(fmt::format("only {} views; 20 to 40 are usual", run.views.size()));
  std::vector<std::string> empty;
  const std::vector<int> count = corners_per_ninth(run);
  for (std::size_t i = 0; i < count.size(); ++i) {
    if (count[i] == 0) empty.emplace_back(kNinths[i]);
  }
  if (!empty.empty()) {
    out.push_back(
        fmt::format("no board corner was seen in: {}; the distortion there is extrapolated, film the board there",
                    fmt::join(empty, ", ")));
  }
  if (fit.rms_px > 1.0) {
    out.push_back(fmt::format("the error of {:.2f} px is large: is the board flat, the clip sharp, the model right?",
                              fit.rms_px));
  }
  return out;
}

std::string calibration_json(const CalibrationRun& run, const std::string& out) {
  const core::CameraModel& camera = run.fit.camera;
  nlohmann::ordered_json parameters;
  const auto add = [&](const char* name, double value, double sigma, bool is_fitted) {
    parameters[name] = {{"value", value}, {"sigma", nullptr}};
    if (is_fitted) parameters[name]["sigma"] = sigma;
  };
  const std::array<double, 4> intrinsics{camera.fx, camera.fy, camera.cx, camera.cy};
  for (std::size_t i = 0; i < 4; ++i) add(kIntrinsics[i], intrinsics[i], run.fit.sigma[i], true);
  for (std::size_t i = 0; i + 4 < run.fit.sigma.size(); ++i) {
    add(coefficient_name(camera.lens, i), camera.distortion[i], run.fit.sigma[4 + i],
        static_cast<int>(i) < run.fit.n_coefficients);
  }
  return drivers::to_json_text({{"version", 1},
                                {"out", out},
                                {"size", {run.width_px, run.height_px}},
                                {"model", camera.lens == core::LensModel::kEquidistant ? "equidistant" : "radtan"},
                                {"parameters", parameters},
                                {"rms_px", run.fit.rms_px},
                                {"images_examined", run.n_looked_at},
                                {"board_found", run.n_found},
                                {"views", run.views.size()},
                                {"left_out", run.dropped},
                                {"corners_per_ninth", corners_per_ninth(run)},
                                {"warnings", calibration_warnings(run)}})
      .text;
}

std::string calibration_words(const CalibrationRun& run) {
  std::string out;
  const auto append = [&out]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
  };
  const core::CameraFit& fit = run.fit;
  append("{} x {} px, board of {} x {} inner corners, squares of {:g} mm\n", run.width_px, run.height_px,
         run.board.columns, run.board.rows, run.board.square_mm);
  append(
      "images examined {}, board found in {}, used {} (spread over the image; the others add no "
      "information)\n",
      run.n_looked_at, run.n_found, run.views.size());
  for (const std::string& reason : run.dropped) append("left out: {}\n", reason);
  append("\nreprojection error {:.3f} px rms; worst view {:.3f} px ({})\n\n", fit.rms_px,
         fit.view_rms_px[worst_view(run)], run.places[worst_view(run)]);
  out += fit.camera.lens == core::LensModel::kEquidistant ? "equidistant (fisheye)\n" : "radial-tangential\n";
  out += parameter_table(fit);
  const std::vector<int> count = corners_per_ninth(run);
  append("\ncorners per ninth of the image    {:6}{:6}{:6}\n", count[0], count[1], count[2]);
  for (std::size_t i = 3; i < 9; i += 3) append("{:34}{:6}{:6}{:6}\n", "", count[i], count[i + 1], count[i + 2]);
  for (const std::string& warning : calibration_warnings(run)) {
    out += "\nwarning: ";
    std::string text;
    drivers::append_wrapped(text, warning, 9);
    out += text.substr(9);
  }
  return out;
}

}  // namespace tools
