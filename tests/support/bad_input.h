#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/pipeline_run.h"
#include "tests/support/service_run.h"
#include "tests/support/swaying_clip.h"

// Inputs that are refused, and how: a row runs the real service on one bad input. It must end by itself with the exit
// code of the row, name the fault and a remedy, and leave no result that contains NaN.
namespace tests::bad_input {

namespace fs = std::filesystem;

inline constexpr int kFrames = 100;
inline constexpr const char* kGoodRegions = "[{name: roof, rect: [20, 20, 80, 50]}]";

// Input of the service; empty fields get valid defaults.
struct Input {
  std::string source;
  std::string camera = "rate_hz: 25";
  std::string regions = kGoodRegions;
  std::string rest;  // further sections
  std::vector<std::string> arguments;
  std::vector<std::string> before;  // a program that starts the service
};

struct BadInput {
  std::string name;
  std::function<Input(const fs::path& folder)> make;
  int code;
  std::vector<std::string> says;  // each must be in the output
};

inline std::ostream& operator<<(std::ostream& out, const BadInput& row) { return out << row.name; }

inline Input from(const fs::path& source) {
  Input input;
  input.source = source.string();
  return input;
}

inline Input clip(const fs::path& folder, int n_frames = kFrames, const char* name = "clip.avi") {
  write_swaying_clip(folder / name, n_frames);
  return from(folder / name);
}

inline Input good(const fs::path& folder) { return clip(folder, 40); }

// Root may read and write everything unless this right is dropped.
inline std::vector<std::string> without_file_rights() {
  if (geteuid() != 0) return {};
  return {"/usr/bin/setpriv", "--bounding-set=-dac_override,-dac_read_search",
          "--inh-caps=-dac_override,-dac_read_search"};
}

inline std::string configuration(const Input& input) {
  return "camera: {source: '" + input.source + "', " + input.camera + "}\nregions: " + input.regions + "\n" +
         input.rest + "spectrum: {segment: 32}\ntelemetry: {lcm_url: ''}\n";
}

inline bool has_word(const std::string& text, const std::string& word) {
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const auto is_letter = [&](std::size_t i) {
      return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0;
    };
    if (!is_letter(at + word.size()) && (at == 0 || !is_letter(at - 1))) return true;
  }
  return false;
}

inline void expect_no_nan(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    const auto extension = file.path().extension();
    if (extension != ".json" && extension != ".csv") continue;
    const std::string text = file_text(file.path());
    for (const char* word : {"nan", "NaN", "inf", "Infinity"})
      EXPECT_FALSE(has_word(text, word)) << file.path() << ": " << word;
    EXPECT_TRUE(extension == ".csv" || json_of(file.path()).is_object()) << file.path();
  }
}

inline void expect_as_told(const BadInput& row) {
  const fs::path folder = own_folder();
  const Input input = row.make(folder);
  for (const std::string& program : input.before) {
    if (program.front() == '/' && !fs::exists(program)) GTEST_SKIP() << "needs " << program << " (util-linux)";
  }
  write_text_file(folder / "config.yaml", configuration(input));
  std::vector<std::string> arguments{"--config", (folder / "config.yaml").string(), "--report",
                                     (folder / "report").string()};
  if (std::find(input.arguments.begin(), input.arguments.end(), "--report") != input.arguments.end())
    arguments.resize(2);
  arguments.insert(arguments.end(), input.arguments.begin(), input.arguments.end());
  const ServiceRun run = run_service(arguments, input.before, 60);
  EXPECT_EQ(run.code, row.code) << run.output;
  for (const std::string& text : row.says) EXPECT_THAT(run.output, ::testing::HasSubstr(text));
  expect_no_nan(folder / "report");
  EXPECT_FALSE(row.code == 2 && fs::exists(folder / "report" / "modal.json"));
}

inline std::string name_of(const ::testing::TestParamInfo<BadInput>& info) { return info.param.name; }

}  // namespace tests::bad_input
