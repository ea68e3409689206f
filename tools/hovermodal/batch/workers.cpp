#include "tools/hovermodal/batch/workers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

extern char** environ;

namespace tools {

namespace {

namespace fs = std::filesystem;

std::string last_line(const fs::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  constexpr std::string_view kPrefix = "hovermodal: ";
  return last.starts_with(kPrefix) ? last.substr(kPrefix.size()) : last;
}

std::string failure_of(int status, const fs::path& into) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("its process was ended by signal {} ({}){}", signal, ::strsignal(signal),
                       signal == SIGKILL ? ": was memory short?" : "");
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 0) return fs::exists(into / kSumsFile) ? "" : "its process ended without a result";
  const std::string said = last_line(into / kLogFile);
  return said.empty() ? fmt::format("its process ended with exit code {}", code) : said;
}

// stdin is empty, stdout and stderr go to the log.
pid_t spawn(const std::string& program, std::vector<std::string> arguments, const std::string& log) {
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::posix_spawn_file_actions_adddup2(&files, 1, 2);
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, program.c_str(), &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::system_error(error, std::generic_category(), program);
  return pid;
}

}  // namespace

LocalWorkers::LocalWorkers(std::string program, int n_jobs)
    : program_(std::move(program)), n_jobs_(static_cast<std::size_t>(std::max(1, n_jobs))) {}

LocalWorkers::~LocalWorkers() {
  for (const Running& one : running_) {
    ::kill(one.pid, SIGKILL);
    ::waitpid(one.pid, nullptr, 0);
  }
}

void LocalWorkers::start(std::size_t number, const FlightOrder& order) {
  try {
    const fs::path into = order.into;
    fs::create_directories(into);
    fs::remove(into / kSumsFile);
    fs::remove(into / kModesFile);
    running_.push_back({number, spawn(program_, arguments_of(order), (into / kLogFile).string()), order.into});
  } catch (const std::exception& e) {
    not_started_.push_back({number, std::string("cannot be started: ") + e.what()});
  }
}

std::optional<FlightEnd> LocalWorkers::poll() {
  if (!not_started_.empty()) {
    FlightEnd end = std::move(not_started_.back());
    not_started_.pop_back();
    return end;
  }
  for (std::size_t i = 0; i < running_.size(); ++i) {
    int status = 0;
    if (::waitpid(running_[i].pid, &status, WNOHANG) != running_[i].pid) continue;
    const Running one = std::move(running_[i]);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    return FlightEnd{one.number, failure_of(status, one.into)};
  }
  return std::nullopt;
}

}  // namespace tools
