#include "drivers/exchange/mat_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <system_error>

#include "core/types/constants.h"
#include "drivers/exchange/mat_handle.h"
#include "drivers/storage/partial_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

std::vector<double> values_or_nan(const std::vector<ExchangeMode>& modes, std::optional<double> ExchangeMode::*member) {
  std::vector<double> out;
  out.reserve(modes.size());
  for (const ExchangeMode& mode : modes) out.push_back((mode.*member).value_or(core::kNan));
  return out;
}
std::vector<double> values(const std::vector<ExchangeMode>& modes, double ExchangeMode::*member) {
  std::vector<double> out;
  out.reserve(modes.size());
  for (const ExchangeMode& mode : modes) out.push_back(mode.*member);
  return out;
}

class MatWriter {
 public:
  MatWriter(const ExchangeRun& run, const std::string& path)
      : run_(run), path_(path), partial_path_(drivers::partial_path(path)) {
    (void)::unlink(partial_path_.c_str());  // a new file, never what a link of that name points to
    file_.reset(Mat_CreateVer(partial_path_.c_str(), "MATLAB 5.0 MAT-file, hovermodal export", MAT_FT_MAT5));
    if (!file_) throw FileError(partial_path_ + ": cannot be written; check the folder and its permissions");
  }

  void write() {
    write_series();
    write_places();
    write_modes();
    write_pairs("spectrum", run_.spectra, true);
    write_pairs("correlation", run_.correlations, false);
    file_.reset();
    commit();
  }

 private:
  void put(MatVariable variable) {
    if (!variable || Mat_VarWrite(file_.get(), variable.get(), MAT_COMPRESSION_NONE) != 0)
      throw FileError(partial_path_ + ": a variable cannot be written; is the disk full?");
  }

  // Column by column.
  void matrix(const char* name, std::vector<double> value, std::size_t n_columns = 1) {
    if (value.empty() || n_columns == 0) return;
    std::array<std::size_t, 2> size{value.size() / n_columns, n_columns};
    put(MatVariable(Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), value.data(), 0)));
  }
  void complex_matrix(const char* name, std::vector<double> re, std::vector<double> im, std::size_t n_columns) {
    if (re.empty() || n_columns == 0) return;
    std::array<std::size_t, 2> size{re.size() / n_columns, n_columns};
    mat_complex_split_t parts{re.data(), im.data()};
    put(MatVariable(Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), &parts, MAT_F_COMPLEX)));
  }
  static matvar_t* text_variable(const char* name, const std::string& text) {
    std::array<std::size_t, 2> size{1, text.size()};
    std::string copy = text;
    return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(), copy.data(), 0);
  }
  void text(const char* name, const std::string& value) { put(MatVariable(text_variable(name, value))); }
  void texts(const char* name, const std::vector<std::string>& all) {
    if (all.empty()) return;
    std::vector<matvar_t*> cells;
    cells.reserve(all.size());
    for (const std::string& one : all) cells.push_back(text_variable(nullptr, one));
    std::array<std::size_t, 2> size{cells.size(), 1};
    put(MatVariable(Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), cells.data(), 0)));
  }

  void write_series() {
    std::vector<std::string> names;
    std::vector<double> delays, displacement;
    for (const ExchangeChannel& channel : run_.channels)
      names.push_back(channel.name), delays.push_back(channel.delay_s);
    for (const std::vector<double>& column : run_.value)
      displacement.insert(displacement.end(), column.begin(), column.end());
    texts("channel_names", names);
    text("unit", run_.unit);
    if (run_.rate_hz > 0.0) matrix("rate_hz", {run_.rate_hz});
    matrix("t_s", run_.t_s);
    matrix("displacement", std::move(displacement), run_.value.size());
    matrix("delay_s", std::move(delays));
  }

  void write_places() {
    std::vector<std::string> names;
    std::vector<double> x, y, node, direction_x, direction_y;
    for (const ExchangeNode& one : run_.nodes) names.push_back(one.name), x.push_back(one.x), y.push_back(one.y);
    for (const ExchangeChannel& channel : run_.channels) {
      node.push_back(static_cast<double>(channel.node + 1));
      direction_x.push_back(channel.direction_x), direction_y.push_back(channel.direction_y);
    }
    x.insert(x.end(), y.begin(), y.end());
    direction_x.insert(direction_x.end(), direction_y.begin(), direction_y.end());
    texts("node_names", names);
    matrix("node_xy", std::move(x), 2);
    matrix("channel_node", std::move(node));
    matrix("channel_direction_xy", std::move(direction_x), 2);
  }

  void write_modes() {
    const std::vector<ExchangeMode>& modes = run_.modes;
    std::vector<std::string> verdicts;
    std::vector<double> re, im, sigma;
    for (const ExchangeMode& mode : modes) {
      verdicts.push_back(mode.verdict);
      for (std::size_t c = 0; c < run_.channels.size(); ++c) {
        const bool known = c < mode.shape.size();
        re.push_back(known ? mode.shape[c].real() : core::kNan);
        im.push_back(known ? mode.shape[c].imag() : core::kNan);
        sigma.push_back(c < mode.shape_std.size() ? mode.shape_std[c] : core::kNan);
      }
    }
    matrix("frequency_hz", values(modes, &ExchangeMode::frequency_hz));
    matrix("frequency_sigma_hz", values_or_nan(modes, &ExchangeMode::frequency_std_hz));
    matrix("damping", values(modes, &ExchangeMode::damping_ratio));
    matrix("damping_sigma", values_or_nan(modes, &ExchangeMode::damping_std));
    matrix("mpc", values(modes, &ExchangeMode::mpc));
    texts("verdict", verdicts);
    complex_matrix("shape", std::move(re), std::move(im), modes.size());
    matrix("shape_sigma", std::move(sigma), modes.size());
  }

  void write_pairs(const std::string& name, const std::vector<ExchangePair>& pairs, bool is_spectrum) {
    if (pairs.empty()) return;
    std::vector<double> abscissa, re, im, i, j;
    for (std::size_t k = 0; k < pairs.front().value.size(); ++k) {
      abscissa.push_back(is_spectrum ? static_cast<double>(k) * run_.frequency_step_hz
                                     : (static_cast<double>(k) - run_.most_lag) / run_.rate_hz);
    }
    for (const ExchangePair& pair : pairs) {
      for (const std::complex<double>& value : pair.value) re.push_back(value.real()), im.push_back(value.imag());
      i.push_back(static_cast<double>(pair.i + 1)), j.push_back(static_cast<double>(pair.j + 1));
    }
    i.insert(i.end(), j.begin(), j.end());
    matrix((name + (is_spectrum ? "_frequency_hz" : "_lag_s")).c_str(), std::move(abscissa));
    if (is_spectrum) {
      complex_matrix(name.c_str(), std::move(re), std::move(im), pairs.size());
    } else {
      matrix(name.c_str(), std::move(re), pairs.size());
    }
    matrix((name + "_pair").c_str(), std::move(i), 2);
  }

  // libmatio does not report a full disk when it closes a file: synchronise, then rename.
  void commit() {
    const int descriptor = ::open(partial_path_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool is_safe = descriptor >= 0 && sync_to_disk(descriptor);
    if (descriptor >= 0) ::close(descriptor);
    std::error_code error;
    if (is_safe) std::filesystem::rename(partial_path_, path_, error);
    if (!is_safe || error) throw FileError(path_ + ": cannot be completed; is the disk full?");
  }

  const ExchangeRun& run_;
  std::string path_, partial_path_;
  MatFile file_;
};

}  // namespace

void write_mat(const ExchangeRun& run, const std::string& path) { MatWriter(run, path).write(); }

}  // namespace drivers
