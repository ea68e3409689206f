#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "firmware_app/config/config.h"
#include "firmware_app/config/config_table.h"
#include "tests/support/config_text.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

using tests::kGood;
using tests::refusal_with;

TEST(ConfigCamera, DriverIsTheDriversOwnKindByItsName) {
  const std::map<std::string, drivers::CameraKind> kinds{{"file", drivers::CameraKind::kFile},
                                                         {"synthetic", drivers::CameraKind::kSynthetic},
                                                         {"v4l2", drivers::CameraKind::kV4l2},
                                                         {"libcamera", drivers::CameraKind::kLibcamera},
                                                         {"stream", drivers::CameraKind::kStream}};
  ASSERT_EQ(drivers::kCameraKindNames.size(), kinds.size());
  for (const auto& [name, kind] : kinds) {
    const AppConfig config =
        parse_config(kGood, "a.yaml", {"camera.driver=" + name, "camera.source=rtsp://camera/main"});
    EXPECT_EQ(config.camera.driver, kind) << name;
    EXPECT_EQ(drivers::to_string(kind), name);
  }
  EXPECT_THAT(config_help(), HasSubstr("default: file   allowed: file | synthetic | v4l2 | libcamera | stream"));
}

TEST(ConfigCamera, AStreamNeedsAnAddressThatIsOpened) {
  const auto refusal = [](const std::string& source) {
    return refusal_with("driver: file\n  source: clip.mp4", "driver: stream\n  source: " + source);
  };
  EXPECT_EQ(refusal("rtsp://user:secret@camera/main\n  transport: udp"), "");
  EXPECT_THAT(refusal("clip.mp4"), AllOf(StartsWith("a.yaml:"), HasSubstr("rtsp://")));
  EXPECT_THAT(refusal("http://user:secret@camera/main"), AllOf(HasSubstr("rtsp://"), Not(HasSubstr("secret"))));
  EXPECT_THAT(refusal_with("driver: file\n  source: clip.mp4", "driver: stream"), HasSubstr("camera.source"));
}

}  // namespace
}  // namespace app
