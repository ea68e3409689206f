#include "drivers/camera/recording/image_folder_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "drivers/camera/recording/gray_convert.h"
#include "drivers/images/image_reader.h"
#include "drivers/storage/ascii.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

// The run of digits at `at`, without leading zeros; moves `at` past it.
std::string_view take_number(const std::string& text, std::size_t& at) noexcept {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t begin = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return std::string_view(text).substr(begin, at - begin);
}

std::vector<fs::path> list_images(const std::string& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') || !is_image_file(name) || !entry.is_regular_file()) continue;
    if (entry.file_size() == 0) {
      throw std::runtime_error(fmt::format("{}: the image is empty (0 bytes): write it again", entry.path().string()));
    }
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

// Returns why the image cannot be used, or empty. IMREAD_UNCHANGED keeps depth and alpha as stored.
std::string load(const fs::path& file, cv::Mat& image) try {
  image = read_image(file.string(), cv::IMREAD_UNCHANGED);
  if (image.empty()) return "cannot be decoded: the file is damaged, unreadable or not an image";
  if (image.depth() == CV_32F || image.depth() == CV_64F) {
    return "has floating-point pixels: convert the images to 8 bits";
  }
  if (image.depth() != CV_8U) return "has 16 bits per channel: convert the images to 8 bits";
  if (image.channels() == 4) {
    return "has an alpha channel: remove it (mogrify -alpha off), a transparent pixel shows nothing that could be seen";
  }
  return {};
} catch (const std::runtime_error& error) {
  return error.what();
}

class ImageFolderSource final : public FrameSource {
 public:
  explicit ImageFolderSource(const std::string& folder) : files_(list_images(folder)) {
    if (files_.empty()) {
      throw std::runtime_error(
          fmt::format("{}: no image in this folder: expected .png, .jpg, .bmp, .tif, .webp or .pgm files", folder));
    }
    const cv::Size first = probe(files_.front());
    const cv::Size last = probe(files_.back());
    if (first != last) {
      throw std::runtime_error(fmt::format(
          "{}: images of different sizes: {} is {} x {} px, {} is {} x {} px: keep one recording per folder", folder,
          files_.front().filename().string(), first.width, first.height, files_.back().filename().string(), last.width,
          last.height));
    }
    info_.width_px = first.width;
    info_.height_px = first.height;
    info_.frame_count = files_.size();
    info_.description =
        fmt::format("folder {} ({} images, {} x {} px)", folder, files_.size(), first.width, first.height);
  }

  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] std::uint64_t index() const noexcept override { return next_ == 0 ? 0 : next_ - 1; }

  ReadStatus read(core::Frame& out) noexcept override {
    if (next_ == files_.size()) return ReadStatus::kEnd;
    const fs::path& file = files_[next_];
    try {
      error_ = load(file, image_);
      if (error_.empty() && (image_.cols != info_.width_px || image_.rows != info_.height_px)) {
        error_ = fmt::format("is {} x {} px, the first image is {} x {} px: keep one recording per folder", image_.cols,
                             image_.rows, info_.width_px, info_.height_px);
      }
      if (error_.empty()) {
        const GrayStatus status = convert_to_gray(image_, out);
        if (status != GrayStatus::kOk) error_ = to_string(status);
      }
    } catch (const std::exception& thrown) {
      error_ = thrown.what();
    }
    if (!error_.empty()) {
      error_ = fmt::format("{}: {}", file.string(), error_);
      return ReadStatus::kFault;
    }
    ++next_;
    return ReadStatus::kFrame;
  }

  [[nodiscard]] bool has_more_frames_than(std::uint64_t n) const override { return files_.size() > n; }

 private:
  static cv::Size probe(const fs::path& file) {
    cv::Mat image;
    const std::string complaint = load(file, image);
    if (!complaint.empty()) throw std::runtime_error(fmt::format("{}: {}", file.string(), complaint));
    require_usable_size(file.string(), image.cols, image.rows);
    return image.size();
  }

  std::vector<fs::path> files_;
  std::size_t next_ = 0;
  cv::Mat image_;
  SourceInfo info_;
  std::string error_;
};

}  // namespace

bool is_image_file(const std::string& path) {
  static constexpr std::array kExtensions = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp",
                                             ".pgm", ".ppm", ".pnm",  ".pfm", ".exr", ".hdr"};
  const std::string extension = lower_ascii(fs::path(path).extension().string());
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

bool natural_less(const std::string& a, const std::string& b) noexcept {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = take_number(a, i);
      const std::string_view y = take_number(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // equal except for leading zeros: any fixed order
}

std::unique_ptr<FrameSource> open_image_folder(const std::string& path) {
  return std::make_unique<ImageFolderSource>(path);
}

}  // namespace drivers
