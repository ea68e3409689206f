#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/command.h"
#include "tests/support/folder_test.h"

namespace {

using testing::HasSubstr;

class Regions : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
};

TEST_F(Regions, ProposesABlockThatTheServiceTakesAsItIs) {
  const auto made = tests::run("hovermodal", "simulate --preset paper --duration 5 --size 540p --out " + path("clip"));
  ASSERT_EQ(made.exit_code, 0) << made.text;
  const auto regions = tests::run("hovermodal", "regions " + path("clip/clip.mp4") + " --lowest-is-base --out " +
                                                    path("regions.yaml") + " --picture " + path("regions.png"));
  ASSERT_EQ(regions.exit_code, 0) << regions.text;
  EXPECT_THAT(regions.text, HasSubstr("noise px"));
  EXPECT_TRUE(std::filesystem::exists(path("regions.png")));
  const std::string yaml = tests::read(path("regions.yaml"));
  EXPECT_THAT(yaml, HasSubstr("name: base"));
  EXPECT_THAT(yaml, HasSubstr("role: background"));
  std::ofstream(path("config.yaml")) << "camera: {source: '" << path("clip/clip.mp4") << "'}\n"
                                     << yaml << "spectrum: {segment: 64}\ntelemetry: {lcm_url: ''}\n";
  const auto check = tests::run("hovermodald", "--config " + path("config.yaml") + " --check");
  EXPECT_EQ(check.exit_code, 0) << check.text;
}

TEST_F(Regions, RefusesWhatIsNoClip) {
  const auto missing = tests::run("hovermodal", "regions " + path("none.mp4"));
  EXPECT_NE(missing.exit_code, 0);
  EXPECT_THAT(missing.text, HasSubstr("none.mp4"));
  std::ofstream(path("text.mp4")) << "no video";
  EXPECT_NE(tests::run("hovermodal", "regions " + path("text.mp4")).exit_code, 0);
}

TEST_F(Regions, HelpTellsHowItChoosesAndShowsAnExample) {
  const auto help = tests::run("hovermodal", "regions --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.text, HasSubstr("HOW IT CHOOSES"));
  EXPECT_THAT(help.text, HasSubstr("hovermodal regions flight.mp4"));
}

}  // namespace
