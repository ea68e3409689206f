#include "firmware_app/report/earlier_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "drivers/storage/text_file.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"

namespace {

namespace fs = std::filesystem;

class EarlierFiles : public tests::FolderTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] std::string text_of(const std::string& name) const { return tests::read(folder_ / name); }
  void keep() const { app::keep_earlier(folder_.string(), "closure", {"closure.json", "structure_*"}); }
};

TEST_F(EarlierFiles, TheFilesOfAResultMoveTogetherAndOthersStay) {
  write("closure.json", "old");
  write("structure_place_1.svg", "picture");
  write("modal.json", "a run's");
  keep();
  EXPECT_FALSE(fs::exists(folder_ / "closure.json"));
  EXPECT_EQ(text_of("closure.1/closure.json"), "old");
  EXPECT_EQ(text_of("closure.1/structure_place_1.svg"), "picture");
  EXPECT_EQ(text_of("modal.json"), "a run's");
}

TEST_F(EarlierFiles, ThreeAreKeptAndTheNewestIsNumberOne) {
  for (const char* text : {"1", "2", "3", "4"}) {
    write("closure.json", text);
    keep();
  }
  keep();  // nothing to keep: nothing is renumbered
  EXPECT_EQ(text_of("closure.1/closure.json"), "4");
  EXPECT_EQ(text_of("closure.3/closure.json"), "2");
  EXPECT_FALSE(fs::exists(folder_ / "closure.4"));
}

TEST_F(EarlierFiles, WhatAnInterruptedCallLeftIsKeptWithTheRest) {
  write("closure.replaced/closure.json", "old");
  write("structure_shapes.svg", "picture");
  keep();
  EXPECT_EQ(text_of("closure.1/closure.json"), "old");
  EXPECT_EQ(text_of("closure.1/structure_shapes.svg"), "picture");
  EXPECT_FALSE(fs::exists(folder_ / "closure.replaced"));
}

TEST_F(EarlierFiles, AFolderThatCannotBeMadeIsNamed) {
  write("closure.json", "old");
  write("closure.replaced", "a file");
  try {
    keep();
    FAIL() << "the earlier result was not kept";
  } catch (const drivers::FileError& error) {
    EXPECT_NE(std::string(error.what()).find(folder_.string()), std::string::npos) << error.what();
  }
  EXPECT_EQ(text_of("closure.json"), "old");
}

}  // namespace
