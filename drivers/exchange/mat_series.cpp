#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/types/constants.h"
#include "drivers/exchange/mat_handle.h"
#include "drivers/exchange/mat_layout.h"
#include "drivers/exchange/series_file.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/series_format.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

// Numeric array of two dimensions, column by column.
struct MatMatrix {
  std::string name;
  std::size_t n_rows = 0, n_columns = 0;
  std::vector<double> value;
  [[nodiscard]] std::size_t longer() const { return std::max(n_rows, n_columns); }
};

template <class Number>
void copy_numbers(const matvar_t& variable, std::vector<double>& out) {
  const auto* from = static_cast<const Number*>(variable.data);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = static_cast<double>(from[k]);
}

// False: a class that is no number.
bool copy_by_class(const matvar_t& variable, std::vector<double>& out) {
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      return copy_numbers<double>(variable, out), true;
    case MAT_T_SINGLE:
      return copy_numbers<float>(variable, out), true;
    case MAT_T_INT8:
      return copy_numbers<std::int8_t>(variable, out), true;
    case MAT_T_UINT8:
      return copy_numbers<std::uint8_t>(variable, out), true;
    case MAT_T_INT16:
      return copy_numbers<std::int16_t>(variable, out), true;
    case MAT_T_UINT16:
      return copy_numbers<std::uint16_t>(variable, out), true;
    case MAT_T_INT32:
      return copy_numbers<std::int32_t>(variable, out), true;
    case MAT_T_UINT32:
      return copy_numbers<std::uint32_t>(variable, out), true;
    case MAT_T_INT64:
      return copy_numbers<std::int64_t>(variable, out), true;
    case MAT_T_UINT64:
      return copy_numbers<std::uint64_t>(variable, out), true;
    default:
      return false;
  }
}

std::optional<MatMatrix> matrix_of(const matvar_t& variable) {
  const bool is_number = variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
  if (!is_number || variable.isComplex != 0 || variable.rank != 2 || variable.data == nullptr ||
      variable.name == nullptr)
    return std::nullopt;
  MatMatrix out{variable.name, variable.dims[0], variable.dims[1], {}};
  if (out.n_rows == 0 || out.n_columns == 0 || variable.data_size <= 0) return std::nullopt;
  const std::size_t n_values = variable.nbytes / static_cast<std::size_t>(variable.data_size);
  if (out.n_rows > n_values || out.n_columns != n_values / out.n_rows) return std::nullopt;
  out.value.resize(out.n_rows * out.n_columns);
  if (!copy_by_class(variable, out.value)) return std::nullopt;
  return out;
}

std::optional<std::string> text_of(const matvar_t& variable) {
  if (variable.class_type != MAT_C_CHAR || variable.data == nullptr || variable.rank != 2) return std::nullopt;
  std::string out;
  const std::size_t n = variable.data_size > 0 ? variable.nbytes / static_cast<std::size_t>(variable.data_size) : 0;
  for (std::size_t k = 0; k < n && k < 256; ++k) {
    const bool is_wide = variable.data_size == 2;
    const unsigned code = is_wide ? static_cast<const std::uint16_t*>(variable.data)[k]
                                  : static_cast<const std::uint8_t*>(variable.data)[k];
    out.push_back(is_wide && code > 0x7eU ? '?' : static_cast<char>(code));
  }
  return out;
}

class MatSeries {
 public:
  explicit MatSeries(const std::string& path) : path_(path) {
    check_mat_layout(path);
    file_.reset(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
    if (!file_) refuse("no MAT file that can be read; save it with -v7 or -v6");
  }

  [[nodiscard]] SeriesFile read() {
    read_variables();
    find_columns();
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw FileError(path_ + ": " + what); }

  // Sizes are checked before the values are read: a compressed variable may be a thousand times larger than the file.
  void read_variables() {
    double n_bytes = 0.0;
    while (true) {
      const MatVariable variable(Mat_VarReadNextInfo(file_.get()));
      if (!variable) break;
      n_bytes += announced_bytes(*variable);
      if (!(n_bytes <= static_cast<double>(Limits::kExchangeBytes)))
        refuse("its variables are larger than 96 MiB; save only the series");
      const std::string name = variable->name != nullptr ? variable->name : "";
      const bool is_number = variable->class_type >= MAT_C_DOUBLE && variable->class_type <= MAT_C_UINT64;
      const bool is_wanted = is_number || name == "unit" || name == "channel_names";
      if (!is_wanted || Mat_VarReadDataAll(file_.get(), variable.get()) != 0) continue;
      if (auto matrix = matrix_of(*variable)) matrices_.push_back(std::move(*matrix));
      if (const auto text = text_of(*variable); text && name == "unit") unit_ = *text;
      if (name == "channel_names" && variable->class_type == MAT_C_CELL) read_names(*variable);
    }
  }
  static double announced_bytes(const matvar_t& variable) {
    double n_values = 1.0;
    for (int d = 0; d < variable.rank && variable.dims != nullptr; ++d)
      n_values *= static_cast<double>(variable.dims[d]);
    return 8.0 * n_values * (variable.isComplex != 0 ? 2.0 : 1.0);
  }

  void read_names(const matvar_t& cells) {
    const std::size_t n = cells.nbytes / sizeof(matvar_t*);
    auto* const* cell = static_cast<matvar_t* const*>(cells.data);
    for (std::size_t k = 0; cell != nullptr && k < n && k < Limits::kColumns; ++k)
      names_.push_back(cell[k] != nullptr ? text_of(*cell[k]).value_or("") : "");
  }

  static bool is_time_name(const std::string& name) { return name == "t_s" || name == "t" || name == "time"; }

  // As long as the vector of times where there is one, else the longest.
  void find_columns() {
    std::size_t longest = 0, timed = 0;
    for (const MatMatrix& matrix : matrices_) {
      longest = std::max(longest, matrix.longer());
      if (is_time_name(matrix.name) && std::min(matrix.n_rows, matrix.n_columns) == 1) timed = matrix.longer();
      const bool is_rate = matrix.name == "rate_hz" || matrix.name == "fs" || matrix.name == "Fs";
      const double first = matrix.value.front();
      if (is_rate && matrix.longer() == 1 && first > 0.0 && std::isfinite(first)) out_.rate_hz = first;
    }
    if (longest < 2) refuse("no real numeric array in it; a series is a vector or a matrix, not a struct or table");
    for (const MatMatrix& matrix : matrices_) {
      if (matrix.longer() == (timed > 1 ? timed : longest)) add_columns(matrix);
    }
    for (const MatMatrix& matrix : matrices_) {  // of our own files
      if (matrix.name != "delay_s" || matrix.longer() != names_.size()) continue;
      for (std::size_t c = 0; c < names_.size(); ++c)
        out_.comments["row_delay_s." + names_[c]] = fmt::format("{}", matrix.value[c]);
    }
  }

  void add_columns(const MatMatrix& matrix) {
    const bool along_rows = matrix.n_columns > matrix.n_rows;  // a sample per column
    const std::size_t n_series = along_rows ? matrix.n_rows : matrix.n_columns, n_samples = matrix.longer();
    if (out_.names.size() + n_series > Limits::kColumns) refuse(fmt::format("more than {} series", Limits::kColumns));
    for (std::size_t c = 0; c < n_series; ++c) {
      std::vector<double>& column = out_.columns.emplace_back(n_samples);
      for (std::size_t t = 0; t < n_samples; ++t) {
        column[t] = along_rows ? matrix.value[t * matrix.n_rows + c] : matrix.value[c * n_samples + t];
        if (std::isinf(column[t])) column[t] = core::kNan, ++out_.n_not_finite;
      }
      std::string name = n_series == 1 ? matrix.name : fmt::format("{}_{}", matrix.name, c + 1);
      if (n_series == names_.size() && n_series > 1 && is_free(names_[c])) name = names_[c];
      if (n_series == 1 && names_.size() == 1 && matrix.name == "displacement" && is_free(names_[0])) name = names_[0];
      add_name(name);
    }
  }
  [[nodiscard]] bool is_free(const std::string& name) const {
    return !name.empty() && name.size() <= 64 && out_.column(name) < 0;
  }
  void add_name(std::string name) {
    try {
      require_text(name, "");
    } catch (const FileError&) {
      name = fmt::format("series_{}", out_.names.size() + 1);
    }
    const bool is_time = is_time_name(name);
    const std::string own = unit_of_name(name);
    out_.units.push_back(is_time ? "" : own.empty() ? unit_ : own);
    out_.names.emplace_back(without_unit(name));
  }

  std::string path_, unit_;
  MatFile file_;
  std::vector<MatMatrix> matrices_;
  std::vector<std::string> names_;
  SeriesFile out_;
};

}  // namespace

SeriesFile read_mat_series(const std::string& path) { return MatSeries(path).read(); }

}  // namespace drivers
