#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera_fit.h"

namespace tools {

// The inner corners of the board in a gray image, to a fraction of a pixel; nullopt if it is incomplete or not found.
[[nodiscard]] std::optional<core::BoardView> find_board(const cv::Mat& gray, const core::ChessBoard& board);

struct FoundBoards {
  int width_px = 0, height_px = 0;
  std::uint64_t n_looked_at = 0;
  std::vector<core::BoardView> views;
  std::vector<std::string> places;  // per view: file and frame, for messages
  std::string hint;                 // if none was found: what was found instead; or empty
};

// Searches clips, folders of images and images, in the given order: every image; of a clip every `every`-th frame,
// 0 = about 200 of them. All must be of one size. Throws std::invalid_argument (no such file, sizes differ) or
// std::runtime_error (cannot be read). decoder_mb: as camera.decoder_mb. Progress goes to standard error, unless
// `is_quiet`.
[[nodiscard]] FoundBoards find_boards(const std::vector<std::string>& sources, const core::ChessBoard& board, int every,
                                      int decoder_mb, bool is_quiet);

}  // namespace tools
