#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/response/logger_model.h"

namespace core::closure {

// Phases of each logger's cross-spectrum with the first one, part by part. Parts are aligned by the coarse offset, so
// that the loggers record the same motion; the phases refer to sample numbers without that alignment.
struct LoggerPhases {
  std::vector<double> coarse_s;  // per logger; whole samples
  Eigen::VectorXd frequency_hz;
  std::vector<double> part_time_s;
  std::vector<std::vector<Eigen::VectorXd>> phase, weight;  // logger, part: per bin; weight 0 or 1
};

// The inverse transform of the cross-spectrum's squared phasors (its doubled phases) has its peak at twice the offset,
// whatever the signs of the modes. Throws as LoggerModel.
[[nodiscard]] LoggerPhases logger_phases(const LoggerRecords& records, std::size_t n_parts);

}  // namespace core::closure
