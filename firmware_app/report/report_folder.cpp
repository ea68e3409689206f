#include "firmware_app/report/report_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <vector>

#include "drivers/storage/partial_file.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/earlier_files.h"

namespace app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartial = "report.partial";        // being written
constexpr const char* kUnfinished = "report.unfinished";  // of a run that was killed
// The steps of a hand-over; the name says which of them is done, so that each can be repeated after a loss of power.
constexpr const char* kComplete = "report.complete";  // all is written, the last report is still in place
constexpr const char* kPlacing = "report.placing";    // the last report is out of the way
constexpr const char* kReplaced = "report.replaced";  // the last report, before it becomes report.1

// What programs write into the folder of a report.
constexpr std::array kReportFiles{"modal.json",        "tracks.csv", "displacements.csv", "closure.json",
                                  "report.html",       "loop.json",  "loop.html",         "frame.png",
                                  "displacements.svg", "scale.svg",  "spectra.svg",       "modes.svg"};
constexpr off_t kReserveBytes = 4 << 20;

// Called for every file of the folder.
template <class Act>
void for_each_file(const fs::path& folder, const Act& act) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) act(file);
}

std::uintmax_t bytes_in(const fs::path& folder) {
  std::uintmax_t sum = 0;
  if (!fs::is_directory(folder)) return 0;
  for_each_file(folder, [&](const fs::path& file) {
    if (file.filename() != ".reserve" && fs::is_regular_file(file)) sum += fs::file_size(file);
  });
  return sum;
}

void sync_folder(const fs::path& folder) noexcept {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)::fsync(descriptor);
  (void)::close(descriptor);
}

void set_last_aside(const fs::path& folder) {
  for (const char* name : kReportFiles) {
    for (const std::string& file : {std::string(name), drivers::partial_path(name)}) {
      const fs::file_status status = fs::symlink_status(folder / file);  // throws where the disk cannot say
      if (fs::is_regular_file(status)) {
        fs::create_directory(folder / kReplaced);
        fs::rename(folder / file, folder / kReplaced / file);
      } else if (fs::exists(status)) {
        std::error_code ignored;
        fs::remove(folder / file, ignored);  // a link or a pipe is no report
      }
    }
  }
  fs::rename(folder / kComplete, folder / kPlacing);
}

// modal.json first: the result without its tracks is worth more than the tracks without a result.
void place_new(const fs::path& folder) {
  std::error_code absent;
  const auto place = [&](const fs::path& file) { fs::rename(file, folder / file.filename()); };
  if (const fs::path first = folder / kPlacing / kReportFiles[0]; fs::exists(first, absent)) place(first);
  for_each_file(folder / kPlacing, place);
  fs::remove(folder / kPlacing);
}

void go_on_with_hand_over(const fs::path& folder, int keep) {
  if (fs::is_directory(folder / kComplete)) set_last_aside(folder);
  if (fs::is_directory(folder / kPlacing)) place_new(folder);
  if (fs::is_directory(folder / kReplaced)) number_earlier(folder, "report", folder / kReplaced, keep);
  sync_folder(folder);
}

}  // namespace

ReportFolder::ReportFolder(const std::string& directory, int keep)
    : directory_(directory),
      working_((fs::path(directory) / kPartial).string()),
      keep_(keep),
      claim_(drivers::FolderClaim::take(directory, "report.directory")) {
  try {
    const fs::path folder(directory), partial(working_), unfinished = folder / kUnfinished;
    go_on_with_hand_over(folder, keep_);
    if (bytes_in(partial) > bytes_in(unfinished)) {
      fs::remove_all(unfinished);
      fs::rename(partial, unfinished);
      fs::remove(unfinished / ".reserve");
      remark_ = fmt::format("an earlier run did not come to its end: what it wrote is in {}", unfinished.string());
    }
    fs::remove_all(partial);
    fs::create_directory(partial);
  } catch (const fs::filesystem_error& error) {
    throw drivers::FileError(fmt::format("report.directory: {}: cannot be used: {}; name a folder that may be written",
                                         directory, error.what()));
  }
  const int reserve = ::open(in_working(".reserve").c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (reserve < 0) return;
  (void)::posix_fallocate(reserve, 0, kReserveBytes);  // a full disk shows where files are written
  (void)::close(reserve);
}

ReportFolder::~ReportFolder() {
  std::error_code ignored;
  free_reserve();
  if (!is_kept_) fs::remove_all(working_, ignored);
}

bool ReportFolder::has_report() const {
  std::error_code absent;
  return fs::exists(fs::path(directory_) / kReportFiles[0], absent);
}

void ReportFolder::free_reserve() noexcept { (void)::unlink(in_working(".reserve").c_str()); }

void ReportFolder::hand_over() {
  free_reserve();
  is_kept_ = true;
  try {
    const fs::path folder(directory_);
    sync_folder(working_);
    fs::rename(working_, folder / kComplete);
    sync_folder(folder);
    go_on_with_hand_over(folder, keep_);
  } catch (const fs::filesystem_error& error) {
    throw drivers::FileError(
        fmt::format("{}: the report cannot be put in place: {}; its files are in {} or {}, and the next run puts them "
                    "in place",
                    directory_, error.what(), kPartial, kComplete));
  }
}

}  // namespace app
