#include "core/identification/line_modes.h"

#include <cmath>
#include <complex>

#include "core/identification/base_response.h"
#include "core/identification/camera_leakage.h"
#include "core/identification/line_evidence.h"
#include "core/identification/stabilisation.h"
#include "core/identification/verdict.h"
#include "core/types/constants.h"

namespace core {

namespace {

PoleCluster cluster_of(const SteadyLine& line, std::size_t n_outputs, const FoldingConfig& folding) {
  std::vector<std::complex<double>> shape(n_outputs);
  for (std::size_t c = 0; c < n_outputs && c < line.amplitude.size(); ++c) shape[c] = line.amplitude[c];
  PoleCluster cluster;
  cluster.representative = unfold(std::polar(1.0, kTwoPi * line.apparent_hz / folding.rate_hz), shape, folding);
  cluster.frequency_hz = frequency_hz(cluster.representative.s);
  cluster.apparent_hz = line.apparent_hz;
  cluster.presence = 1.0;
  cluster.i_orders = {0};
  return cluster;
}

}  // namespace

std::vector<Mode> judge_steady_lines(const std::vector<SteadyLine>& lines, const CpsdSums& sums,
                                     const std::vector<ChannelInfo>& channels, const std::vector<ChannelInfo>& outputs,
                                     const FoldingConfig& folding) {
  std::vector<Mode> modes;
  SpectralLineTest examiner(sums, folding);
  const CameraLeakage camera(sums, channels);
  for (const SteadyLine& line : lines) {
    const PoleCluster cluster = cluster_of(line, outputs.size(), folding);
    SpectralLineEvidence evidence = examiner.examine(cluster.representative);
    evidence.steady_segments = line.n_segments, evidence.steady_coherence = line.coherence;
    evidence.witness_share = camera.examine(observed_shape(cluster.representative, folding), line.apparent_hz).share;
    const BaseResponse response = base_response(sums, channels, line.apparent_hz);
    modes.push_back(judge(cluster, response, outputs, {0}, VerdictRules{}, evidence));
  }
  return modes;
}

}  // namespace core
