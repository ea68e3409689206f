#ifdef HOVERMODAL_WITH_GROUND
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/support/child_process.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"
#include "tests/support/places.h"
#include "tests/support/raw_http.h"

namespace {

using testing::HasSubstr;

class RegionsPage : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] static std::string post(const std::string& body, const std::string& more = "") {
    return "POST /regions HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n" + more + "\r\n" + body;
  }
};

TEST_F(RegionsPage, WhatIsSavedInThePageIsTheFile) {
  const auto made = tests::run("hovermodal", "simulate --preset paper --duration 3 --size 540p --out " + path("clip"));
  ASSERT_EQ(made.exit_code, 0) << made.text;
  tests::ChildProcess page(
      {tests::program("hovermodal"), "regions", path("clip/clip.mp4"), "--serve", "--out", path("regions.yaml")});
  const std::string address = "open http://127.0.0.1:";
  ASSERT_TRUE(page.wait_for("Ctrl-C ends.", 120)) << page.output();
  const int port = std::atoi(page.output().c_str() + page.output().find(address) + address.size());
  EXPECT_THAT(tests::raw_http(port, tests::get("/")), HasSubstr("page.js"));
  EXPECT_THAT(tests::raw_http(port, tests::get("/frame.png")), HasSubstr("image/png"));
  EXPECT_THAT(tests::raw_http(port, tests::get("/regions.json")), HasSubstr("\"size\":[960,540]"));
  const std::string body = R"({"regions":[{"name":"roof","rect":[10,20,100,30],"role":"base","axis":"u"}]})";
  EXPECT_EQ(tests::status_of(tests::raw_http(port, post(body, "Origin: http://evil.example\r\n"))), 403);
  EXPECT_THAT(tests::read(path("regions.yaml")), testing::Not(HasSubstr("roof")));
  EXPECT_THAT(tests::raw_http(port, post("{}")), HasSubstr("not saved"));
  EXPECT_THAT(tests::raw_http(port, post(body)), HasSubstr("saved to"));
  EXPECT_THAT(tests::read(path("regions.yaml")), HasSubstr("name: roof, rect: [10, 20, 100, 30], role: base"));
  EXPECT_THAT(tests::raw_http(port, tests::get("/regions.json")), HasSubstr("roof"));
}

TEST_F(RegionsPage, NeedsAFileToWrite) {
  const auto run = tests::run("hovermodal", "regions none.mp4 --serve");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.text, HasSubstr("--out"));
}

}  // namespace
#endif
