#include "drivers/host/instruction_counter.h"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace drivers {

InstructionCounter::InstructionCounter() {
  perf_event_attr event{};
  event.size = sizeof event;
  event.type = PERF_TYPE_HARDWARE;
  event.config = PERF_COUNT_HW_INSTRUCTIONS;
  event.inherit = 1;
  event.exclude_kernel = event.exclude_hv = 1;
  constexpr int kThisProcess = 0, kAnyProcessor = -1, kNoGroup = -1;
  descriptor_ = static_cast<int>(::syscall(SYS_perf_event_open, &event, kThisProcess, kAnyProcessor, kNoGroup,
                                           static_cast<unsigned long>(PERF_FLAG_FD_CLOEXEC)));
  if (descriptor_ >= 0) return;
  why_not_ = errno == EACCES || errno == EPERM
                 ? "the kernel does not permit it; as root: sysctl kernel.perf_event_paranoid=2"
                 : "this processor, or the virtual machine, has no counter of instructions";
}

InstructionCounter::~InstructionCounter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<std::uint64_t> InstructionCounter::count() const {
  std::uint64_t n = 0;
  if (descriptor_ < 0 || ::read(descriptor_, &n, sizeof n) != static_cast<ssize_t>(sizeof n)) return {};
  return n;
}

}  // namespace drivers
