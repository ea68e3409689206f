#include "firmware_app/config/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "firmware_app/config/config_image.h"
#include "firmware_app/config/config_table.h"
#include "tests/support/config_text.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using tests::kGood;
using tests::refusal;
using tests::refusal_of_line;
using tests::refusal_with;

TEST(Config, TakesEveryWrittenValueAndKeepsDefaults) {
  const AppConfig config = parse_config(kGood, "a.yaml");
  EXPECT_EQ(config.method, Method::kPaper);
  EXPECT_EQ(config.camera.driver, drivers::CameraKind::kFile);
  EXPECT_EQ(config.camera.source, "clip.mp4");
  EXPECT_EQ(config.camera.rate_hz, 29.97);
  ASSERT_EQ(config.regions.size(), 2U);
  EXPECT_EQ(config.regions[0].name, "base");
  EXPECT_EQ(config.regions[0].role, core::RegionRole::kBase);
  EXPECT_EQ(config.regions[0].u_px, 10.0);
  EXPECT_EQ(config.regions[0].v_px, 20.0);
  EXPECT_EQ(config.regions[0].width_px, 30.0);
  EXPECT_EQ(config.regions[0].height_px, 40.0);
  EXPECT_FALSE(config.regions[0].both_axes);
  EXPECT_TRUE(config.regions[1].both_axes);
  EXPECT_EQ(config.scale.known_length_mm, 300.0);
  EXPECT_EQ(config.scale.to_px[0], 100.0);
  EXPECT_EQ(config.spectrum.segment, SpectrumConfig{}.segment);
  EXPECT_NE(config.hash, 0U);
}

TEST(Config, PaperTakesTheCamerasVelocityUnlessARegionsIsAskedFor) {
  EXPECT_EQ(parse_config(kGood, "a.yaml").paper.velocity, core::ShutterVelocity::kCamera);
  EXPECT_EQ(parse_config(kGood, "a.yaml", {"paper.velocity=region"}).paper.velocity, core::ShutterVelocity::kRegion);
  EXPECT_THAT(refusal_of_line("paper: {velocity: structure}"),
              AllOf(HasSubstr("paper.velocity"), HasSubstr("camera | region")));
  EXPECT_THAT(config_help(), HasSubstr("default: camera   allowed: camera | region"));
}

TEST(Config, TakesEveryDefaultOfTheTableBack) {
  AppConfig defaults;
  defaults.regions.resize(1);
  for (const ConfigKey& key : config_keys()) {
    if (!key.default_text.empty()) continue;  // keys for which absence is not a value
    drivers::YamlNode node = drivers::parse_yaml("k: " + key.canonical(defaults, 0), "d").items[0];
    AppConfig other;
    other.regions.resize(1);
    EXPECT_EQ(key.set(other, 0, node), std::nullopt) << key.path;
    EXPECT_EQ(key.canonical(other, 0), key.canonical(defaults, 0)) << key.path;
  }
}

// One valid value other than the default per key: shows that no two keys share a member and none is forgotten.
TEST(Config, EachKeySetsItsOwnMemberOnly) {
  const std::map<std::string, std::string> special{
      {"method", "paper"},
      {"paper.velocity", "region"},
      {"camera.driver", "v4l2"},
      {"camera.decoder_mb", "300"},
      {"camera.pace", "realtime"},
      {"camera.transport", "udp"},
      {"camera.readout_direction", "left"},
      {"camera.size", "[640, 480]"},
      {"camera.mount_rpy_deg", "[1, 2, 3]"},
      {"calibration.distortion", "[1, 2, 3, 4, 5]"},
      {"calibration.model", "equidistant"},
      {"regions[].length", "[1, 2, 3, 4, 5]"},
      {"scale.lengths", "[[1, 2, 3, 4, 5]]"},
      {"scale.points", "[[1, 2, 0, 0], [9, 2, 5, 0], [9, 9, 5, 5], [1, 9, 0, 5]]"},
      {"regions[].rect", "[5, 6, 7, 8]"},
      {"regions[].role", "base"},
      {"regions[].axis", "12.5"},
      {"scale.from", "[3, 4]"},
      {"scale.to", "[3, 4]"},
      {"spectrum.window", "boxcar"},
      {"spectrum.witness", "false"},
      {"spectrum.overlap", "0.25"},
      {"identification.references", "[a, b]"},
      {"identification.min_mpc", "0.5"},
      {"identification.max_damping", "0.5"},
      {"tracking.search_px", "70"},
      {"tracking.least_correlation", "0.5"},
      {"tracking.corner_quality", "0.5"},
      {"telemetry.preview_px", "100"},
      {"telemetry.max_kbit_s", "64"},
      {"report.tracks", "false"},
      {"report.notes", "[\"place: here\", wind]"},
      {"closure.adopt", "off"},
      {"closure.window_s", "70"},
      {"closure.period_s", "70"},
      {"scale.adaptive", "false"},
      {"scale.only", "false"},
      {"rt.required", "true"},
      {"rt.thin_overload", "false"},
      {"rt.lock_memory", "true"},
      {"spectrum.segment", "64"}};
  for (const ConfigKey& key : config_keys()) {
    AppConfig before, after;
    before.regions.resize(1);
    after.regions.resize(1);
    const auto value = special.find(key.path);
    const drivers::YamlNode node =
        drivers::parse_yaml("k: " + (value == special.end() ? "7" : value->second), "v").items[0];
    ASSERT_EQ(key.set(after, 0, node), std::nullopt) << key.path;
    for (const ConfigKey& other : config_keys()) {
      EXPECT_EQ(other.canonical(before, 0) != other.canonical(after, 0), other.path == key.path)
          << key.path << " and " << other.path;
    }
  }
}

TEST(Config, NamesFileLineKeyValueRangeAndRemedy) {
  EXPECT_EQ(refusal_with("rate_hz: 29.97", "rate_hz: 2e7"),
            "a.yaml:5: camera.rate_hz: 2e7 is refused: allowed 0.001 .. 1000000 (Hz); write a smaller number");
  EXPECT_EQ(
      refusal_with("axis: both", "axis: w"),
      "a.yaml:10: regions.1.axis: w is refused: allowed auto | u | v | both | -360 .. 360 (degrees); write auto, u, v, "
      "both, or an angle");
}

TEST(Config, RefusesZeroRateWhenWritten) {
  for (const char* rate : {"0", "-25", "0.0", ".nan", "nan", ".inf", "inf", "1e999", "\"25\"", "25 Hz", "0x19", "[25]",
                           "{a: 1}", "~", ""}) {
    EXPECT_THAT(refusal_with("rate_hz: 29.97", std::string("rate_hz: ") + rate), HasSubstr("a.yaml:5: camera.rate_hz"))
        << rate;
  }
}

TEST(Config, RefusesUnknownKeysAndSuggestsTheNearest) {
  EXPECT_THAT(refusal_with("rate_hz:", "rate:"),
              AllOf(HasSubstr("a.yaml:5: camera.rate: unknown key"), HasSubstr("`camera.rate_hz`")));
  EXPECT_THAT(refusal_of_line("spektrum: {segment: 64}"), AllOf(HasSubstr("a.yaml:12"), HasSubstr("`spectrum`")));
  EXPECT_THAT(refusal_of_line("tracking: {lcm_url: x}"), HasSubstr("`telemetry.lcm_url`"));
  EXPECT_THAT(refusal_of_line("tracking: {window: 21}"), HasSubstr("`tracking.window_px`"));
  EXPECT_THAT(refusal_with("axis:", "axes:"), HasSubstr("`regions[].axis`"));
  EXPECT_THAT(refusal_of_line("spectrum: {qqqqqqqqqqqqqq: 1}"), HasSubstr("segment"));
}

TEST(Config, RefusesPathNotationAsKeys) {
  EXPECT_THAT(refusal_of_line("camera.rate_hz: 30"), HasSubstr("a.yaml:12: camera.rate_hz: unknown key"));
  EXPECT_THAT(refusal("regions[]: {name: a}\n"), HasSubstr("a.yaml:1: regions[]: unknown key"));
  EXPECT_THAT(refusal("\"regions[].name\": a\n"), HasSubstr("unknown key"));
}

TEST(Config, RefusesDuplicateKeysAtEveryLevel) {
  EXPECT_THAT(refusal_with("rate_hz: 29.97", "rate_hz: 25\n  rate_hz: 26"),
              AllOf(HasSubstr("a.yaml:6"), HasSubstr("`rate_hz`"), HasSubstr("line 5")));
  EXPECT_THAT(refusal_of_line("method: paper"), AllOf(HasSubstr("a.yaml:12"), HasSubstr("written twice")));
  EXPECT_THAT(refusal_of_line("camera: {}"), HasSubstr("written twice"));
  EXPECT_THAT(refusal_with("{name: base,", "{name: base, name: top,"), HasSubstr("written twice"));
}

TEST(Config, RefusesBrokenRegions) {
  EXPECT_THAT(refusal("camera: {source: a}\n"), HasSubstr("a.yaml: regions: no region is refused"));
  EXPECT_THAT(refusal("camera: {source: a}\nregions: []\n"), HasSubstr("a.yaml:2: regions"));
  EXPECT_THAT(refusal("camera: {source: a}\nregions:\n"), HasSubstr("a.yaml:2: regions"));
  EXPECT_THAT(refusal_with("name: roof", "name: base"),
              AllOf(HasSubstr("a.yaml:8"), HasSubstr("`base` is already used")));
  EXPECT_THAT(refusal_with("name: base", "name: roof.u"), HasSubstr("`roof.u` is already used"));
  for (const char* name : {"\"\"", "\"a b\"", "a/b", "a,b", "ä", R"("a\nb")", "~", "[a]"}) {
    EXPECT_THAT(refusal_with("name: roof", std::string("name: ") + name), HasSubstr("a.yaml:8: regions.1.name"))
        << name;
  }
  EXPECT_THAT(refusal_with("name: roof", "axis: u").empty(), false);
  for (const char* rect : {"[1, 2, 0, 4]", "[1, 2, 3, -4]", "[1, 2, 3]", "[1, 2, 3, 4, 5]", "7", "[1, 2, 3, .nan]",
                           "[-1, 2, 3, 4]", "[1, 2, 3, x]", "[[1], 2, 3, 4]"}) {
    EXPECT_THAT(refusal_with("rect: [1, 2, 3, 4]", std::string("rect: ") + rect), HasSubstr("a.yaml:9: regions.1.rect"))
        << rect;
  }
  EXPECT_THAT(refusal("camera: {source: a}\nregions: [{name: a}]\n"), HasSubstr("regions.0.rect: nothing is refused"));
  EXPECT_THAT(refusal("camera: {source: a}\nregions: [{rect: [1, 2, 3, 4]}]\n"),
              HasSubstr("regions.0.name: nothing is refused"));
  EXPECT_THAT(refusal("camera: {source: a}\nregions: [{name: a, rect: [1, 2, 3, 4], role: background}]\n"),
              HasSubstr("only static regions"));
  EXPECT_THAT(refusal("camera: {source: a}\nregions: [base]\n"), HasSubstr("regions.0: base is refused"));
}

TEST(Config, RefusesBrokenScale) {
  EXPECT_THAT(refusal_with("known_length_mm: 300", "known_length_mm: 300, only: sometimes"),
              HasSubstr("true | false | auto"));
  EXPECT_THAT(refusal_with("to: [100, 0]", "to: [0, 0]"), HasSubstr("scale.to"));
  EXPECT_THAT(refusal_with("known_length_mm: 300", "known_length_mm: 0"),
              HasSubstr("scale.known_length_mm: 0 is refused"));
  EXPECT_THAT(refusal_with("known_length_mm: 300", "known_length_mm: -1"), HasSubstr("scale.known_length_mm"));
  EXPECT_THAT(refusal_with("known_length_mm: 300, ", ""), HasSubstr("scale.known_length_mm: nothing"));
  EXPECT_THAT(refusal_with(", to: [100, 0]", ""), HasSubstr("scale.to: nothing"));
  EXPECT_THAT(refusal_with("from: [0, 0], ", ""), HasSubstr("scale.from: nothing"));
}

TEST(Config, RefusesBrokenCalibration) {
  EXPECT_THAT(refusal_of_line("calibration: {fx: 1000}"), HasSubstr("calibration.fy: nothing"));
  EXPECT_THAT(refusal_of_line("calibration: {distortion: [1, 2, 3, 4]}"), HasSubstr("calibration.fx: nothing"));
  EXPECT_THAT(refusal_of_line("calibration: {file: c.yaml, fx: 1, fy: 1, cx: 1, cy: 1}"), HasSubstr("not both"));
  EXPECT_THAT(refusal_of_line("calibration: {fx: 0, fy: 1, cx: 1, cy: 1}"), HasSubstr("calibration.fx: 0 is refused"));
  EXPECT_THAT(refusal_of_line("calibration: {fx: 9, fy: 9, cx: 1, cy: 1, distortion: [1, 2, 3]}"),
              HasSubstr("4 to 8 numbers"));
  EXPECT_EQ(refusal_of_line("calibration: {fx: 9, fy: 9, cx: 1, cy: 1, distortion: [1, 2, 3, 4]}"), "");
  EXPECT_EQ(refusal_of_line("calibration: {file: c.yaml}"), "");
}

TEST(Config, RefusesOtherOutOfRangeValues) {
  for (const char* line :
       {"spectrum: {segment: 15}", "spectrum: {segment: 64.5}", "spectrum: {segment: 6e2}",
        "spectrum: {segment: 99999999999999999999}", "spectrum: {overlap: 0.96}", "spectrum: {window: welch}",
        "identification: {period: 0}", "identification: {min_mpc: 1.1}", "tracking: {points_per_region: 0}",
        "telemetry: {channel_prefix: a b}", "telemetry: {displacement_every: 0}", "rt: {priority: 99}",
        "rt: {required: 1}", "report: {tracks: maybe}", "tracking: {min_points: 31}", "tracking: 5", "tracking: [1]"}) {
    EXPECT_THAT(refusal_of_line(line), AllOf(StartsWith("a.yaml:12: "), HasSubstr("is refused: allowed"))) << line;
  }
  EXPECT_THAT(refusal_with("driver: file", "driver: usb"), HasSubstr("file | synthetic | v4l2 | libcamera | stream"));
  EXPECT_THAT(refusal_with("  source: clip.mp4\n", ""), HasSubstr("camera.source: nothing is refused"));
  EXPECT_EQ(refusal_with("driver: file\n  source: clip.mp4", "driver: synthetic"), "");
  EXPECT_EQ(refusal_of_line("tracking:"), "");  // all keys commented out
}

TEST(Config, RefusesReferencesThatNameNoChannel) {
  EXPECT_THAT(refusal_of_line("identification: {references: [floor9]}"),
              AllOf(HasSubstr("a.yaml:12"), HasSubstr("base | roof.u | roof.v")));
  EXPECT_THAT(refusal_of_line("identification: {references: [roof]}"), HasSubstr("roof is refused"));
  EXPECT_THAT(refusal_of_line("identification: {references: [base, base]}"), HasSubstr("each name once"));
  EXPECT_EQ(refusal_of_line("identification: {references: [base, roof.v]}"), "");
}

TEST(Config, RefusesWhatIsNoPlainYaml) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("is empty"));
  EXPECT_THAT(refusal("~\n"), HasSubstr("is empty"));
  EXPECT_THAT(refusal("hello\n"), HasSubstr("a.yaml:1"));
  EXPECT_THAT(refusal("- a\n- b\n"), HasSubstr("a.yaml:1"));
  EXPECT_THAT(refusal("a: [1\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(refusal("camera:\n\tsource: x\n"), AllOf(HasSubstr("a.yaml:2"), HasSubstr("tab")));
  EXPECT_THAT(refusal(std::string("camera:\n  source: a\0b", 21)), AllOf(HasSubstr("a.yaml:2"), HasSubstr("0x00")));
  EXPECT_THAT(refusal("\x7f"
                      "ELF\x02\x01"),
              HasSubstr("binary"));
  EXPECT_THAT(refusal("camera: {source: \xff\xfe}"), HasSubstr("UTF-8"));
  EXPECT_THAT(refusal(std::string(kGood) + "---\nmethod: paper\n"), HasSubstr("more than one document"));
  EXPECT_THAT(refusal("camera: &c {source: a}\nregions: *c\n"), HasSubstr("anchors"));
  EXPECT_THAT(refusal("? [a, b]\n: c\n"), HasSubstr("a.yaml:1"));
  EXPECT_THAT(refusal(std::string(2U << 20U, '#')), HasSubstr("larger than"));
}

TEST(Config, RefusesDeepNestingWithoutRecursion) {
  for (const char* opening : {"[", "{", "- ", "? ", "{a: ", "a: [", "[{"}) {
    std::string text;
    while (text.size() < 300000) text += opening;
    EXPECT_FALSE(refusal(text).empty()) << opening;
  }
}

TEST(Config, RefusesMissingFilesAndDirectories) {
  EXPECT_THROW(static_cast<void>(load_config("/nonexistent/a.yaml")), ConfigError);
  EXPECT_THROW(static_cast<void>(load_config(::testing::TempDir())), ConfigError);
  EXPECT_THROW(static_cast<void>(load_config("/dev/zero")), ConfigError);
  EXPECT_THROW(static_cast<void>(load_config("")), ConfigError);
}

}  // namespace
}  // namespace app
