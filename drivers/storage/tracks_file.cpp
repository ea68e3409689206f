#include "drivers/storage/tracks_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr std::string_view kTracksHeader = "frame,t_s,point,region,u_px,v_px,sigma_px";
constexpr double kMaxPixel = 1e6;

}  // namespace

class TracksPass::Reader {
 public:
  // known: names of the regions, if the file was read before; null: this is the first time.
  Reader(const std::string& path, const std::vector<std::string>* known) : lines_(path), known_(known) {
    head_.path = head_.camera.description = path;
    read_header();
  }

  [[nodiscard]] TracksFile check() {
    if (!next(head_.first)) lines_.fail("no track in the file; was the run stopped before its first frame?");
    core::TrackFrame frame = head_.first;
    do {
      ++head_.n_frames;
    } while (next(frame));
    if (head_.region_axes.size() > head_.region_names.size())
      lines_.fail("`# axes:` has more entries than `# regions:`");
    head_.last_sequence = sequence_;
    return std::move(head_);
  }

  [[nodiscard]] bool next(core::TrackFrame& out) {
    out.points.clear();
    if (!has_row_ && !read_next_row()) return false;
    out.sequence = sequence_, out.t_start_ns = t_ns_, out.gap_before = gap_before_;
    n_points_.assign(n_points_.size(), 0);
    do {
      place(out.points);
    } while (read_next_row() && !begins_frame_);
    return true;
  }

 private:
  void read_header() {
    std::string_view line;
    while (lines_.next(line)) {
      if (line == kTracksHeader) return require_complete_header();
      std::string key, value;
      if (!line.starts_with('#')) break;
      if (split_comment(line, key, value)) set_comment(key, value);
    }
    lines_.fail(fmt::format("expected the header `{}`", kTracksHeader));
  }

  void require_complete_header() const {
    const core::CameraInfo& camera = head_.camera;
    if (camera.width_px == 0 || camera.height_px == 0)
      lines_.fail("no comment `# image_size_px: WIDTH x HEIGHT` above");
    if (camera.rate_hz == 0.0) lines_.fail("no comment `# rate_hz: RATE` above");
  }

  void set_comment(const std::string& key, const std::string& value) {
    core::CameraInfo& camera = head_.camera;
    if (key == "image_size_px") return set_image_size(value);
    if (key == "rate_hz") camera.rate_hz = comment_number(key, value, 1e-6, 1e9);
    if (key == "readout_ms") camera.readout_ns = std::llround(comment_number(key, value, -1e6, 1e6) * 1e6);
    if (key == "exposure_ms") camera.exposure_ns = std::llround(comment_number(key, value, 0.0, 1e6) * 1e6);
    if (key == "frame_count" && value != "unknown") {
      camera.frame_count = static_cast<std::uint64_t>(comment_number(key, value, 0.0, 1e15));
    }
    if (key == "coding_block_px") camera.coding_block_px = static_cast<int>(comment_number(key, value, 0.0, 1e5));
    if (key == "readout_direction") set_direction(value);
    if (key == "regions") set_regions(value);
    if (key == "axes") set_axes(value);
  }

  [[nodiscard]] double comment_number(const std::string& key, const std::string& value, double low, double high) const {
    const auto number = parse_number(value);
    if (!number || *number < low || *number > high) {
      lines_.fail(fmt::format("{}: `{}` is refused: allowed {} .. {}", key, printable(value), low, high));
    }
    return *number;
  }

  void set_image_size(const std::string& value) {
    const std::size_t by = value.find(" x ");
    if (by == std::string::npos)
      lines_.fail(fmt::format("image_size_px: `{}` is not WIDTH x HEIGHT", printable(value)));
    head_.camera.width_px = static_cast<int>(comment_number("image width", value.substr(0, by), 1, 1e5));
    head_.camera.height_px = static_cast<int>(comment_number("image height", value.substr(by + 3), 1, 1e5));
  }

  void set_direction(const std::string& value) {
    using core::ReadoutDirection;
    if (value == "down")
      head_.camera.readout_direction = ReadoutDirection::kDown;
    else if (value == "up")
      head_.camera.readout_direction = ReadoutDirection::kUp;
    else if (value == "left")
      head_.camera.readout_direction = ReadoutDirection::kLeft;
    else if (value == "right")
      head_.camera.readout_direction = ReadoutDirection::kRight;
    else
      lines_.fail(
          fmt::format("readout_direction: `{}` is refused: allowed down | up | left | right", printable(value)));
  }

  void set_regions(const std::string& value) {
    split_cells(value, cells_);
    for (const std::string_view name : cells_) region_index(name);
  }

  void set_axes(const std::string& value) {
    split_cells(value, cells_);
    head_.region_axes.assign(cells_.begin(), cells_.end());
  }

  std::uint16_t region_index(std::string_view name) {
    if (name.empty() || name.size() > 64) lines_.fail("the region name is empty or longer than 64 characters");
    const auto [found, is_new] = region_of_.try_emplace(std::string(name), head_.region_names.size());
    if (is_new) {
      if (head_.region_names.size() == Limits::kRegions)
        lines_.fail(fmt::format("more than {} regions; is a column shifted?", Limits::kRegions));
      if (known_ != nullptr && (found->second >= known_->size() || (*known_)[found->second] != name))
        lines_.fail("the file has changed since it was checked; read it when nothing writes it any more");
      head_.region_names.emplace_back(name);
    }
    return static_cast<std::uint16_t>(found->second);
  }

  [[nodiscard]] double cell_number(std::size_t i, const char* name, double low, double high) const {
    const auto number = parse_number(cells_[i]);
    if (!number || *number < low || *number > high) {
      lines_.fail(fmt::format("{}: `{}` is refused: allowed {} .. {}", name, printable(cells_[i]), low, high));
    }
    return *number;
  }

  // The next line with a point. False: the end.
  bool read_next_row() {
    std::string_view line;
    has_row_ = false;
    while (!has_row_ && lines_.next(line)) {
      if (line.empty()) continue;
      read_row(line);
      has_row_ = true;
    }
    return has_row_;
  }

  void read_row(std::string_view line) {
    split_cells(line, cells_);
    if (cells_.size() != 7) lines_.fail(fmt::format("{} cells instead of 7; is the file cut off?", cells_.size()));
    const auto sequence = parse_unsigned(cells_[0]);
    if (!sequence) lines_.fail(fmt::format("frame: `{}` is no frame number", printable(cells_[0])));
    std::int64_t t_ns = 0;
    if (!parse_seconds_ns(cells_[1], t_ns))
      lines_.fail(fmt::format("t_s: `{}` is no time in seconds", printable(cells_[1])));
    open_frame(*sequence, t_ns);
    const auto id = parse_unsigned(cells_[2]);
    if (!id || *id > std::numeric_limits<std::uint32_t>::max()) {
      lines_.fail(fmt::format("point: `{}` is no point number", printable(cells_[2])));
    }
    point_.id = static_cast<std::uint32_t>(*id);
    point_.region = region_index(cells_[3]);
    point_.u_px = cell_number(4, "u_px", -kMaxPixel, kMaxPixel);
    point_.v_px = cell_number(5, "v_px", -kMaxPixel, kMaxPixel);
    point_.sigma_px = cell_number(6, "sigma_px", 0.0, kMaxPixel);
    point_.seen = point_.inlier = true;
    require_once(*sequence);
  }

  // The frame in which each point was last seen detects a second line in the same frame without searching the frame.
  void require_once(std::uint64_t sequence) {
    const auto [last, is_new] = last_frame_of_.try_emplace(point_.id, sequence);
    if (!is_new && std::exchange(last->second, sequence) == sequence) {
      lines_.fail(fmt::format("point {} appears twice in frame {}", point_.id, sequence));
    }
    if (last_frame_of_.size() > Limits::kTrackedPoints)
      lines_.fail(fmt::format("more than {} different points; is a column shifted?", Limits::kTrackedPoints));
  }

  // Of the line that was read last.
  void place(std::vector<core::TrackPoint>& points) {
    if (point_.region >= n_points_.size()) n_points_.resize(point_.region + std::size_t{1}, 0);
    if (++n_points_[point_.region] > Limits::kPointsPerRegion)
      lines_.fail(fmt::format("more than {} points of region `{}` in one frame; track fewer, or divide the region",
                              Limits::kPointsPerRegion, printable(head_.region_names[point_.region])));
    if (points.size() == Limits::kPointsPerFrame)
      lines_.fail(fmt::format("more than {} points in one frame; track fewer", Limits::kPointsPerFrame));
    points.push_back(point_);
  }

  void open_frame(std::uint64_t sequence, std::int64_t t_ns) {
    begins_frame_ = !is_open_ || sequence != sequence_;
    if (is_open_ && !begins_frame_) {
      if (t_ns != t_ns_) lines_.fail(fmt::format("frame {} has two times", sequence));
      return;
    }
    if (is_open_ && sequence < sequence_)
      lines_.fail(fmt::format("frame {} follows frame {}: it goes back", sequence, sequence_));
    if (is_open_ && t_ns <= t_ns_) lines_.fail(fmt::format("frame {}: its time does not lie after the last", sequence));
    gap_before_ = is_open_ && sequence != sequence_ + 1;
    sequence_ = sequence, t_ns_ = t_ns, is_open_ = true;
  }

  CsvLines lines_;
  const std::vector<std::string>* known_;
  TracksFile head_;
  std::vector<std::string_view> cells_;
  std::unordered_map<std::string, std::size_t> region_of_;
  std::unordered_map<std::uint32_t, std::uint64_t> last_frame_of_;
  std::vector<std::size_t> n_points_;  // of the present frame, by region
  // The line that was read last, and its frame.
  core::TrackPoint point_;
  std::uint64_t sequence_ = 0;
  std::int64_t t_ns_ = 0;
  bool is_open_ = false, begins_frame_ = false, gap_before_ = false, has_row_ = false;
};

TracksPass::TracksPass(const TracksFile& file) : reader_(std::make_unique<Reader>(file.path, &file.region_names)) {}
TracksPass::~TracksPass() = default;
bool TracksPass::next(core::TrackFrame& out) { return reader_->next(out); }

TracksFile read_tracks_csv(const std::string& path) { return TracksPass::Reader(path, nullptr).check(); }

}  // namespace drivers
