#include "drivers/images/image_encoder.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

// After <cstdio>: jpeglib.h uses FILE without including it.
#include <jpeglib.h>
// After jpeglib.h.
#include <jerror.h>

namespace drivers {
namespace {

void require_type(const cv::Mat& image, int type, const char* what) {
  if (image.empty() || image.type() != type) throw std::invalid_argument(std::string(what) + ": wrong type of pixels");
}

// False: no memory is left.
[[nodiscard]] bool lengthen(std::vector<std::uint8_t>& bytes, std::size_t more) noexcept {
  try {
    bytes.resize(bytes.size() + more);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// libjpeg and libpng report errors by callbacks that must not return: longjmp, across their C frames only. No object
// with a destructor is constructed between setjmp and the jump.
struct JpegWriter {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  std::jmp_buf failed{};
  jpeg_destination_mgr to{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  std::vector<std::uint8_t> bytes;

  JpegWriter() {
    encoder.err = jpeg_std_error(&errors);
    encoder.client_data = this;
    errors.error_exit = [](j_common_ptr common) {
      auto* self = static_cast<JpegWriter*>(common->client_data);
      self->errors.format_message(common, self->message.data());
      std::longjmp(self->failed, 1);
    };
    errors.emit_message = [](j_common_ptr, int) {};  // otherwise warnings go to stderr
    errors.output_message = [](j_common_ptr) {};
    if (setjmp(failed) != 0) throw std::bad_alloc();  // nothing else fails in it
    jpeg_create_compress(&encoder);
    // Not jpeg_mem_dest(): where the memory for a larger buffer is refused, it leaves a pointer to the freed one.
    to.init_destination = [](j_compress_ptr started) { grow(started, kFirstBytes); };
    to.empty_output_buffer = [](j_compress_ptr full) -> boolean {
      grow(full, of(full).bytes.size());
      return TRUE;
    };
    to.term_destination = [](j_compress_ptr done) {
      of(done).bytes.resize(of(done).bytes.size() - of(done).to.free_in_buffer);
    };
    encoder.dest = &to;
  }
  ~JpegWriter() { jpeg_destroy_compress(&encoder); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  static constexpr std::size_t kFirstBytes = 1 << 14;
  [[nodiscard]] static JpegWriter& of(j_compress_ptr encoder) {
    return *static_cast<JpegWriter*>(encoder->client_data);
  }
  static void grow(j_compress_ptr encoder, std::size_t more) {
    JpegWriter& self = of(encoder);
    const std::size_t n = self.bytes.size();
    if (!lengthen(self.bytes, more)) ERREXIT1(encoder, JERR_OUT_OF_MEMORY, 0);
    self.to.next_output_byte = self.bytes.data() + n;
    self.to.free_in_buffer = more;
  }

  [[nodiscard]] bool write(const cv::Mat& gray, int quality, bool optimize) noexcept {
    if (setjmp(failed) != 0) return false;
    encoder.image_width = static_cast<JDIMENSION>(gray.cols);
    encoder.image_height = static_cast<JDIMENSION>(gray.rows);
    encoder.input_components = 1;
    encoder.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&encoder);
    jpeg_set_quality(&encoder, quality, TRUE);
    encoder.optimize_coding = optimize ? TRUE : FALSE;
    jpeg_start_compress(&encoder, TRUE);
    while (encoder.next_scanline < encoder.image_height) {
      auto* row = const_cast<JSAMPROW>(gray.ptr(static_cast<int>(encoder.next_scanline)));
      jpeg_write_scanlines(&encoder, &row, 1);
    }
    jpeg_finish_compress(&encoder);
    return true;
  }
};

struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 128> message{};
  std::vector<std::uint8_t> bytes;

  PngWriter() {
    png = png_create_write_struct(
        PNG_LIBPNG_VER_STRING, this,
        [](png_structp failed, png_const_charp text) {
          auto* self = static_cast<PngWriter*>(png_get_error_ptr(failed));
          std::snprintf(self->message.data(), self->message.size(), "%s", text);
          png_longjmp(failed, 1);
        },
        [](png_structp, png_const_charp) {});
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  static void append(png_structp png, png_bytep data, std::size_t n) {
    std::vector<std::uint8_t>& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes;
    if (!lengthen(bytes, n)) png_error(png, "out of memory");
    std::copy_n(data, n, bytes.end() - static_cast<std::ptrdiff_t>(n));
  }

  [[nodiscard]] bool write(const cv::Mat& bgr, int level) {
    if (png == nullptr || info == nullptr) return false;
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, this, &append, [](png_structp) {});
    png_set_compression_level(png, level);
    png_set_compression_strategy(png, 0);  // Z_DEFAULT_STRATEGY
    png_set_IHDR(png, info, static_cast<png_uint_32>(bgr.cols), static_cast<png_uint_32>(bgr.rows), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_bgr(png);
    for (int v = 0; v < bgr.rows; ++v) png_write_row(png, bgr.ptr(v));
    png_write_end(png, info);
    return true;
  }
};

}  // namespace

std::vector<std::uint8_t> encode_jpeg(const cv::Mat& gray, int quality, bool optimize) {
  require_type(gray, CV_8UC1, "JPEG");
  JpegWriter writer;
  if (!writer.write(gray, quality, optimize)) {
    throw std::runtime_error(std::string("the image cannot be written as JPEG: ") + writer.message.data());
  }
  return std::move(writer.bytes);
}

std::vector<std::uint8_t> encode_png(const cv::Mat& bgr, int level) {
  require_type(bgr, CV_8UC3, "PNG");
  PngWriter writer;
  if (!writer.write(bgr, level)) {
    throw std::runtime_error(std::string("the image cannot be written as PNG: ") + writer.message.data());
  }
  return std::move(writer.bytes);
}

}  // namespace drivers
