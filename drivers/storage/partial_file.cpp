#include "drivers/storage/partial_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace drivers {

int open_new_file(const char* path) noexcept {
  (void)::unlink(path);
  return ::open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
}

bool sync_to_disk(int descriptor) noexcept {
  for (;;) {
    if (::fsync(descriptor) == 0 || errno == EINVAL) return true;
    if (errno != EINTR) return false;
  }
}

}  // namespace drivers
