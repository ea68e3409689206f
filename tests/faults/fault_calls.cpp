// Preloaded into a program (LD_PRELOAD): its n-th call to the kernel's file functions, or to the allocator, fails.
//   HOVERMODAL_FAULT=KIND:N       KIND as in kKinds; N = 0: calls are counted and none fails
//   HOVERMODAL_FAULT_COUNT=FILE   receives a Count, kept up to date while the program runs, so that it survives a crash
// File functions are trapped at the kernel's door (seccomp, SIGSYS), so that calls from inside of libc and of every
// library are seen; counting begins at main(). Descriptors 0 to 2 never fail. The allocator's n-th call is the n-th
// place in the program (return address) that allocates for the first time, or an allocation of 32 KiB or more.
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>

#include "tests/faults/fault_kinds.h"

// The one instruction by which trapped calls are made for good; the filter lets it pass.
asm(R"(
.text
.globl hovermodal_fault_call
.type hovermodal_fault_call, @function
hovermodal_fault_call:
  movq %rdi, %rax
  movq %rsi, %rdi
  movq %rdx, %rsi
  movq %rcx, %rdx
  movq %r8, %r10
  movq %r9, %r8
  movq 8(%rsp), %r9
  syscall
.globl hovermodal_fault_call_end
hovermodal_fault_call_end:
  ret
)");
extern "C" long hovermodal_fault_call(long number, long a, long b, long c, long d, long e, long f);
extern "C" char hovermodal_fault_call_end;

namespace faults {
namespace {

struct Call {
  long number;
  Calls calls;
  bool is_of_descriptor;  // its first argument
};
constexpr std::array kCalls{
    Call{SYS_read, kRead, true},        Call{SYS_pread64, kRead, true},     Call{SYS_readv, kRead, true},
    Call{SYS_write, kWrite, true},      Call{SYS_pwrite64, kWrite, true},   Call{SYS_writev, kWrite, true},
    Call{SYS_open, kOpen, false},       Call{SYS_openat, kOpen, false},     Call{SYS_creat, kOpen, false},
    Call{SYS_socket, kOpen, false},     Call{SYS_eventfd2, kOpen, false},   Call{SYS_pipe2, kOpen, false},
    Call{SYS_dup, kOpen, false},        Call{SYS_fallocate, kGrow, true},   Call{SYS_ftruncate, kGrow, true},
    Call{SYS_mkdir, kGrow, false},      Call{SYS_mkdirat, kGrow, false},    Call{SYS_rename, kGrow, false},
    Call{SYS_renameat, kGrow, false},   Call{SYS_renameat2, kGrow, false},  Call{SYS_link, kGrow, false},
    Call{SYS_unlink, kRemove, false},   Call{SYS_unlinkat, kRemove, false}, Call{SYS_rmdir, kRemove, false},
    Call{SYS_fsync, kSync, true},       Call{SYS_fdatasync, kSync, true},   Call{SYS_close, kClose, true},
    Call{SYS_stat, kLook, false},       Call{SYS_lstat, kLook, false},      Call{SYS_fstat, kLook, true},
    Call{SYS_newfstatat, kLook, false}, Call{SYS_statx, kLook, false},      Call{SYS_access, kLook, false},
    Call{SYS_getdents64, kLook, true},  Call{SYS_flock, kLock, true}};

const Call* call_of(long number) {
  for (const Call& call : kCalls) {
    if (call.number == number) return &call;
  }
  return nullptr;
}

bool changes_file(long number, const long* a) {
  if (number == SYS_open) return (a[1] & (O_WRONLY | O_RDWR | O_CREAT)) != 0;
  if (number == SYS_openat) return (a[2] & (O_WRONLY | O_RDWR | O_CREAT)) != 0;
  return number == SYS_creat;
}

void note(long number, const long* a) {
  if (count->n_failed++ != 0) return;
  count->call = number;
  const bool has_path = number == SYS_open || number == SYS_mkdir || number == SYS_unlink || number == SYS_stat ||
                        number == SYS_rename || number == SYS_access || number == SYS_rmdir;
  const bool has_path_at = number == SYS_openat || number == SYS_unlinkat || number == SYS_newfstatat;
  const char* path = has_path      ? reinterpret_cast<const char*>(a[0])
                     : has_path_at ? reinterpret_cast<const char*>(a[1])
                                   : nullptr;
  if (path != nullptr) {
    std::strncpy(count->what.data(), path, count->what.size() - 1);
  } else if (call_of(number)->is_of_descriptor) {
    std::array<char, 64> link{};
    std::size_t n = 0;
    for (const char c : std::string_view("/proc/self/fd/")) link[n++] = c;
    std::array<char, 20> digits{};
    std::size_t n_digits = 0;
    for (long fd = a[0]; fd > 0; fd /= 10) digits[n_digits++] = static_cast<char>('0' + fd % 10);
    while (n_digits > 0) link[n++] = digits[--n_digits];
    const long got = hovermodal_fault_call(SYS_readlink, reinterpret_cast<long>(link.data()),
                                           reinterpret_cast<long>(count->what.data()),
                                           static_cast<long>(count->what.size() - 1), 0, 0, 0);
    if (got < 0) count->what[0] = '?';
  }
}

long make(long number, const long* a) { return hovermodal_fault_call(number, a[0], a[1], a[2], a[3], a[4], a[5]); }

long fail(long number, const Call& call, long* a) {
  note(number, a);
  if (kind->name == "slow") {
    const timespec pause{0, 300'000'000};
    nanosleep(&pause, nullptr);
    return make(number, a);
  }
  if (kind->name == "short") {
    if (number != SYS_readv && number != SYS_writev && a[2] > 1) a[2] /= 2;
    return make(number, a);
  }
  if (call.calls == kClose) (void)make(number, a);  // the descriptor is gone in any case
  return -kind->error;
}

long decide(long number, long* a) {
  const Call* call = call_of(number);
  if (!is_counting.load(std::memory_order_relaxed) || call == nullptr || (kind->calls & call->calls) == 0 ||
      (call->is_of_descriptor && a[0] <= 2) || (kind->needs_change && call->calls == kOpen && !changes_file(number, a)))
    return make(number, a);
  return is_hit(next_number()) ? fail(number, *call, a) : make(number, a);
}

void on_trap(int, siginfo_t*, void* context) {
  const int kept = errno;
  auto& r = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  std::array<long, 6> a{r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10], r[REG_R8], r[REG_R9]};
  r[REG_RAX] = decide(static_cast<long>(r[REG_RAX]), a.data());
  errno = kept;
}

void install_filter() {
  struct sigaction action {};
  action.sa_sigaction = on_trap;
  action.sa_flags = SA_SIGINFO | SA_NODEFER | SA_RESTART;
  sigaction(SIGSYS, &action, nullptr);
  static std::array<sock_filter, 2 * kCalls.size() + 8> program;
  std::size_t n = 0;
  const auto end = reinterpret_cast<std::uint64_t>(&hovermodal_fault_call_end);
  // Calls from the one instruction pass: its address is that of the following instruction.
  program[n++] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, instruction_pointer));
  program[n++] = BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(end), 0, 3);
  program[n++] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, instruction_pointer) + 4);
  program[n++] = BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(end >> 32U), 0, 1);
  program[n++] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  program[n++] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (const Call& call : kCalls) {
    if ((kind->calls & call.calls) == 0) continue;
    program[n++] = BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call.number), 0, 1);
    program[n++] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  }
  program[n++] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  const sock_fprog filter{static_cast<unsigned short>(n), program.data()};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) _exit(125);
}

void take_orders() {
  const char* order = std::getenv("HOVERMODAL_FAULT");
  if (order == nullptr) return;
  const std::string_view text(order);
  const std::size_t colon = text.find(':');
  for (const Kind& known : kKinds) {
    if (known.name == text.substr(0, colon)) kind = &known;
  }
  if (kind == nullptr || colon == text.npos) _exit(125);
  nth = std::strtoull(order + colon + 1, nullptr, 10);
  if (const char* file = std::getenv("HOVERMODAL_FAULT_COUNT")) {
    const int descriptor = ::open(file, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0 || ::ftruncate(descriptor, sizeof(FaultCount)) != 0) _exit(125);
    void* shared = ::mmap(nullptr, sizeof(FaultCount), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    if (shared == MAP_FAILED) _exit(125);
    count = new (shared) FaultCount;
  }
  if ((kind->calls & ~kMemory) != 0) install_filter();
  is_counting.store(true, std::memory_order_relaxed);
}

}  // namespace
}  // namespace faults

extern "C" {
int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  using Start = int (*)(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  static int (*real_main)(int, char**, char**) = nullptr;
  real_main = main;
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(
      [](int n, char** arguments, char** environment) {
        faults::take_orders();
        const int code = real_main(n, arguments, environment);
        faults::is_counting.store(false, std::memory_order_relaxed);
        return code;
      },
      argc, argv, init, fini, rtld_fini, stack_end);
}
}
