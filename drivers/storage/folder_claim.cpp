#include "drivers/storage/folder_claim.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <system_error>
#include <utility>

#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using FolderId = std::pair<dev_t, ino_t>;

struct Claims {
  std::mutex mutex;
  std::map<FolderId, std::weak_ptr<FolderClaim>> held;
};

Claims& claims_of_process() {
  static Claims claims;
  return claims;
}

// "by process 123 (hovermodald)", from the kernel's list of locks. Some file systems list another device than stat
// does, hence the inode alone.
std::string owner_words(ino_t inode) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream cells(line);
    std::string number, kind, mode, access, place;
    long pid = 0;
    if (!(cells >> number >> kind >> mode >> access >> pid >> place) || kind != "FLOCK" || pid <= 0) continue;
    if (place.substr(place.rfind(':') + 1) != std::to_string(inode)) continue;
    std::string name;
    std::ifstream command(fmt::format("/proc/{}/comm", pid));
    if (std::getline(command, name)) name = " (" + printable(name) + ")";
    return fmt::format("by process {}{}", pid, name);
  }
  return "by another process";
}

void make_folder(const std::string& folder, const std::string& key) {
  std::error_code error;
  const std::string name = printable(folder, 200);
  if (folder.empty()) throw FileError(key + " is empty; name a folder");
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error))
    throw FileError(fmt::format("{}: {}: is a file, not a folder; name another folder", key, name));
  std::filesystem::create_directories(folder, error);
  if (error)
    throw FileError(
        fmt::format("{}: {}: cannot be made: {}; name a folder that may be written", key, name, error.message()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(fmt::format("{}: {}: cannot be written: {}; name a folder that may be written", key, name,
                                std::strerror(errno)));
}

}  // namespace

FolderClaim::~FolderClaim() { ::close(descriptor_); }

std::shared_ptr<FolderClaim> FolderClaim::take(const std::string& folder, const std::string& key) {
  make_folder(folder, key);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    throw FileError(fmt::format("{}: {}: cannot be opened: {}; name a folder that may be read and written", key,
                                printable(folder, 200), std::strerror(errno)));
  std::shared_ptr<FolderClaim> claim(new FolderClaim(descriptor));
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return claim;
  Claims& claims = claims_of_process();
  const std::lock_guard lock(claims.mutex);
  std::weak_ptr<FolderClaim>& held = claims.held[{status.st_dev, status.st_ino}];
  if (std::shared_ptr<FolderClaim> own = held.lock()) return own;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw FolderInUse(fmt::format("{}: {}: is in use {}; stop it, or name another folder", key, printable(folder, 200),
                                  owner_words(status.st_ino)));
  held = claim;
  return claim;
}

}  // namespace drivers
