#include "firmware_app/replay/tracks_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "drivers/storage/text_file.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::uint64_t kLater = 2'000'000;

// Two points in frames 0 to 9, and again from frame kLater on.
drivers::TracksFile tracks_with_a_gap() {
  const auto path = std::filesystem::path(::testing::TempDir()) / "tracks_record_gap.csv";
  std::ofstream out(path);
  out.precision(12);
  out << "# image_size_px: 480 x 270\n# rate_hz: 25\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
  for (const std::uint64_t from : {std::uint64_t{0}, kLater}) {
    for (std::uint64_t k = from; k < from + 10; ++k) {
      for (int point = 0; point < 2; ++point)
        out << k << ',' << static_cast<double>(k) / 25.0 << ',' << point << ",top," << 100 + point << ",90,0.02\n";
    }
  }
  out.close();
  return drivers::read_tracks_csv(path.string());
}

AppConfig configuration(const std::string& region) {
  AppConfig config;
  config.regions.resize(1);
  config.regions.front().name = region;
  config.regions.front().u_px = 90.0, config.regions.front().v_px = 80.0;
  config.regions.front().width_px = 40.0, config.regions.front().height_px = 20.0;
  return config;
}

TEST(TracksRecord, OfAnyLengthTheEndCanBeTaken) {
  const TracksRecord record = tracks_record(tracks_with_a_gap(), configuration("top"), 100);
  ASSERT_EQ(record.record.u_px.rows(), 10) << "those before the gap are older than a hundred frames";
  EXPECT_EQ(record.record.u_px.cols(), 2);
}

TEST(TracksRecord, ALongRecordAsAWholeIsRefused) {
  try {
    (void)tracks_record(tracks_with_a_gap(), configuration("top"));
    FAIL() << "accepted";
  } catch (const drivers::FileError& refused) {
    EXPECT_THAT(refused.what(), AllOf(HasSubstr("2000010 frames"), HasSubstr("divide the record")));
  }
}

TEST(TracksRecord, AnotherRunsConfigurationIsRefused) {
  EXPECT_THROW((void)tracks_record(tracks_with_a_gap(), configuration("roof"), 100), drivers::FileError);
}

}  // namespace
}  // namespace app
