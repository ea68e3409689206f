#include "core/closure/closure_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace core::closure {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Known {
  std::string name;
  double heldout_alone = 0.0;  // held-out error with this effect alone
  std::size_t n_parameters = 1;
  std::string refusal = {};
};

// A level with prescribed results: held-out errors fall as given, the residual is structured above 1.
class ScriptedLevel : public ClosureLevel {
 public:
  std::vector<Known> known;
  double heldout = 4.0, chance = 0.5;
  std::map<std::string, double> refit_losses;  // factor of the held-out error after the refit with an effect
  std::optional<double> heldout_once_known;    // without an effect, after it was adopted once and dropped
  std::vector<std::string> adopted;

  [[nodiscard]] std::string name() const override { return "structure"; }
  [[nodiscard]] std::string unit() const override { return "%"; }
  [[nodiscard]] std::vector<NotObservable> not_observable() const override {
    return {{"clock", "absorbed", "film a clock"}};
  }
  [[nodiscard]] std::vector<std::string> candidates() const override {
    std::vector<std::string> out;
    for (const Known& k : known) out.push_back(k.name);
    return out;
  }
  LevelFit fit() override {
    return {heldout / 2.0, 0.1, heldout, heldout > 1.0, heldout > 1.0 ? "structured" : "noise"};
  }
  std::vector<CandidateScore> score() override {
    std::vector<CandidateScore> out;
    for (const Known& k : known) {
      CandidateScore s;
      s.effect = k.name;
      s.id = {k.name};
      s.n_parameters = k.n_parameters;
      s.heldout = k.heldout_alone;
      s.score = heldout * heldout - k.heldout_alone * k.heldout_alone;
      s.refusal = k.refusal;
      out.push_back(s);
    }
    return out;
  }
  double surrogate_score(std::uint64_t seed) override { return seeds[seed]++ == 0 ? chance : 1e9; }
  struct Refusal {
    std::string name, refusal;
  };
  std::map<std::string, Refusal> refusals_after;  // of another effect, once this one is adopted
  std::string needless;                           // an effect that any later one makes needless
  std::optional<std::size_t> drop_needless() override {
    const auto found = std::find(adopted.begin(), adopted.end(), needless);
    if (found == adopted.end() || found + 1 == adopted.end()) return std::nullopt;
    const auto at = static_cast<std::size_t>(found - adopted.begin());
    adopted.erase(found);
    return at;
  }
  void adopt(std::size_t i) override {
    adopted.push_back(known.at(i).name);
    before_ = heldout;
    heldout = known.at(i).heldout_alone;
    if (const auto loss = refit_losses.find(known.at(i).name); loss != refit_losses.end()) heldout *= loss->second;
    taken_ = known.at(i);
    known.erase(known.begin() + static_cast<std::ptrdiff_t>(i));
    for (Known& k : known) {
      if (refusals_after.count(taken_.name) != 0 && refusals_after[taken_.name].name == k.name)
        k.refusal = refusals_after[taken_.name].refusal;
    }
  }
  void drop() override {
    adopted.pop_back();
    heldout = heldout_once_known.value_or(before_);
    known.push_back(taken_);
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(std::size_t) const override { return {{"p", "1", 2.0, 0.1}}; }
  [[nodiscard]] std::string meaning(std::size_t i) const override { return "meaning of " + adopted.at(i); }
  std::vector<std::string> rivals(std::size_t i, std::uint64_t) override {
    return i == 0 ? std::vector<std::string>{"twin"} : std::vector<std::string>{};
  }
  [[nodiscard]] std::vector<ClosureMode> modes() const override { return {}; }
  [[nodiscard]] std::optional<double> reference_error() const override { return heldout; }
  [[nodiscard]] std::string reference_unit() const override { return "mm"; }
  [[nodiscard]] std::string describe_residual() const override { return "left over"; }

  std::map<std::uint64_t, int> seeds;

 private:
  double before_ = 0.0;
  Known taken_;
};

TEST(ClosureLoop, AdoptsTheBestUntilOnlyNoiseIsLeft) {
  ScriptedLevel level;
  level.known = {{"weak", 3.0}, {"strong", 1.5}, {"finishing", 0.9}};
  level.known[2].heldout_alone = 2.0;
  const ClosureResult first = close_loop(level, {.n_surrogates = 333});
  EXPECT_THAT(level.adopted, ElementsAre("strong"));
  EXPECT_THAT(first.stop_reason, HasSubstr("no candidate lowers"));
  ASSERT_EQ(first.steps.size(), 1U);
  EXPECT_DOUBLE_EQ(first.steps[0].heldout_before, 4.0);
  EXPECT_DOUBLE_EQ(first.steps[0].heldout_after, 1.5);
  EXPECT_DOUBLE_EQ(first.steps[0].threshold, 0.5);
  EXPECT_THAT(first.steps[0].rivals, ElementsAre("twin"));
  EXPECT_EQ(first.steps[0].meaning, "meaning of strong");
  EXPECT_EQ(first.steps[0].others.front().effect, "finishing");
  EXPECT_EQ(first.unexplained, "left over");
  EXPECT_GT(first.unexplained_fraction, 0.0);
  EXPECT_EQ(first.n_surrogates, 333U);
  EXPECT_EQ(*first.reference_error_before, 4.0);
  EXPECT_EQ(*first.reference_error_after, 1.5);
  EXPECT_EQ(first.reference_unit, "mm");
  EXPECT_EQ(first.not_observable.size(), 1U);
}

TEST(ClosureLoop, WhatALaterEffectMakesNeedlessIsRemoved) {
  ScriptedLevel level;
  level.needless = "latent";
  level.known = {{"latent", 2.0}, {"cause", 1.5}};
  level.refusals_after["latent"] = {"cause", ""};
  level.known[1].refusal = "a projection of another effect";
  const ClosureResult result = close_loop(level);
  EXPECT_THAT(level.adopted, ElementsAre("cause"));
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "cause");
  EXPECT_DOUBLE_EQ(result.steps[0].heldout_before, 2.0);
}

TEST(ClosureLoop, StopsAtNoiseWithoutASingleSurrogate) {
  ScriptedLevel level;
  level.heldout = 0.8;
  level.known = {{"tempting", 0.1}};
  const ClosureResult result = close_loop(level);
  EXPECT_TRUE(result.steps.empty());
  EXPECT_EQ(result.n_surrogates, 0U);
  EXPECT_EQ(result.stop_reason, "noise");
  EXPECT_EQ(result.unexplained_fraction, 0.0);
}

TEST(ClosureLoop, LeavesWhatChanceReaches) {
  ScriptedLevel level;
  level.chance = 100.0;
  level.known = {{"lucky", 1.5}};
  const ClosureResult result = close_loop(level);
  EXPECT_TRUE(level.adopted.empty());
  EXPECT_THAT(result.stop_reason, HasSubstr("lucky, does not exceed the chance threshold"));
}

TEST(ClosureLoop, RefusedCandidatesAreNamedAndNeverAdopted) {
  ScriptedLevel level;
  level.known = {{"impossible", 0.1, 1, "implausible: negative mass"}, {"modest", 2.0}};
  const ClosureResult result = close_loop(level);
  EXPECT_THAT(level.adopted, ElementsAre("modest"));
  EXPECT_EQ(result.steps[0].others[0].refusal, "implausible: negative mass");
}

TEST(ClosureLoop, FewerParametersWinATie) {
  ScriptedLevel level;
  level.known = {{"three", 1.500, 3}, {"one", 1.505, 1}};
  (void)close_loop(level);
  EXPECT_EQ(level.adopted.front(), "one");
}

TEST(ClosureLoop, TakesBackWhatTheRefitDoesNotKeep) {
  ScriptedLevel level;
  level.refit_losses = {{"deceiver", 10.0}};
  level.known = {{"deceiver", 1.5}};
  const ClosureResult result = close_loop(level);
  EXPECT_TRUE(level.adopted.empty());
  EXPECT_TRUE(result.steps.empty());
  EXPECT_THAT(result.stop_reason, HasSubstr("was reverted"));
}

TEST(ClosureLoop, TheNextBestIsTriedAfterOneThatTheRefitDoesNotKeep) {
  ScriptedLevel level;
  level.refit_losses = {{"deceiver", 10.0}};
  level.known = {{"deceiver", 0.9}, {"true", 1.2}};
  const ClosureResult result = close_loop(level);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "true");
  ASSERT_FALSE(result.refused.empty());
  EXPECT_EQ(result.refused[0].effect, "deceiver");
  EXPECT_THAT(result.refused[0].refusal, HasSubstr("was reverted"));
}

// The noise held a part of the effect: the error without it is larger than was known before it was adopted.
TEST(ClosureLoop, AnEffectThatChangesTheNoiseIsComparedWithTheNewNoise) {
  ScriptedLevel level;
  level.heldout = 1.5, level.known = {{"hidden in the noise", 1.0}};
  level.refit_losses = {{"hidden in the noise", 1.49}};
  level.heldout_once_known = 4.0;
  const ClosureResult result = close_loop(level);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_DOUBLE_EQ(result.steps[0].heldout_before, 4.0);
}

TEST(ClosureLoop, WhatTakesOutLessThanWasAskedForIsNotTold) {
  for (const double least : {2.6, 2.7}) {  // 4 -> 3 removes sqrt(7) = 2.65
    ScriptedLevel level;
    level.known = {{"small", 3.0}};
    const ClosureResult result = close_loop(level, {.least_gain = least});
    EXPECT_EQ(result.steps.size(), least < 2.65 ? 1U : 0U);
    const bool is_stated = result.stop_reason.find("small, is smaller than the smallest effect") != std::string::npos;
    EXPECT_EQ(is_stated, least > 2.65);
  }
}

TEST(ClosureLoop, NeverDrawsASurrogateTwice) {
  ScriptedLevel level;
  level.known = {{"a", 2.5}, {"b", 2.0}, {"c", 1.5}};
  (void)close_loop(level, {.n_surrogates = 50});
  for (const auto& [seed, times] : level.seeds) EXPECT_EQ(times, 1) << seed;
}

// So that the time left can be told.
TEST(ClosureLoop, TellsHowManySurrogatesOfAStepAreDone) {
  ScriptedLevel level;
  level.known = {{"strong", 0.5}};
  std::vector<LoopProgress> told;
  (void)close_loop(level, {.n_surrogates = 50, .progress = [&](const LoopProgress& now) { told.push_back(now); }});
  std::size_t n_counted = 0;
  for (const LoopProgress& now : told) {
    if (now.n == 0) continue;
    EXPECT_EQ(now.words, "surrogates of step 1");
    EXPECT_EQ(now.n, 50U);
    EXPECT_EQ(now.n_done, n_counted++);
  }
  EXPECT_EQ(n_counted, 50U);
  EXPECT_EQ(told.front().words, "fitting the model without effects");
}

TEST(ClosureLoop, DrawsNoMoreSurrogatesWhereAFewLeaveNoDoubt) {
  ScriptedLevel level;
  level.known = {{"strong", 0.5}};
  const ClosureResult result = close_loop(level, {.n_surrogates = 100, .n_surrogates_when_plain = 12});
  EXPECT_THAT(level.adopted, ElementsAre("strong"));
  EXPECT_EQ(result.n_surrogates, 12U);
}

TEST(ClosureLoop, DrawsAllSurrogatesWhereAFewLeaveDoubt) {
  ScriptedLevel level;
  level.chance = 6.0;  // the candidate's score is 15.75: above it, but not threefold
  level.known = {{"weak", 0.5}};
  const ClosureResult result = close_loop(level, {.n_surrogates = 100, .n_surrogates_when_plain = 12});
  EXPECT_THAT(level.adopted, ElementsAre("weak"));
  EXPECT_EQ(result.n_surrogates, 100U);
}

TEST(ClosureLoop, InfiniteAndUndefinedScoresAreLeft) {
  ScriptedLevel level;
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  level.known = {{"nan", nan}, {"inf", inf}};
  const ClosureResult result = close_loop(level);
  EXPECT_TRUE(level.adopted.empty());
  EXPECT_FALSE(result.stop_reason.empty());
}

TEST(ClosureLoop, RefusesTooFewSurrogates) {
  ScriptedLevel level;
  EXPECT_THROW((void)close_loop(level, {.n_surrogates = 3}), std::invalid_argument);
}

TEST(ChanceThreshold, IsAnOrderStatisticWhereThereAreEnough) {
  std::vector<double> scores;
  for (int i = 1; i <= 999; ++i) scores.push_back(i);
  EXPECT_EQ(chance_threshold(scores), 997.0);  // exceeded by three of a thousand, the next draw included
  scores.resize(333);
  EXPECT_EQ(chance_threshold(scores), 333.0);
}

TEST(ChanceThreshold, ReadsAGumbelTailFromFew) {
  // Gumbel quantiles at (i - 1/2) / n; location 2, scale 3: the 99.7 % level is 2 + 3 * 5.8076.
  std::vector<double> scores;
  for (int i = 0; i < 100; ++i) scores.push_back(2.0 - 3.0 * std::log(-std::log((i + 0.5) / 100.0)));
  EXPECT_NEAR(chance_threshold(scores), 19.4, 1.0);
}

}  // namespace
}  // namespace core::closure
