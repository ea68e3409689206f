#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/pipeline_run.h"

namespace tests {

inline constexpr std::uint64_t kShortClip = 150;
inline constexpr std::size_t kChannels = 7;  // six floors and the base

struct PublisherMood {
  bool refuses = false;
  std::chrono::microseconds pause{0};
};

inline app::AppConfig config_of(const SceneClip& clip, const std::vector<std::string>& overrides) {
  return app::parse_config(scene_config(clip.motion), "scene", overrides);
}

// A pipeline with a scripted camera, and everything its publisher received.
struct Rig {
  explicit Rig(const CameraScript& script, const std::vector<std::string>& overrides = {"spectrum.segment=64"},
               std::uint64_t n_drawn = kShortClip, PublisherMood mood = {})
      : clip(scene_clip(n_drawn)), heard(std::make_shared<Heard>()) {
    pipeline =
        std::make_unique<app::Pipeline>(config_of(*clip, overrides), std::make_unique<ScriptedCamera>(clip, script),
                                        std::make_unique<TellingPublisher>(heard, mood.refuses, mood.pause));
  }

  // Starts, waits for the end, and destroys the pipeline, so that `heard` is complete.
  app::Pipeline::Outcome run(std::chrono::seconds patience = kPatience) {
    pipeline->start();
    return finish(patience);
  }
  app::Pipeline::Outcome finish(std::chrono::seconds patience = kPatience) {
    EXPECT_TRUE(runs_to_its_end(*pipeline, patience))
        << "still running: " << pipeline->health().frames_processed << " frames";
    app::Pipeline::Outcome outcome = pipeline->join();
    expect_accounted(outcome.health);
    pipeline.reset();
    for (const core::ModalEstimate& estimate : heard->estimates) expect_finite(estimate);
    EXPECT_EQ(heard->estimates.size(), outcome.health.estimates);
    return outcome;
  }

  std::shared_ptr<const SceneClip> clip;
  std::shared_ptr<Heard> heard;
  std::unique_ptr<app::Pipeline> pipeline;
};

inline CameraScript frames(std::uint64_t n) {
  CameraScript script;
  script.n_frames = n;
  return script;
}

// Faster than any tracker after its first hundred frames, which come slowly; its own clock states 25 frames a second,
// so that two seconds are 50 frames.
inline CameraScript too_fast(std::uint64_t n) {
  CameraScript script = frames(n);
  script.lossless = false;
  script.frame_time = std::chrono::microseconds(50);
  script.is_dark = [](std::uint64_t k) {
    if (k < 100) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return false;
  };
  return script;
}

}  // namespace tests
