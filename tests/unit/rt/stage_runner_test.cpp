#include "rt/stage_runner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "rt/clock.h"

namespace rt {
namespace {

using namespace std::chrono_literals;

// step() returns the script's values in turn, then always the last. All but the atomics belong to the stage's thread.
class ScriptedStage : public Stage {
 public:
  explicit ScriptedStage(std::vector<StepStatus> script) : script_(std::move(script)) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "scripted"; }
  StepStatus step() noexcept override {
    step_thread = std::this_thread::get_id();
    const auto at = static_cast<std::size_t>(n_steps.fetch_add(1));
    return script_[std::min(at, script_.size() - 1)];
  }
  void finish() noexcept override {
    finish_thread = std::this_thread::get_id();
    steps_at_finish = n_steps.load();
    ++n_finish;
  }

  std::atomic<int> n_steps{0};
  int n_finish = 0;
  int steps_at_finish = 0;
  std::thread::id step_thread, finish_thread;

 private:
  std::vector<StepStatus> script_;
};

constexpr auto kWorked = StepStatus::kWorked;
constexpr auto kIdle = StepStatus::kIdle;
constexpr auto kFinished = StepStatus::kFinished;
constexpr auto kFault = StepStatus::kFault;

void run(ScriptedStage& stage, StageRunner& runner) {
  runner.start();
  runner.join();
  EXPECT_EQ(stage.n_finish, 1);
  EXPECT_EQ(stage.steps_at_finish, stage.n_steps.load()) << "no step after finish()";
}

TEST(StageRunner, StepsUntilTheStageFinishes) {
  ScriptedStage stage({kWorked, kWorked, kWorked, kFinished});
  StageRunner runner(stage, {"worker", 0, -1});
  EXPECT_FALSE(runner.finished());
  run(stage, runner);
  EXPECT_EQ(stage.n_steps.load(), 4);
  EXPECT_TRUE(runner.finished());
  EXPECT_FALSE(runner.faulted());
}

TEST(StageRunner, CallsFinishOnTheStagesOwnThread) {
  ScriptedStage stage({kWorked, kFinished});
  StageRunner runner(stage, {"worker", 0, -1});
  run(stage, runner);
  EXPECT_EQ(stage.finish_thread, stage.step_thread);
  EXPECT_NE(stage.finish_thread, std::this_thread::get_id());
}

TEST(StageRunner, AFaultEndsTheStageAndIsTold) {
  ScriptedStage stage({kWorked, kFault, kWorked});
  StageRunner runner(stage, {"worker", 0, -1});
  run(stage, runner);
  EXPECT_EQ(stage.n_steps.load(), 2);
  EXPECT_TRUE(runner.faulted());
  EXPECT_TRUE(runner.finished());
}

TEST(StageRunner, CountsTheTimeOfStepsThatWorkedOnly) {
  ScriptedStage stage({kIdle, kIdle, kFinished});
  stage.stats().busy_ns.store(0);
  StageRunner runner(stage, {"worker", 0, -1});
  run(stage, runner);
  EXPECT_EQ(stage.stats().step.percentiles().n, 1U) << "only the last step counts";
  EXPECT_EQ(stage.stats().busy_ns.load(), stage.stats().step.percentiles().max_ns);
  EXPECT_GT(stage.stats().busy_ns.load(), 0U);
  EXPECT_GT(stage.stats().cpu_ns.load(), 0U);
}

// A stage that is idle until told otherwise.
class WaitingStage : public Stage {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "waiting"; }
  StepStatus step() noexcept override {
    ++n_steps;
    return go.load() ? StepStatus::kFinished : StepStatus::kIdle;
  }
  void finish() noexcept override { ++n_finish; }

  std::atomic<bool> go{false};
  std::atomic<int> n_steps{0};
  std::atomic<int> n_finish{0};
};

TEST(StageRunner, AnIdleStageSleepsAndANudgeWakesIt) {
  WaitingStage stage;
  StageRunner runner(stage, {"waiting", 0, -1});
  runner.start();
  std::this_thread::sleep_for(50ms);
  // It would spin through millions of steps otherwise; a wait ends after 100 ms, or early by a signal.
  EXPECT_LT(stage.n_steps.load(), 100);
  stage.go.store(true);
  stage.wakeup().nudge();
  runner.join();
  EXPECT_TRUE(runner.finished());
  EXPECT_EQ(stage.n_finish.load(), 1);
}

TEST(StageRunner, AbortEndsAnIdleStageAndStillFinishesIt) {
  WaitingStage stage;
  StageRunner runner(stage, {"waiting", 0, -1});
  runner.start();
  runner.abort();
  runner.join();
  EXPECT_TRUE(runner.finished());
  EXPECT_FALSE(runner.faulted());
  EXPECT_EQ(stage.n_finish.load(), 1);
}

TEST(StageRunner, AbortEndsABusyStage) {
  ScriptedStage stage({kWorked});
  StageRunner runner(stage, {"busy", 0, -1});
  runner.start();
  while (stage.n_steps.load() < 10) std::this_thread::yield();
  runner.abort();
  runner.join();
  EXPECT_EQ(stage.n_finish, 1);
}

TEST(StageRunner, AbortBeforeTheStartTakesNoStep) {
  ScriptedStage stage({kWorked});
  StageRunner runner(stage, {"never", 0, -1});
  runner.abort();
  run(stage, runner);
  EXPECT_EQ(stage.n_steps.load(), 0);
}

// Hangs inside a step until told otherwise.
class HangingStage : public Stage {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "hanging"; }
  StepStatus step() noexcept override {
    inside.store(true);
    while (!go.load()) std::this_thread::sleep_for(1ms);
    return StepStatus::kFinished;
  }

  std::atomic<bool> inside{false}, go{false};
};

TEST(StageRunner, AStageThatHangsInAStepIsStalledUntilItGoesOn) {
  HangingStage stage;
  StageRunner runner(stage, {"hanging", 0, -1});
  runner.set_stall_limit_ns(1'000'000'000);
  EXPECT_EQ(runner.stalled_for_ns(monotonic_ns()), 0) << "not started";
  runner.start();
  while (!stage.inside.load()) std::this_thread::sleep_for(1ms);
  EXPECT_GT(runner.stalled_for_ns(monotonic_ns() + 1'000'000'000), 1'000'000'000);
  stage.go.store(true);
  runner.join();
  EXPECT_EQ(runner.stalled_for_ns(monotonic_ns() + 10'000'000'000), 0) << "ended";
}

TEST(StageRunner, AnIdleStageLooksForWorkAgainAndAgainAndIsNotStalled) {
  WaitingStage stage;
  StageRunner runner(stage, {"waiting", 0, -1});
  runner.set_stall_limit_ns(20'000'000'000);
  runner.start();
  while (stage.n_steps.load() < 3) std::this_thread::sleep_for(1ms);  // woken by its time-out alone
  EXPECT_EQ(runner.stalled_for_ns(monotonic_ns()), 0);
  stage.go.store(true);
  stage.wakeup().nudge();
  runner.join();
}

TEST(StageRunner, JoinsInItsDestructor) {
  ScriptedStage stage({kWorked, kWorked, kFinished});
  {
    StageRunner runner(stage, {"worker", 0, -1});
    runner.start();
  }
  EXPECT_EQ(stage.n_finish, 1);
}

TEST(StageStats, Adds) {
  StageStats stats;
  StageStats::add(stats.n_in);
  StageStats::add(stats.n_in, 4);
  EXPECT_EQ(stats.n_in.load(), 5U);
}

}  // namespace
}  // namespace rt
