#include "drivers/camera/recording/hevc_references.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "drivers/camera/recording/container.h"
#include "tests/support/ffmpeg_clip.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

std::vector<std::uint8_t> extradata_of(int n_references, const std::string& name) {
  const auto clip = test_support::fresh_folder() / name;
  test_support::ffmpeg(fmt::format("{} -c:v libx265 -preset ultrafast -x265-params ref={}:bframes=0:log-level=none {}",
                                   test_support::noisy_film(3), n_references, test_support::quoted(clip)));
  const Container container(clip.string());
  const AVCodecParameters& of = *container.stream().codecpar;
  return {of.extradata, of.extradata + of.extradata_size};
}

// As `ffmpeg -bsf:v trace_headers` shows them (sps_max_dec_pic_buffering_minus1 2, 3 and 8); the decoder hands out one
// more.
TEST(HevcReferences, AreFoundInBothFormsOfTheExtradata) {
  for (const auto& [n, kept] : {std::pair{1, 3}, std::pair{3, 4}, std::pair{8, 9}}) {
    EXPECT_EQ(hevc_references(extradata_of(n, "clip.mp4")), kept);
    EXPECT_EQ(hevc_references(extradata_of(n, "clip.ts")), kept);
  }
}

TEST(HevcReferences, AnyBytesAreAccepted) {
  const std::vector<std::uint8_t> whole = extradata_of(3, "clip.mp4");
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const int found = hevc_references(std::span(whole).first(n));
    EXPECT_TRUE(found == 0 || found == 4) << n;
  }
  std::mt19937 draw(1);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> damaged = whole;
    for (int k = 0; k < 4; ++k) damaged[draw() % damaged.size()] = static_cast<std::uint8_t>(draw());
    const int found = hevc_references(damaged);
    EXPECT_GE(found, 0);
    EXPECT_LE(found, 16);
  }
}

}  // namespace
}  // namespace drivers
