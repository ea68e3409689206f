#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/command.h"

namespace tests {

// A command of `hovermodal` with standard output and standard error apart.
struct Streams {
  int exit_code = -1;
  std::string out, err;
};
inline Streams run_apart(const std::string& arguments) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string errors = (std::filesystem::path(::testing::TempDir()) /
                              (std::string(test->test_suite_name()) + "_" + test->name() + ".stderr"))
                                 .string();
  const Outcome outcome =
      run("hovermodal", arguments + " 2>" + errors + " #");  // # ends the command before run()'s 2>&1
  return {outcome.exit_code, outcome.text, read(errors)};
}

// Checks --json, --quiet and both of one command that may be repeated; returns the document. `exit_code`: of each.
inline nlohmann::json expect_answers(const std::string& arguments, int exit_code = 0) {
  const Streams quiet = run_apart(arguments + " --quiet");
  EXPECT_EQ(quiet.exit_code, exit_code) << quiet.err;
  EXPECT_EQ(quiet.out, "");
  if (exit_code == 0) {
    EXPECT_EQ(quiet.err, "");
  }
  const Streams json = run_apart(arguments + " --json"), both = run_apart(arguments + " --json --quiet");
  EXPECT_EQ(json.exit_code, exit_code) << json.err;
  EXPECT_EQ(both.out, json.out);
  EXPECT_EQ(both.err, quiet.err);
  nlohmann::json document = nlohmann::json::parse(json.out, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << json.out;
  return document;
}

}  // namespace tests
