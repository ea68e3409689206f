#include "drivers/storage/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <utility>

#include "drivers/storage/yaml.h"

namespace drivers {
namespace {

// Calibration programs also write the corner points they used: larger than a configuration.
constexpr YamlLimits kLimits{.max_bytes = 16U << 20U, .max_depth = 8, .max_nodes = 2000000};

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
      refuse(model->line,
             fmt::format("camera_model `{}` is not supported; calibrate as `pinhole`", printable(model->text)));
    }
    Calibration out;
    const YamlNode& intrinsics = *camera.find("intrinsics");
    const std::vector<double> k = numbers(intrinsics, "intrinsics");
    if (k.size() != 4)
      refuse(intrinsics.line, fmt::format("intrinsics: {} numbers instead of 4 (fx fy cx cy)", k.size()));
    out.fx = k[0], out.fy = k[1], out.cx = k[2], out.cy = k[3];
    require_model(camera);
    const YamlNode* coefficients = camera.find("distortion_coeffs");
    if (coefficients == nullptr) refuse(camera.line, "distortion_coeffs is missing; is the file cut off?");
    set_distortion(out, *coefficients, numbers(*coefficients, "distortion_coeffs"));
    if (const YamlNode* resolution = camera.find("resolution")) {
      if (resolution->items.size() != 2) refuse(resolution->line, "resolution: expected [width, height]");
      out.width_px = size_px(resolution->items[0], "resolution");
      out.height_px = size_px(resolution->items[1], "resolution");
    }
    return checked(std::move(out), intrinsics.line);
  }

  // OpenCV FileStorage and ROS camera_info share this form; only the names of the keys differ.
  [[nodiscard]] Calibration matrix_form(const YamlNode& root) const {
    const YamlNode* camera = first_of(root, {"camera_matrix", "cameraMatrix", "CameraMatrix", "K", "k"});
    if (camera == nullptr) {
      refuse(root.line, "is no calibration: neither `intrinsics` (Kalibr) nor `camera_matrix` (OpenCV, ROS) found");
    }
    if (const YamlNode* fisheye = root.find("fisheye_model"); fisheye != nullptr && fisheye->text != "0") {
      refuse(fisheye->line,
             "a fisheye (equidistant) calibration is not supported; calibrate as pinhole, 4 or 5 coefficients");
    }
    require_model(root);
    const std::vector<double> k = matrix(*camera, "camera_matrix");
    if (k.size() != 9) refuse(camera->line, fmt::format("camera_matrix: {} numbers instead of 9", k.size()));
    if (std::abs(k[1]) > 1e-6 * std::abs(k[0]) || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
      refuse(camera->line, "camera_matrix: not of the form [fx 0 cx; 0 fy cy; 0 0 1]");
    }
    Calibration out;
    out.fx = k[0], out.fy = k[4], out.cx = k[2], out.cy = k[5];
    const YamlNode* coefficients = first_of(root, {"distortion_coefficients", "dist_coeffs", "distCoeffs", "DistCoeffs",
                                                   "dist_coefs", "distortion", "D", "d"});
    if (coefficients == nullptr) refuse(root.line, "distortion_coefficients is missing; is the file cut off?");
    set_distortion(out, *coefficients, matrix(*coefficients, "distortion_coefficients"));
    const YamlNode* width = first_of(root, {"image_width", "image_Width", "width"});
    const YamlNode* height = first_of(root, {"image_height", "image_Height", "height"});
    if (width != nullptr && height != nullptr) {
      out.width_px = size_px(*width, "image_width");
      out.height_px = size_px(*height, "image_height");
    }
    return checked(std::move(out), camera->line);
  }

  [[nodiscard]] static const YamlNode* first_of(const YamlNode& root, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
      if (const YamlNode* node = root.find(key)) return node;
    }
    return nullptr;
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

  void require_model(const YamlNode& camera) const {
    const YamlNode* model = camera.find("distortion_model");
    if (model == nullptr || model->text == "radtan" || model->text == "plumb_bob") return;
    refuse(model->line,
           fmt::format("distortion_model `{}` is not supported; calibrate as radial-tangential (radtan, plumb_bob)",
                       printable(model->text)));
  }

  // Coefficients beyond k3 (rational, thin prism, tilt) may stand there as zeros.
  void set_distortion(Calibration& out, const YamlNode& node, std::vector<double> values) const {
    while (values.size() > 5 && values.back() == 0.0) values.pop_back();
    if (values.size() != 4 && values.size() != 5) {
      refuse(node.line, fmt::format("distortion: {} numbers instead of 4 or 5 (k1 k2 p1 p2 [k3])", values.size()));
    }
    for (const double value : values) {
      if (std::abs(value) > 100.0)
        refuse(node.line, fmt::format("distortion: {} is refused: allowed -100 .. 100", value));
    }
    out.distortion = std::move(values);
    out.model = "pinhole-radtan";
  }

  [[nodiscard]] Calibration checked(Calibration out, int line) const {
    for (const double focal : {out.fx, out.fy}) {
      if (focal < 1.0 || focal > 1e6)
        refuse(line, fmt::format("focal length {} is refused: allowed 1 .. 1000000 (px)", focal));
    }
    for (const double centre : {out.cx, out.cy}) {
      if (std::abs(centre) > 1e6)
        refuse(line, fmt::format("principal point {} is refused: allowed within 1000000 px", centre));
    }
    return out;
  }

  const std::string& name_;
};

}  // namespace

Calibration parse_calibration(const std::string& text, const std::string& name) {
  // OpenCV's "%YAML:1.0" is no YAML directive: blank it, the lines keep their numbers.
  std::string body = text;
  if (body.starts_with("%YAML:")) std::fill_n(body.begin(), std::min(body.find('\n'), body.size()), ' ');
  return CalibrationReader(name).read(parse_yaml(body, name, kLimits));
}

Calibration read_calibration(const std::string& path) {
  return parse_calibration(read_text_file(path, kLimits.max_bytes), path);
}

}  // namespace drivers
