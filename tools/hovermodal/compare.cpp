// hovermodal compare: one result against another, and both against the truth.
#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/identification/mac.h"
#include "firmware_app/report/modal_json.h"
#include "tools/hovermodal/commands.h"

namespace tools {

namespace {

using Shape = std::vector<std::complex<double>>;

struct Options {
  std::string result, reference;
};

// The mode of `report` that is meant by `wanted`: within 10 % in frequency, the best MAC.
struct Match {
  const core::Mode* mode = nullptr;
  double mac = 0.0;
};

// Components of `mode` for the channels of `names`, 0 where a channel is not there.
Shape shape_for(const app::ModalReport& report, const core::Mode& mode, const std::vector<std::string>& names) {
  Shape shape;
  for (const std::string& name : names) {
    const auto at = std::find(report.channel_names.begin(), report.channel_names.end(), name);
    shape.push_back(at == report.channel_names.end() ? 0.0 : mode.shape[static_cast<std::size_t>(at - report.channel_names.begin())]);
  }
  return shape;
}

Match find(const app::ModalReport& report, const core::Mode& wanted, const std::vector<std::string>& names, const Shape& wanted_shape) {
  Match best;
  for (const core::Mode& mode : report.estimate.modes) {
    if (std::abs(mode.frequency_hz / wanted.frequency_hz - 1.0) > 0.1) continue;
    const double mac = core::mac(shape_for(report, mode, names), wanted_shape);
    if (best.mode == nullptr || mac > best.mac) best = {&mode, mac};
  }
  return best;
}

std::vector<std::string> common_channels(const app::ModalReport& a, const app::ModalReport& b) {
  std::vector<std::string> names;
  for (const std::string& name : a.channel_names) {
    if (std::find(b.channel_names.begin(), b.channel_names.end(), name) != b.channel_names.end()) names.push_back(name);
  }
  return names;
}

// One line a mode: "mode 1: 1.6497 Hz, reference 1.6484 Hz, error 0.078 %, MAC 0.99991, ...".
void print_against(const app::ModalReport& result, const app::ModalReport& reference, bool with_scatter) {
  const std::vector<std::string> names = common_channels(result, reference);
  int number = 0;
  for (const core::Mode& wanted : reference.estimate.modes) {
    ++number;
    const Match match = find(result, wanted, names, shape_for(reference, wanted, names));
    if (match.mode == nullptr) {
      fmt::print("mode {} reference {:.4f} Hz not found\n", number, wanted.frequency_hz);
      continue;
    }
    const double error = match.mode->frequency_hz / wanted.frequency_hz - 1.0;
    fmt::print("mode {} reference {:.4f} Hz found {:.4f} Hz error {:.4f} % MAC {:.5f}", number, wanted.frequency_hz,
               match.mode->frequency_hz, 100.0 * error, match.mac);
    if (with_scatter && wanted.damping_ratio > 0.0 && result.estimate.duration_s > 0.0) {
      const double sigma = std::sqrt(wanted.damping_ratio / (2.0 * std::numbers::pi * wanted.frequency_hz * result.estimate.duration_s));
      fmt::print(" sigmas {:.2f}", error / sigma);
    }
    fmt::print(" damping {:.2f} % reference {:.2f} %\n", 100.0 * match.mode->damping_ratio, 100.0 * wanted.damping_ratio);
  }
}

}  // namespace

void add_compare(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "compare", "Frequencies and shapes of one modal.json against another, or against a simulation's truth.json\n"
                 "  hovermodal compare --result out/modal.json --reference truth.json");
  command->add_option("--result", options->result, "modal.json to judge")->required()->type_name("FILE");
  command->add_option("--reference", options->reference, "modal.json or truth.json to judge it by")->required()->type_name("FILE");
  command->callback([options] {
    const app::ModalReport result = app::read_modal_json(options->result);
    const app::ModalReport reference = app::read_modal_json(options->reference);
    print_against(result, reference, true);
  });
}

}  // namespace tools
