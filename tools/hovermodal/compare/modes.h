#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware_app/report/modal_json.h"

namespace tools {

// Table 1 of Yoon, Hoskere, Park & Spencer 2017: accelerometers (their reference) and camera on the drone.
struct PaperMode {
  double accelerometer_hz, drone_hz, mac_percent, error_percent;
};

// One mode of the reference (of the truth, if given) beside the mode of the result that corresponds to it.
struct ComparedMode {
  std::size_t number = 0;  // of the truth if given, else of the reference; from 1
  bool is_folded = false;  // above half of the reference's rate
  std::optional<double> found_hz, reference_hz;
  // Where both were found. MAC of the complex shapes, and of them taken as real ones.
  std::optional<double> error_percent, mac_percent, real_mac_percent;
  // With a truth that has a mode within 10 %. Sigmas: of the least scatter possible for the record's length.
  std::optional<double> true_hz, true_error_percent, true_error_sigmas;
  std::optional<PaperMode> paper;
};

// `truth`: null = none.
[[nodiscard]] std::vector<ComparedMode> compare_modes(const app::ModalReport& result, const app::ModalReport& reference,
                                                      const app::ModalReport* truth, bool with_paper);
[[nodiscard]] std::string compared_text(const std::vector<ComparedMode>& modes, bool with_truth, bool with_paper);
[[nodiscard]] std::string compared_json(const std::vector<ComparedMode>& modes);

}  // namespace tools
