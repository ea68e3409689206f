#include "drivers/host/command_line.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

namespace drivers {

namespace {

const std::map<std::string, core::ReadoutDirection>& readout_directions() {
  using core::ReadoutDirection;
  static const std::map<std::string, ReadoutDirection> kDirections = [] {
    std::map<std::string, ReadoutDirection> named;
    for (const ReadoutDirection direction :
         {ReadoutDirection::kDown, ReadoutDirection::kUp, ReadoutDirection::kLeft, ReadoutDirection::kRight}) {
      named.emplace(core::to_string(direction), direction);
    }
    return named;
  }();
  return kDirections;
}

// "nan" and "inf" are numbers for the parser, and no value for any option.
std::string fault_of_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && !std::isfinite(value) ? text + " is no finite number" : std::string();
}

}  // namespace

CommandOption CommandOption::required(bool is_required) { return option_->required(is_required); }
CommandOption CommandOption::type_name(const char* name) { return option_->type_name(name); }
CommandOption CommandOption::show_default() { return option_->capture_default_str(); }
CommandOption CommandOption::group(const char* heading) { return option_->group(heading); }
CommandOption CommandOption::separator(char between) { return option_->delimiter(between); }
CommandOption CommandOption::repeated() { return option_->take_all(); }
CommandOption CommandOption::range(int least, int most) { return option_->check(CLI::Range(least, most)); }
CommandOption CommandOption::range(double least, double most) { return option_->check(CLI::Range(least, most)); }
CommandOption CommandOption::not_negative() { return option_->check(CLI::NonNegativeNumber); }
CommandOption CommandOption::positive() { return option_->check(CLI::PositiveNumber); }
CommandOption CommandOption::one_of(const std::vector<std::string>& values) {
  return option_->check(CLI::IsMember(values));
}
CommandOption CommandOption::check(const std::function<std::string(const std::string&)>& fault_of) {
  return option_->check(fault_of);
}

CommandOption Command::option(const char* name, std::string& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, int& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, std::uint64_t& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, double& value, const std::string& help) {
  return app_->add_option(name, value, help)->check(fault_of_number);
}
CommandOption Command::option(const char* name, std::optional<std::string>& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, std::optional<int>& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, std::optional<std::uint64_t>& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, std::optional<double>& value, const std::string& help) {
  return app_->add_option(name, value, help)->check(fault_of_number);
}
CommandOption Command::option(const char* name, std::vector<std::string>& value, const std::string& help) {
  return app_->add_option(name, value, help);
}
CommandOption Command::option(const char* name, std::vector<double>& value, const std::string& help) {
  return app_->add_option(name, value, help)->check(fault_of_number);
}
CommandOption Command::option(const char* name, std::vector<std::array<double, 4>>& value, const std::string& help) {
  return app_->add_option(name, value, help)->check(fault_of_number);
}
CommandOption Command::option(const char* name, core::ReadoutDirection& value, const std::string& help) {
  CLI::Option* added = app_->add_option(name, value, help);
  added->transform(CLI::CheckedTransformer(readout_directions()).description(""));  // its default shows character codes
  return added->type_name("down|up|left|right");
}
CommandOption Command::flag(const char* name, bool& value, const std::string& help) {
  return app_->add_flag(name, value, help);
}
void Command::footer(const std::string& text) { app_->footer(text); }

Command Command::subcommand(const std::string& name, const std::string& help) {
  return Command(app_->add_subcommand(name, help));
}
void Command::hide() { app_->group(""); }
void Command::on_run(const std::function<void()>& action) { app_->callback(action); }

bool Command::given(const char* name) const { return app_->count(name) > 0; }
bool Command::subcommand_given() const { return !app_->get_subcommands().empty(); }

class CommandLine::Formatter final : public CLI::Formatter {
 public:
  void add(const std::string& subcommand, const std::string& line) { summaries_[subcommand] = line; }

  std::string make_subcommand(const CLI::App* command) const override {
    const std::string description = command->get_description();
    const auto known = summaries_.find(command->get_name());
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_display_name(true),
                             known == summaries_.end() ? description.substr(0, description.find('\n')) : known->second,
                             kNameColumns);
    return out.str();
  }

 private:
  static constexpr std::size_t kNameColumns = 14;
  std::map<std::string, std::string> summaries_;
};

CommandLine::CommandLine(const std::string& help)
    : CommandLine(std::make_unique<CLI::App>(help), std::make_shared<Formatter>()) {}

CommandLine::CommandLine(std::unique_ptr<CLI::App> owned, const std::shared_ptr<Formatter>& formatter)
    : Command(owned.get()), owned_(std::move(owned)), formatter_(formatter) {
  app_->formatter(formatter_);
}

CommandLine::~CommandLine() = default;

void CommandLine::version(const std::string& text) { app_->set_version_flag("--version", text); }
void CommandLine::require_subcommand() { app_->require_subcommand(1); }

void CommandLine::summary(const std::string& subcommand, const std::string& line) { formatter_->add(subcommand, line); }

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& e) {
    return app_->exit(e) == 0 ? 0 : 2;
  }
}

}  // namespace drivers
