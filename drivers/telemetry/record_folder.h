#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// The files of recorded runs in one folder: "<stream_id>_run0007_002.lcm" is the third file of the seventh run.

struct RecordPart {
  std::string path;
  int run = 0;   // 1, 2, ...
  int file = 0;  // 0, 1, ...
  std::uint64_t n_bytes = 0;
};

[[nodiscard]] std::string record_name(std::string_view stream_id, int run, int file);

// Files that a run left without their heads, under the name that they have until then (partial_path()).
void remove_partial_records(const std::string& folder);

// Oldest first. Other files in the folder are ignored. Throws std::runtime_error when it cannot be read.
[[nodiscard]] std::vector<RecordPart> record_parts(const std::string& folder);

// The number of the next run: one more than the largest. A file whose number is the last that a name can hold does not
// stop the count. Throws std::runtime_error where no number is left.
[[nodiscard]] int next_run(const std::vector<RecordPart>& parts);

// Removes the oldest files of runs before `run` until the remaining files and `wanted_bytes` fit into the quota.
// False: they do not fit; only the run's own files are left.
bool make_room(const std::string& folder, int run, std::uint64_t wanted_bytes, std::uint64_t quota_bytes);

// The file itself and the files of its run that follow it without a gap, in order.
[[nodiscard]] std::vector<std::string> files_from(const std::string& path);

}  // namespace drivers
