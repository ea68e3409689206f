#include "drivers/telemetry/rotating_log.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "drivers/telemetry/record_folder.h"

namespace drivers {

RotatingLog::RotatingLog(const RecordOptions& options) : options_(options) {
  std::error_code refused;
  std::filesystem::create_directories(options.directory, refused);
  if (refused)
    throw std::runtime_error(
        fmt::format("record.directory: \"{}\" cannot be made: {}", options.directory, refused.message()));
  run_ = next_run(record_parts(options.directory));
}

std::string RotatingLog::path_of(int file) const {
  return (std::filesystem::path(options_.directory) / record_name(options_.identity.stream_id, run_, file)).string();
}

void RotatingLog::begin(WriteHead write_head) {
  write_head_ = std::move(write_head);
  if (!open_next())
    throw std::runtime_error(
        fmt::format("record.directory: \"{}\": the first file of the record cannot be written: is the disk full, or "
                    "record.quota_mb smaller than record.file_mb?",
                    options_.directory));
}

bool RotatingLog::open_next() {
  file_.reset();
  if (!make_room(options_.directory, run_, options_.file_bytes, options_.quota_bytes)) return false;
  file_ = std::make_unique<EventLogFile>(path_of(next_file_));
  if (write_head_(*file_, next_file_++) && file_->flush()) return true;
  file_.reset();
  return false;
}

bool RotatingLog::write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept {
  if (!file_) return false;
  try {
    if (file_->n_bytes() >= options_.file_bytes && !open_next()) return false;
    return file_->write(channel, bytes, utc_ns);
  } catch (...) {
    return false;
  }
}

bool RotatingLog::flush() noexcept { return file_ && file_->flush(); }

}  // namespace drivers
