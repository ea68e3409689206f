#include "tools/hovermodal/identify/series_output.h"

#include <fmt/core.h>

#include <filesystem>
#include <stdexcept>

#include "core/identification/merge_setups.h"
#include "drivers/storage/json.h"
#include "firmware_app/report/earlier_files.h"
#include "firmware_app/report/page/report_page.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_findings.h"
#include "tools/hovermodal/modes_text.h"

namespace tools {

namespace {

std::string page_of(const std::string& directory) { return directory + "/" + std::string(app::kReportName); }

}  // namespace

std::string findings_text(const app::SeriesResult& result) {
  std::string text = modes_text(result.estimate, result.channels);
  if (!result.response.empty()) text += "response to the input (H1):\n";
  for (const core::ResponsePeak& peak : result.response) {
    text += fmt::format("  {:9.4f} Hz  gain {:.1f} at {}  coherence {:.2f}\n", peak.frequency_hz, peak.gain,
                        result.channels[static_cast<std::size_t>(peak.channel)].name, peak.coherence);
  }
  for (const std::string& remark : result.remarks) text += "note: " + remark + "\n";
  return text;
}

std::string write_findings(const app::SeriesResult& result, const std::string& directory) {
  drivers::write_file_atomically(directory + "/modal.json", modes_json(result.estimate, result.channels));
  return page_of(directory);
}

namespace {

// Unknown components must not be joined as zeros.
void leave_out_unknown(core::SetupModes& setup) {
  for (std::size_t c = setup.channels.size(); c-- > 0;) {
    if (c >= setup.estimate.channels.size() || setup.estimate.channels[c].takes_part) continue;
    const auto at = static_cast<std::ptrdiff_t>(c);
    setup.channels.erase(setup.channels.begin() + at);
    setup.estimate.channels.erase(setup.estimate.channels.begin() + at);
    for (auto* modes : {&setup.estimate.modes, &setup.estimate.rejected}) {
      for (core::Mode& mode : *modes) {
        if (c < mode.shape.size()) mode.shape.erase(mode.shape.begin() + at);
        if (c < mode.shape_std.size()) mode.shape_std.erase(mode.shape_std.begin() + at);
      }
    }
  }
}

}  // namespace

app::SeriesResult merge_findings(const std::vector<SeriesFindings>& setups) {
  std::vector<core::SetupModes> list;
  for (const SeriesFindings& setup : setups) {
    core::SetupModes& one = list.emplace_back();
    one.name = setup.name;
    one.estimate = setup.result.estimate;
    one.channels = setup.result.channels;
    one.references = setup.references;
    leave_out_unknown(one);
  }
  core::MergedSetups merged = core::merge_setups(list);
  app::SeriesResult result;
  result.estimate = std::move(merged.estimate);
  result.channels = std::move(merged.channels);
  result.remarks = std::move(merged.remarks);
  return result;
}

std::string write_merged(const app::SeriesResult& result, const app::PageHead& head, const std::string& directory) {
  app::RunFacts facts;
  facts.source = "set-ups merged";
  facts.merged = true;
  facts.title = head.title, facts.notes = head.notes;
  facts.method = "hovermodal";
  facts.counted = false;
  app::PictureInputs inputs;
  inputs.channels = result.channels;
  inputs.estimate = &result.estimate;
  inputs.facts = &facts;
  app::compare_with(inputs, head.compare);
  app::keep_earlier_report(directory);
  (void)app::write_pictures(directory, inputs);
  return write_findings(result, directory);
}

}  // namespace tools
