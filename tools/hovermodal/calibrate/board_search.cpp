#include "tools/hovermodal/calibrate/board_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "drivers/camera/recording/frame_source.h"
#include "drivers/camera/recording/image_folder_source.h"
#include "drivers/images/image_reader.h"
#include "tools/hovermodal/clip_source.h"
#include "tools/hovermodal/simulate/progress.h"

namespace tools {
namespace {

constexpr int kSearchPx = 1000;  // longer side of the searched image; corners are then refined at full size
constexpr std::uint64_t kFramesOfClip = 200;

double least_spacing_px(const std::vector<cv::Point2f>& corners, const core::ChessBoard& board) {
  const auto columns = static_cast<std::size_t>(board.columns);
  double least = 1e9;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((i + 1) % columns != 0) least = std::min(least, cv::norm(corners[i + 1] - corners[i]));
    if (i + columns < corners.size()) least = std::min(least, cv::norm(corners[i + columns] - corners[i]));
  }
  return least;
}

bool search(const cv::Mat& gray, cv::Size pattern, std::vector<cv::Point2f>& corners) {
  constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  const double share = std::min(1.0, static_cast<double>(kSearchPx) / std::max(gray.cols, gray.rows));
  cv::Mat small = gray;
  if (share < 1.0) cv::resize(gray, small, {}, share, share, cv::INTER_AREA);
  if (!cv::findChessboardCorners(small, pattern, corners, kFlags)) return false;
  const double share_u = static_cast<double>(small.cols) / gray.cols;
  const double share_v = static_cast<double>(small.rows) / gray.rows;
  for (cv::Point2f& p : corners) {  // pixel centres lie at whole numbers
    p.x = static_cast<float>((static_cast<double>(p.x) + 0.5) / share_u - 0.5);
    p.y = static_cast<float>((static_cast<double>(p.y) + 0.5) / share_v - 0.5);
  }
  return true;
}

// A user may count squares instead of inner corners, which are one fewer each way.
std::string hint_for(const cv::Mat& gray, const core::ChessBoard& board) {
  std::vector<cv::Point2f> corners;
  if (board.columns < 4 || board.rows < 4 || !search(gray, {board.columns - 1, board.rows - 1}, corners)) return {};
  return fmt::format("a board of {0}x{1} inner corners is seen: give --board {0}x{1} (inner corners, not squares)",
                     board.columns - 1, board.rows - 1);
}

class BoardSearch {
 public:
  BoardSearch(const core::ChessBoard& board, int every, int decoder_mb, bool is_quiet)
      : board_(board), every_(every), decoder_mb_(decoder_mb), is_quiet_(is_quiet) {}

  void look_through(const std::string& source) {
    if (gives_up()) return;
    std::error_code error;
    if (!std::filesystem::exists(source, error)) {
      throw std::invalid_argument(source + ": no such file or folder; name a clip, images, or a folder of images");
    }
    if (!std::filesystem::is_directory(source, error) && drivers::is_image_file(source)) return look_at_image(source);
    const auto frames = open_clip(source, decoder_mb_);
    require_size(source, frames->info().width_px, frames->info().height_px);
    look_at_frames(source, *frames);
  }

  [[nodiscard]] FoundBoards take() { return std::move(found_); }

 private:
  // Another board is in the picture: searching each image for the declared one would take seconds.
  [[nodiscard]] bool gives_up() const {
    return !found_.hint.empty() && found_.views.empty() && found_.n_looked_at >= 3;
  }

  static cv::Mat read(const std::string& file) try {
    return drivers::read_image(file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file + ": " + error.what());
  }

  void look_at_image(const std::string& file) {
    const cv::Mat image = read(file);
    if (image.empty()) throw std::runtime_error(file + ": cannot be decoded: damaged, or not an image");
    require_size(file, image.cols, image.rows);
    look(image, file);
  }

  void look_at_frames(const std::string& source, drivers::FrameSource& frames) {
    const drivers::SourceInfo& info = frames.info();
    const std::uint64_t apart = !info.has_rate ? 1
                                : every_ > 0   ? static_cast<std::uint64_t>(every_)
                                               : std::max<std::uint64_t>(1, info.frame_count / kFramesOfClip);
    core::Frame frame;
    frame.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
    Progress progress("looking for the board,", info.frame_count, "frames", is_quiet_);
    for (std::uint64_t i = 0; !gives_up(); ++i) {
      const drivers::ReadStatus status = frames.read(frame);
      if (status == drivers::ReadStatus::kFault) throw std::runtime_error(frames.error());
      if (status == drivers::ReadStatus::kEnd) break;
      if (i % apart == 0) {
        look(cv::Mat(info.height_px, info.width_px, CV_8U, frame.pixels.data()),
             fmt::format("{} frame {}", std::filesystem::path(source).filename().string(), i));
      }
      progress.update(std::min(i + 1, std::max<std::uint64_t>(info.frame_count, 1)));
    }
  }

  void look(const cv::Mat& gray, const std::string& place) {
    ++found_.n_looked_at;
    if (auto view = find_board(gray, board_)) {
      found_.views.push_back(std::move(*view));
      found_.places.push_back(place);
      found_.hint.clear();
    } else if (found_.views.empty() && found_.hint.empty() && found_.n_looked_at <= 40) {
      found_.hint = hint_for(gray, board_);
    }
  }

  void require_size(const std::string& file, int width_px, int height_px) {
    if (found_.width_px == 0) found_.width_px = width_px, found_.height_px = height_px;
    if (found_.width_px == width_px && found_.height_px == height_px) return;
    throw std::invalid_argument(
        fmt::format("{}: is {} x {} px, the images before it are {} x {} px; calibrate each mode of the camera "
                    "separately",
                    file, width_px, height_px, found_.width_px, found_.height_px));
  }

  core::ChessBoard board_;
  int every_, decoder_mb_;
  bool is_quiet_;
  FoundBoards found_;
};

}  // namespace

std::optional<core::BoardView> find_board(const cv::Mat& gray, const core::ChessBoard& board) {
  std::vector<cv::Point2f> corners;
  if (!search(gray, {board.columns, board.rows}, corners)) return std::nullopt;
  // The window must contain one corner only, and little lens distortion: a third of the way to the next one.
  const int half = std::clamp(static_cast<int>(0.33 * least_spacing_px(corners, board)), 2, 15);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-4);
  cv::cornerSubPix(gray, corners, {half, half}, {-1, -1}, until);
  core::BoardView view;
  for (const cv::Point2f& p : corners) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
    view.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
  }
  return view;
}

FoundBoards find_boards(const std::vector<std::string>& sources, const core::ChessBoard& board, int every,
                        int decoder_mb, bool is_quiet) {
  drivers::silence_media_libraries();
  BoardSearch search(board, every, decoder_mb, is_quiet);
  for (const std::string& source : sources) search.look_through(source);
  return search.take();
}

}  // namespace tools
