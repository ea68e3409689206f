#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>

#include "tools/hovermodal/regions/picker.h"
#include "tools/hovermodal/regions/regions_text.h"

namespace {

using testing::HasSubstr;

std::string one(const std::string& members) { return "{\"regions\":[{" + members + "}]}"; }

std::string refusal(const std::string& json) {
  try {
    (void)tools::read_regions(json, 640, 480);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(RegionsPicker, ReadsWhatThePageSends) {
  const auto regions = tools::read_regions(
      R"({"regions":[{"name":"roof","rect":[10,20,100,30],"role":"structure","axis":"both"},
                     {"name":"wall","rect":[0,0,640,10],"role":"background","axis":"30"}]})",
      640, 480);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(regions[0].width_px, 100.0);
  EXPECT_TRUE(regions[0].both_axes);
  EXPECT_EQ(regions[1].role, core::RegionRole::kBackground);
  EXPECT_EQ(regions[1].axis_deg, 30.0);
  EXPECT_THAT(tools::regions_yaml(regions),
              HasSubstr("- {name: roof, rect: [10, 20, 100, 30], role: structure, axis: both}"));
}

TEST(RegionsPicker, WhatItServesItReadsAgain) {
  const auto regions =
      tools::read_regions(one(R"("name":"a","rect":[1,2,30,40],"role":"ground","axis":"v")"), 640, 480);
  const auto again = tools::read_regions(tools::regions_json(regions, 640, 480), 640, 480);
  EXPECT_EQ(tools::regions_yaml(again), tools::regions_yaml(regions));
}

TEST(RegionsPicker, SaysWhatCannotBe) {
  EXPECT_THAT(refusal("nonsense"), HasSubstr("expected"));
  EXPECT_THAT(refusal("{\"regions\":[]}"), HasSubstr("0 regions"));
  EXPECT_THAT(refusal(one(R"("rect":[1,2,30,40],"role":"ground","axis":"v")")), HasSubstr("no name"));
  EXPECT_THAT(refusal(one(R"("name":"a: b","rect":[1,2,30,40],"role":"ground","axis":"v")")), HasSubstr("letters"));
  EXPECT_THAT(refusal(one(R"("name":"a","rect":[1,2,30],"role":"ground","axis":"v")")),
              HasSubstr("four whole numbers"));
  EXPECT_THAT(refusal(one(R"("name":"a","rect":[600,2,50,40],"role":"ground","axis":"v")")), HasSubstr("640 x 480"));
  EXPECT_THAT(refusal(one(R"("name":"a","rect":[1,2,-30,40],"role":"ground","axis":"v")")), HasSubstr("not lie"));
  EXPECT_THAT(refusal(one(R"("name":"a","rect":[9223372036854775807,2,30,40],"role":"ground","axis":"v")")),
              HasSubstr("not lie"));
  EXPECT_THAT(refusal(one(R"("name":"a","rect":[1,2,30,40],"role":"king","axis":"v")")), HasSubstr("role"));
  EXPECT_THAT(refusal(one(R"("name":"a","rect":[1,2,30,40],"role":"base","axis":"1e9")")), HasSubstr("axis"));
  const std::string same = R"({"name":"a","rect":[1,2,30,40],"role":"base","axis":"u"})";
  EXPECT_THAT(refusal("{\"regions\":[" + same + "," + same + "]}"), HasSubstr("two regions"));
}

TEST(RegionsPicker, AnyBytesAreReadOrRefused) {
  const std::string good = one(R"("name":"a","rect":[1,2,30,40],"role":"base","axis":"u")");
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (std::uint_fast32_t k = 0, n = 1 + random() % 5; k < n; ++k)
      text[random() % text.size()] = static_cast<char>(random());
    (void)refusal(text);
  }
}

}  // namespace
