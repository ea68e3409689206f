#include "core/identification/listed_modes.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace core {

std::vector<ListedMode> listed_modes(std::vector<Mode>& modes, int first) {
  std::vector<ListedMode> out;
  out.reserve(modes.size());
  for (Mode& mode : modes) out.push_back({std::move(mode), first++});
  return out;
}

void list_again(std::vector<ListedMode> structural, std::vector<ListedMode> rejected, ModalEstimate& estimate) {
  const auto n_before = estimate.modes.size() + estimate.rejected.size();
  estimate.modes.clear(), estimate.rejected.clear();
  std::vector<int> now(n_before, -1);
  int n = 0;
  for (auto* list : {&structural, &rejected}) {
    std::stable_sort(list->begin(), list->end(), [](const ListedMode& a, const ListedMode& b) {
      return a.mode.frequency_hz < b.mode.frequency_hz;
    });
    for (ListedMode& one : *list) {
      if (one.i_line >= 0) now[static_cast<std::size_t>(one.i_line)] = n;
      ++n;
      (list == &structural ? estimate.modes : estimate.rejected).push_back(std::move(one.mode));
    }
  }
  for (StabilisationPole& pole : estimate.poles) {
    if (pole.i_line >= 0) pole.i_line = now[static_cast<std::size_t>(pole.i_line)];
  }
}

}  // namespace core
