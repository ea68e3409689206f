#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "core/closure/observation/observation_record.h"

namespace core::closure {

// Positions of a record as one matrix: rows 2j, 2j+1 = u, v of point j, one column per frame, px. Gaps are interpolated
// linearly between the adjacent samples and listed in `missing` (row, frame).
[[nodiscard]] Eigen::MatrixXd stacked_positions(const ObservationRecord& record,
                                                std::vector<std::pair<Eigen::Index, Eigen::Index>>& missing);

}  // namespace core::closure
