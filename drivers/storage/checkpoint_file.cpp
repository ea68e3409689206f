#include "drivers/storage/checkpoint_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "drivers/storage/limits.h"
#include "drivers/storage/partial_file.h"
#include "drivers/storage/regular_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {

namespace {

constexpr std::array<char, 8> kMagic{'H', 'M', 'S', 'T', 'A', 'T', 'E', '\n'};

struct Head {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kCheckpointVersion;
  std::uint32_t reserved = 0;
  std::uint64_t n_bytes = 0;
  std::uint64_t checksum = 0;
};

// FNV-1a over 64-bit words, the remainder by bytes: fast enough for a large file.
std::uint64_t checksum(std::span<const std::uint8_t> bytes) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325U;
  constexpr std::uint64_t kPrime = 0x100000001b3U;
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, 8);
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 29;  // mixes high bits of a word into low bits of the sum
  }
  for (; at < bytes.size(); ++at) hash = (hash ^ bytes[at]) * kPrime;
  return hash;
}

// A descriptor that closes itself.
class File {
 public:
  explicit File(int descriptor) noexcept : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }
  [[nodiscard]] bool write(const void* data, std::size_t n_bytes) const noexcept {
    return write_bytes(descriptor_, data, n_bytes) == n_bytes;
  }
  [[nodiscard]] bool sync() const noexcept { return sync_to_disk(descriptor_); }

 private:
  int descriptor_;
};

std::string why(const std::string& path) { return path + ": " + std::generic_category().message(errno); }

std::string write_or_why(const std::string& path, const std::string& partial, std::span<const std::uint8_t> bytes) {
  Head head;
  head.n_bytes = bytes.size();
  head.checksum = checksum(bytes);
  {
    const File file(open_new_file(partial.c_str()));
    if (!file.is_open()) return why(partial);
    if (!file.write(&head, sizeof head) || !file.write(bytes.data(), bytes.size()) || !file.sync()) return why(partial);
  }
  if (std::rename(partial.c_str(), path.c_str()) != 0) return why(path);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const File directory(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.is_open()) (void)directory.sync();
  return {};
}

}  // namespace

std::string write_checkpoint(const std::string& path, std::span<const std::uint8_t> bytes) noexcept {
  try {
    const std::string partial = partial_path(path);
    std::string refused = write_or_why(path, partial, bytes);
    if (!refused.empty()) (void)::unlink(partial.c_str());  // frees the space on a full disk
    return refused;
  } catch (const std::exception&) {
    return "out of memory";
  }
}

CheckpointRead read_checkpoint(const std::string& path, std::uint64_t max_bytes) {
  CheckpointRead out;
  std::error_code error;
  // A path that cannot be looked at counts as there: opening it says why.
  out.exists = std::filesystem::status(path, error).type() != std::filesystem::file_type::not_found;
  if (!out.exists) return out;
  FileHandle in;
  try {
    in = open_regular_file(path, "it should be a state of hovermodal");
  } catch (const FileError& unreadable) {
    out.refused = unreadable.what();
    return out;
  }
  Head head;
  const auto refuse = [&out](std::string reason) {
    out.refused = std::move(reason);
    out.bytes.clear();
    return out;
  };
  const auto read = [&](void* to, std::size_t n_bytes) {
    try {
      return read_bytes(in.get(), to, n_bytes, path) == n_bytes;
    } catch (const FileError&) {
      return false;
    }
  };
  if (!read(&head, sizeof head)) return refuse("it is cut off in its head");
  if (head.magic != kMagic || head.reserved != 0) return refuse("it is not a state of hovermodal");
  if (head.version != kCheckpointVersion) {
    return refuse("its version is " + std::to_string(head.version) + ", ours is " + std::to_string(kCheckpointVersion));
  }
  const std::uint64_t size = bytes_of(in.get());
  if (head.n_bytes > max_bytes) {
    return refuse(std::to_string(head.n_bytes) + " bytes are more than the " + std::to_string(max_bytes) +
                  " that this configuration needs at most");
  }
  if (size != sizeof head + head.n_bytes) {
    return refuse("it is " + std::to_string(size) + " bytes long and should be " +
                  std::to_string(sizeof head + head.n_bytes));
  }
  out.bytes.resize(static_cast<std::size_t>(head.n_bytes));
  if (!read(out.bytes.data(), out.bytes.size())) return refuse("it cannot be read to its end");
  if (checksum(out.bytes) != head.checksum) return refuse("its checksum is wrong: it is damaged");
  return out;
}

std::string boot_id() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(in, id);
  return id;
}

}  // namespace drivers
