#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/types/constants.h"
#include "drivers/exchange/mat_writer.h"
#include "drivers/exchange/mcap_file.h"
#include "drivers/exchange/mcap_writer.h"
#include "drivers/exchange/modes_csv.h"
#include "drivers/exchange/series_file.h"
#include "drivers/exchange/uff_writer.h"
#include "drivers/storage/text_file.h"

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::NanSensitiveDoubleEq;
using ::testing::Pointwise;

std::string temporary(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "hovermodal_exchange";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

// Two floors and a base of 40 samples at 25 Hz, one mode with a complex shape, one spectrum and one correlation.
drivers::ExchangeRun small_run() {
  drivers::ExchangeRun run;
  run.name = "flight";
  run.nodes = {{"roof", 10.0, -5.0}, {"base", 11.0, -80.0}};
  run.channels = {{"roof.u", 0, 1.0, 0.0, 0.002}, {"roof.v", 0, 0.0, -1.0, 0.002}, {"base", 1, 1.0, 0.0, 0.02}};
  run.line = {1, 0};
  run.rate_hz = 25.0;
  for (int k = 0; k < 40; ++k) run.t_s.push_back(k / 25.0);
  for (int c = 0; c < 3; ++c) {
    std::vector<double>& column = run.value.emplace_back();
    for (int k = 0; k < 40; ++k) column.push_back(std::sin(0.3 * k + c) / 3.0);
  }
  drivers::ExchangeMode mode;
  mode.frequency_hz = 1.65704564684744, mode.frequency_std_hz = 0.00465;
  mode.damping_ratio = 0.01057;
  mode.shape = {{1.0, 0.0}, {0.25, -0.125}, {core::kNan, core::kNan}};
  mode.shape_std = {0.0, 0.01, core::kNan};
  mode.mpc = 0.99, mode.verdict = "structural";
  run.modes = {mode};
  run.frequency_step_hz = 25.0 / 32.0, run.segment = 16, run.most_lag = 1;
  run.spectra = {{0, 1, {{1.0, 2.0}, {3.0, -4.0}}}};
  run.correlations = {{0, 0, {0.5, 1.0, 0.5}}};
  return run;
}

double at_digits(double value, const char* format) { return std::stod(fmt::format(fmt::runtime(format), value)); }

TEST(ExchangeFiles, AUniversalFileReadsBackToThirteenDigits) {
  const drivers::ExchangeRun run = small_run();
  const std::string path = temporary("run.uff");
  drivers::write_uff(run, path);
  const drivers::SeriesFile back = drivers::read_any_series(path);
  EXPECT_THAT(back.names, ElementsAre("roof.u", "roof.v", "base"));
  EXPECT_THAT(back.units, ElementsAre("mm", "mm", "mm"));
  EXPECT_EQ(back.rate_hz, 25.0);
  EXPECT_EQ(back.comments.at("row_delay_s.base"), "0.02");
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_EQ(back.columns[c].size(), 40U);
    for (std::size_t k = 0; k < 40; ++k) EXPECT_EQ(back.columns[c][k], at_digits(run.value[c][k], "{:.12e}"));
  }
}

TEST(ExchangeFiles, MissingSamplesOfAUniversalFileStayMissing) {
  drivers::ExchangeRun run = small_run();
  run.value[1][7] = run.value[1][8] = core::kNan;
  const std::string path = temporary("gaps.uff");
  drivers::write_uff(run, path);
  const drivers::SeriesFile back = drivers::read_any_series(path);
  ASSERT_EQ(back.columns[1].size(), 40U);
  EXPECT_TRUE(std::isnan(back.columns[1][7]) && std::isnan(back.columns[1][8]));
  EXPECT_EQ(back.columns[1][9], at_digits(run.value[1][9], "{:.12e}"));
  EXPECT_EQ(back.columns[0][7], at_digits(run.value[0][7], "{:.12e}"));
}

TEST(ExchangeFiles, UnevenTimesOfAUniversalFileAreAColumn) {
  drivers::ExchangeRun run = small_run();
  run.t_s[3] += 0.01;
  const std::string path = temporary("uneven.uff");
  drivers::write_uff(run, path);
  const drivers::SeriesFile back = drivers::read_any_series(path);
  ASSERT_EQ(back.names.front(), "t_s");
  EXPECT_DOUBLE_EQ(back.columns[0][3], 0.13);
  EXPECT_EQ(back.columns[2][3], at_digits(run.value[1][3], "{:.12e}"));
}

TEST(ExchangeFiles, AModeOfAUniversalFileHasItsEigenvalueAndLeavesUnknownNodesOut) {
  const std::string path = temporary("mode.uff");
  drivers::write_uff(small_run(), path);
  const std::string text = bytes_of(path);
  EXPECT_THAT(text, HasSubstr("frequency_hz 1.65704564684744, sigma 0.00465"));
  EXPECT_THAT(text, HasSubstr("damping_ratio 0.01057, sigma unknown"));
  EXPECT_THAT(text, HasSubstr(" -1.10050E-01  1.04109E+01"));  // -zeta w, w sqrt(1 - zeta^2)
  // The roof moves 1 along x and, its axis v being downwards, -(0.25 - 0.125i) along y; the base is unknown.
  EXPECT_THAT(text, HasSubstr("         1\n  1.00000E+00  0.00000E+00 -2.50000E-01  1.25000E-01  0.00000E+00"));
  const std::size_t mode = text.find("\n    55\n");
  EXPECT_EQ(text.substr(mode, text.find("    -1", mode) - mode).find("\n         2\n"), std::string::npos);
}

// As other programs write it: single precision, two functions, units in data set 164.
std::string foreign_uff(const std::string& dof, const std::string& data, const std::string& values) {
  return "    -1\n   164\n         1SI                           2\n  1.00000000000000000E+00  1.0  1.0\n  0.0\n    "
         "-1\n"
         "    -1\n    58\nNONE\nNONE\n01-Jan-20 10:00:00\nNONE\nNONE\n" +
         dof + "\n" + data + "\n        17    0    0    0 NONE                 NONE\n" +
         "        12    0    0    0 NONE                 NONE\n         0    0    0    0 NONE                 NONE\n" +
         "         0    0    0    0 NONE                 NONE\n" + values + "    -1\n";
}
constexpr const char* kDof = "    1         0    0         0 BEAM              17   3 NONE               0   0";

TEST(ExchangeFiles, AUniversalFileOfAnotherProgramHasNamesRateAndUnit) {
  const std::string path = temporary("foreign.uff");
  std::ofstream(path) << foreign_uff(kDof, "         2         8         1  0.00000E+00  1.00000E-02  0.00000E+00",
                                     "  1.00000E+00 -2.00000E+00  3.00000D+00  4.00000E+00  5.00000E+00  6.00000E+00\n"
                                     "  7.00000E+00  8.00000E+00\n");
  const drivers::SeriesFile back = drivers::read_any_series(path);
  EXPECT_THAT(back.names, ElementsAre("BEAM_17z"));
  EXPECT_THAT(back.units, ElementsAre("m/s^2"));
  EXPECT_EQ(back.rate_hz, 100.0);
  EXPECT_THAT(back.columns[0], ElementsAre(1, -2, 3, 4, 5, 6, 7, 8));
}

TEST(ExchangeFiles, ABinaryUniversalFileIsRead) {
  std::string values;
  for (const float value : {1.5F, -0.25F, 3.0F}) values.append(reinterpret_cast<const char*>(&value), sizeof value);
  std::string text =
      foreign_uff(kDof, "         2         3         1  0.00000E+00  1.00000E-02  0.00000E+00", values + "\n");
  text.replace(text.find("    58\n"), 7,
               "    58b     1     2          11          12     0     0           0           0\n");
  const std::string path = temporary("binary.uff");
  std::ofstream(path, std::ios::binary) << text;
  EXPECT_THAT(drivers::read_any_series(path).columns[0], ElementsAre(1.5, -0.25, 3.0));
}

void expect_refused(const std::string& text, const std::string& words) {
  const std::string path = temporary("refused.uff");
  std::ofstream(path, std::ios::binary) << text;
  try {
    (void)drivers::read_any_series(path);
    ADD_FAILURE() << "not refused: " << words;
  } catch (const drivers::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(ExchangeFiles, FaultsOfAUniversalFileAreNamed) {
  const std::string data = "         2         4         1  0.00000E+00  1.00000E-02  0.00000E+00";
  expect_refused(foreign_uff(kDof, data, "  1.00000E+00\n"), "1 values instead of 4");
  expect_refused(foreign_uff(kDof, data, "  1.0000xE+00\n"), "is no number");
  std::string many = data;
  many.replace(10, 10, " 999999999");
  expect_refused(foreign_uff(kDof, many, "  1.00000E+00\n"), "too short for them");
  std::string other = kDof;
  other.replace(0, 5, "    4");
  expect_refused(foreign_uff(other, data, "  1.00000E+00\n"), "no time response");
  expect_refused("    -1\n    58\nNONE\n", "cut off");
}

TEST(ExchangeFiles, AMatFileReadsBackToTheLastBit) {
  drivers::ExchangeRun run = small_run();
  run.value[1][7] = core::kNan;
  const std::string path = temporary("run.mat");
  drivers::write_mat(run, path);
  const drivers::SeriesFile back = drivers::read_any_series(path);
  EXPECT_THAT(back.names, ElementsAre("t_s", "roof.u", "roof.v", "base"));
  EXPECT_THAT(back.units, ElementsAre("", "mm", "mm", "mm"));
  EXPECT_EQ(back.rate_hz, 25.0);
  EXPECT_EQ(back.comments.at("row_delay_s.base"), "0.02");
  EXPECT_EQ(back.columns[0], run.t_s);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_THAT(back.columns[c + 1], Pointwise(NanSensitiveDoubleEq(), run.value[c]));
}

TEST(ExchangeFiles, AFileThatIsNoMatFileIsRefused) {
  const std::string path = temporary("broken.mat");
  std::ofstream(path, std::ios::binary) << "MATLAB 5.0 MAT-file" << std::string(200, '\0');
  EXPECT_THROW((void)drivers::read_any_series(path), drivers::FileError);
}

TEST(ExchangeFiles, ATableOfTextIsStillATable) {
  const std::string path = temporary("table.csv");
  std::ofstream(path) << "t_s,a\n0,-1\n1,2\n";
  EXPECT_THAT(drivers::read_any_series(path).columns[1], ElementsAre(-1, 2));
}

TEST(ExchangeFiles, TheTableOfModesIsFlatAndExact) {
  const std::string path = temporary("modes.csv");
  drivers::write_modes_csv(small_run(), path);
  EXPECT_EQ(bytes_of(path),
            "mode,frequency_hz,frequency_sigma_hz,damping,damping_sigma,mpc,verdict,roof.u.re,roof.u.im,roof.u.sigma,"
            "roof.v.re,roof.v.im,roof.v.sigma,base.re,base.im,base.sigma\n"
            "1,1.65704564684744,0.00465,0.01057,,0.99,structural,1,0,0,0.25,-0.125,0.01,,,\n");
}

TEST(ExchangeFiles, TheChecksumIsThatOfEthernet) {
  EXPECT_EQ(drivers::crc32("123456789"), 0xcbf43926U);
  EXPECT_EQ(drivers::crc32("6789", drivers::crc32("12345")), 0xcbf43926U);
}

std::uint64_t little(const std::string& bytes, std::size_t at, std::size_t n) {
  std::uint64_t out = 0;
  for (std::size_t i = n; i-- > 0;) out = (out << 8U) | static_cast<unsigned char>(bytes[at + i]);
  return out;
}

TEST(ExchangeFiles, AnMcapFileHasItsRecordsIndexAndChecksums) {
  drivers::ExchangeRun run = small_run();
  run.value[2][5] = core::kNan;
  const std::string path = temporary("run.mcap");
  drivers::write_mcap(run, path);
  const std::string bytes = bytes_of(path);
  const std::string magic("\x89MCAP0\r\n", 8);
  ASSERT_EQ(bytes.substr(0, 8), magic);
  ASSERT_EQ(bytes.substr(bytes.size() - 8), magic);
  std::map<int, int> n_of;
  std::size_t data_end = 0, footer = 0, chunk = 0;
  for (std::size_t at = 8; at + 9 < bytes.size() - 8; at += 9 + little(bytes, at + 1, 8)) {
    ++n_of[bytes[at]];
    if (bytes[at] == 0x0f) data_end = at;
    if (bytes[at] == 0x02) footer = at;
    if (bytes[at] == 0x06) chunk = at;
  }
  EXPECT_THAT(n_of, ElementsAre(testing::Pair(1, 1), testing::Pair(2, 1), testing::Pair(3, 4), testing::Pair(4, 4),
                                testing::Pair(6, 1), testing::Pair(7, 4), testing::Pair(8, 1), testing::Pair(11, 1),
                                testing::Pair(14, 4), testing::Pair(15, 1)));
  EXPECT_EQ(little(bytes, data_end + 9, 4), drivers::crc32(std::string_view(bytes).substr(0, data_end)));
  const std::size_t summary = little(bytes, footer + 9, 8);
  EXPECT_EQ(summary, data_end + 13);
  EXPECT_EQ(little(bytes, footer + 25, 4),
            drivers::crc32(std::string_view(bytes).substr(summary, footer + 25 - summary)));
  const std::size_t records = chunk + 9 + 8 + 8 + 8 + 4 + 4 + 8;
  EXPECT_EQ(little(bytes, chunk + 9 + 24, 4),
            drivers::crc32(std::string_view(bytes).substr(records, little(bytes, records - 8, 8))));
  EXPECT_THAT(bytes, HasSubstr(R"("t_s":0.2,"unit":"mm","channel":{"roof.u":)"));
  EXPECT_THAT(bytes, HasSubstr(R"("base":null}})"));
}

TEST(ExchangeFiles, TheSameRunGivesTheSameBytes) {
  for (const char* name : {"same.uff", "same.mat", "same.mcap"}) {
    const auto write = [&](const std::string& path) {
      if (path.ends_with("uff")) drivers::write_uff(small_run(), path);
      if (path.ends_with("mat")) drivers::write_mat(small_run(), path);
      if (path.ends_with("mcap")) drivers::write_mcap(small_run(), path);
      return bytes_of(path);
    };
    EXPECT_EQ(write(temporary(name)), write(temporary(name))) << name;
  }
}

TEST(ExchangeFiles, AFolderThatIsMissingIsNamed) {
  const std::string path = temporary("none") + "/run.mat";
  EXPECT_THROW(drivers::write_mat(small_run(), path), drivers::FileError);
  EXPECT_THROW(drivers::write_uff(small_run(), path), drivers::FileError);
}

}  // namespace
