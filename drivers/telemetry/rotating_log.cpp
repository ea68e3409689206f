#include "drivers/telemetry/rotating_log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "drivers/storage/partial_file.h"
#include "drivers/telemetry/record_folder.h"

namespace drivers {

RotatingLog::RotatingLog(const RecordOptions& options) : options_(options) {
  std::error_code refused;
  std::filesystem::create_directories(options.directory, refused);
  if (refused) {
    throw std::runtime_error(
        fmt::format("record.directory: \"{}\" cannot be made: {}", options.directory, refused.message()));
  }
  remove_partial_records(options.directory);
  run_ = next_run(record_parts(options.directory));
}

std::string RotatingLog::path_of(int file) const {
  return (std::filesystem::path(options_.directory) / record_name(options_.identity.stream_id, run_, file)).string();
}

void RotatingLog::begin(WriteHead write_head) {
  write_head_ = std::move(write_head);
  if (!open_next()) {
    throw std::runtime_error(
        fmt::format("record.directory: \"{}\": the first file of the record cannot be written: {}", options_.directory,
                    error() != 0 ? std::generic_category().message(error()) + "; free space on that disk"
                                 : "record.quota_mb is smaller than record.file_mb, or than what other files need"));
  }
}

bool RotatingLog::open_next() {
  end_file();
  if (!make_room(options_.directory, run_, options_.file_bytes, options_.quota_bytes)) {
    error_.store(0, std::memory_order_relaxed);
    return false;
  }
  // A file without its head cannot be replayed: it has its name when its head is on the disk.
  const std::string path = path_of(next_file_), partial = partial_path(path);
  file_ = std::make_unique<EventLogFile>(partial, EventLogFile::Link::kRefuse);
  int error = 0;
  if (!write_head_(*file_, next_file_) || !file_->sync()) {
    error = file_->error();
  } else if (std::rename(partial.c_str(), path.c_str()) != 0) {
    error = errno;
  } else {
    ++next_file_;
    return true;
  }
  error_.store(error, std::memory_order_relaxed);
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  return false;
}

void RotatingLog::end_file() noexcept {
  if (!file_) return;
  (void)file_->close();
  count();
  n_lost_without_file_ += file_->n_lost();
  file_.reset();
}

void RotatingLog::count() noexcept {
  n_lost_.store(n_lost_without_file_ + (file_ ? file_->n_lost() : 0), std::memory_order_relaxed);
  if (file_ && file_->error() != 0) error_.store(file_->error(), std::memory_order_relaxed);
}

bool RotatingLog::write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept {
  bool is_open = false;
  try {
    is_open = file_ && (file_->n_bytes() < options_.file_bytes || open_next());
  } catch (const std::system_error& refused) {
    error_.store(refused.code().value(), std::memory_order_relaxed);
  } catch (...) {
    error_.store(errno, std::memory_order_relaxed);
  }
  const bool is_written = is_open && file_->write(channel, bytes, utc_ns);
  if (!is_open) ++n_lost_without_file_;
  count();
  return is_written;
}

bool RotatingLog::flush() noexcept {
  try {
    const bool is_flushed = file_ ? file_->flush() : write_head_ && open_next();
    if (file_) sync_.request(file_->descriptor());
    return count(), is_flushed;
  } catch (...) {  // the file cannot be opened, as before
    return false;
  }
}

bool RotatingLog::close() noexcept {
  if (!file_) return n_lost() == 0;
  const bool is_safe = file_->close();
  count();
  return is_safe && sync_.error() == 0;
}

}  // namespace drivers
