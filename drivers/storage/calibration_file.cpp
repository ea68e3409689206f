#include "drivers/storage/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <utility>

#include "drivers/storage/limits.h"
#include "drivers/storage/yaml.h"

namespace drivers {
namespace {

// Calibration programs also write the corner points used: such files are larger than a configuration.
constexpr YamlLimits kLimits{.max_bytes = Limits::kCalibrationBytes, .max_depth = 8, .max_nodes = 300000};

class CalibrationReader {
 public:
  explicit CalibrationReader(const std::string& name) : name_(name) {}

  [[nodiscard]] Calibration read(const YamlNode& root) const {
    if (root.kind != YamlNode::Kind::kMap) refuse(root.line, "is no calibration: expected keys, e.g. camera_matrix");
    for (std::size_t i = 0; i < root.keys.size(); ++i) {
      if (root.keys[i].starts_with("cam") && root.items[i].find("intrinsics") != nullptr) return kalibr(root, i);
    }
    if (root.find("intrinsics") != nullptr) return kalibr_camera(root);
    return matrix_form(root);
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", name_, line, what));
  }

  [[nodiscard]] double number(const YamlNode& node, const std::string& key) const {
    const auto value = node.kind == YamlNode::Kind::kScalar ? parse_number(node.text) : std::nullopt;
    if (!value || std::abs(*value) > 1e9) {
      refuse(node.line, fmt::format("{}: `{}` is no usable number; calibrate again", key, printable(node.text)));
    }
    return *value;
  }

  [[nodiscard]] std::vector<double> numbers(const YamlNode& node, const std::string& key) const {
    if (node.kind != YamlNode::Kind::kList) refuse(node.line, fmt::format("{}: expected a list of numbers", key));
    std::vector<double> values;
    for (const YamlNode& item : node.items) values.push_back(number(item, key));
    return values;
  }

  [[nodiscard]] int size_px(const YamlNode& node, const std::string& key) const {
    const double value = number(node, key);
    if (value < 1.0 || value > 100000.0 || value != std::floor(value)) {
      refuse(node.line, fmt::format("{}: {} is refused: allowed 1 .. 100000 (px)", key, printable(node.text)));
    }
    return static_cast<int>(value);
  }

  [[nodiscard]] Calibration kalibr(const YamlNode& root, std::size_t i_camera) const {
    for (std::size_t i = i_camera + 1; i < root.keys.size(); ++i) {
      if (root.items[i].find("intrinsics") != nullptr) {
        refuse(root.key_lines[i],
               fmt::format("a second camera `{}`; keep the one camera that is used", printable(root.keys[i])));
      }
    }
    return kalibr_camera(root.items[i_camera]);
  }

  [[nodiscard]] Calibration kalibr_camera(const YamlNode& camera) const {
    if (const YamlNode* model = camera.find("camera_model"); model != nullptr && model->text != "pinhole") {
      refuse(model->line, fmt::format("camera_model: `{}` is not supported; calibrate as `pinhole` with radtan or "
                                      "equidistant distortion",
                                      printable(model->text)));
    }
    const YamlNode* model = camera.find("distortion_model");
    if (model == nullptr) refuse(camera.line, "distortion_model is missing; is the file cut off?");
    const YamlNode& intrinsics = *camera.find("intrinsics");
    const std::vector<double> k = numbers(intrinsics, "intrinsics");
    if (k.size() != 4)
      refuse(intrinsics.line, fmt::format("intrinsics: {} numbers instead of 4 (fx fy cx cy)", k.size()));
    Calibration out;
    out.camera.fx = k[0], out.camera.fy = k[1], out.camera.cx = k[2], out.camera.cy = k[3];
    const YamlNode* coefficients = camera.find("distortion_coeffs");
    const Form form = form_of(*model);
    if (coefficients == nullptr && form != Form::kNone)
      refuse(camera.line, "distortion_coeffs is missing; is the file cut off?");
    if (coefficients != nullptr)
      set_distortion(out.camera, form, *coefficients, numbers(*coefficients, "distortion_coeffs"));
    if (const YamlNode* resolution = camera.find("resolution")) {
      if (resolution->items.size() != 2) refuse(resolution->line, "resolution: expected [width, height]");
      out.width_px = size_px(resolution->items[0], "resolution");
      out.height_px = size_px(resolution->items[1], "resolution");
    }
    require_sound(out, intrinsics.line);
    return out;
  }

  // OpenCV FileStorage and ROS camera_info share this form; only the names of the keys differ.
  [[nodiscard]] Calibration matrix_form(const YamlNode& root) const {
    const YamlNode* camera =
        first_of(root, {"camera_matrix", "cameraMatrix", "CameraMatrix", "Camera_Matrix", "K", "k"});
    if (camera == nullptr) {
      refuse(root.line, "is no calibration: neither `intrinsics` (Kalibr) nor `camera_matrix` (OpenCV, ROS) found");
    }
    const std::vector<double> k = matrix(*camera, "camera_matrix");
    if (k.size() != 9) refuse(camera->line, fmt::format("camera_matrix: {} numbers instead of 9", k.size()));
    if (std::abs(k[1]) > 1e-6 * std::abs(k[0]) || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
      refuse(camera->line, "camera_matrix: not of the form [fx 0 cx; 0 fy cy; 0 0 1]; calibrate without skew");
    }
    Calibration out;
    out.camera.fx = k[0], out.camera.fy = k[4], out.camera.cx = k[2], out.camera.cy = k[5];
    const YamlNode* coefficients =
        first_of(root, {"distortion_coefficients", "dist_coeffs", "distCoeffs", "DistCoeffs", "dist_coefs",
                        "Distortion_Coefficients", "distortion_coeffs", "distortion", "D", "d"});
    const Form form = matrix_form_distortion(root);
    if (coefficients == nullptr && form != Form::kNone)
      refuse(root.line, "distortion_coefficients is missing; is the file cut off?");
    if (coefficients != nullptr)
      set_distortion(out.camera, form, data_of(*coefficients), matrix(*coefficients, "distortion_coefficients"));
    const YamlNode* width = first_of(root, {"image_width", "image_Width", "width"});
    const YamlNode* height = first_of(root, {"image_height", "image_Height", "height"});
    if (width != nullptr && height != nullptr) {
      out.width_px = size_px(*width, "image_width");
      out.height_px = size_px(*height, "image_height");
    }
    if (const YamlNode* rms = first_of(root, {"avg_reprojection_error", "Avg_Reprojection_Error"})) {
      out.rms_px = std::abs(number(*rms, "avg_reprojection_error"));
    }
    require_sound(out, data_of(*camera).line);
    return out;
  }

  [[nodiscard]] static const YamlNode* first_of(const YamlNode& root, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
      if (const YamlNode* node = root.find(key)) return node;
    }
    return nullptr;
  }

  [[nodiscard]] static const YamlNode& data_of(const YamlNode& matrix) {
    const YamlNode* data = matrix.find("data");
    return data == nullptr ? matrix : *data;
  }

  // {rows, cols, data: [...]}, or the bare list of ROS messages.
  [[nodiscard]] std::vector<double> matrix(const YamlNode& node, const std::string& key) const {
    if (node.kind == YamlNode::Kind::kList) return numbers(node, key);
    const YamlNode* data = node.find("data");
    if (data == nullptr) refuse(node.line, fmt::format("{}: no `data`; is the file cut off?", key));
    const std::vector<double> values = numbers(*data, key);
    const YamlNode* rows = node.find("rows");
    const YamlNode* cols = node.find("cols");
    if (rows == nullptr || cols == nullptr) return values;
    const double n_expected = number(*rows, key + ".rows") * number(*cols, key + ".cols");
    if (n_expected != static_cast<double>(values.size())) {
      refuse(data->line, fmt::format("{}: {} numbers instead of rows x cols = {}", key, values.size(), n_expected));
    }
    return values;
  }

  enum class Form : std::uint8_t { kNone, kBrown, kRational, kAnyOfOpencv, kEquidistant };

  [[nodiscard]] Form form_of(const YamlNode& model) const {
    static const std::map<std::string, Form> kForms{{"radtan", Form::kBrown},
                                                    {"plumb_bob", Form::kBrown},
                                                    {"rational_polynomial", Form::kRational},
                                                    {"equidistant", Form::kEquidistant},
                                                    {"equi", Form::kEquidistant},
                                                    {"fisheye", Form::kEquidistant},
                                                    {"none", Form::kNone}};
    const auto found = kForms.find(model.text);
    if (found != kForms.end()) return found->second;
    refuse(model.line,
           fmt::format("distortion_model: `{}` is not supported; calibrate as radial-tangential (radtan, plumb_bob, "
                       "rational_polynomial) or equidistant",
                       printable(model.text)));
  }

  // OpenCV itself names no model: it follows from the number of coefficients, and from a flag in the files of its
  // fisheye sample.
  [[nodiscard]] Form matrix_form_distortion(const YamlNode& root) const {
    const YamlNode* model = root.find("distortion_model");
    if (model != nullptr && !model->text.empty()) return form_of(*model);
    const YamlNode* fisheye = root.find("fisheye_model");
    return fisheye != nullptr && number(*fisheye, "fisheye_model") != 0.0 ? Form::kEquidistant : Form::kAnyOfOpencv;
  }

  [[noreturn]] void refuse_count(const YamlNode& node, std::size_t n, const char* wanted) const {
    refuse(node.line,
           fmt::format("distortion: {} numbers instead of {}; is the file cut off, or the model another?", n, wanted));
  }

  void set_distortion(core::CameraModel& out, Form form, const YamlNode& node,
                      const std::vector<double>& values) const {
    std::size_t n = values.size();
    if (form == Form::kEquidistant && n != 4) refuse_count(node, n, "4 (k1 k2 k3 k4)");
    if (form == Form::kNone && std::any_of(values.begin(), values.end(), [](double k) { return k != 0.0; }))
      refuse(node.line, "distortion: coefficients with distortion_model `none`; name the model, or remove them");
    // Coefficients beyond those of the model may be present as zeros.
    const std::size_t n_model = form == Form::kRational || form == Form::kAnyOfOpencv ? 8 : 5;
    while (n > n_model && values[n - 1] == 0.0) --n;
    if (n > 8)
      refuse(node.line,
             "distortion: thin prism and tilt (more than 8 coefficients) are not supported; calibrate without");
    const bool counts = n == 4 || n == 5 || (n_model == 8 && n == 8);
    if (form == Form::kBrown && !counts) refuse_count(node, n, "4 or 5 (k1 k2 p1 p2 [k3])");
    if (form != Form::kNone && !counts) refuse_count(node, n, "4, 5 or 8 (k1 k2 p1 p2 [k3 [k4 k5 k6]])");
    const double most = n == 8 ? 1e5 : 100.0;  // numerator and denominator of the rational form often nearly cancel
    for (std::size_t i = 0; i < n; ++i) {
      if (std::abs(values[i]) > most) {
        refuse(node.line,
               fmt::format("distortion: {} is refused: allowed {} .. {}; calibrate again", values[i], -most, most));
      }
    }
    std::copy_n(values.begin(), std::min(n, out.distortion.size()), out.distortion.begin());
    out.lens = form == Form::kEquidistant ? core::LensModel::kEquidistant : core::LensModel::kRadialTangential;
  }

  void require_sound(const Calibration& calibration, int line) const {
    const std::string fault = calibration_fault(calibration.camera, calibration.width_px, calibration.height_px);
    if (!fault.empty()) refuse(line, fault);
  }

  const std::string& name_;
};

}  // namespace

Calibration parse_calibration(const std::string& text, const std::string& name) {
  // OpenCV's "%YAML:1.0" is no valid YAML directive: it is blanked, so that line numbers stay the same.
  std::string body = text;
  if (body.starts_with("%YAML:")) std::fill_n(body.begin(), std::min(body.find('\n'), body.size()), ' ');
  return CalibrationReader(name).read(parse_yaml(body, name, kLimits));
}

Calibration read_calibration(const std::string& path) {
  return parse_calibration(read_text_file(path, kLimits.max_bytes), path);
}

}  // namespace drivers
