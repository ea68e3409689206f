#include "tools/hovermodal/closeloop/closing.h"

#include <filesystem>
#include <utility>

#include "drivers/storage/json.h"
#include "firmware_app/report/closure_json.h"
#include "firmware_app/report/earlier_files.h"
#include "tools/hovermodal/closeloop/words.h"

namespace tools {

core::closure::ClosureResult close_level(const Answer& answer, core::closure::ClosureLevel& level,
                                         core::closure::ClosureOptions options) {
  const ProgressLine line(answer);
  options.progress = line.teller();
  return core::closure::close_loop(level, options);
}

void show_closure(const Answer& answer, const core::closure::ClosureResult& result, const std::string& more,
                  const std::string& report, const std::string& file) {
  const std::string json = app::closure_json(result);
  if (file == "closure.json") answer.document(json);
  answer.text("{}{}", closure_text(result), more);
  if (report.empty()) return;
  const std::string path = (std::filesystem::path(report) / file).string();
  drivers::write_file_atomically(path, json);
  answer.text("{} written\n", path);
}

void keep_earlier_closure(const std::string& report) {
  if (!report.empty())
    app::keep_earlier(
        report, "closure",
        {"closure.json", "closure_field.svg", "closure_residual.svg", "closure_modes.svg", "structure_*"});
}

}  // namespace tools
