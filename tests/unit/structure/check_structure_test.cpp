#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/places.h"

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string text;
};

Outcome check(const fs::path& root) {
  const std::string command = "'" + tests::source_path("tools/check_structure.sh") + "' '" + root.string() + "' 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) outcome.text += buffer.data();
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

// A small tree that keeps every rule; each test plants one violation.
class CheckStructure : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(::testing::TempDir()) / "check_structure" /
            ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(root_);
    for (const char* header :
         {"core/types/frame.h", "core/closure/model.h", "core/simulation/scene.h", "rt/spsc_ring.h", "rt/clock.h",
          "rt/stage.h", "drivers/camera/camera.h", "firmware_app/service/pipeline.h",
          "firmware_app/service/stages/items.h", "tools/hovermodal/commands.h"}) {
      write(header, "#pragma once\n");
    }
    write("drivers/camera/synthetic_camera.cpp",
          "#include \"core/simulation/scene.h\"\n#include \"core/types/frame.h\"\n#include \"rt/clock.h\"\n");
    write("tools/hovermodal/replay.cpp",
          "#include \"drivers/camera/camera.h\"\n#include \"firmware_app/service/pipeline.h\"\n");
  }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }

  // Plants a file; expects the check to fail at exactly that place.
  void expect_refused(const std::string& path, const std::string& text, int line) {
    write(path, text);
    const Outcome outcome = check(root_);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.rfind(path + ":" + std::to_string(line) + ": ", 0), 0U) << outcome.text;
    EXPECT_NE(outcome.text.find("1 violations"), std::string::npos) << outcome.text;
  }

  fs::path root_;
};

TEST_F(CheckStructure, AcceptsATreeThatKeepsTheRules) {
  const Outcome outcome = check(root_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
}

TEST_F(CheckStructure, RefusesCoreThatIncludesRt) {
  expect_refused("core/geometry/scale.cpp", "// scale\n#include \"rt/clock.h\"\n", 2);
}

TEST_F(CheckStructure, RefusesRtThatIncludesCore) {
  expect_refused("rt/memory.cpp", "#include \"core/types/frame.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesSimulationThatKnowsTheClosure) {
  expect_refused("core/simulation/effects.cpp", "#include \"core/closure/model.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesAClockInCore) {
  expect_refused("core/geometry/scale.cpp", "#include <vector>\n#include <chrono>\n", 2);
}

TEST_F(CheckStructure, RefusesADriverThatKnowsStages) {
  expect_refused("drivers/camera/recording/file_camera.cpp", "#include \"rt/stage.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesSimulationInAnyOtherDriver) {
  expect_refused("drivers/camera/recording/file_camera.cpp", "#include \"core/simulation/scene.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesAToolThatKnowsStages) {
  expect_refused("tools/hovermodal/spy/spy.cpp", "\n\n#include \"firmware_app/service/stages/items.h\"\n", 3);
}

TEST_F(CheckStructure, RefusesAChainThatKnowsThreads) {
  expect_refused("firmware_app/chain/diagnosis.h", "#pragma once\n#include \"rt/spsc_ring.h\"\n", 2);
}

TEST_F(CheckStructure, RefusesAChainThatKnowsItsStages) {
  expect_refused("firmware_app/chain/diagnosis.cpp", "#include \"firmware_app/service/stages/items.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesAServiceThatKnowsTools) {
  expect_refused("firmware_app/service/main.cpp", "#include \"tools/hovermodal/commands.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesAnIncludeThatIsNotWrittenFromTheRoot) {
  expect_refused("core/geometry/scale.cpp", "#include \"../types/frame.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesAnIncludeOfNoFile) {
  expect_refused("core/geometry/scale.cpp", "#include \"core/types/nothing.h\"\n", 1);
}

TEST_F(CheckStructure, RefusesAHeaderWithoutPragmaOnce) {
  expect_refused("core/types/region.h", "namespace core {}\n", 1);
}

TEST_F(CheckStructure, RefusesTheNamespaceOfAnotherRoom) {
  expect_refused("rt/memory.cpp", "\nnamespace core {\n}\n", 2);
  fs::remove(root_ / "rt/memory.cpp");
  expect_refused("core/closure/model.cpp", "namespace core {\n}\n", 1);
}

TEST_F(CheckStructure, AcceptsTheRoomsOwnNamespace) {
  write("core/geometry/scale.cpp", "namespace core {\nnamespace scale_kernels {\n}\n}\n");
  write("core/closure/model.cpp", "namespace core::closure {\n}\n");
  write("firmware_app/service/run.cpp", "namespace fs = std::filesystem;\nnamespace app {\nnamespace {\n}\n}\n");
  const Outcome outcome = check(root_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
}

TEST_F(CheckStructure, RefusesTheThreeHundredAndFirstLine) {
  std::string text;
  for (int line = 0; line < 300; ++line) text += "\n";
  write("core/types/long.cpp", text);
  EXPECT_EQ(check(root_).exit_code, 0);
  expect_refused("core/types/long.cpp", text + "\n", 301);
}

TEST_F(CheckStructure, RefusesAnOpenEnd) { expect_refused("rt/memory.cpp", std::string("\n// TO") + "DO: later\n", 2); }

TEST_F(CheckStructure, RefusesAPathOfOneMachine) {
  expect_refused("tools/cmake/Flags.cmake", std::string("set(DATA /ho") + "me/someone/data)\n", 1);
}

TEST_F(CheckStructure, SaysWhenThereIsNothingToCheck) {
  fs::create_directories(root_ / "empty");
  const Outcome outcome = check(root_ / "empty");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.text.find("no source folder"), std::string::npos) << outcome.text;
}

}  // namespace
