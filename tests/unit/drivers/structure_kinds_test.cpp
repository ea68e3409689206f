#include "drivers/storage/structure_kinds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "drivers/storage/limits.h"
#include "drivers/storage/matrix_market.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "tests/support/folder_test.h"

namespace drivers {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& keys) {
  try {
    (void)parse_structure("structure:\n" + keys, "s.yaml");
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StructureKinds, ReadsABeamWithItsRegions) {
  const auto declared = parse_structure(
      "structure:\n  kind: beam\n  spans: [{length_m: 10, ei_nm2: 2.0e6, mass_per_m_kg: 50, parts: 4}]\n"
      "  supports: [{rotation: rigid}, {displacement: 1.0e5}]\n  modes: 5\n  stiffness: known\n"
      "  regions: [{name: middle, at_m: [5, 0, 0], direction: [0, 0, 2]}]\n",
      "s.yaml");
  ASSERT_TRUE(declared.model);
  EXPECT_EQ(declared.model->kind(), "beam");
  EXPECT_EQ(declared.n_storeys, 5U);
  EXPECT_TRUE(declared.stiffness_over_mass_per_s2);
  EXPECT_EQ(declared.floors, std::vector<std::string>{"middle"});
  EXPECT_NEAR(declared.model->sights().front().direction.z(), 1.0, 1e-12);
}

TEST(StructureKinds, LocateSearchesTheStoreysOfAShearFrame) {
  const auto declared = parse_structure("structure: {kind: shear_frame, locate: true, masses: [1, 1, 1]}\n", "s.yaml");
  ASSERT_TRUE(declared.model);
  EXPECT_EQ(declared.model->kind(), "shear_frame");
  EXPECT_EQ(declared.n_storeys, 3U);
}

TEST(StructureKinds, RefusalsNameLineKeyAndRemedy) {
  const std::string tower = "  kind: tower\n  height_m: 30\n  ei_nm2: 3.0e8\n  mass_per_m_kg: 160\n";
  EXPECT_THAT(refusal("  kind: dome\n"), HasSubstr("s.yaml:2: structure.kind: `dome` is not known; write one of"));
  EXPECT_THAT(refusal(tower + "  hight: 3\n"), HasSubstr("s.yaml:6: structure.hight is not known"));
  EXPECT_THAT(refusal(tower + "  parts: 900\n"), HasSubstr("structure.parts: 900 is refused: allowed 1 .. 60"));
  EXPECT_THAT(refusal(tower + "  foot_rotation: soft\n"), HasSubstr("write rigid, free, or a stiffness"));
  EXPECT_THAT(refusal(tower + "  tip_mass_kg: 1.0e9\n"), HasSubstr("it buckles"));
  EXPECT_THAT(refusal(tower + "  regions: [{name: a, at_m: [0, 0, 3000]}]\n"), HasSubstr("check at_m and its unit"));
  EXPECT_THAT(refusal(tower + "  regions: [{name: a, at_m: [0, 0]}]\n"), HasSubstr("2 values, 3 are expected"));
  EXPECT_THAT(refusal("  kind: frame2d\n  nodes: [{name: a, at_m: [0, 0]}]\n"
                      "  members: [{from: a, to: z, ei_nm2: 1, ea_n: 1, mass_per_m_kg: 1}]\n"),
              HasSubstr("there is no node `z`"));
}

class MatrixMarket : public tests::FolderTest {
 protected:
  std::string refused(const std::string& text) {
    try {
      (void)read_matrix_market(file(text));
    } catch (const FileError& error) {
      return error.what();
    }
    return "accepted";
  }
};

TEST_F(MatrixMarket, ReadsCoordinatesAndArraysOfEitherSymmetry) {
  const auto a =
      read_matrix_market(file("%%MatrixMarket matrix coordinate real symmetric\n% remark\n2 2 2\n1 1 3.5\n2 1 -1e2\n"));
  EXPECT_EQ(a.coeff(0, 0), 3.5);
  EXPECT_EQ(a.coeff(0, 1), -100.0);
  EXPECT_EQ(a.coeff(1, 0), -100.0);
  const auto b = read_matrix_market(file("%%MatrixMarket matrix array real general\n2 2\n1\n2\n3\n4\n"));
  EXPECT_EQ(b.coeff(1, 0), 2.0);
  EXPECT_EQ(b.coeff(0, 1), 3.0);
  const auto c = read_matrix_market(file("%%MatrixMarket matrix array real symmetric\n2 2\n1\n2\n4"));
  EXPECT_EQ(c.coeff(0, 1), 2.0);
  EXPECT_EQ(c.coeff(1, 1), 4.0);
}

TEST_F(MatrixMarket, HostileFilesAreRefusedWithTheLine) {
  const std::string head = "%%MatrixMarket matrix coordinate real general\n";
  EXPECT_THAT(refused("1 2 3\n"), HasSubstr(":1: does not begin with %%MatrixMarket"));
  EXPECT_THAT(refused("%%MatrixMarket matrix coordinate complex general\n1 1 0\n"), HasSubstr("real numbers"));
  EXPECT_THAT(refused(head + "2 2 2\n1 1 1\n"), HasSubstr("ends after 1 of 2 entries"));
  EXPECT_THAT(refused(head + "2 2 1\n1 3 1\n"), HasSubstr(":3: column `3` is refused: allowed 1 .. 2"));
  EXPECT_THAT(refused(head + "2 2 1\n1 1 nan\n"), HasSubstr("is no finite number"));
  EXPECT_THAT(refused(head + "2 2 1\n1 1 1\n2 2 1\n"), HasSubstr("more than the 1 entries stated"));
  EXPECT_THAT(refused(head + "900000000 2 1\n1 1 1\n"), HasSubstr("rows `900000000` is refused"));
  EXPECT_THAT(refused(head + "9 9 999999999999\n"), HasSubstr("entries `999999999999` is refused"));
}

TEST_F(MatrixMarket, AFileOfTenGigabytesIsRefusedBeforeItIsRead) {
  const std::string path = file("%%MatrixMarket matrix array real general\n");
  std::filesystem::resize_file(path, 10'000'000'000);
  EXPECT_THAT([&] { (void)read_matrix_market(path); },
              testing::ThrowsMessage<FileError>(HasSubstr("more than 536870912 are refused")));
  std::filesystem::resize_file(path, 0);
}

}  // namespace
}  // namespace drivers
