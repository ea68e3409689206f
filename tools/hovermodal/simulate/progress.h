#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace tools {

// Progress of a long job, on standard error: a line that rewrites itself on a terminal, a line per 10 % elsewhere;
// quiet: nothing.
class Progress {
 public:
  Progress(std::string what, std::uint64_t total, std::string unit = "frames", bool is_quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint64_t done);
  void say(const std::string& text);  // prints a separate line
  [[nodiscard]] double elapsed_s() const;

 private:
  void print(std::uint64_t done);

  using Clock = std::chrono::steady_clock;
  std::string what_, unit_;
  std::uint64_t total_;
  bool terminal_, quiet_;
  bool line_open_ = false;
  Clock::time_point start_ = Clock::now(), last_print_{};
  std::uint64_t last_tenth_ = 0;
};

}  // namespace tools
