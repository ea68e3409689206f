#include "firmware_app/report/loss_words.h"

#include <fmt/format.h>

namespace app {

std::string point_loss_words(const core::PointLosses& losses, std::size_t n_points) {
  std::string causes;
  const auto add = [&](std::uint32_t n, const char* words) {
    if (n > 0) causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", n, words);
  };
  add(losses.unlike, "covered or with another surface in their window");
  add(losses.elsewhere, "moving otherwise than their region");
  add(losses.left_image, "outside the image");
  add(losses.light, "in another light");
  if (causes.empty()) return causes;
  const auto n = losses.total();
  return fmt::format("{} of {} points {} lost: {}", n, n_points, n == 1 ? "is" : "are", causes);
}

}  // namespace app
