// One update of the identification, timed in process CPU time, on data that tests/bench/identification_speed.py reads
// too: a new segment of 1024 samples into the sums, correlations, ERA, poles and shapes of orders 2-60, their clusters.
//   identification_speed make DATA CHANNELS SEED: writes 300 s at 30 Hz, as doubles by sample
//   identification_speed run DATA CHANNELS plain|cva BLOCK_ROWS REPEATS POLES: the least milliseconds of an update
//   identification_speed service CHANNELS UPDATES SEED: the service's defaults, with standard deviations; the least
//     milliseconds of an identification
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "core/identification/era.h"
#include "core/identification/identifier.h"
#include "core/identification/stabilisation.h"
#include "core/spectrum/welch_cpsd.h"
#include "tests/bench/update_data.h"

namespace {

using bench::cpu_ms;
using bench::kRateHz;
using bench::make_motion;
using bench::push;

constexpr int kSegment = 1024;
constexpr int kMaxOrder = 60;
constexpr int kSamples = 9000;

// First, middle and last channel.
std::vector<int> references_of(int n_channels) { return {0, (n_channels - 1) / 2, n_channels - 1}; }

struct Update {
  std::vector<core::OrderPole> poles;
  std::vector<core::PoleCluster> clusters;
  double last_singular_value = 0.0;
};

Update identify(const core::CpsdSums& sums, const core::EraConfig& config) {
  core::Correlations correlations;
  core::Realisation realisation;
  Update out;
  const std::span<const int> pairs_with =
      config.canonical_variates ? std::span<const int>{} : std::span<const int>(config.references);
  if (core::compute_correlations(sums, 2 * config.block_rows + config.first_lag, 0, correlations, pairs_with) !=
          core::CorrelationStatus::kOk ||
      core::realise(correlations, config, realisation) != core::EraStatus::kOk) {
    std::fprintf(stderr, "identification_speed: no realisation\n");
    std::exit(1);
  }
  out.last_singular_value = realisation.singular_values[kMaxOrder - 1];
  const core::FoldingConfig folding{kRateHz, 0.0, {}};
  for (int order = 2; order <= kMaxOrder; order += 2) {
    for (const core::DiscretePole& pole : core::poles_of_order(realisation, order)) {
      out.poles.push_back({order / 2 - 1, core::unfold(pole.lambda, pole.shape, folding)});
    }
  }
  out.clusters = core::cluster_poles(out.poles, kMaxOrder / 2);
  return out;
}

void write_poles(const Update& update, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return;
  for (const core::OrderPole& p : update.poles) {
    const std::complex<double> lambda = std::exp(p.pole.s / kRateHz);
    std::fprintf(file, "%d %.17g %.17g %.17g\n", 2 * (p.i_order + 1), lambda.real(), lambda.imag(), p.pole.mpc);
  }
  std::fclose(file);
}

int run(const std::string& path, int n_channels, bool weighted, int block_rows, int repeats, const std::string& poles) {
  const auto n = static_cast<std::size_t>(n_channels);
  std::ifstream file(path, std::ios::binary);
  std::vector<double> motion(n * kSamples);
  file.read(reinterpret_cast<char*>(motion.data()), static_cast<std::streamsize>(motion.size() * sizeof(double)));
  if (!file) {
    std::fprintf(stderr, "identification_speed: %s does not hold %d samples of %d channels\n", path.c_str(), kSamples,
                 n_channels);
    return 1;
  }
  // 16 segments, the last of them in the timed part.
  const std::size_t hop = kSegment / 2, begin = kSegment + 14 * hop;
  core::WelchCpsd start({.n_channels = n_channels, .segment = kSegment, .rate_hz = kRateHz});
  push(start, motion, n, 0, begin);
  core::EraConfig config;
  config.block_rows = block_rows;
  config.max_order = kMaxOrder;
  config.references = references_of(n_channels);
  config.canonical_variates = weighted;
  config.with_maps = false;  // the comparator computes no standard deviations either
  double least_ms = 1e300;
  Update update;
  for (int k = 0; k < repeats; ++k) {
    core::WelchCpsd welch = start;
    const double t0 = cpu_ms();
    push(welch, motion, n, begin, begin + hop);
    update = identify(welch.sums(), config);
    least_ms = std::min(least_ms, cpu_ms() - t0);
  }
  write_poles(update, poles);
  std::printf("%.3f ms\t%zu poles\t%zu clusters\tsingular value 60: %.12g\n", least_ms, update.poles.size(),
              update.clusters.size(), update.last_singular_value);
  return 0;
}

int service(int n_channels, int n_updates, std::uint64_t seed) {
  const std::vector<double> motion = make_motion(n_channels, kSamples, seed);
  core::WelchCpsd welch({.n_channels = n_channels, .segment = 512, .rate_hz = kRateHz});
  push(welch, motion, static_cast<std::size_t>(n_channels), 0, kSamples);
  std::vector<core::ChannelInfo> channels(static_cast<std::size_t>(n_channels));
  const core::Identifier identifier({}, channels);
  double least_ms = 1e300;
  for (int k = 0; k < n_updates; ++k) {
    const double t0 = cpu_ms();
    const core::ModalEstimate estimate = identifier.identify(welch.sums());
    least_ms = std::min(least_ms, cpu_ms() - t0);
    std::printf("%s: order %d, %zu modes, %zu rejected\n", estimate.status.c_str(), estimate.model_order,
                estimate.modes.size(), estimate.rejected.size());
  }
  std::printf("least %.3f ms\n", least_ms);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() == 4 && arguments[0] == "make") {
    const std::vector<double> motion = make_motion(std::stoi(arguments[2]), kSamples, std::stoull(arguments[3]));
    std::ofstream(arguments[1], std::ios::binary)
        .write(reinterpret_cast<const char*>(motion.data()),
               static_cast<std::streamsize>(motion.size() * sizeof(double)));
    return 0;
  }
  if (arguments.size() == 7 && arguments[0] == "run") {
    return run(arguments[1], std::stoi(arguments[2]), arguments[3] == "cva", std::stoi(arguments[4]),
               std::stoi(arguments[5]), arguments[6]);
  }
  if (arguments.size() == 4 && arguments[0] == "service")
    return service(std::stoi(arguments[1]), std::stoi(arguments[2]), std::stoull(arguments[3]));
  std::fprintf(
      stderr,
      "usage: identification_speed make DATA CHANNELS SEED | run DATA CHANNELS plain|cva BLOCK_ROWS REPEATS POLES "
      "| service CHANNELS UPDATES SEED\n");
  return 2;
}
