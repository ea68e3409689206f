#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "drivers/storage/calibration_file.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "drivers/storage/tracks_file.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/modal_json.h"
#include "tests/support/places.h"
#include "tests/support/track_frames.h"

namespace {

// Damages a valid file as editors, transfers, typing errors and attackers might.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  [[nodiscard]] std::string mutate(std::string text) {
    const std::size_t n = 1 + below(4);
    for (std::size_t i = 0; i < n; ++i) text = once(std::move(text));
    return text;
  }

 private:
  [[nodiscard]] std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  [[nodiscard]] std::string once(std::string text) {
    static const std::vector<std::string> kSplices{"[",
                                                   "]",
                                                   "{",
                                                   "}",
                                                   ": ",
                                                   "- ",
                                                   "? ",
                                                   "&a ",
                                                   "*a",
                                                   "!!x ",
                                                   "\t",
                                                   "\n",
                                                   "\"",
                                                   "'",
                                                   "|\n",
                                                   ">\n",
                                                   "---\n",
                                                   "...\n",
                                                   "%YAML 9.9\n",
                                                   "~",
                                                   ".nan",
                                                   ".inf",
                                                   "1e999",
                                                   "-0",
                                                   "99999999999999999999",
                                                   ",",
                                                   ",,",
                                                   "#",
                                                   "\r\n",
                                                   std::string(1, '\0'),
                                                   "\xff",
                                                   "\xef\xbb\xbf",
                                                   "<<: ",
                                                   "=",
                                                   "0x10",
                                                   "1_000",
                                                   "true",
                                                   "null",
                                                   std::string(500, '['),
                                                   std::string(300, '-') + " "};
    switch (below(7)) {
      case 0:
        if (!text.empty()) text[below(text.size())] ^= static_cast<char>(1U << below(8));
        return text;
      case 1:
        return text.substr(0, below(text.size() + 1));
      case 2:
        return text.insert(below(text.size() + 1), kSplices[below(kSplices.size())]);
      case 3:
        return text.erase(below(text.size() + 1), below(12));
      default:
        return with_lines(std::move(text));
    }
  }

  [[nodiscard]] std::string with_lines(std::string text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    if (lines.empty()) return text;
    const std::size_t i = below(lines.size()), j = below(lines.size());
    switch (below(4)) {
      case 0:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(i), lines[j]);
        break;
      case 1:
        std::swap(lines[i], lines[j]);
        break;
      case 2:
        lines[i].insert(0, below(6), ' ');
        break;
      default:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i));
        break;
    }
    text.clear();
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }

  std::mt19937_64 random_;
};

std::string shipped(const std::string& name) {
  return drivers::read_text_file(tests::source_path("firmware_app/config/") + name, 1U << 20U);
}

// Runs `read` on mutations of `text`; any exception except Expected is a failure. Returns the numbers accepted and
// refused.
template <class Expected, class Read>
std::pair<int, int> fuzz(const std::string& text, int n_cases, const Read& read) {
  int n_taken = 0, n_refused = 0;
  for (int seed = 0; seed < n_cases; ++seed) {
    const std::string mutation = Mutator(static_cast<std::uint64_t>(seed)).mutate(text);
    try {
      read(mutation);
      ++n_taken;
    } catch (const Expected& error) {
      EXPECT_STRNE(error.what(), "");
      ++n_refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "seed " << seed << " let this through: " << error.what();
    }
  }
  EXPECT_GT(n_refused, n_cases / 20) << "the mutations do no harm";
  EXPECT_GT(n_taken, 0) << "the mutations leave nothing whole";
  return {n_taken, n_refused};
}

class FuzzFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = std::filesystem::path(::testing::TempDir()) / "config_fuzz_test";
    std::filesystem::create_directories(folder);
    path_ = (folder / ::testing::UnitTest::GetInstance()->current_test_info()->name()).string();
  }
  [[nodiscard]] const std::string& write(const std::string& text) const {
    std::filesystem::remove(
        path_);  // a truncated file is synchronised to disk when it is closed: a hundred times slower
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  std::string path_;
};

TEST(ConfigFuzz, GivesAConfigurationOrConfigError) {
  for (const char* name : {"example.yaml", "synthetic.yaml"}) {
    fuzz<app::ConfigError>(shipped(name), 3000, [](const std::string& text) {
      const app::AppConfig config = app::parse_config(text, "fuzz");
      ASSERT_FALSE(config.regions.empty());
      ASSERT_TRUE(config.camera.rate_hz == 0.0 || (config.camera.rate_hz >= 1e-3 && config.camera.rate_hz <= 1e6));
      for (const core::Region& region : config.regions) ASSERT_TRUE(region.width_px >= 1.0 && region.height_px >= 1.0);
    });
  }
}

TEST(ConfigFuzz, OverridesGiveAConfigurationOrConfigError) {
  const std::string text = shipped("example.yaml");
  for (const char* good :
       {"camera.rate_hz=25", "regions.0.rect=[1, 2, 3, 4]", "scale={known_length_mm: 3, from: [1, 2], to: [3, 4]}"}) {
    fuzz<app::ConfigError>(good, 500, [&](const std::string& mutation) {
      static_cast<void>(app::parse_config(text, "fuzz", {mutation}));
    });
  }
}

TEST(CalibrationFuzz, GivesACalibrationOrFileError) {
  const std::string kalibr =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.29, 0.08, -0.0003, 0.0001]\n  distortion_model: "
      "radtan\n"
      "  intrinsics: [461.6, 460.1, 362.6, 246.0]\n  resolution: [752, 480]\n";
  const std::string opencv =
      "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   "
      "dt: d\n"
      "   data: [ 650., 0., 320., 0., 660., 240., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n"
      "   cols: 1\n   dt: d\n   data: [ -0.4, 0.2, 0., 0., -0.05 ]\n";
  const std::string ros =
      "height: 480\nwidth: 640\ndistortion_model: equidistant\nD: [-0.01, 0.02, -0.003, 0.0004]\n"
      "K: [350.5, 0.0, 320.0, 0.0, 351.5, 240.0, 0.0, 0.0, 1.0]\n";
  for (const std::string& text : {kalibr, opencv, ros}) {
    fuzz<drivers::FileError>(text, 2000, [](const std::string& mutation) {
      const drivers::Calibration c = drivers::parse_calibration(mutation, "fuzz");
      ASSERT_EQ(drivers::calibration_fault(c.camera, c.width_px, c.height_px), "");
    });
  }
}

TEST_F(FuzzFile, TracksGiveFramesOrFileError) {
  std::string text =
      "# image_size_px: 640 x 480\n# rate_hz: 25\n# readout_ms: 10\n# regions: "
      "a,b\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
  for (int k = 0; k < 20; ++k) text += std::to_string(k) + ",0." + std::to_string(100 + k) + ",1,a,10.5,20.5,0.05\n";
  fuzz<drivers::FileError>(text, 3000, [&](const std::string& mutation) {
    const drivers::TracksFile tracks = drivers::read_tracks_csv(write(mutation));
    const std::vector<core::TrackFrame> frames = tests::frames_of(tracks);
    for (std::size_t k = 1; k < frames.size(); ++k) ASSERT_GT(frames[k].t_start_ns, frames[k - 1].t_start_ns);
    for (const auto& frame : frames)
      for (const auto& point : frame.points) ASSERT_LT(point.region, tracks.region_names.size());
  });
}

TEST_F(FuzzFile, SeriesGiveColumnsOrFileError) {
  std::string text = "# unit: mm\nframe,t_s,a,b\n";
  for (int k = 0; k < 20; ++k) text += std::to_string(k) + ",0." + std::to_string(100 + k) + ",1.5,\n";
  fuzz<drivers::FileError>(text, 3000, [&](const std::string& mutation) {
    const drivers::SeriesFile series = drivers::read_series_csv(write(mutation));
    for (const auto& column : series.columns) ASSERT_EQ(column.size(), series.columns.front().size());
  });
}

TEST_F(FuzzFile, ModalJsonGivesModesOrFileError) {
  core::ModalEstimate estimate;
  estimate.modes.resize(2);
  for (core::Mode& mode : estimate.modes) mode.shape = {{1.0, 0.0}, {0.5, -0.25}};
  const std::string text = app::modal_json({"paper", {"a", "b"}, estimate, {"x"}, {}});
  fuzz<drivers::FileError>(text, 3000, [&](const std::string& mutation) {
    const app::ModalReport report = app::read_modal_json(write(mutation));
    for (const core::Mode& mode : report.estimate.modes)
      ASSERT_TRUE(mode.shape.empty() || mode.shape.size() == report.channel_names.size());
  });
}

}  // namespace
