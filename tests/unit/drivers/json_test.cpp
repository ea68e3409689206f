#include "drivers/storage/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonText, WritesShortestNumbersAndKeepsKeyOrder) {
  Json value = Json::object();
  value["z"] = 0.1;
  value["a"] = {1.0, 1e-20, -2.5};
  value["n"] = nullptr;
  value["o"] = Json::object();
  value["l"] = Json::array();
  value["m"] = {{{"q", 3}}};
  EXPECT_EQ(to_json_text(value).text,
            "{\n  \"z\": 0.1,\n  \"a\": [1, 1e-20, -2.5],\n  \"n\": null,\n  \"o\": {},\n  \"l\": [],\n  \"m\": [\n    "
            "{\n      \"q\": 3\n    }\n  ]\n}\n");
}

TEST(JsonText, WritesNullForWhatIsNotFiniteAndCountsIt) {
  const JsonText text = to_json_text(Json{std::nan(""), INFINITY, -INFINITY, -0.0});
  EXPECT_EQ(text.text, "[null, null, null, 0]\n");
  EXPECT_EQ(text.n_not_finite, 3U);
}

TEST(JsonText, ReadsBackToTheSameDoubles) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    static_assert(sizeof(value) == sizeof(bits));
    std::memcpy(&value, &bits, sizeof(value));
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(Json::parse(to_json_text(Json(value)).text).get<double>(), value);
  }
}

TEST(JsonText, SurvivesBrokenUtf8) { EXPECT_TRUE(Json::accept(to_json_text(Json{{"\xff", "a\xc3"}}).text)); }

TEST(JsonFile, RefusesWhatIsNoJson) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "json_test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "a.json").string();
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("{\"a\": 1e999}"), std::string("{\"a\": NaN}"),
        std::string("\xff\xff"), std::string(200000, '['), std::string(40, '[') + std::string(40, ']')}) {
    std::ofstream(path, std::ios::binary) << text;
    EXPECT_THROW(static_cast<void>(read_json_file(path)), FileError) << text.substr(0, 20);
  }
  EXPECT_THROW(static_cast<void>(read_json_file((folder / "missing").string())), FileError);
}

// Two programs may use one file at a time: `hovermodal simulate` writes the configuration that a service is reading.
TEST(WriteFileAtomically, LeavesAReaderTheOldFileOrTheNewOneAtEveryMoment) {
  const std::string path = testing::TempDir() + "hovermodal_atomic.txt";
  write_file_atomically(path, "old");
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (int i = 0; i < 300; ++i) write_file_atomically(path, i % 2 == 0 ? "new" : "old");
    done = true;
  });
  int n_reads = 0, n_broken = 0;
  while (!done) {
    std::ifstream file(path);
    std::string text;
    file >> text;
    ++n_reads;
    if (text != "old" && text != "new") ++n_broken;
  }
  writer.join();
  EXPECT_GT(n_reads, 0);
  EXPECT_EQ(n_broken, 0);
}

}  // namespace
}  // namespace drivers
