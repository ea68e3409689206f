#ifdef HOVERMODAL_WITH_LCM
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "drivers/telemetry/layout_watch.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/closure_report_t.hpp"
#include "hovermodal/displacement_t.hpp"
#include "hovermodal/health_t.hpp"
#include "hovermodal/modal_estimate_t.hpp"
#include "hovermodal/preview_t.hpp"
#include "hovermodal/spectrum_t.hpp"
#include "hovermodal/tracks_t.hpp"

namespace {

using ::testing::HasSubstr;

// A type that has changed must not be sent under its old channel name: increase its number in kTopicLayouts and enter
// the new fingerprint here. (Before a release: only the fingerprint.)
TEST(LcmLayout, AChangedMessageGoesOutOnAChannelOfAnotherName) {
  struct Known {
    drivers::Topic topic;
    std::int64_t fingerprint;
    int layout;
    std::uint64_t known;
  };
  const std::vector<Known> all{
      {drivers::kModal, hovermodal::modal_estimate_t::getHash(), 1, 0x744f13eb4ceaa029ULL},
      {drivers::kDisplacement, hovermodal::displacement_t::getHash(), 1, 0xa0635ab64a3f9c20ULL},
      {drivers::kSpectrum, hovermodal::spectrum_t::getHash(), 1, 0xf928a12909f0ba45ULL},
      {drivers::kTracks, hovermodal::tracks_t::getHash(), 1, 0xca2b38f581ab6af3ULL},
      {drivers::kClosure, hovermodal::closure_report_t::getHash(), 1, 0x3b92c13028072752ULL},
      {drivers::kHealth, hovermodal::health_t::getHash(), 1, 0x933916262f764722ULL},
      {drivers::kPreview, hovermodal::preview_t::getHash(), 1, 0x7d8e4fce4feb97a2ULL},
  };
  ASSERT_EQ(all.size(), drivers::kTopics);
  for (const Known& one : all) {
    EXPECT_EQ(static_cast<std::uint64_t>(one.fingerprint), one.known)
        << std::hex << one.fingerprint << " of " << drivers::kTopicSuffixes[one.topic];
    EXPECT_EQ(drivers::kTopicLayouts[one.topic], one.layout) << drivers::kTopicSuffixes[one.topic];
  }
}

TEST(LcmLayout, TheFirstLayoutKeepsThePlainNameAndLaterOnesSayTheirNumber) {
  EXPECT_EQ(drivers::topic_channel("HOVERMODAL", drivers::kModal), "HOVERMODAL_MODAL");
  EXPECT_EQ(drivers::topic_channel("A.b", drivers::kHealth, 3), "A.b_HEALTH_V3");
}

TEST(LcmLayout, ReadsTopicAndLayoutOffAChannelName) {
  const auto plain = drivers::topic_of("P", "P_TRACKS");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->topic, drivers::kTracks);
  EXPECT_EQ(plain->layout, 1);
  const auto later = drivers::topic_of("P", "P_CLOSURE_V12");
  ASSERT_TRUE(later);
  EXPECT_EQ(later->topic, drivers::kClosure);
  EXPECT_EQ(later->layout, 12);
  for (const char* name : {"P", "Q_TRACKS", "P_TRACKS_", "P_TRACKS_V", "P_TRACKS_V1", "P_TRACKS_V0", "P_TRACKS_V-2",
                           "P_TRACKS_V2x", "P_TRACKS_V99999999999999999999", "P_NOISE", "", "P_TRACKSV2"}) {
    EXPECT_FALSE(drivers::topic_of("P", name)) << name;
  }
}

TEST(LcmLayout, ThePatternTakesEveryLayoutOfThePrefixAlone) {
  const std::regex pattern(drivers::topics_pattern("A.b"), std::regex::extended);
  for (const char* name : {"A.b_MODAL", "A.b_HEALTH_V2", "A.b_SPECTRUM_V17"})
    EXPECT_TRUE(std::regex_match(name, pattern)) << name;
  for (const char* name : {"Axb_MODAL", "A.b_MODAL_X", "A.b_SELFTEST", "A.b_MODAL_V"})
    EXPECT_FALSE(std::regex_match(name, pattern)) << name;
}

TEST(LayoutWatch, SaysNothingOfNoise) {
  drivers::LayoutWatch watch;
  for (std::int64_t n = 0; n < 1000; ++n) watch.note_fingerprint(drivers::kModal, 1000 + n, 7);
  EXPECT_TRUE(watch.words("P").empty());
}

TEST(LayoutWatch, TellsAFingerprintThatKeepsComing) {
  drivers::LayoutWatch watch;
  for (int n = 0; n < 5; ++n) watch.note_fingerprint(drivers::kModal, 0xAB, 7);
  watch.note_fingerprint(drivers::kModal, 0x1, 7);  // noise in between does not reset it
  const auto words = watch.words("P");
  ASSERT_EQ(words.size(), 1U);
  EXPECT_THAT(words[0], HasSubstr("P_MODAL"));
  EXPECT_THAT(words[0], HasSubstr("another version, fingerprint 00000000000000ab"));
  EXPECT_THAT(words[0], HasSubstr("5 messages"));
}

TEST(LayoutWatch, TellsTheLayoutOfAnotherChannelName) {
  drivers::LayoutWatch watch;
  watch.note_layout(drivers::kHealth, 2);
  const auto words = watch.words("P");
  ASSERT_EQ(words.size(), 1U);
  EXPECT_THAT(words[0], HasSubstr("P_HEALTH_V2"));
  EXPECT_THAT(words[0], HasSubstr("layout 2"));
  EXPECT_THAT(words[0], HasSubstr("programs of one version"));
}

}  // namespace
#endif
