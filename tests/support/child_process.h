#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "tests/support/patience.h"

namespace tests {

// A program with its stdout and stderr on one pipe. Killed and reaped when this goes out of scope.
class ChildProcess {
 public:
  explicit ChildProcess(std::vector<std::string> arguments) {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(ends[1]);
    out_ = ends[0];
  }
  ~ChildProcess() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    if (out_ >= 0) close(out_);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Reads until `text` was written; false if the program ended or the time ran out.
  bool wait_for(const std::string& text, int patience_s = 30) {
    return read_until([&] { return output_.find(text) != output_.npos; }, patience_s);
  }

  // Reads to the end; returns the exit code, 128 + signal, or -1 if it did not end (it is then killed).
  int wait_for_exit(int patience_s = 60) {
    if (!read_until([&] { return at_end_; }, patience_s)) ::kill(pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    if (!at_end_) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  // Waits until the threads of that name have used so much processor time; false if the time ran out.
  [[nodiscard]] bool wait_until_busy(const std::string& thread, double cpu_s, int patience_s = 30) {
    bool is_busy = false;
    (void)read_until([&] { return is_busy = cpu_of(thread) >= cpu_s; }, patience_s);
    return is_busy;
  }

  void signal(int number) const { ::kill(pid_, number); }
  [[nodiscard]] const std::string& output() const { return output_; }

 private:
  [[nodiscard]] double cpu_of(const std::string& thread) const {
    double ticks = 0.0;
    std::error_code gone;
    const std::filesystem::path tasks = "/proc/" + std::to_string(pid_) + "/task";
    for (const auto& task : std::filesystem::directory_iterator(tasks, gone)) {
      std::string stat;
      std::getline(std::ifstream(task.path() / "stat"), stat);
      const std::size_t begin = stat.find('('), end = stat.rfind(')');
      if (end == stat.npos || stat.substr(begin + 1, end - begin - 1) != thread) continue;
      std::istringstream fields(stat.substr(end + 1));
      std::string field;
      for (int i = 3; i < 14; ++i) fields >> field;  // proc(5): field 3 follows the name, 14 and 15 are the times
      double user = 0.0, system = 0.0;
      fields >> user >> system;
      ticks += user + system;
    }
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  template <class Done>
  bool read_until(Done done, int patience_s) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(patience_s) * kSlowdown;
    while (!done()) {
      if (at_end_ || std::chrono::steady_clock::now() > deadline) return false;
      pollfd waiting{out_, POLLIN, 0};
      if (poll(&waiting, 1, 100) <= 0) continue;
      std::array<char, 4096> buffer{};
      const auto n = read(out_, buffer.data(), buffer.size());
      if (n <= 0) at_end_ = true;
      if (n > 0) output_.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return true;
  }

  pid_t pid_ = -1;
  int out_ = -1;
  bool at_end_ = false;
  std::string output_;
};

}  // namespace tests
