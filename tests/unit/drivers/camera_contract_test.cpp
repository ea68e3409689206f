#include "tests/support/camera_contract.h"

#include "drivers/camera/camera_factory.h"
#include "tests/support/numbered_sender.h"
#include "tests/support/test_clip.h"

namespace test_support {
namespace {

std::unique_ptr<drivers::Camera> clip_camera(bool realtime) {
  const auto clip = fresh_folder() / "clip.mp4";
  write_clip(clip, {.n_frames = 12, .width_px = 96, .height_px = 80});
  return drivers::make_camera({.source = clip.string(), .rate_hz = 50.0, .realtime = realtime});
}

std::unique_ptr<drivers::Camera> scene_camera(bool realtime) {
  return drivers::make_camera(
      {.kind = drivers::CameraKind::kSynthetic, .realtime = realtime, .synthetic_duration_s = 0.5});
}

std::unique_ptr<drivers::Camera> stream_camera() {
  static const Sent sent;
  return drivers::make_camera({.kind = drivers::CameraKind::kStream, .source = sent.source()});
}

INSTANTIATE_TEST_SUITE_P(Drivers, CameraContract,
                         ::testing::Values(ContractCamera{"file", [] { return clip_camera(false); }},
                                           ContractCamera{"file_realtime", [] { return clip_camera(true); }},
                                           ContractCamera{"synthetic", [] { return scene_camera(false); }},
                                           ContractCamera{"synthetic_realtime", [] { return scene_camera(true); }},
                                           ContractCamera{"stream", stream_camera, true}),
                         contract_name);

}  // namespace
}  // namespace test_support
