#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types/frame.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace drivers {

// The command line of a program is declared once, then parsed; CLI11 does both. Its templates cost each source that
// includes them eight seconds of the compiler's time: only command_line.cpp does.

// What the declaration of an option returns: further properties, in any order.
class CommandOption {
 public:
  CommandOption required(bool is_required = true);
  CommandOption type_name(const char* name);  // in the help, in place of TEXT, INT, UINT or FLOAT
  CommandOption show_default();               // in the help: the variable's value as it is now
  CommandOption group(const char* heading);   // of the help
  CommandOption separator(char between_values);
  CommandOption repeated();  // each use of the option adds values

  // Other values are refused. A limit is included, except the 0 of positive().
  CommandOption range(int least, int most);
  CommandOption range(double least, double most);
  CommandOption not_negative();
  CommandOption positive();
  CommandOption one_of(const std::vector<std::string>& values);
  CommandOption check(const std::function<std::string(const std::string& value)>& fault_of);  // empty = accepted

 private:
  friend class Command;
  CommandOption(CLI::Option* option) : option_(option) {}
  CLI::Option* option_;
};

// A program or one of its subcommands: a handle, valid as long as the program's CommandLine.
class Command {
 public:
  // `name`: "--seed", or a word for values without a name. `value` outlives the parsing; it keeps its default where the
  // option is not given.
  CommandOption option(const char* name, std::string& value, const std::string& help = "");
  CommandOption option(const char* name, int& value, const std::string& help = "");
  CommandOption option(const char* name, std::uint64_t& value, const std::string& help = "");
  CommandOption option(const char* name, double& value, const std::string& help = "");
  CommandOption option(const char* name, std::optional<std::string>& value, const std::string& help = "");
  CommandOption option(const char* name, std::optional<int>& value, const std::string& help = "");
  CommandOption option(const char* name, std::optional<std::uint64_t>& value, const std::string& help = "");
  CommandOption option(const char* name, std::optional<double>& value, const std::string& help = "");
  CommandOption option(const char* name, std::vector<std::string>& value, const std::string& help = "");
  CommandOption option(const char* name, std::vector<double>& value, const std::string& help = "");
  CommandOption option(const char* name, std::vector<std::array<double, 4>>& value, const std::string& help = "");
  CommandOption option(const char* name, core::ReadoutDirection& value, const std::string& help = "");
  CommandOption flag(const char* name, bool& value, const std::string& help);
  void footer(const std::string& text);  // end of the help

  Command subcommand(const std::string& name, const std::string& help);
  void hide();  // from the help of the program
  void on_run(const std::function<void()>& action);

  // After parsing. `name`: of a declared option.
  [[nodiscard]] bool given(const char* name) const;
  [[nodiscard]] bool subcommand_given() const;

 protected:
  explicit Command(CLI::App* app) : app_(app) {}
  CLI::App* app_;
};

class CommandLine : public Command {
 public:
  explicit CommandLine(const std::string& help);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  void version(const std::string& text);  // --version prints it
  void require_subcommand();
  // The line of a subcommand in the program's help; without it, the first line of its own help.
  void summary(const std::string& subcommand, const std::string& line);

  // Sets the variables and runs the actions of the subcommands given; what an action throws is passed on. Returns an
  // exit code if the program is to end: 0 after help or version, 2 after a message about wrong usage.
  [[nodiscard]] std::optional<int> parse(int argc, const char* const* argv);

 private:
  class Formatter;
  CommandLine(std::unique_ptr<CLI::App> owned, const std::shared_ptr<Formatter>& formatter);

  std::unique_ptr<CLI::App> owned_;
  std::shared_ptr<Formatter> formatter_;
};

}  // namespace drivers
