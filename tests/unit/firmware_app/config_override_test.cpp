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
#include "tests/support/places.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using tests::kGood;
using tests::refusal;
using tests::refusal_of_line;
using tests::refusal_with;
using tests::replaced;

TEST(Config, OverridesGoThroughTheSameChecks) {
  const AppConfig config =
      parse_config(kGood, "a.yaml",
                   {"camera.rate_hz=50", "camera.rate_hz=60", "regions.0.axis=v", "camera.source=a=b: [c]",
                    "regions.1.rect=[5, 6, 7, 8]", "telemetry.lcm_url=", "identification.references=[base]",
                    "spectrum={segment: 64, overlap: 0}", "regions.2.name=new", "regions.2.rect=[1, 1, 9, 9]"});
  EXPECT_EQ(config.camera.rate_hz, 60.0);
  EXPECT_EQ(config.regions[0].axis_deg, 90.0);
  EXPECT_EQ(config.camera.source, "a=b: [c]");
  EXPECT_EQ(config.regions[1].width_px, 7.0);
  EXPECT_EQ(config.telemetry.lcm_url, "");
  EXPECT_THAT(config.identification.references, ElementsAre("base"));
  EXPECT_EQ(config.spectrum.segment, 64);
  ASSERT_EQ(config.regions.size(), 3U);
  EXPECT_EQ(config.regions[2].name, "new");
}

TEST(Config, NamesTheOverrideThatIsRefused) {
  EXPECT_THAT(refusal(kGood, {"camera.rate_hz=0"}),
              StartsWith("--set camera.rate_hz=0: camera.rate_hz: 0 is refused: allowed 0.001"));
  EXPECT_THAT(refusal(kGood, {"camera.rate=3"}),
              AllOf(StartsWith("--set camera.rate=3"), HasSubstr("`camera.rate_hz`")));
  EXPECT_THAT(refusal(kGood, {"regions.1.name=base"}),
              AllOf(StartsWith("--set regions.1.name=base"), HasSubstr("is already used")));
  for (const char* text : {"",
                           "=",
                           "camera.rate_hz",
                           "=5",
                           "camera=5",
                           "regions=5",
                           "regions.9.axis=u",
                           "regions.x.axis=u",
                           "regions.=u",
                           "regions.0=5",
                           "regions.0.=u",
                           "regions.-1.axis=u",
                           "camera.=3",
                           ".=3",
                           "spectrum={segment: 64",
                           "spectrum={a: &b 1}",
                           "regions.18446744073709551615.name=a",
                           "regions[].name=x",
                           "camera.rate_hz=\n25",
                           "regions=[]"}) {
    EXPECT_THAT(refusal(kGood, {text}), StartsWith("--set ")) << text;
  }
}

TEST(Config, HashFollowsResultsOnly) {
  const auto hash = [](const std::vector<std::string>& overrides) {
    return parse_config(kGood, "a.yaml", overrides).hash;
  };
  const std::uint64_t plain = hash({});
  EXPECT_EQ(hash({"telemetry.lcm_url=", "report.tracks=false", "rt.priority=5", "camera.rate_hz=29.970",
                  "camera.decoder_mb=99"}),
            plain);
  EXPECT_EQ(parse_config(std::string(kGood) + "# note\n", "b.yaml").hash, plain);
  EXPECT_NE(hash({"camera.rate_hz=29.98"}), plain);
  EXPECT_NE(hash({"regions.0.axis=v"}), plain);
  EXPECT_NE(hash({"spectrum.segment=1024"}), plain);
  EXPECT_NE(hash({"scale.adaptive=false"}), plain);
}

TEST(Config, HelpNamesEveryKeyWithinHundredColumns) {
  const std::string help = config_help();
  for (const ConfigKey& key : config_keys()) EXPECT_THAT(help, HasSubstr("\n" + key.path + " ")) << key.path;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(Config, ExampleInTheHelpIsValid) {
  const std::string help = config_help();
  const std::size_t begin = help.find("    method:"), end = help.find("\n\nAny key");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(refusal(help.substr(begin, end - begin) + "\n"), "");
}

TEST(Config, ShippedFilesAreValid) {
  int n_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(tests::source_path("firmware_app/config"))) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW(check_against_image(load_config(entry.path().string()), 1920, 1080)) << entry.path();
    ++n_files;
  }
  EXPECT_GE(n_files, 2);
}

TEST(ConfigImage, RefusesRegionsAndScaleOutsideTheImage) {
  const AppConfig config = parse_config(kGood, "a.yaml");
  EXPECT_NO_THROW(check_against_image(config, 101, 60));
  const auto message = [&](int width, int height) -> std::string {
    try {
      check_against_image(config, width, height);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(message(39, 1000), AllOf(HasSubstr("regions.0.rect"), HasSubstr("`base`"), HasSubstr("39 x 1000 px")));
  EXPECT_THAT(message(1000, 59), HasSubstr("regions.0.rect"));
  EXPECT_THAT(message(100, 1000), HasSubstr("scale.to"));
}

}  // namespace
}  // namespace app
