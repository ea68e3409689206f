#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/page/report_page.h"
#include "tests/support/made_up_run.h"
#include "tests/support/xml_fault.h"

namespace app {

inline std::string page_of(RunData& run) {
  run.inputs.facts = &run.facts;
  return report_html(run.inputs);
}

// Without the part between the first `begin` and the `end` after it.
inline std::string without(std::string text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin), to = text.find(end, from);
  if (from != std::string::npos && to != std::string::npos) text.erase(from, to + end.size() - from);
  return text;
}

// Parts of HTML unknown to an XML reader: the doctype, the text of style and script, comments.
inline std::string markup_of(const std::string& page) {
  std::string out = without(without(page, "<style>", "</style>"), "<script>", "</script>");
  for (int i = 0; i < 3; ++i) out = without(out, "<!", ">");
  return out;
}

inline std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

inline void expect_sound(const std::string& page) {
  EXPECT_LT(page.size(), 2'000'000U);
  const std::string markup = markup_of(page);
  EXPECT_EQ(test_support::xml_fault(markup), "");
  for (const char* bad : {"nan ", "nan\"", " inf", "\"inf", "-inf"})
    EXPECT_THAT(markup, ::testing::Not(::testing::HasSubstr(bad)));
}

inline void expect_nothing_from_outside(const std::string& page) {
  const std::string name_space = "http://www.w3.org/2000/svg";
  EXPECT_EQ(count_of(page, "http://"), count_of(page, name_space));
  EXPECT_EQ(count_of(page, "https://"), 0U);
  EXPECT_EQ(count_of(page, "src="), 0U);
  EXPECT_EQ(count_of(page, "@import"), 0U);
  EXPECT_EQ(count_of(page, "url("), 0U);
  EXPECT_EQ(count_of(page, "href=\""), count_of(page, "href=\"#") + count_of(page, "href=\"data:image/jpeg;base64,"));
}

// The modes of make_run, the first 2 % lower, the third absent, one more at 20 Hz.
inline std::shared_ptr<const ModalReport> former_run(std::size_t n_channels) {
  ModalReport out;
  for (std::size_t i = 0; i < n_channels; ++i) out.channel_names.push_back(fmt::format("floor{}", i));
  for (const double hz : {1.657, 5.04, 20.0})
    out.estimate.modes.push_back(made_up_mode(hz, hz, n_channels, core::Verdict::kStructural));
  out.estimate.modes[0].frequency_hz *= 0.98;
  return std::make_shared<const ModalReport>(out);
}

// Text of one section.
inline std::string section_of(const std::string& page, const char* id) {
  const std::size_t begin = page.find(fmt::format("<section id=\"{}\"", id));
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</section>", begin) - begin);
}

}  // namespace app
