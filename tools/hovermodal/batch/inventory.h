#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tools {

enum class FlightKind : std::uint8_t { kRecord, kTracks, kClip };

[[nodiscard]] const char* to_string(FlightKind kind) noexcept;
[[nodiscard]] FlightKind flight_kind(const std::string& text);  // throws std::invalid_argument

// One flight of a batch: a unit that can be analysed by itself.
struct Flight {
  std::string name;  // its path in the folder, without extension: unique; also the folder of its results
  FlightKind kind = FlightKind::kRecord;
  std::string path;    // of the record's first file, the tracks.csv or the clip
  std::string config;  // of tracks and clips; a record contains its own
};

struct Inventory {
  std::vector<Flight> flights;        // by name, whatever the order of the files on the disk
  std::vector<std::string> left_out;  // files that look like a flight but are not usable, with the reason
};

// All flights below `folder`, except below `results`: records of the service (NAME_runNNNN_000.lcm), tracks.csv with
// config.yaml beside it, clips (.mp4, .mkv, .avi, .mov) with NAME.yaml or config.yaml beside them. `config`, where not
// empty, is for tracks and clips that have none. Throws std::invalid_argument: no such folder.
[[nodiscard]] Inventory find_flights(const std::string& folder, const std::string& results, const std::string& config);

}  // namespace tools
