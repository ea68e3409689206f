#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace drivers {

// Another process writes into the folder. A usage error: two services need folders of their own.
class FolderInUse : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// One owner per folder: an advisory lock (flock) on the folder itself, which leaves no file behind and ends with the
// process, however it ends. Claims of one process on one folder share the lock.
class FolderClaim {
 public:
  ~FolderClaim();
  FolderClaim(const FolderClaim&) = delete;
  FolderClaim& operator=(const FolderClaim&) = delete;

  // Makes the folder if it is missing. `key` names the setting in messages ("report.directory"). Throws FolderInUse,
  // naming the other process where the kernel reports it, and FileError where the folder is none, cannot be made or
  // cannot be written to. File systems without locks (some networks) are accepted unlocked. Any thread.
  [[nodiscard]] static std::shared_ptr<FolderClaim> take(const std::string& folder, const std::string& key);

 private:
  explicit FolderClaim(int descriptor) noexcept : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace drivers
