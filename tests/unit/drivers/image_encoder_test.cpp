#include "drivers/images/image_encoder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <stdexcept>
#include <vector>

#include "drivers/images/image_reader.h"

namespace {

using drivers::encode_jpeg;
using drivers::encode_png;

// Noise on a chequered pattern: neither flat nor incompressible.
cv::Mat pattern(int rows, int cols, int type) {
  cv::Mat image(rows, cols, type);
  std::mt19937 draw(1);
  const int n = image.channels();
  for (int v = 0; v < rows; ++v) {
    for (int i = 0; i < cols * n; ++i)
      image.ptr(v)[i] =
          static_cast<unsigned char>(90U + 60U * static_cast<unsigned>((i / 9 + v / 7) % 2) + draw() % 20U);
  }
  return image;
}

TEST(ImageEncoder, JpegHasTheBytesOfOpenCv) {
  const cv::Mat gray = pattern(123, 321, CV_8UC1);
  for (const int quality : {5, 15, 50, 78, 85}) {
    for (const bool optimize : {false, true}) {
      std::vector<unsigned char> reference;
      ASSERT_TRUE(cv::imencode(".jpg", gray, reference,
                               {cv::IMWRITE_JPEG_QUALITY, quality, cv::IMWRITE_JPEG_OPTIMIZE, optimize ? 1 : 0}));
      EXPECT_EQ(encode_jpeg(gray, quality, optimize), reference) << quality << (optimize ? " optimized" : "");
    }
  }
}

TEST(ImageEncoder, PngHasTheBytesOfOpenCvAlsoOfAPartOfAnImage) {
  const cv::Mat whole = pattern(77, 201, CV_8UC3), part = whole(cv::Rect(3, 5, 50, 40));
  for (const cv::Mat& image : {whole, part}) {
    std::vector<unsigned char> reference;
    ASSERT_TRUE(cv::imencode(".png", image, reference, {cv::IMWRITE_PNG_COMPRESSION, 6}));
    EXPECT_EQ(encode_png(image, 6), reference);
  }
}

TEST(ImageEncoder, RefusesWhatTheFormatCannotHold) {
  EXPECT_THROW((void)encode_jpeg(cv::Mat(1, 70000, CV_8UC1, cv::Scalar(0)), 50), std::runtime_error);
  EXPECT_THROW((void)encode_jpeg(cv::Mat(8, 8, CV_8UC3, cv::Scalar(0)), 50), std::invalid_argument);
  EXPECT_THROW((void)encode_png(cv::Mat(8, 8, CV_8UC1, cv::Scalar(0)), 6), std::invalid_argument);
  EXPECT_THROW((void)encode_png(cv::Mat(), 6), std::invalid_argument);
}

TEST(ImageReader, ReadsWhatWasWrittenAndNothingElse) {
  const std::filesystem::path folder = ::testing::TempDir();
  const std::string file = (folder / "image_reader_test.png").string();
  const cv::Mat image = pattern(40, 60, CV_8UC3);
  ASSERT_TRUE(cv::imwrite(file, image));
  const cv::Mat read = drivers::read_image(file, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.size(), image.size());
  EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0);
  // 20000 x 20000 in a header, which is all that is read of it.
  const std::string huge = (folder / "image_reader_huge.png").string();
  const char header[] =
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x4e\x20\0\0\x4e\x20\x08\0\0\0\0\xc6\x1b\x19\xe5\0\0\0\0IEND\xae\x42\x60\x82";
  std::ofstream(huge, std::ios::binary).write(header, sizeof header - 1);
  EXPECT_THROW((void)drivers::read_image(huge, cv::IMREAD_UNCHANGED), std::runtime_error);
  EXPECT_TRUE(drivers::read_image((folder / "no_such_image.png").string(), cv::IMREAD_UNCHANGED).empty());
}

}  // namespace
