#ifdef HOVERMODAL_WITH_GROUND
#include <gtest/gtest.h>

#include "tools/hovermodal/ground/web_guard.h"
#include "tools/hovermodal/ground/web_head.h"

namespace {

using tools::HeadProgress;
using tools::TokenCheck;
using tools::WebGuard;
using tools::WebOrigin;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

WebOrigin asked(std::string_view host, std::string_view origin = {}, std::string_view site = {},
                std::string_view mode = {}, std::string_view dest = {}) {
  return {host, origin, site, mode, dest};
}

TEST(GroundWebGuard, KnowsTheLoopbackByItsNamesAndNoOther) {
  const WebGuard guard;
  for (const char* host : {"127.0.0.1", "127.0.0.1:8086", "localhost:9000", "LocalHost", "[::1]:8086", "127.3.2.1:1"}) {
    EXPECT_EQ(tools::refused_origin(guard, asked(host)), "") << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:8086", "127.0.0.1.evil.example", "192.168.1.5:8086",
                           "localhost.evil.example", "[::1", "127.0.0.1:", "127.0.0.1:80a", ":8086", "0.0.0.0:8086"}) {
    EXPECT_NE(tools::refused_origin(guard, asked(host)), "") << host;
  }
}

TEST(GroundWebGuard, ANetworkAddressIsKnownByFiguresAndByGivenNames) {
  const WebGuard guard{kToken, {"ground.local"}, false};
  for (const char* host : {"192.168.1.5:8086", "10.0.0.1", "[fe80::1]:8086", "Ground.Local:8086", "localhost"}) {
    EXPECT_EQ(tools::refused_origin(guard, asked(host)), "") << host;
  }
  EXPECT_NE(tools::refused_origin(guard, asked("rebound.example:8086")), "");
}

TEST(GroundWebGuard, RefusesOtherOriginsAndSites) {
  const WebGuard guard;
  EXPECT_EQ(tools::refused_origin(guard, asked("localhost:1", "http://localhost:1", "same-origin", "cors", "empty")),
            "");
  EXPECT_EQ(tools::refused_origin(guard, asked("localhost:1", "", "none", "navigate", "document")), "");
  EXPECT_EQ(tools::refused_origin(guard, asked("localhost:1", "", "cross-site", "navigate", "document")), "")
      << "a link";
  for (const char* origin :
       {"http://evil.example", "null", "https://localhost:1", "http://localhost:2", "http://127.0.0.1:1"}) {
    EXPECT_NE(tools::refused_origin(guard, asked("localhost:1", origin)), "") << origin;
  }
  EXPECT_NE(tools::refused_origin(guard, asked("localhost:1", "", "cross-site", "no-cors", "image")), "");
  EXPECT_NE(tools::refused_origin(guard, asked("localhost:1", "", "same-site", "cors", "empty")), "");
  EXPECT_NE(tools::refused_origin(guard, asked("localhost:1", "", "cross-site", "navigate", "iframe")), "");
}

TEST(GroundWebGuard, TakesTheTokenFromTheQueryOrTheCookie) {
  const WebGuard guard{kToken, {}, false};
  const std::string cookie = std::string(tools::kTokenCookie) + "=" + kToken;
  EXPECT_EQ(tools::check_token({}, "", ""), TokenCheck::kNotAsked);
  EXPECT_EQ(tools::check_token(guard, kToken, ""), TokenCheck::kFromQuery);
  EXPECT_EQ(tools::check_token(guard, "", cookie), TokenCheck::kFromCookie);
  EXPECT_EQ(tools::check_token(guard, "", "a=b; " + cookie + "; c=d"), TokenCheck::kFromCookie);
  EXPECT_EQ(tools::check_token(guard, "", ""), TokenCheck::kMissing);
  EXPECT_EQ(tools::check_token(guard, "", "x" + cookie), TokenCheck::kMissing);
  EXPECT_EQ(tools::check_token(guard, "wrong", cookie), TokenCheck::kWrong);
  EXPECT_EQ(tools::check_token(guard, "", cookie + "0"), TokenCheck::kWrong);
  EXPECT_EQ(tools::check_token(guard, std::string(kToken).substr(1), ""), TokenCheck::kWrong);
}

TEST(GroundWebGuard, ComparesWhole) {
  EXPECT_TRUE(tools::equal_in_constant_time("", ""));
  EXPECT_TRUE(tools::equal_in_constant_time(kToken, kToken));
  for (const char* other : {"", "0", "0123456789abcdef0123456789abcdee", "1123456789abcdef0123456789abcdef",
                            "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"}) {
    EXPECT_FALSE(tools::equal_in_constant_time(kToken, other)) << other;
    EXPECT_FALSE(tools::equal_in_constant_time(other, kToken)) << other;
  }
}

TEST(GroundWebGuard, RandomTokensAreLongAndDifferent) {
  const std::string a = tools::random_token(), b = tools::random_token();
  EXPECT_EQ(a.size(), 32U);
  EXPECT_EQ(tools::refused_token(a), "");
  EXPECT_NE(a, b);
  EXPECT_NE(tools::refused_token("short"), "");
  EXPECT_NE(tools::refused_token("0123456789abcdef; Path=/"), "");
}

HeadProgress look(std::string_view bytes) { return tools::look_at_head(bytes, 256, 16); }

TEST(GroundWebHead, WaitsForTheWholeRequestAndNoLonger) {
  const std::string head = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";
  for (std::size_t n = 0; n < head.size(); ++n) EXPECT_EQ(look(head.substr(0, n)).state, HeadProgress::kNeedsMore) << n;
  EXPECT_EQ(look(head + "more").state, HeadProgress::kWhole);
  EXPECT_EQ(look(head + "more").n_head, head.size());
  const std::string post = "POST / HTTP/1.1\r\ncontent-length:  5 \r\n\r\n";
  EXPECT_EQ(look(post + "1234").state, HeadProgress::kNeedsMore);
  EXPECT_EQ(look(post + "12345").state, HeadProgress::kWhole);
  EXPECT_EQ(look(post + "12345").n_body, 5U);
}

TEST(GroundWebHead, RefusesWhatIsTooLongOrAmbiguous) {
  const auto status = [](const std::string& lines) { return look("GET / HTTP/1.1\r\n" + lines + "\r\n\r\n").status; };
  EXPECT_EQ(look(std::string(256, 'a')).status, 431);
  EXPECT_EQ(status("A: " + std::string(300, 'a')), 431);
  EXPECT_EQ(status("Content-Length: 17"), 413);
  EXPECT_EQ(status("Content-Length: 99999999999999999999999"), 400);
  EXPECT_EQ(status("Content-Length: -1"), 400);
  EXPECT_EQ(status("Content-Length: 1\r\nContent-Length: 1"), 400);
  EXPECT_EQ(status("Transfer-Encoding: chunked"), 501);
  EXPECT_EQ(status("Content-Encoding: gzip"), 501);
  EXPECT_EQ(status("no colon"), 400);
  EXPECT_EQ(status("Content-Length : 1"), 400);
  EXPECT_EQ(look(std::string("GET /\0 HTTP/1.1\r\n\r\n", 20)).status, 400);
}

}  // namespace
#endif
