#include "drivers/storage/regular_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/camera/recording/srt_file.h"
#include "drivers/camera/recording/timestamp_file.h"
#include "drivers/storage/attitude_file.h"
#include "drivers/storage/checkpoint_file.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/json.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"
#include "drivers/storage/tracks_file.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// A pipe without a writer would be waited for, /dev/zero read for ever.
TEST(RegularFile, NoReaderWaitsForAPipeOrReadsADevice) {
  const fs::path folder = test_support::fresh_folder();
  const std::string pipe = (folder / "clip.timestamps.csv").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string device = (folder / "zero.csv").string();
  fs::create_symlink("/dev/zero", device);
  for (const std::string& path : {pipe, device}) {
    EXPECT_THAT(refusal([&] { (void)open_regular_file(path, "name a file"); }), HasSubstr("device or pipe"));
    EXPECT_THAT(refusal([&] { (void)read_timestamp_file(path); }), HasSubstr("device or pipe"));
    EXPECT_THAT(refusal([&] { (void)read_srt(path); }), HasSubstr("device or pipe"));
    EXPECT_THAT(refusal([&] { (void)read_tracks_csv(path); }), HasSubstr("device or pipe"));
    EXPECT_THAT(refusal([&] { (void)read_text_file(path, 100); }), HasSubstr("device or pipe"));
    EXPECT_THAT(read_checkpoint(path).refused, HasSubstr("device or pipe"));
  }
}

TEST(RegularFile, TellsTheSizeOfWhatIsTooLarge) {
  const fs::path path = test_support::fresh_folder() / "large";
  std::ofstream(path) << "0123456789";
  fs::resize_file(path, 5'000'000'000);  // sparse
  EXPECT_THAT(refusal([&] { (void)open_regular_file(path.string(), "name a file", 1000); }),
              AllOf(HasSubstr("5000000000 bytes"), HasSubstr("1000")));
  EXPECT_EQ(bytes_of(open_regular_file(path.string(), "name a file").get()), 5'000'000'000U);
}

TEST(RegularFile, ALineOfTimeStampsIsBounded) {
  const fs::path path = test_support::fresh_folder() / "clip.timestamps.csv";
  std::ofstream(path) << "frame,t_s\n0,0\n1," << std::string(Limits::kLineBytes, '1') << "\n";
  EXPECT_THAT(refusal([&] { (void)read_timestamp_file(path.string()); }),
              HasSubstr(":3: the line is longer than 64 KiB"));
}

TEST(RegularFile, PointsOfARegionAreBounded) {
  const fs::path path = test_support::fresh_folder() / "tracks.csv";
  {
    std::ofstream out(path);
    out << "# image_size_px: 64 x 64\n# rate_hz: 25\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
    for (std::size_t i = 0; i <= Limits::kPointsPerRegion; ++i) out << "0,0," << i << ",roof,1,1,0.1\n";
  }
  EXPECT_THAT(refusal([&] { (void)read_tracks_csv(path.string()); }),
              HasSubstr("more than 4096 points of region `roof`"));
}

TEST(RegularFile, PointsOfAFrameAreBounded) {
  const fs::path path = test_support::fresh_folder() / "tracks.csv";
  {
    std::ofstream out(path);
    out << "# image_size_px: 64 x 64\n# rate_hz: 25\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
    for (std::size_t i = 0; i <= Limits::kPointsPerFrame; ++i) out << "0,0," << i << ",r" << i % 32 << ",1,1,0.1\n";
  }
  EXPECT_THAT(refusal([&] { (void)read_tracks_csv(path.string()); }), HasSubstr("more than 65536 points in one frame"));
}

// The lines are counted before memory is taken for their values.
TEST(RegularFile, ValuesOfATableAreBounded) {
  const fs::path path = test_support::fresh_folder() / "wide.csv";
  constexpr std::size_t kWide = 4000;
  {
    std::ofstream out(path);
    for (std::size_t i = 0; i < kWide; ++i) out << (i == 0 ? "c" : ",c") << i;
    out << std::string(Limits::kSeriesCells / kWide + 2, '\n');
  }
  const auto words = AllOf(HasSubstr("lines of 4000 columns are more than 30000000 values"), HasSubstr("divide"));
  EXPECT_THAT(refusal([&] { (void)read_series_csv(path.string()); }), words);
}

TEST(RegularFile, LinesOfTimesAndAttitudesAreBounded) {
  const fs::path path = test_support::fresh_folder() / "clip.timestamps.csv";
  std::ofstream(path) << "frame,t_s\n" << std::string(Limits::kTimestamps, '\n');
  EXPECT_THAT(refusal([&] { (void)read_timestamp_file(path.string()); }),
              AllOf(HasSubstr("5000002 lines are more than 5000000"), HasSubstr("split the recording")));
  EXPECT_THAT(refusal([&] { (void)read_attitude_csv(path.string()); }), HasSubstr("lines are more than 3000000"));
}

// A list of many objects is read in time with their number; an object of many keys would take its square.
TEST(RegularFile, JsonIsBoundedInDepthAndKeys) {
  const fs::path path = test_support::fresh_folder() / "modal.json";
  const auto refused = [&](const std::string& text) {
    std::ofstream(path) << text;
    return refusal([&] { (void)read_json_file(path.string()); });
  };
  std::string many = "[", keys = "{";
  for (std::size_t i = 0; i < 200'000; ++i) many += "{\"a:[{\\\"\":1},";
  for (std::size_t i = 0; i <= Limits::kJsonKeys; ++i) keys += (i == 0 ? "\"" : ",\"") + std::to_string(i) + "\":1";
  EXPECT_EQ(refused(many + "{}]"), "");
  EXPECT_THAT(refused(keys + "}"), HasSubstr("an object has more than 4096 keys"));
  EXPECT_THAT(refused(std::string(33, '[') + std::string(33, ']')), HasSubstr("nested deeper than 32"));
  EXPECT_EQ(refused(std::string(32, '[') + std::string(32, ']')), "");
}

TEST(RegularFile, CommentsOfATableAreBounded) {
  const fs::path path = test_support::fresh_folder() / "comments.csv";
  {
    std::ofstream out(path);
    for (std::size_t i = 0; i < 20; ++i) out << "# k" << i << ": " << std::string(60 * Limits::kKiB, 'x') << "\n";
    out << "a,b\n1,2\n";
  }
  EXPECT_THAT(refusal([&] { (void)read_series_csv(path.string()); }), HasSubstr("bytes of comments"));
}

}  // namespace
}  // namespace drivers
