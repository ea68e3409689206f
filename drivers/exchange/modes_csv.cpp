#include "drivers/exchange/modes_csv.h"

#include <cmath>
#include <utility>

#include "drivers/storage/csv_writer.h"

namespace drivers {
namespace {

class ModesTable {
 public:
  explicit ModesTable(const std::string& path) : file_(path, OldFile::kKeepUntilCommit) {}

  void cell(const std::string& text) {
    if (!std::exchange(is_first_, false)) file_.buffer().push_back(',');
    if (text.find_first_of(",\"\n") == std::string::npos) return append_text(file_.buffer(), text);
    file_.buffer().push_back('"');
    for (const char c : text) {
      if (c == '"') file_.buffer().push_back('"');
      file_.buffer().push_back(c);
    }
    file_.buffer().push_back('"');
  }
  void number(double value) { cell(std::isfinite(value) ? fmt::format("{}", value) : ""); }
  void number(const std::optional<double>& value) { value ? number(*value) : cell(""); }
  void end_row() {
    file_.buffer().push_back('\n');
    (void)file_.end_line();
    is_first_ = true;
  }
  void commit() { file_.commit(); }

 private:
  CsvWriter file_;
  bool is_first_ = true;
};

}  // namespace

void write_modes_csv(const ExchangeRun& run, const std::string& path) {
  ModesTable table(path);
  for (const char* name : {"mode", "frequency_hz", "frequency_sigma_hz", "damping", "damping_sigma", "mpc", "verdict"})
    table.cell(name);
  for (const ExchangeChannel& channel : run.channels) {
    for (const char* part : {".re", ".im", ".sigma"}) table.cell(channel.name + part);
  }
  table.end_row();
  for (std::size_t m = 0; m < run.modes.size(); ++m) {
    const ExchangeMode& mode = run.modes[m];
    table.cell(fmt::format("{}", m + 1));
    table.number(mode.frequency_hz);
    table.number(mode.frequency_std_hz);
    table.number(mode.damping_ratio);
    table.number(mode.damping_std);
    table.number(mode.mpc);
    table.cell(mode.verdict);
    for (std::size_t c = 0; c < run.channels.size(); ++c) {
      const bool known = c < mode.shape.size() && std::isfinite(std::abs(mode.shape[c]));
      known ? table.number(mode.shape[c].real()) : table.cell("");
      known ? table.number(mode.shape[c].imag()) : table.cell("");
      known&& c < mode.shape_std.size() ? table.number(mode.shape_std[c]) : table.cell("");
    }
    table.end_row();
  }
  table.commit();
}

}  // namespace drivers
