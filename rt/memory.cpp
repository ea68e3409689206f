#include "rt/memory.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>

namespace rt {

std::string lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::string("locking memory refused (") + std::strerror(errno) +
         "): grant CAP_IPC_LOCK or raise RLIMIT_MEMLOCK";
}

}  // namespace rt
