#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/exchange/series_file.h"
#include "drivers/storage/text_file.h"

namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string number(std::uint32_t value) {
  std::string out;
  for (int byte = 0; byte < 4; ++byte) out += static_cast<char>(value >> (8 * byte) & 0xFFU);
  return out;
}

// A MAT file of version 5, little-endian, with one array in these bytes after its flags and dimensions.
std::string mat_of(std::uint32_t array_class, std::vector<std::uint32_t> dimensions, const std::string& rest) {
  std::string array = number(6) + number(8) + number(array_class) + number(0);
  array += number(5) + number(static_cast<std::uint32_t>(4 * dimensions.size()));
  for (const std::uint32_t dimension : dimensions) array += number(dimension);
  array += number(1) + number(0) + rest;
  std::string head = "MATLAB 5.0 MAT-file";
  head.resize(124, ' ');
  return head + std::string("\0\1IM", 4) + number(14) + number(static_cast<std::uint32_t>(array.size())) + array;
}
std::string refusal_of_mat(const std::string& bytes) {
  const std::string path = (std::filesystem::path(testing::TempDir()) / "hovermodal_hostile.mat").string();
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    (void)drivers::read_mat_series(path);
  } catch (const drivers::FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MatLayout, ACellThatAnnouncesMoreArraysThanItsBytesHoldIsRefused) {
  EXPECT_THAT(refusal_of_mat(mat_of(1, {40000, 50000}, "")), HasSubstr("announces 2000000000 arrays in 0 bytes"));
  // Two arrays fit into sixteen bytes: this one holds no series, but it is no hostile one.
  EXPECT_THAT(refusal_of_mat(mat_of(1, {2, 1}, std::string(16, '\0'))), Not(HasSubstr("announces")));
}

TEST(MatLayout, ANestedCellIsCheckedLikeTheOuterOne) {
  const std::string inner = mat_of(1, {40000, 50000}, "").substr(128);
  EXPECT_THAT(refusal_of_mat(mat_of(1, {1, 1}, inner)), HasSubstr("announces 2000000000 arrays"));
}

TEST(MatLayout, ATextOfMoreValuesThanItsBytesIsRefused) {
  EXPECT_THAT(refusal_of_mat(mat_of(4, {1, 4000000000U}, "")), HasSubstr("announces 4000000000 values in 0 bytes"));
}

TEST(MatLayout, AnArrayWithoutFlagsOrDimensionsIsRefused) {
  std::string whole = mat_of(4, {1, 2}, "");
  std::string damaged = whole;
  damaged[128 + 8] = '\x7F';  // type of the flags
  EXPECT_THAT(refusal_of_mat(damaged), HasSubstr("does not begin with its flags"));
  damaged = whole;
  damaged[128 + 8 + 16] = '\x7F';  // type of the dimensions
  EXPECT_THAT(refusal_of_mat(damaged), HasSubstr("is not its dimensions"));
}

TEST(MatLayout, AnythingElseBetweenTheVariablesIsRefused) {
  const std::string whole = mat_of(4, {1, 0}, "");
  EXPECT_THAT(refusal_of_mat(whole + "a text in between, "), HasSubstr("where a variable should begin"));
  EXPECT_THAT(refusal_of_mat(mat_of(38, {1, 0}, "")), HasSubstr("an array of class 38"));
}

TEST(MatLayout, AVariableOfVersion4IsCheckedToo) {
  const std::string name("t_s\0", 4), values(16, '\1');
  EXPECT_THAT(refusal_of_mat(number(0) + number(2) + number(1) + number(0) + number(4) + name + values),
              Not(HasSubstr("announces")));
  EXPECT_THAT(refusal_of_mat(number(0) + number(2) + number(1) + number(1) + number(4) + name + values),
              HasSubstr("a variable announces 36 bytes, 20 are left"));
  EXPECT_THAT(refusal_of_mat(number(0) + number(2) + number(1) + number(0) + number(2000000000) + name + values),
              HasSubstr("a variable announces 2000000016 bytes"));
  EXPECT_THAT(refusal_of_mat(std::string(40, 'x')), HasSubstr("no MAT file that can be read"));
}

TEST(MatLayout, AnElementThatEndsBeyondTheFileIsRefused) {
  std::string whole = mat_of(6, {1, 1}, std::string("\x09\0\0\0\x08\0\0\0\0\0\0\0\0\0\xF0\x3F", 16));
  EXPECT_THAT(refusal_of_mat(whole), HasSubstr("no real numeric array"));  // one number is no series
  EXPECT_THAT(refusal_of_mat(whole.substr(0, whole.size() - 8)), HasSubstr("cut off or damaged"));
  whole[128 + 8 + 16 + 4] = '\x7F';  // bytes of the dimensions
  EXPECT_THAT(refusal_of_mat(whole), HasSubstr("an element announces 127 bytes"));
}

}  // namespace
