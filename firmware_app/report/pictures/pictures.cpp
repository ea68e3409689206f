#include "firmware_app/report/pictures/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/estimate_words.h"
#include "firmware_app/report/page/report_page.h"
#include "firmware_app/report/pictures/parts.h"

namespace app {
namespace {

// Draws one picture after the other; a failure does not prevent the others.
class PictureWriter {
 public:
  explicit PictureWriter(const std::string& directory) : directory_(directory) {}

  template <class Draw>
  void write(const char* name, const Draw& draw) {
    attempt(name, [&] {
      const std::string path = (std::filesystem::path(directory_) / name).string();
      std::error_code ignored;  // an error that matters shows when the new file is written
      std::filesystem::remove(path, ignored);
      const std::string content = draw();
      if (content.empty()) return;
      drivers::write_file_atomically(path, content);
      names_.emplace_back(name);
    });
  }

  template <class Work>
  void attempt(const char* name, const Work& work) {
    try {
      work();
    } catch (const drivers::FileError& error) {  // its text contains the file's name
      add_failure(error.what());
    } catch (const std::exception& error) {  // a library, or out of memory
      add_failure(fmt::format("{} cannot be drawn: {}", name, error.what()));
    }
  }

  [[nodiscard]] std::vector<std::string> finish() {
    if (!failures_.empty()) throw drivers::FileError("pictures are missing: " + failures_);
    return std::move(names_);
  }

 private:
  void add_failure(std::string_view what) {
    if (!failures_.empty()) failures_ += "; ";
    failures_ += what;
  }

  std::string directory_;
  std::vector<std::string> names_;
  std::string failures_;
};

}  // namespace

std::vector<std::string> write_pictures(const std::string& directory, const PictureInputs& given) {
  PictureInputs inputs = given;
  core::ModalEstimate estimate;
  const auto takes_part = [](const core::ChannelRecord& channel) { return channel.takes_part; };
  if (given.estimate != nullptr &&
      !std::all_of(given.estimate->channels.begin(), given.estimate->channels.end(), takes_part)) {
    estimate = with_unknown_components(*given.estimate);
    inputs.estimate = &estimate;
  }
  PictureWriter writer(directory);
  writer.write("frame.png", [&] { return frame_png(inputs); });
  writer.write("displacements.svg", [&] { return displacements_svg(inputs, kFileFormat); });
  writer.write("scale.svg", [&] { return scale_svg(inputs, kFileFormat); });
  writer.write("spectra.svg", [&] { return spectra_svg(inputs, kFileFormat); });
  writer.write("modes.svg", [&] { return modes_svg(inputs); });
  writer.write("report.html", [&] { return inputs.facts == nullptr ? std::string() : report_html(inputs); });
  return writer.finish();
}

std::size_t curve_points(std::size_t n_curves, const PictureFormat& format) noexcept {
  // The page contains every picture twice, and must stay below 2 MB with all of them.
  const double share = !format.on_page ? 1.0 : is_narrow(format) ? 0.2 : 0.4;
  const auto all = static_cast<std::size_t>(share * static_cast<double>(kMaxPicturePoints));
  const auto most = static_cast<std::size_t>(is_narrow(format) ? 0.4 * kMaxCurvePoints : 1.0 * kMaxCurvePoints);
  return std::clamp<std::size_t>(all / std::max<std::size_t>(1, n_curves), 50, most);
}

std::string decimals_text(double value, int n_decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, n_decimals) : "–";
}

std::string four_digits_text(double value) {
  if (!std::isfinite(value)) return "–";
  return std::abs(value) < 999.95 ? fmt::format("{:#.4g}", value) : fmt::format("{:.0f}", value);
}

bool is_folded(const core::Mode& mode) noexcept { return mode.fold_n.value_or(0) != 0; }

std::string frequency_text(const core::Mode& mode, bool with_deviation) {
  std::string out = four_digits_text(mode.frequency_hz);
  if (with_deviation && mode.frequency_std_hz) out += " ± " + decimals_text(*mode.frequency_std_hz, 3);
  out += " Hz";
  if (is_folded(mode)) out += ", seen at " + four_digits_text(mode.apparent_hz);
  return out;
}

}  // namespace app
