#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "drivers/storage/csv.h"
#include "drivers/storage/tracks_file.h"
#include "firmware_app/config/config.h"
#include "tests/support/command.h"
#include "tests/support/places.h"

// `hovermodal simulate --scene` as a user runs it.
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

using tests::Outcome;
using tests::read;
using tests::run;

class SimulateScene : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "hovermodal_simulate_scene" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Simulates a scene of this text and gives its truth.
  Json simulate(const std::string& text, const std::string& arguments) {
    std::ofstream(folder_ / "scene.yaml") << text;
    const Outcome outcome = run("hovermodal", "simulate --scene " + (folder_ / "scene.yaml").string() + " " +
                                                  arguments + " --out " + (folder_ / "out").string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
    return outcome.exit_code == 0 ? Json::parse(read(folder_ / "out" / "truth.json")) : Json();
  }
  static std::map<std::string, Json> effects(const Json& truth) {
    std::map<std::string, Json> by_name;
    for (const Json& effect : truth.at("effects")) by_name[effect.at("name")] = effect;
    return by_name;
  }
  [[nodiscard]] std::string config_path() const { return (folder_ / "out" / "config.yaml").string(); }

  fs::path folder_;
};

TEST_F(SimulateScene, EveryExampleMakesItsRecordAndAConfigurationTheServiceTakes) {
  int n = 0;
  for (const auto& entry : fs::directory_iterator(tests::source_path("tools/scenes"))) {
    const fs::path out = folder_ / entry.path().stem();
    const Outcome outcome = run("hovermodal", "simulate --scene " + entry.path().string() +
                                                  (n % 2 == 0 ? " --tracks-only" : " --channels-only") +
                                                  " --duration 2 --points 4 --out " + out.string());
    ASSERT_EQ(outcome.exit_code, 0) << entry.path() << outcome.text;
    EXPECT_NO_THROW((void)app::load_config((out / "config.yaml").string())) << entry.path();
    ++n;
  }
  EXPECT_EQ(n, 7);
}

TEST_F(SimulateScene, ConfigurationTellsWhatIsDeclaredAndTruthTellsAll) {
  const Json truth = simulate(
      "camera: {lens: {model: radial_tangential, k: [-0.1, 0.02, 0.001, 0.002]}, readout_direction: up}\n"
      "declare: {readout_ms: 15, exposure_ms: false}\n",
      "--tracks-only --duration 2 --points 4");
  const app::AppConfig config = app::load_config(config_path());
  EXPECT_DOUBLE_EQ(config.camera.readout_ms, 15.0);
  EXPECT_DOUBLE_EQ(config.camera.exposure_ms, 0.0);
  EXPECT_EQ(config.camera.readout_direction, core::ReadoutDirection::kUp);
  EXPECT_DOUBLE_EQ(config.camera.rate_hz, 25.0);
  EXPECT_DOUBLE_EQ(config.calibration.fx, 2100.0);
  EXPECT_DOUBLE_EQ(config.calibration.distortion[0], -0.1);
  EXPECT_DOUBLE_EQ(config.scale.known_length_mm, 840.0);
  EXPECT_EQ(truth.at("scene").at("camera").at("readout_ms"), 26);
  EXPECT_EQ(truth.at("declared").at("readout_ms"), 15);
  EXPECT_TRUE(truth.at("declared").at("exposure_ms").is_null());
  const drivers::TracksFile tracks = drivers::read_tracks_csv((folder_ / "out" / "tracks.csv").string());
  EXPECT_EQ(tracks.camera.readout_ns, 15'000'000);
  EXPECT_EQ(tracks.camera.exposure_ns, 0);
  EXPECT_EQ(tracks.camera.readout_direction, core::ReadoutDirection::kUp);
}

TEST_F(SimulateScene, AFisheyeIsDeclared) {
  (void)simulate("camera: {lens: {model: equidistant, k: [0.01, 0.02, 0.003, 0.004]}}\n",
                 "--channels-only --duration 2");
  const app::AppConfig config = app::load_config(config_path());
  EXPECT_EQ(config.calibration.model, core::LensModel::kEquidistant);
  EXPECT_DOUBLE_EQ(config.calibration.distortion[3], 0.004);
}

TEST_F(SimulateScene, AnUndeclaredLensOrFocalLengthIsLeftOut) {
  (void)simulate("camera: {lens: {model: equidistant, k: [0.1, 0, 0, 0]}}\ndeclare: {lens: false}\n",
                 "--channels-only --duration 2");
  EXPECT_DOUBLE_EQ(app::load_config(config_path()).calibration.distortion[0], 0.0);
  (void)simulate("declare: {focal_length: false}\n", "--channels-only --duration 2");
  EXPECT_DOUBLE_EQ(app::load_config(config_path()).calibration.fx, 0.0);
  std::ofstream(folder_ / "scene.yaml") << "camera: {lens: {model: radial_tangential, k: [0.1, 0, 0, 0]}}\n"
                                           "declare: {focal_length: false}\n";
  const Outcome refused = run("hovermodal", "simulate --channels-only --scene " + (folder_ / "scene.yaml").string() +
                                                " --out " + (folder_ / "out").string());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.text, HasSubstr("declare.lens"));
}

TEST_F(SimulateScene, TruthSaysHowLargeEachEffectIsInTheTracks) {
  const Json truth = simulate(
      "hover: {x_rms_mm: 0, y_rms_mm: 0, z_rms_mm: 0, roll_rms_deg: 0.1}\n"
      "timing: {drop_probability: 0.01}\ntracks: {noise_px: 0.2, loss_probability: 0.1}\n",
      "--tracks-only --duration 20");
  const auto by_name = effects(truth);
  EXPECT_NEAR(by_name.at("track_noise").at("rms_px").get<double>(), 0.2, 0.01);
  EXPECT_TRUE(by_name.at("track_loss").at("rms_px").is_null());
  EXPECT_TRUE(by_name.at("sensor_noise").at("rms_px").is_null());
  // Announced drops take frames away and move nothing.
  EXPECT_TRUE(by_name.at("drops").at("rms_px").is_null());
  EXPECT_EQ(by_name.at("drops").at("declared"), true);
  EXPECT_EQ(by_name.at("roll").at("declared"), false);
  EXPECT_EQ(by_name.at("roll").at("parameters").at("hover.roll_rms_deg"), 0.1);
  // About 400 px from the centre, 0.1 degrees: 0.7 px, per axis 0.5; the clip's share of a slow drift varies.
  EXPECT_GT(by_name.at("roll").at("rms_px").get<double>(), 0.1);
  EXPECT_LT(by_name.at("roll").at("rms_px").get<double>(), 2.0);
  EXPECT_FALSE(by_name.contains("hover_x"));
  EXPECT_FALSE(by_name.contains("lens"));
}

TEST_F(SimulateScene, UnannouncedDropsMoveWhatIsSeen) {
  const Json truth = simulate("timing: {drop_probability: 0.02}\ndeclare: {timestamps: false}\n",
                              "--tracks-only --duration 20 --points 4");
  const auto by_name = effects(truth);
  EXPECT_EQ(by_name.at("drops").at("declared"), false);
  EXPECT_GT(by_name.at("drops").at("rms_px").get<double>(), 0.05);
}

TEST_F(SimulateScene, ChannelsAreADisplacementsFileThatIdentifyTakes) {
  const Json truth = simulate("seed: 2\n", "--channels-only --duration 120");
  const drivers::SeriesFile file = drivers::read_series_csv((folder_ / "out" / "displacements.csv").string());
  EXPECT_EQ(file.names, (std::vector<std::string>{"frame", "t_s", "scale_mm_per_px", "floor1", "floor2", "floor3",
                                                  "floor4", "floor5", "floor6", "base"}));
  EXPECT_EQ(file.comments.at("unit"), "mm");
  EXPECT_TRUE(file.comments.contains("row_delay_s.floor3"));
  EXPECT_EQ(file.columns[0].size(), 3000U);
  const Outcome outcome =
      run("hovermodal", "identify --max-frequency 20 --base base --series " +
                            (folder_ / "out" / "displacements.csv").string() + " --report " + folder_.string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const Json modal = Json::parse(read(folder_ / "modal.json"));
  for (std::size_t i = 0; i < 4; ++i) {
    const double wanted_hz = truth.at("modes")[i].at("frequency_hz");
    double nearest_hz = 0.0;
    for (const Json& mode : modal.at("modes")) {
      const double f = mode.at("frequency_hz");
      if (std::abs(f - wanted_hz) < std::abs(nearest_hz - wanted_hz)) nearest_hz = f;
    }
    EXPECT_NEAR(nearest_hz, wanted_hz, 0.01 * wanted_hz);
  }
}

TEST_F(SimulateScene, TruthHasOneLineForEachPictureThatIsDelivered) {
  (void)simulate("timing: {drop_probability: 0.1, duplicate_probability: 0.1}\n", "--channels-only --duration 20");
  const drivers::SeriesFile truth = drivers::read_series_csv((folder_ / "out" / "truth_displacements.csv").string());
  const drivers::SeriesFile channels = drivers::read_series_csv((folder_ / "out" / "displacements.csv").string());
  EXPECT_LT(channels.columns[0].size(), 480U);
  EXPECT_LT(truth.columns[0].size(), channels.columns[0].size() - 10);
  EXPECT_GT(truth.columns[0].size(), 350U);
}

TEST_F(SimulateScene, PrintsACompleteSceneThatMakesTheSame) {
  const Outcome printed = run("hovermodal", "simulate --print-scene --preset shear_frame --seed 6 --duration 4");
  ASSERT_EQ(printed.exit_code, 0) << printed.text;
  (void)simulate(printed.text, "--tracks-only");
  const std::string direct = (folder_ / "direct").string();
  ASSERT_EQ(
      run("hovermodal", "simulate --preset shear_frame --seed 6 --duration 4 --tracks-only --out " + direct).exit_code,
      0);
  EXPECT_EQ(read(folder_ / "out" / "tracks.csv"), read(fs::path(direct) / "tracks.csv"));
}

TEST_F(SimulateScene, AChangedSceneIsMadeAnew) {
  (void)simulate("light: {gain_rms: 0.01}\n", "--tracks-only --duration 2 --points 4");
  const auto first = fs::last_write_time(folder_ / "out" / "tracks.csv");
  (void)simulate("# a comment\nlight: {gain_rms: 0.01}\n", "--tracks-only --duration 2 --points 4");
  EXPECT_EQ(fs::last_write_time(folder_ / "out" / "tracks.csv"), first);
  (void)simulate("light: {gain_rms: 0.02}\n", "--tracks-only --duration 2 --points 4");
  EXPECT_NE(fs::last_write_time(folder_ / "out" / "tracks.csv"), first);
}

TEST_F(SimulateScene, ComplexShapesStandInTruthAsPairs) {
  const Json truth = simulate("preset: shear_frame\nstructure: {damping: {kind: dashpots, n_s_per_m: [60, 0, 0, 0]}}\n",
                              "--channels-only --duration 2");
  EXPECT_TRUE(truth.at("modes")[1].at("shape").at("floor1").is_array());
}

TEST_F(SimulateScene, RefusesBadScenesWithExitCode2) {
  const std::string out = " --channels-only --out " + (folder_ / "out").string();
  std::ofstream(folder_ / "bad.yaml") << "camera:\n  readout: 3\n";
  const Outcome unknown = run("hovermodal", "simulate --scene " + (folder_ / "bad.yaml").string() + out);
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.text, HasSubstr("bad.yaml:2: camera.readout: unknown key; did you mean `camera.readout_ms`"));
  EXPECT_EQ(run("hovermodal", "simulate --scene " + (folder_ / "none.yaml").string() + out).exit_code, 2);
  EXPECT_EQ(run("hovermodal", "simulate --scene " + folder_.string() + out).exit_code, 2);
  EXPECT_EQ(run("hovermodal", "simulate --tracks-only" + out).exit_code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(SimulateScene, TheServiceAcceptsTheConfigurationOfAClip) {
  (void)simulate("declare: {readout_ms: 12, exposure_ms: false}\n", "--size 640x360 --duration 1");
  const Outcome checked = run("hovermodald", "--check --set spectrum.segment=16 --config " + config_path());
  EXPECT_EQ(checked.exit_code, 0) << checked.text;
}

}  // namespace
