#include "drivers/host/command_line.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

std::optional<int> parse(drivers::CommandLine& program, std::initializer_list<const char*> arguments) {
  std::vector<const char*> words{"program"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return program.parse(static_cast<int>(words.size()), words.data());
}

std::string help_of(drivers::CommandLine& program, std::initializer_list<const char*> arguments) {
  testing::internal::CaptureStdout();
  const std::optional<int> exit_code = parse(program, arguments);
  std::string help = testing::internal::GetCapturedStdout();
  EXPECT_EQ(exit_code, 0);
  return help;
}

// Exit code and message of one option that is declared by `declare`.
struct Refusal {
  std::optional<int> exit_code;
  std::string message;
};
template <class Declare>
Refusal answer(const Declare& declare, std::initializer_list<const char*> arguments) {
  drivers::CommandLine program("test");
  declare(program);
  testing::internal::CaptureStderr();
  const std::optional<int> exit_code = parse(program, arguments);
  return {exit_code, testing::internal::GetCapturedStderr()};
}

struct Values {
  std::string text = "as it was";
  int whole = -7;
  std::uint64_t seed = 1;
  double number = 0.5;
  std::optional<std::string> maybe_text, absent_text;
  std::optional<int> maybe_whole;
  std::optional<std::uint64_t> maybe_seed;
  std::optional<double> maybe_number;
  std::vector<std::string> texts;
  std::vector<double> numbers{9.0};
  std::vector<std::array<double, 4>> rectangles;
  core::ReadoutDirection direction = core::ReadoutDirection::kDown;
  bool flag = false, absent_flag = false;
};

void declare_all(drivers::Command& command, Values& values) {
  command.option("--text", values.text);
  command.option("--whole", values.whole);
  command.option("--seed", values.seed);
  command.option("--number", values.number);
  command.option("--maybe-text", values.maybe_text);
  command.option("--absent-text", values.absent_text);
  command.option("--maybe-whole", values.maybe_whole);
  command.option("--maybe-seed", values.maybe_seed);
  command.option("--maybe-number", values.maybe_number);
  command.option("words", values.texts);
  command.option("--numbers", values.numbers).separator(',');
  command.option("--rectangle", values.rectangles).separator(',');
  command.option("--direction", values.direction);
  command.flag("--flag", values.flag, "");
  command.flag("--absent-flag", values.absent_flag, "");
}

TEST(CommandLine, SetsVariablesOfEveryType) {
  drivers::CommandLine program("test");
  Values values;
  declare_all(program, values);
  ASSERT_FALSE(parse(program, {"a",
                               "b",
                               "--whole",
                               "-3",
                               "--seed",
                               "18446744073709551615",
                               "--number",
                               "1e-3",
                               "--maybe-text",
                               "t",
                               "--maybe-whole",
                               "4",
                               "--maybe-seed",
                               "5",
                               "--maybe-number",
                               "-6.5",
                               "--numbers",
                               "1,2.5",
                               "--rectangle",
                               "1,2,3,4",
                               "--rectangle",
                               "5,6,7,8",
                               "--direction",
                               "left",
                               "--flag"}));
  EXPECT_EQ(values.text, "as it was");
  EXPECT_EQ(values.whole, -3);
  EXPECT_EQ(values.seed, 18446744073709551615ULL);
  EXPECT_EQ(values.number, 1e-3);
  EXPECT_EQ(values.maybe_text, "t");
  EXPECT_FALSE(values.absent_text);
  EXPECT_EQ(values.maybe_whole, 4);
  EXPECT_EQ(values.maybe_seed, 5U);
  EXPECT_EQ(values.maybe_number, -6.5);
  EXPECT_EQ(values.texts, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(values.numbers, (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(values.rectangles, (std::vector<std::array<double, 4>>{{1, 2, 3, 4}, {5, 6, 7, 8}}));
  EXPECT_EQ(values.direction, core::ReadoutDirection::kLeft);
  EXPECT_TRUE(values.flag);
  EXPECT_FALSE(values.absent_flag);
  EXPECT_TRUE(program.given("--whole"));
  EXPECT_FALSE(program.given("--text"));
}

TEST(CommandLine, RefusesValuesOutsideTheirRangeWithExitCode2) {
  int whole = 0;
  double number = 0.0;
  const auto range = [&](drivers::Command& command) { command.option("--n", whole).range(2, 5); };
  EXPECT_FALSE(answer(range, {"--n", "2"}).exit_code);
  EXPECT_FALSE(answer(range, {"--n", "5"}).exit_code);
  const Refusal refused = answer(range, {"--n", "6"});
  EXPECT_EQ(refused.exit_code, 2);
  // The middle is CLI11's: "2 to 5" in 2.3, "[2 - 5]" in 2.4.
  EXPECT_EQ(refused.message.find("--n: Value 6 not in range "), 0U) << refused.message;
  EXPECT_NE(refused.message.find("\nRun with --help for more information.\n"), std::string::npos) << refused.message;
  const auto fraction = [&](drivers::Command& command) { command.option("--n", number).range(0.25, 0.5); };
  EXPECT_FALSE(answer(fraction, {"--n", "0.25"}).exit_code);
  EXPECT_EQ(answer(fraction, {"--n", "0.2"}).exit_code, 2);
  const auto not_negative = [&](drivers::Command& command) { command.option("--n", number).not_negative(); };
  EXPECT_FALSE(answer(not_negative, {"--n", "0"}).exit_code);
  EXPECT_EQ(answer(not_negative, {"--n", "-1"}).exit_code, 2);
  const auto positive = [&](drivers::Command& command) { command.option("--n", number).positive(); };
  EXPECT_FALSE(answer(positive, {"--n", "1e-9"}).exit_code);
  EXPECT_EQ(answer(positive, {"--n", "0"}).exit_code, 2);
}

TEST(CommandLine, RefusesWhatIsUnknownMissingOrNotAllowed) {
  std::string text;
  core::ReadoutDirection direction = core::ReadoutDirection::kDown;
  const auto one_of = [&](drivers::Command& command) { command.option("--t", text).one_of({"a", "b"}); };
  EXPECT_FALSE(answer(one_of, {"--t", "b"}).exit_code);
  EXPECT_EQ(answer(one_of, {"--t", "c"}).exit_code, 2);
  EXPECT_EQ(answer(one_of, {"--unknown"}).exit_code, 2);
  const auto required = [&](drivers::Command& command) { command.option("--t", text).required(); };
  EXPECT_NE(answer(required, {}).message.find("--t is required"), std::string::npos);
  const auto checked = [&](drivers::Command& command) {
    command.option("--t", text).check([](const std::string& value) { return value == "good" ? "" : "be good"; });
  };
  EXPECT_FALSE(answer(checked, {"--t", "good"}).exit_code);
  EXPECT_NE(answer(checked, {"--t", "bad"}).message.find("be good"), std::string::npos);
  EXPECT_EQ(answer([&](drivers::Command& command) { command.option("--d", direction); }, {"--d", "askew"}).exit_code,
            2);
}

TEST(CommandLine, HelpShowsTypesDefaultsAndGroups) {
  drivers::CommandLine program("what it is for");
  int whole = 3;
  std::string text;
  program.option("--n", whole, "a number").range(1, 5).show_default().group("Numbers");
  program.option("--t", text, "a text").type_name("FILE");
  program.footer("at the end");
  const std::string help = help_of(program, {"--help"});
  EXPECT_EQ(help.find("what it is for"), 0U);
  // The default is "=3" in CLI11 2.3, "[3]" in 2.4.
  EXPECT_NE(help.find("Numbers:\n  --n INT:INT in [1 - 5]"), std::string::npos) << help;
  EXPECT_TRUE(help.find("[1 - 5]=3    a number") != std::string::npos ||
              help.find("[1 - 5] [3]  a number") != std::string::npos)
      << help;
  EXPECT_NE(help.find("--t FILE"), std::string::npos) << help;
  EXPECT_NE(help.find("at the end"), std::string::npos);
}

TEST(CommandLine, ListsSubcommandsByOneLine) {
  drivers::CommandLine program("test");
  program.subcommand("first", "Line one\nline two");
  program.subcommand("second", "Long text");
  program.subcommand("internal", "Of no use to users").hide();
  program.summary("second", "Short");
  const std::string help = help_of(program, {"--help"});
  EXPECT_NE(help.find("  first       Line one\n  second      Short\n"), std::string::npos) << help;
  EXPECT_EQ(help.find("line two"), std::string::npos);
  EXPECT_EQ(help.find("internal"), std::string::npos);
}

TEST(CommandLine, RunsTheActionsOfTheSubcommandsGiven) {
  drivers::CommandLine program("test");
  program.require_subcommand();
  std::vector<std::string> calls;
  drivers::Command outer = program.subcommand("outer", "");
  outer.on_run([&calls, outer] { calls.push_back(outer.subcommand_given() ? "outer of inner" : "outer"); });
  outer.subcommand("inner", "").on_run([&] { calls.emplace_back("inner"); });
  program.subcommand("other", "").on_run([] { throw std::runtime_error("the action's own"); });
  EXPECT_EQ(parse(program, {}), 2);
  EXPECT_TRUE(calls.empty());
  EXPECT_FALSE(parse(program, {"outer"}));
  EXPECT_EQ(calls, std::vector<std::string>{"outer"});
  calls.clear();
  EXPECT_FALSE(parse(program, {"outer", "inner"}));
  EXPECT_EQ(calls, (std::vector<std::string>{"inner", "outer of inner"}));
  EXPECT_THROW((void)parse(program, {"other"}), std::runtime_error);
}

TEST(CommandLine, PrintsItsVersion) {
  drivers::CommandLine program("test");
  program.version("program 1.2");
  EXPECT_EQ(help_of(program, {"--version"}), "program 1.2\n");
}

TEST(CommandLine, NoOptionTakesWhatIsNoFiniteNumber) {
  for (const char* text : {"nan", "inf", "-inf", "NAN"}) {
    double one = 0.0;
    std::vector<double> several;
    const auto declare = [&](drivers::CommandLine& program) {
      program.option("--one", one, "");
      program.option("--several", several, "");
    };
    EXPECT_EQ(answer(declare, {"--one", text}).exit_code, 2) << text;
    EXPECT_EQ(answer(declare, {"--several", "1", text}).exit_code, 2) << text;
  }
}

}  // namespace
