#include "drivers/images/image_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <stdexcept>
#include <string>
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

std::string refusal_of(const std::string& head) {
  const std::string path = ::testing::TempDir() + "image_reader_head";
  std::ofstream(path, std::ios::binary) << head << std::string(64, '\0');
  try {
    (void)drivers::read_image(path, cv::IMREAD_UNCHANGED);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

// A frame of three parts, of which the first has twice the others' resolution where `is_subsampled`.
std::string jpeg_head(unsigned char mark, unsigned width, unsigned height, bool is_subsampled) {
  const auto byte = [](unsigned value) { return std::string(1, static_cast<char>(value & 0xFFU)); };
  std::string head("\xFF\xD8\xFF\xFE\x00\x04xx\xFF", 9);  // a comment before it
  head += byte(mark) + byte(0) + byte(17) + byte(8) + byte(height >> 8U) + byte(height) + byte(width >> 8U) +
          byte(width) + byte(3);
  for (unsigned part = 1; part <= 3; ++part)
    head += byte(part) + byte(is_subsampled && part == 1 ? 0x22 : 0x11) + byte(0);
  return head;
}

std::string png_head(char bits, char colour) {
  std::string head("\x89PNG\r\n\x1a\n\x00\x00\x00\x0DIHDR\x00\x00\x20\x00\x00\x00\x20\x00", 24);  // 8192 x 8192
  return head + bits + colour;
}

TEST(ImageReader, RefusesWhatIsTooLargeBeforeItIsDecoded) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal_of(jpeg_head(0xC0, 8192, 8200, false)), HasSubstr("8192 x 8200 pixels, more than 67108864"));
  EXPECT_THAT(refusal_of(jpeg_head(0xC2, 8192, 8192, false)), HasSubstr("progressive JPEG, which takes 402653184"));
  EXPECT_THAT(refusal_of(jpeg_head(0xC2, 8192, 8192, true)), HasSubstr("which takes 201326592 bytes"));
  EXPECT_THAT(refusal_of(png_head(8, 6)), HasSubstr("8192 x 8192 pixels of 4 bytes"));
  EXPECT_THAT(refusal_of(png_head(16, 2)), HasSubstr("pixels of 6 bytes"));
}

TEST(ImageReader, ReadsAProgressiveImage) {
  const cv::Mat image = pattern(123, 321, CV_8UC3);
  const std::string path = ::testing::TempDir() + "progressive.jpg";
  ASSERT_TRUE(cv::imwrite(path, image, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}));
  EXPECT_EQ(drivers::read_image(path, cv::IMREAD_UNCHANGED).size(), image.size());
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
