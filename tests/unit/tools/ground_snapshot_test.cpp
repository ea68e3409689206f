#ifdef HOVERMODAL_WITH_GROUND
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "drivers/telemetry/encode.h"
#include "tests/support/telemetry_samples.h"
#include "tools/hovermodal/ground/json_parts.h"
#include "tools/hovermodal/ground/live_stream.h"

namespace {

using drivers::to_message;
using drivers::to_messages;
using nlohmann::json;
using tools::LiveStream;

constexpr std::int64_t kSecond = 1'000'000'000;

class GroundSnapshot : public ::testing::Test {
 protected:
  template <class Message>
  void send(const std::string& topic, Message message, std::int64_t sequence) {
    message.sequence = sequence;
    message.utc_ns = utc_ns_ += 1'000'000;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    stream_.receive("TEST_" + topic, bytes.data(), bytes.size(), now_ns_ += 1'000'000);
  }
  void send_samples(int n, std::int64_t first = 0, const std::string& id = "tower") {
    for (int i = 0; i < n; ++i) {
      const auto number = static_cast<std::uint64_t>(first + i);
      send("DISPLACEMENT", to_message(tests::sample_displacement(3, number), {id, 1}), first + i);
    }
  }
  void send_health(std::int64_t sequence, const std::string& id = "tower") {
    send("HEALTH", to_message(tests::sample_health("running", 3), tests::sample_channels(3), {id, 1}), sequence);
  }
  void send_estimate(std::size_t n_modes, std::uint64_t number = 0) {
    for (const auto& part :
         to_messages(tests::sample_estimate(3, n_modes, number), tests::sample_channels(3), {"tower", 1})) {
      send("MODAL", part, n_modal_++);
    }
  }
  [[nodiscard]] json whole() const { return json::parse(stream_.snapshot(now_ns_)); }

  LiveStream stream_{"TEST"};
  std::int64_t now_ns_ = kSecond, utc_ns_ = 1000 * kSecond, n_modal_ = 0;
};

TEST_F(GroundSnapshot, SaysThatNothingWasHeard) {
  const json out = whole();
  EXPECT_FALSE(out["link"]["heard"].get<bool>());
  EXPECT_TRUE(out["link"]["silent_s"].is_null());
  for (const char* part : {"health", "modes", "spectra", "preview", "closure", "structure", "traces"})
    EXPECT_FALSE(out.contains(part)) << part;
  EXPECT_EQ(stream_.preview_jpeg(), "");
}

TEST_F(GroundSnapshot, HoldsTheNewestOfEverything) {
  send_health(0);
  send_samples(5);
  send_estimate(4);
  for (const auto& m : to_messages(tests::sample_sums(3, 512), tests::sample_channels(3), {"tower", 1}))
    send("SPECTRUM", m, m.channel_index);
  send("CLOSURE", to_message(tests::sample_closure(2), {"tower", 1}), 0);
  core::closure::ClosureReport structure = tests::sample_closure(1);
  structure.result.level = "structure", structure.result.unit = "%";
  send("CLOSURE", to_message(structure, {"tower", 1}), 1);
  const json out = whole();
  EXPECT_EQ(out["link"]["stream"], "tower");
  EXPECT_EQ(out["link"]["topics"]["displacement"]["received"], 5);
  EXPECT_EQ(out["health"]["state"], "running");
  EXPECT_EQ(out["health"]["channels"].size(), 3U);
  EXPECT_EQ(out["health"]["regions"][0]["state"], "searching");
  ASSERT_EQ(out["modes"]["modes"].size(), 4U);
  EXPECT_EQ(out["modes"]["modes"][0]["hz"], 1.5);
  EXPECT_EQ(out["modes"]["modes"][0]["verdict"], "structural");
  EXPECT_EQ(out["modes"]["modes"][0]["re"].size(), 3U);
  EXPECT_EQ(out["traces"]["mm"].size(), 3U);
  EXPECT_EQ(out["traces"]["t_s"].size(), 5U);
  EXPECT_EQ(out["spectra"]["channels"][0]["log10"].size(), 257U);
  EXPECT_EQ(out["closure"]["in_force"].size(), 1U);
  EXPECT_EQ(out["closure"]["unit"], "px");
  EXPECT_EQ(out["structure"]["unit"], "%");
}

TEST_F(GroundSnapshot, NewsAreToldOnce) {
  send_health(0);
  send_samples(5);
  const json first = json::parse(stream_.news(now_ns_).value());
  EXPECT_EQ(first["traces"]["t_s"].size(), 5U);
  EXPECT_FALSE(stream_.news(now_ns_).has_value());
  send_samples(2, 5);
  const json second = json::parse(stream_.news(now_ns_).value());
  EXPECT_EQ(second["traces"]["first"], 5);
  EXPECT_EQ(second["traces"]["t_s"].size(), 2U);
  EXPECT_FALSE(second.contains("health"));
  EXPECT_TRUE(stream_.news(now_ns_ + 2 * kSecond).has_value()) << "how long the link is silent";
}

TEST_F(GroundSnapshot, CountsWhatWasLostOnTheLink) {
  send_samples(5);
  send_samples(1, 10);
  EXPECT_EQ(whole()["link"]["topics"]["displacement"]["lost"], 5);
}

TEST_F(GroundSnapshot, AServiceThatBeginsAgainIsANewRunWithoutTheOldModes) {
  send_health(50);
  send_samples(5, 100);
  send_estimate(4);
  EXPECT_EQ(whole()["link"]["run"], 0);
  utc_ns_ += 20 * kSecond;
  send_health(0);
  EXPECT_EQ(whole()["link"]["run"], 1);
  EXPECT_FALSE(whole().contains("modes"));
  send_samples(3, 0);
  EXPECT_EQ(whole()["link"]["run"], 1) << "the same restart, seen on another channel";
  n_modal_ = 0;
  send_estimate(2);
  EXPECT_EQ(whole()["modes"]["modes"].size(), 2U);
}

TEST_F(GroundSnapshot, FollowsAnotherStreamOnceItsOwnIsSilent) {
  send_health(0);
  send_health(1, "other");
  EXPECT_EQ(whole()["link"]["stream"], "tower");
  EXPECT_EQ(whole()["link"]["foreign"], 1);
  now_ns_ += 20 * kSecond;
  send_health(2, "other");
  EXPECT_EQ(whole()["link"]["stream"], "other");
  EXPECT_EQ(whole()["link"]["run"], 1);
}

TEST_F(GroundSnapshot, StaysBoundedWhateverComes) {
  auto health = to_message(tests::sample_health("running", 3), tests::sample_channels(3000), {"tower", 1});
  send("HEALTH", health, 0);
  for (int i = 0; i < 3000; ++i)
    send("DISPLACEMENT", to_message(tests::sample_displacement(300, static_cast<std::uint64_t>(i)), {"tower", 1}), i);
  for (const auto& m : to_messages(tests::sample_sums(40, 16384), tests::sample_channels(40), {"tower", 1}))
    send("SPECTRUM", m, m.channel_index);
  for (const auto& m : to_messages(tests::sample_estimate(300, 200), tests::sample_channels(300), {"tower", 1}))
    send("MODAL", m, n_modal_++);
  const json out = whole();
  EXPECT_EQ(out["traces"]["mm"].size(), tools::kMostShownChannels);
  EXPECT_EQ(out["traces"]["mm"][0].size(), drivers::StreamMonitor::kHistory);
  EXPECT_EQ(out["spectra"]["channels"].size(), tools::kMostShownChannels);
  EXPECT_LE(out["spectra"]["channels"][0]["log10"].size(), tools::kMostShownBins);
  EXPECT_EQ(out["modes"]["modes"].size(), tools::kMostShownModes);
  EXPECT_EQ(out["health"]["channels"].size(), tools::kMostShownChannels);
  EXPECT_LT(stream_.snapshot(now_ns_).size(), 700'000U);
}

TEST_F(GroundSnapshot, TextThatIsNotUtf8AndNumbersThatAreNoneStayJson) {
  auto health = to_message(tests::sample_health("run\xff\"<script>", 3), {}, {"tower", 1});
  send("HEALTH", health, 0);
  auto estimate = to_messages(tests::sample_estimate(3, 1), tests::sample_channels(3), {"tower", 1}).at(0);
  estimate.modes[0].frequency_hz = std::numeric_limits<double>::infinity();
  estimate.modes[0].verdict = 99;
  send("MODAL", estimate, 0);
  const json out = whole();
  EXPECT_TRUE(out["modes"]["modes"][0]["hz"].is_null());
  EXPECT_EQ(out["modes"]["modes"][0]["verdict"], "numerical");
}

TEST_F(GroundSnapshot, DamagedMessagesStayJson) {
  const drivers::StreamIdentity identity{"tower", 1};
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> seeds;
  const auto add = [&](const std::string& topic, const auto& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    seeds.emplace_back("TEST_" + topic, bytes);
  };
  add("HEALTH", to_message(tests::sample_health("running", 1), tests::sample_channels(3), identity));
  add("DISPLACEMENT", to_message(tests::sample_displacement(3, 1), identity));
  add("PREVIEW", to_message(tests::sample_preview(1), {core::Region{}}, identity));
  add("CLOSURE", to_message(tests::sample_closure(2), identity));
  add("MODAL", to_messages(tests::sample_estimate(3, 2), tests::sample_channels(3), identity).at(0));
  add("SPECTRUM", to_messages(tests::sample_sums(2, 64), tests::sample_channels(2), identity).at(0));
  std::mt19937 draw(1);
  for (int round = 0; round < 5000; ++round) {
    auto [topic, bytes] = seeds[draw() % seeds.size()];
    for (unsigned i = 0; i < 1 + draw() % 6; ++i)
      bytes[8 + draw() % (bytes.size() - 8)] = static_cast<std::uint8_t>(draw());
    stream_.receive(topic, bytes.data(), bytes.size(), now_ns_ += 100'000'000);
    const auto news = stream_.news(now_ns_);
    EXPECT_FALSE(json::parse(news.value_or("{}"), nullptr, false).is_discarded()) << round;
  }
  EXPECT_FALSE(whole().is_discarded());
}

TEST(GroundNumber, KeepsSoManyDigits) {
  EXPECT_EQ(tools::rounded(1.23456789, 3).dump(), "1.23");
  EXPECT_EQ(tools::rounded(-0.000123456, 3).dump(), "-0.000123");
  EXPECT_EQ(tools::rounded(123456.0, 3).dump(), "123000.0");
  EXPECT_EQ(tools::rounded(0.0).dump(), "0");
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity(), 1e308, 1e-308, 5e-324}) {
    const json out = tools::rounded(value);
    EXPECT_TRUE(out.is_null() || std::isfinite(out.get<double>())) << value;
  }
}

}  // namespace
#endif
