#pragma once

#include <vector>

#include "core/types/modal_estimate.h"

namespace core {

// Modes of an estimate with the index that the poles of its diagram name; -1: not of that diagram.
struct ListedMode {
  Mode mode;
  int i_line = -1;
};

// first: index of the first one. The modes are moved from.
[[nodiscard]] std::vector<ListedMode> listed_modes(std::vector<Mode>& modes, int first);

// Writes both lists, each by frequency, and renumbers the lines that the diagram's poles name.
void list_again(std::vector<ListedMode> structural, std::vector<ListedMode> rejected, ModalEstimate& estimate);

}  // namespace core
