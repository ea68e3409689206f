#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identification/camera_leakage.h"
#include "core/identification/folding.h"
#include "core/identification/identifier.h"
#include "core/identification/mode_scatter.h"
#include "core/identification/model_fit.h"
#include "core/identification/neighbour_leakage.h"
#include "core/identification/stabilisation.h"

namespace core {

// Poles of all orders of a record's model, and the lines that they form in the stabilisation diagram.
struct RecordPoles {
  std::string status;  // "ok", or the reason for no model: then all else is empty
  ModelFit fit;
  std::vector<int> orders;
  // Parallel: as observed, unfolded, and the part of a neighbour that was taken out.
  std::vector<PoleOfOrder> observed;
  std::vector<OrderPole> unfolded;
  std::vector<std::optional<NeighbourLeakage>> leaks;
  std::vector<PoleCluster> lines;  // found in a quarter of the orders or more; as published: every pole
};

// Two lines closer than their widths are resolved with more block rows, where the record has room for them.
[[nodiscard]] RecordPoles find_poles(const CpsdSums& sums, const IdentifierConfig& config,
                                     const std::vector<ChannelInfo>& channels, const FoldingConfig& folding,
                                     const CameraLeakage& camera);

}  // namespace core
