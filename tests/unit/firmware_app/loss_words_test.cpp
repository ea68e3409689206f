#include "firmware_app/report/loss_words.h"

#include <gtest/gtest.h>

namespace app {
namespace {

TEST(PointLossWords, NameEveryCauseThatOccurred) {
  EXPECT_EQ(point_loss_words({}, 240), "");
  EXPECT_EQ(
      point_loss_words({2, 0, 9, 1}, 240),
      "12 of 240 points are lost: 9 covered or with another surface in their window, 1 moving otherwise than their "
      "region, 2 outside the image");
  EXPECT_EQ(point_loss_words({0, 3, 0, 0}, 3), "3 of 3 points are lost: 3 in another light");
  EXPECT_EQ(point_loss_words({0, 1, 0, 0}, 158), "1 of 158 points is lost: 1 in another light");
}

}  // namespace
}  // namespace app
