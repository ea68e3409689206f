#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <jpeglib.h>

#include "tests/device/uvc_descriptors.h"

namespace usb {

using Image = std::vector<std::uint8_t>;

// A colour JPEG, 4:2:0 as in cameras, of a gray image; the colours are arbitrary and smooth.
inline Image jpeg_of(const std::uint8_t* gray, int width_px, int height_px) {
  constexpr int kQuality = 90;
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long n_bytes = 0;
  jpeg_mem_dest(&encoder, &bytes, &n_bytes);
  encoder.image_width = static_cast<JDIMENSION>(width_px);
  encoder.image_height = static_cast<JDIMENSION>(height_px);
  encoder.input_components = 3;
  encoder.in_color_space = JCS_YCbCr;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, kQuality, TRUE);
  jpeg_start_compress(&encoder, TRUE);
  Image row(3 * static_cast<std::size_t>(width_px));
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      std::uint8_t* pixel = row.data() + 3 * u;
      pixel[0] = gray[static_cast<std::ptrdiff_t>(v) * width_px + u];
      pixel[1] = static_cast<std::uint8_t>(64 + u % 128);
      pixel[2] = static_cast<std::uint8_t>(64 + v % 128);
    }
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&encoder, &line, 1);
  }
  jpeg_finish_compress(&encoder);
  Image out(bytes, bytes + n_bytes);
  jpeg_destroy_compress(&encoder);
  std::free(bytes);
  return out;
}

// Its luma, as every reader should decode it.
inline Image luma_of(const Image& jpeg) {
  jpeg_decompress_struct decoder{};
  jpeg_error_mgr errors{};
  decoder.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&decoder);
  jpeg_mem_src(&decoder, jpeg.data(), jpeg.size());
  jpeg_read_header(&decoder, TRUE);
  decoder.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&decoder);
  Image gray(static_cast<std::size_t>(decoder.output_width) * decoder.output_height);
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW line = gray.data() + static_cast<std::size_t>(decoder.output_scanline) * decoder.output_width;
    jpeg_read_scanlines(&decoder, &line, 1);
  }
  jpeg_finish_decompress(&decoder);
  jpeg_destroy_decompress(&decoder);
  return gray;
}

// The gray frames of a file, as transmitted.
inline std::vector<Image> played_frames(const std::string& path, const VideoMode& mode) {
  std::ifstream file(path, std::ios::binary);
  const Image gray((std::istreambuf_iterator<char>(file)), {});
  const std::size_t n_pixels = mode.pixels();
  std::vector<Image> images;
  for (std::size_t at = 0; at + n_pixels <= gray.size(); at += n_pixels) {
    const std::uint8_t* first = gray.data() + at;
    switch (mode.format) {
      case VideoFormat::kGray:
        images.emplace_back(first, first + n_pixels);
        break;
      case VideoFormat::kYuyv:
        images.emplace_back();
        for (std::size_t i = 0; i < n_pixels; ++i) images.back().insert(images.back().end(), {first[i], 128});
        break;
      case VideoFormat::kMjpeg:
        images.push_back(jpeg_of(first, mode.width_px, mode.height_px));
        break;
    }
  }
  if (images.empty()) throw std::runtime_error(path + ": not one frame of that size");
  return images;
}

// For MJPEG, which is not lossless: the luma that was sent, in one file.
inline void write_luma(const std::string& path, const std::vector<Image>& jpegs) {
  std::ofstream file(path, std::ios::binary);
  for (const Image& jpeg : jpegs) {
    const Image gray = luma_of(jpeg);
    file.write(reinterpret_cast<const char*>(gray.data()), static_cast<std::streamsize>(gray.size()));
  }
}

}  // namespace usb
