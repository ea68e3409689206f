// Stops one thread of a running process in the middle of its work until the process ends: simulates a stage that hangs,
// so that the service itself needs no test code for it. Needs root; for tests in the virtual machine
// (cases/systemd.sh).
//   hold_thread PID THREAD_NAME
#include <dirent.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

namespace {

// The thread's id, 0 if the process has no thread of that name.
pid_t thread_of(const std::string& pid, const std::string& name) {
  const std::string tasks = "/proc/" + pid + "/task";
  DIR* folder = opendir(tasks.c_str());
  if (folder == nullptr) return 0;
  pid_t found = 0;
  while (const dirent* entry = readdir(folder)) {
    std::ifstream file(tasks + "/" + entry->d_name + "/comm");
    std::string its_name;
    if (std::getline(file, its_name) && its_name == name) found = static_cast<pid_t>(std::atol(entry->d_name));
  }
  closedir(folder);
  return found;
}

// Stops the thread; true unless it was only waiting for work (a waiting thread is idle, not hung).
bool stopped_at_work(pid_t thread) {
  if (ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) != 0) return false;
  int status = 0;
  if (waitpid(thread, &status, __WALL) != thread || !WIFSTOPPED(status)) return false;
  user_regs_struct registers{};
  if (ptrace(PTRACE_GETREGS, thread, nullptr, &registers) != 0) return false;
  return static_cast<long>(registers.orig_rax) != SYS_futex;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("hold_thread PID THREAD_NAME\n", stderr);
    return 2;
  }
  const pid_t thread = thread_of(argv[1], argv[2]);
  if (thread == 0 || ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0) {
    std::fprintf(stderr, "hold_thread: %s of %s: %s\n", argv[2], argv[1],
                 thread == 0 ? "no such thread" : std::strerror(errno));
    return 1;
  }
  for (int i = 0; !stopped_at_work(thread); ++i) {
    if (i == 2000 || ptrace(PTRACE_CONT, thread, nullptr, nullptr) != 0) {
      std::fputs("hold_thread: the thread was never met at work\n", stderr);
      return 1;
    }
    usleep(7000);
  }
  std::puts("held");
  std::fflush(stdout);
  int status = 0;
  while (waitpid(thread, &status, __WALL) == thread && !WIFEXITED(status) && !WIFSIGNALED(status)) {
  }
  return 0;
}
