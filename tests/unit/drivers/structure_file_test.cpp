#include "drivers/storage/structure_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    (void)parse_structure(text, "frame.yaml");
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(StructureFile, ReadsEveryKey) {
  const auto frame = parse_structure(
      "structure:\n  kind: shear_frame\n  storeys: 3\n  storey_height_mm: 140\n  masses: [1, 1, 0.8]\n"
      "  stiffness_ratio: [2, 1, 1]\n  stiffness_over_mass_per_s2: 16\n  data: simulated\n  dt_s: 0.01\n"
      "  frequency_sigma_percent: 0.3\n  shape_sigma: 0.05\n  floors: [a, b, c]\n",
      "frame.yaml");
  EXPECT_EQ(frame.n_storeys, 3U);
  EXPECT_EQ(*frame.storey_height_mm, 140.0);
  EXPECT_EQ(frame.mass, (std::vector<double>{1.0, 1.0, 0.8}));
  EXPECT_EQ(frame.stiffness_ratio.front(), 2.0);
  EXPECT_EQ(*frame.stiffness_over_mass_per_s2, 16.0);
  EXPECT_TRUE(frame.simulated);
  EXPECT_EQ(*frame.dt_s, 0.01);
  EXPECT_NEAR(frame.frequency_sigma, 0.003, 1e-12);
  EXPECT_EQ(frame.shape_sigma, 0.05);
  EXPECT_EQ(frame.floors.back(), "c");
}

TEST(StructureFile, DefaultsAreAUniformMeasuredFrame) {
  const auto frame = parse_structure("structure: {kind: shear_frame, storeys: 6}", "frame.yaml");
  EXPECT_TRUE(frame.mass.empty());
  EXPECT_FALSE(frame.simulated);
  EXPECT_FALSE(frame.stiffness_over_mass_per_s2);
}

TEST(StructureFile, RefusalsNameFileLineKeyValueAndRemedy) {
  const std::pair<std::string, std::vector<std::string>> rows[] = {
      {"structure:\n  storeys: many\n", {"frame.yaml:2", "structure.storeys", "many", "decimal"}},
      {"structure:\n  storeys: 2.5\n", {"frame.yaml:2", "2.5", "whole"}},
      {"structure:\n  storeys: 1000\n", {"frame.yaml:2", "1000", "1 .. 100"}},
      {"structure:\n  storeyss: 3\n", {"frame.yaml:2", "structure.storeyss", "did you mean `structure.storeys`"}},
      {"structure:\n  kind: bridge\n  storeys: 2\n", {"frame.yaml:2", "bridge", "shear_frame"}},
      {"structure:\n  kind: shear_frame\n", {"structure.storeys is missing"}},
      {"structure: {storeys: 3, masses: [1, 2]}", {"masses", "2 values for 3 storeys"}},
      {"structure: {storeys: 3, masses: [1, nan, 2]}", {"masses", "nan"}},
      {"structure: {storeys: 3, masses: 7}", {"masses", "expected a list"}},
      {"structure: {storeys: 3, masses: [1, -1, 2]}", {"masses", "-1", "allowed"}},
      {"structure: {storeys: 3, dt_s: 0.1}", {"dt_s", "data: simulated"}},
      {"structure: {storeys: 3, data: guessed}", {"guessed", "measured or simulated"}},
      {"storeys: 3\n", {"no section `structure`"}},
      {"structure: {storeys: 3}\nmore: 1\n", {"frame.yaml:2", "more"}},
      {"structure: [1, 2]\n", {"no section"}},
      {"", {"empty"}}};
  for (const auto& [text, words] : rows) {
    const std::string said = refusal(text);
    for (const std::string& word : words) EXPECT_THAT(said, HasSubstr(word)) << text;
  }
}

}  // namespace
}  // namespace drivers
