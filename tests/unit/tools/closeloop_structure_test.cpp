#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/answers.h"
#include "tests/support/folder_test.h"

// Declarations and modes that cannot be compared, and what is said of them, as a user runs `closeloop --structure`.
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kTower =
    "structure:\n  kind: tower\n  height_m: 30\n  ei_nm2: 3.0e8\n  mass_per_m_kg: 160\n  parts: 4\n";
constexpr const char* kHead = "%%MatrixMarket matrix coordinate real ";

class CloseloopStructure : public tests::FolderTest {
 protected:
  void write(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  // What the program says of these modes; its exit code must be `expected`.
  [[nodiscard]] std::string told(const std::string& structure, const std::string& modes, int expected) const {
    write("s.yaml", structure), write("modes.csv", modes);
    const auto run = tests::run_apart("closeloop --structure " + (folder_ / "s.yaml").string() + " --reference " +
                                      (folder_ / "modes.csv").string());
    EXPECT_EQ(run.exit_code, expected) << run.out << run.err;
    return run.out + run.err;
  }
  // Of three masses on springs, K and M given.
  [[nodiscard]] std::string of_matrices(const std::string& k, const std::string& m, int expected,
                                        const char* dof = "3") const {
    write("k.mtx", kHead + k), write("m.mtx", kHead + m);
    write("upper.mtx", kHead + std::string("symmetric\n3 3 3\n2 2 100\n3 2 -100\n3 3 100\n"));
    return told(std::string("structure:\n  kind: matrices\n  k: k.mtx\n  m: m.mtx\n"
                            "  groups: [{name: upper, k: upper.mtx}]\n  regions: [{name: roof, dofs: [") +
                    dof + "]}]\n",
                "frequency_hz\n0.6919\n1.7806\n2.7379\n", expected);
  }
};

const std::string kStiffness = "symmetric\n3 3 5\n1 1 200\n2 1 -100\n2 2 200\n3 2 -100\n3 3 100\n";
const std::string kMass = "symmetric\n3 3 3\n1 1 1\n2 2 1\n3 3 1\n";

TEST_F(CloseloopStructure, UnitsAThousandTimesWrongAreNamed) {
  EXPECT_THAT(told(std::string(kTower) + "  stiffness: known\n", "frequency_hz\n850\n5300\n14900\n", 1),
              AllOf(HasSubstr("fewer than two are modes of the model"), HasSubstr("check the units")));
  EXPECT_THAT(told(kTower, "frequency_hz\n850\n5300\n14900\n29200\n", 0),
              AllOf(HasSubstr("times the declared one: check the units"), HasSubstr("mode  reference Hz")));
  EXPECT_THAT(of_matrices("symmetric\n3 3 3\n1 1 1e19\n2 2 1e19\n3 3 1e19\n", kMass, 1), HasSubstr("units of K and M"));
}

TEST_F(CloseloopStructure, MatricesOfNoStructureAreRefusedInWords) {
  EXPECT_THAT(of_matrices(kStiffness, kMass, 0), HasSubstr("soft_part"));
  EXPECT_THAT(of_matrices("general\n3 3 4\n1 1 200\n1 2 -100\n2 2 200\n3 3 100\n", kMass, 1),
              HasSubstr("is not symmetric: elements 2, 1 and 1, 2"));
  EXPECT_THAT(of_matrices(kStiffness, "symmetric\n2 2 2\n1 1 1\n2 2 1\n", 1), HasSubstr("same degrees of freedom"));
  EXPECT_THAT(of_matrices("symmetric\n3 3 4\n1 1 100\n2 1 -200\n2 2 100\n3 3 100\n", kMass, 1),
              HasSubstr("positive definite"));
  EXPECT_THAT(of_matrices(kStiffness, kMass, 1, "30"), HasSubstr("names degree of freedom 30; there are 3"));
}

TEST_F(CloseloopStructure, AMasslessDegreeOfFreedomIsCondensed) {
  EXPECT_THAT(of_matrices(kStiffness, "symmetric\n3 3 2\n1 1 1\n3 3 1\n", 0), HasSubstr("level structure"));
}

TEST_F(CloseloopStructure, WithFewerModesThanParametersTheErrorsAreStillSaid) {
  EXPECT_THAT(told(kTower, "frequency_hz\n0.85\n5.3\n", 0),
              AllOf(HasSubstr("cannot be fitted with a mode left out; measure more modes"),
                    HasSubstr("no effect adopted"), HasSubstr("mode  reference Hz")));
  EXPECT_THAT(told(kTower, "frequency_hz\n0.85\n", 1), HasSubstr("two or more are needed to leave one out"));
}

TEST_F(CloseloopStructure, DampingOverFrequencyNamesItsMechanism) {
  EXPECT_THAT(told(kTower,
                   "frequency_hz,damping_ratio,damping_sigma\n0.85,0.02,0.002\n5.3,0.0032,0.0003\n"
                   "14.9,0.00114,0.0001\n29.2,0.00058,0.00006\n",
                   0),
              HasSubstr("damping of 4 modes over frequency: viscous, mass-proportional"));
  EXPECT_THAT(told(kTower, "frequency_hz,damping_ratio,damping_sigma\n0.85,0.02,0.002\n5.3,0.0032,\n14.9,,0.0001\n", 0),
              HasSubstr("cannot be told from fewer than 3 modes"));
}

}  // namespace
