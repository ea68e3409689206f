#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/places.h"

namespace tests {

inline const std::string kService = program("hovermodald");
inline const std::string kTools = program("hovermodal");

struct ServiceRun {
  int code = -1;  // 128 + signal when it was killed, -1 when it hung
  std::string output;
};

// Runs hovermodald to its end; `before` is a program with arguments that starts it, e.g. prlimit.
inline ServiceRun run_service(const std::vector<std::string>& arguments, std::vector<std::string> before = {},
                              int patience_s = 90) {
  before.emplace_back(kService);
  before.insert(before.end(), arguments.begin(), arguments.end());
  ChildProcess child(before);
  ServiceRun run;
  run.code = child.wait_for_exit(patience_s);
  run.output = child.output();
  return run;
}

inline void write_text_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline nlohmann::json json_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in, nullptr, false);
}

// Rendered once and shared by all tests, processes and build folders of this user: `hovermodal simulate` does not
// repeat a complete folder. The lock keeps two processes from rendering at once. Contains clip.mp4, config.yaml,
// truth.json.
inline const std::filesystem::path& simulated_folder() {
  static const std::filesystem::path folder = [] {
    const auto made = std::filesystem::path(::testing::TempDir()) / ("hovermodal_clip_" + std::to_string(getuid()));
    std::filesystem::create_directories(made);
    const int lock = open((made / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    flock(lock, LOCK_EX);
    ChildProcess simulate({kTools, "simulate", "--size", "480x270", "--duration", "24", "--out", made.string()});
    const int code = simulate.wait_for_exit(120);
    close(lock);
    if (code != 0) throw std::runtime_error("hovermodal simulate: " + simulate.output());
    return made;
  }();
  return folder;
}

}  // namespace tests
