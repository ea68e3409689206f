#include "drivers/camera/device/luma.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

namespace drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth = 34, kHeight = 32;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

Bytes noise(std::size_t n) {
  std::mt19937 random(1);
  Bytes bytes(n);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

Bytes read(PixelLayout layout, const Bytes& bytes, std::size_t stride = 0) {
  Bytes luma(kPixels);
  LumaReader reader(layout, kWidth, kHeight, stride);
  EXPECT_EQ(reader.read(bytes.data(), bytes.size(), luma.data()), LumaStatus::kOk);
  return luma;
}

TEST(Luma, PlanarAndGrayImagesAreTheirFirstPlane) {
  const Bytes image = noise(kPixels * 3 / 2);
  EXPECT_EQ(read(PixelLayout::kGray8, image), Bytes(image.begin(), image.begin() + kPixels));
}

TEST(Luma, RowsMayBePadded) {
  const Bytes image = noise(40 * kHeight);
  const Bytes luma = read(PixelLayout::kGray8, image, 40);
  for (std::size_t v = 0; v < kHeight; ++v) {
    for (std::size_t u = 0; u < kWidth; ++u) ASSERT_EQ(luma[v * kWidth + u], image[v * 40 + u]);
  }
}

TEST(Luma, InterleavedFormatsGiveTheirLumaBytes) {
  const Bytes image = noise(2 * kPixels);
  const Bytes yuyv = read(PixelLayout::kYuyv, image), uyvy = read(PixelLayout::kUyvy, image);
  for (std::size_t i = 0; i < kPixels; ++i) {
    ASSERT_EQ(yuyv[i], image[2 * i]);
    ASSERT_EQ(uyvy[i], image[2 * i + 1]);
  }
}

TEST(Luma, DeepGrayKeepsItsHighBits) {
  for (const auto& [layout, bits] : {std::pair{PixelLayout::kGray10, 10U}, std::pair{PixelLayout::kGray12, 12U},
                                     std::pair{PixelLayout::kGray16, 16U}}) {
    Bytes image = noise(2 * kPixels);
    for (std::size_t i = 0; i < kPixels; ++i) image[2 * i + 1] &= static_cast<std::uint8_t>((1U << (bits - 8U)) - 1U);
    const Bytes luma = read(layout, image);
    for (std::size_t i = 0; i < kPixels; ++i) {
      ASSERT_EQ(luma[i], (image[2 * i] + 256U * image[2 * i + 1]) >> (bits - 8U)) << bits;
    }
  }
}

TEST(Luma, ColourIsWeighedAsOpenCvDoes) {
  const Bytes image = noise(3 * kPixels);
  for (const auto& [layout, code] : {std::pair{PixelLayout::kRgb24, static_cast<int>(cv::COLOR_RGB2GRAY)},
                                     std::pair{PixelLayout::kBgr24, static_cast<int>(cv::COLOR_BGR2GRAY)}}) {
    const Bytes luma = read(layout, image);
    cv::Mat gray;
    cv::cvtColor(cv::Mat(kHeight, kWidth, CV_8UC3, const_cast<std::uint8_t*>(image.data())), gray, code);
    for (std::size_t i = 0; i < kPixels; ++i) ASSERT_NEAR(luma[i], gray.data[i], 1);
  }
}

TEST(Luma, BuffersThatAreTooShortAreRefused) {
  for (const PixelLayout layout : {PixelLayout::kGray8, PixelLayout::kGray10, PixelLayout::kYuyv, PixelLayout::kUyvy,
                                   PixelLayout::kRgb24, PixelLayout::kBgr24}) {
    const Bytes image = noise(row_bytes(layout, kWidth) * kHeight);
    Bytes luma(kPixels);
    LumaReader reader(layout, kWidth, kHeight, 0);
    EXPECT_EQ(reader.read(image.data(), image.size(), luma.data()), LumaStatus::kOk);
    EXPECT_EQ(reader.read(image.data(), image.size() - 1, luma.data()), LumaStatus::kShort);
    EXPECT_EQ(reader.read(image.data(), 0, luma.data()), LumaStatus::kShort);
  }
}

Bytes jpeg(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  cv::randu(image, 0, 255);
  cv::GaussianBlur(image, image, {9, 9}, 3);
  Bytes bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 95});
  return bytes;
}

TEST(Luma, JpegIsDecodedAsOpenCvDoes) {
  const Bytes bytes = jpeg(kWidth, kHeight);
  const Bytes luma = read(PixelLayout::kMjpeg, bytes);
  const cv::Mat gray = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  for (std::size_t i = 0; i < kPixels; ++i) ASSERT_NEAR(luma[i], gray.data[i], 2);
}

TEST(Luma, DamagedJpegsAreRefusedAndTheNextOneIsRead) {
  const Bytes whole = jpeg(kWidth, kHeight);
  LumaReader reader(PixelLayout::kMjpeg, kWidth, kHeight, 0);
  Bytes luma(kPixels);
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    Bytes bytes = whole;
    if (trial % 2 == 0) bytes.resize(random() % bytes.size());
    for (unsigned n = random() % 8; n > 0 && !bytes.empty(); --n) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    (void)reader.read(bytes.data(), bytes.size(), luma.data());  // may be valid; must not write beyond `luma`
  }
  EXPECT_EQ(reader.read(whole.data(), whole.size() / 2, luma.data()), LumaStatus::kDamaged);
  const Bytes other = jpeg(kWidth + 2, kHeight);
  EXPECT_EQ(reader.read(other.data(), other.size(), luma.data()), LumaStatus::kDamaged);
  EXPECT_EQ(reader.read(whole.data(), whole.size(), luma.data()), LumaStatus::kOk);
}

}  // namespace
}  // namespace drivers
