#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "drivers/host/command_line.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {

// Nothing reaches standard output while this exists.
class Silence {
 public:
  Silence() : kept_(::dup(STDOUT_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    std::fflush(stdout);
    ::dup2(nowhere, STDOUT_FILENO);
    ::close(nowhere);
  }
  ~Silence() {
    std::fflush(stdout);
    ::dup2(kept_, STDOUT_FILENO);
    ::close(kept_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_;
};

// An empty folder, removed with what is in it. In memory where that is possible: reports are brought to the disk.
class Folder {
 public:
  Folder() : path_((place() / "fuzzXXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw std::system_error(errno, std::generic_category(), path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  static std::filesystem::path place() {
    constexpr const char* kMemory = "/dev/shm";
    return ::access(kMemory, W_OK) == 0 ? kMemory : std::filesystem::temp_directory_path();
  }
  std::string path_;
};

// One subcommand of `hovermodal` in this process, as its main() runs it. Returns what it refuses with; empty: it came
// to its end.
inline std::string run_program(void (*add)(drivers::Command&), const std::vector<std::string>& arguments) {
  drivers::CommandLine program{"hovermodal"};
  add(program);
  std::vector<const char*> words{"hovermodal"};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  try {
    const auto code = program.parse(static_cast<int>(words.size()), words.data());
    return code.value_or(0) == 0 ? "" : "the command line is refused";
  } catch (const Violation&) {
    throw;
  } catch (const std::exception& refusal) {
    require(*refusal.what() != '\0', "a refusal says why");
    return refusal.what();
  }
}

}  // namespace tests::fuzz
