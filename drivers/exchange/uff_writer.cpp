#include "drivers/exchange/uff_writer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/exchange/uff_records.h"

namespace drivers {
namespace {

constexpr std::size_t kNodesALine = 125;  // more are not supported by every reader
enum FunctionType : int {
  kTimeResponse = 1,
  kCrossSpectrum = 3,
  kAutoCorrelation = 7,
  kCrossCorrelation = 8,
  kPowerDensity = 9
};
enum QuantityType : int { kUnknownQuantity = 0, kGeneral = 1, kDisplacement = 8, kTime = 17, kFrequency = 18 };

// Head of a function at a nodal degree of freedom (data set 58).
struct FunctionHead {
  FunctionType type = kTimeResponse;
  int number = 0;
  std::string title, remark;
  std::size_t response = 0;
  const std::size_t* reference = nullptr;
  bool complex = false;
  std::size_t n_values = 0;
  bool even = true;
  double first = 0.0, step = 0.0;
  QuantityType abscissa = kTime, ordinate = kDisplacement;
  std::string abscissa_unit = "s", ordinate_unit;
};

class UffWriter {
 public:
  UffWriter(const ExchangeRun& run, const std::string& path)
      : run_(run), file_(path, OldFile::kKeepUntilCommit), out_(file_) {}

  void write() {
    write_header();
    write_units();
    write_nodes();
    write_lines();
    for (std::size_t m = 0; m < run_.modes.size(); ++m) write_mode(m);
    for (std::size_t c = 0; c < run_.value.size(); ++c) write_series(c);
    for (const ExchangePair& pair : run_.spectra) write_spectrum(pair);
    for (const ExchangePair& pair : run_.correlations) write_correlation(pair);
    file_.commit();
  }

 private:
  void write_header() {
    out_.begin_dataset(151);
    out_.text(run_.name);
    out_.text("operational modal analysis from video");
    out_.text("hovermodal");
    out_.record(fmt::format("{:20}{:10d}{:10d}{:10d}", "", 0, 0, 0));
    out_.record(uff_text("", 20));
    out_.text("hovermodal export");
    out_.record(uff_text("", 20));
    out_.end_dataset();
  }

  // Factors by which a value is divided to give SI units.
  void write_units() {
    const bool is_length = run_.unit == "mm";
    out_.begin_dataset(164);
    out_.record(
        fmt::format("{:10d}{}{:10d}", is_length ? 5 : 9, uff_text(is_length ? "mm (milli newton)" : run_.unit, 20), 2));
    out_.record(fmt::format("{:25.17E}{:25.17E}{:25.17E}", is_length ? 1e3 : 1.0, is_length ? 1e3 : 1.0, 1.0));
    out_.record(fmt::format("{:25.17E}", 273.15));
    out_.end_dataset();
  }

  void write_nodes() {
    out_.begin_dataset(15);
    for (std::size_t n = 0; n < run_.nodes.size(); ++n) {
      out_.record(fmt::format("{:10d}{:10d}{:10d}{:10d}{:13.5E}{:13.5E}{:13.5E}", n + 1, 0, 0, 11, run_.nodes[n].x,
                              run_.nodes[n].y, 0.0));
    }
    out_.end_dataset();
  }

  // Each part begins with the last node of the one before.
  void write_lines() {
    for (std::size_t first = 0, part = 1; first + 1 < run_.line.size(); first += kNodesALine - 1, ++part) {
      const std::size_t n = std::min(kNodesALine, run_.line.size() - first);
      out_.begin_dataset(82);
      out_.record(fmt::format("{:10d}{:10d}{:10d}", part, n, 11));
      out_.text("regions in order; not a member of the structure");
      std::string fields;
      for (std::size_t k = 0; k < n; ++k) {
        fields += fmt::format("{:10d}", run_.line[first + k] + 1);
        if (k % 8 == 7 || k + 1 == n) out_.record(fields), fields.clear();
      }
      out_.end_dataset();
    }
  }

  // All digits: the eigenvalue itself has six.
  [[nodiscard]] static std::string with_sigma(double value, const std::optional<double>& sigma) {
    return sigma ? fmt::format("{}, sigma {}", value, *sigma) : fmt::format("{}, sigma unknown", value);
  }

  void write_mode(std::size_t m) {
    const ExchangeMode& mode = run_.modes[m];
    const double w = 2.0 * std::numbers::pi * mode.frequency_hz, zeta = mode.damping_ratio;
    out_.begin_dataset(55);
    out_.text(run_.name);
    out_.text(fmt::format("mode {}", m + 1));
    out_.text("frequency_hz " + with_sigma(mode.frequency_hz, mode.frequency_std_hz));
    out_.text("damping_ratio " + with_sigma(zeta, mode.damping_std));
    out_.text("shape without a scale: modal A and B are unknown and 0");
    out_.record(fmt::format("{:10d}{:10d}{:10d}{:10d}{:10d}{:10d}", 1, 3, 2, 8, 5, 3));
    out_.record(fmt::format("{:10d}{:10d}{:10d}{:10d}", 2, 6, 0, m + 1));
    for (const double value : {-zeta * w, w * std::sqrt(std::max(0.0, 1.0 - zeta * zeta)), 0.0, 0.0, 0.0, 0.0})
      out_.single(value);
    for (std::size_t n = 0; n < run_.nodes.size(); ++n) write_node_of_mode(mode, n);
    out_.end_dataset();
  }

  // The sum over the channels of a region; a region without a known component is left out.
  void write_node_of_mode(const ExchangeMode& mode, std::size_t node) {
    std::complex<double> x = 0.0, y = 0.0;
    bool known = false;
    for (std::size_t c = 0; c < run_.channels.size() && c < mode.shape.size(); ++c) {
      const ExchangeChannel& channel = run_.channels[c];
      if (channel.node != node || !std::isfinite(std::abs(mode.shape[c]))) continue;
      x += mode.shape[c] * channel.direction_x;
      y += mode.shape[c] * channel.direction_y;
      known = true;
    }
    if (!known) return;
    out_.record(fmt::format("{:10d}", node + 1));
    for (const double value : {x.real(), x.imag(), y.real(), y.imag(), 0.0, 0.0}) out_.single(value);
  }

  void write_series(std::size_t c) {
    const std::vector<double>& values = run_.value[c];
    const auto n_seen = static_cast<std::size_t>(
        std::count_if(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
    FunctionHead head;
    head.number = static_cast<int>(c) + 1;
    head.title = run_.channels[c].name;
    head.response = c;
    head.even = n_seen == values.size() && run_.is_even();
    head.n_values = n_seen;
    head.first = head.even && !run_.t_s.empty() ? run_.t_s.front() : 0.0;
    head.step = head.even ? 1.0 / run_.rate_hz : 0.0;
    head.remark = fmt::format("rate_hz={}; delay_s={}; {} missing", run_.rate_hz, run_.channels[c].delay_s,
                              values.size() - n_seen);
    head.ordinate_unit = run_.unit;
    begin_function(head);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!std::isfinite(values[k])) continue;
      head.even ? out_.full(values[k]) : out_.full_at(run_.t_s[k], values[k]);
    }
    end_function();
  }

  void write_spectrum(const ExchangePair& pair) {
    const bool is_power = pair.i == pair.j;
    FunctionHead head;
    head.type = is_power ? kPowerDensity : kCrossSpectrum;
    head.number = ++n_pairs_;
    head.title = pair_title("spectral density", pair);
    head.remark =
        fmt::format("step_hz={}; one-sided; Welch, {} samples a segment, Hann", run_.frequency_step_hz, run_.segment);
    head.abscissa = kFrequency, head.abscissa_unit = "Hz";
    head.step = run_.frequency_step_hz;
    write_pair(pair, head, !is_power, run_.unit + "^2/Hz");
  }

  void write_correlation(const ExchangePair& pair) {
    FunctionHead head;
    head.type = pair.i == pair.j ? kAutoCorrelation : kCrossCorrelation;
    head.number = ++n_pairs_;
    head.title = pair_title("correlation", pair);
    head.remark = "E[x_response(t + lag) x_reference(t)]; missing samples accounted for";
    head.step = 1.0 / run_.rate_hz;
    head.first = -run_.most_lag / run_.rate_hz;
    write_pair(pair, head, false, run_.unit + "^2");
  }

  void write_pair(const ExchangePair& pair, FunctionHead& head, bool complex, std::string unit) {
    head.response = pair.i;
    head.reference = &pair.j;
    head.complex = complex;
    head.n_values = pair.value.size();
    head.ordinate = kGeneral, head.ordinate_unit = std::move(unit);
    begin_function(head);
    for (const std::complex<double>& value : pair.value) {
      out_.full(value.real());
      if (complex) out_.full(value.imag());
    }
    end_function();
  }

  [[nodiscard]] std::string pair_title(const char* what, const ExchangePair& pair) const {
    const std::string& response = run_.channels[pair.i].name;
    return pair.i == pair.j ? fmt::format("{} of {}", what, response)
                            : fmt::format("{} of {} and {}", what, response, run_.channels[pair.j].name);
  }

  // " name       node dir": an oblique axis has no direction in the format and is a scalar, 0.
  [[nodiscard]] std::string degree_of_freedom(const std::size_t* c) const {
    if (c == nullptr) return fmt::format(" {}{:10d}{:4d}", uff_text("NONE", 10), 0, 0);
    const ExchangeChannel& channel = run_.channels[*c];
    constexpr double kAlong = 1.0 - 1e-9;
    const auto along = [](double component, int axis) {
      return component > kAlong ? axis : component < -kAlong ? -axis : 0;
    };
    const int direction = along(channel.direction_x, 1) + along(channel.direction_y, 2);
    return fmt::format(" {}{:10d}{:4d}", uff_text(run_.nodes[channel.node].name, 10), channel.node + 1, direction);
  }

  static std::string axis_record(QuantityType type, const char* label, const std::string& unit) {
    return fmt::format("{:10d}{:5d}{:5d}{:5d} {} {}", static_cast<int>(type), 0, 0, 0, uff_text(label, 20),
                       uff_text(unit, 20));
  }

  void begin_function(const FunctionHead& head) {
    out_.begin_dataset(58);
    out_.text(head.title);
    out_.text(run_.name);
    out_.text("NONE");
    out_.text(fmt::format("axis ({:.9g}, {:.9g}), x right, y up", run_.channels[head.response].direction_x + 0.0,
                          run_.channels[head.response].direction_y + 0.0));
    out_.text(head.remark);
    out_.record(fmt::format("{:5d}{:10d}{:5d}{:10d}{}{}", static_cast<int>(head.type), head.number, 0, 0,
                            degree_of_freedom(&head.response), degree_of_freedom(head.reference)));
    out_.record(fmt::format("{:10d}{:10d}{:10d}{:13.5E}{:13.5E}{:13.5E}", head.complex ? 6 : 4, head.n_values,
                            head.even ? 1 : 0, head.first, head.step, 0.0));
    out_.record(axis_record(head.abscissa, head.abscissa == kFrequency ? "frequency" : "time", head.abscissa_unit));
    out_.record(
        axis_record(head.ordinate, head.ordinate == kDisplacement ? "displacement" : "NONE", head.ordinate_unit));
    out_.record(axis_record(kUnknownQuantity, "NONE", "NONE"));
    out_.record(axis_record(kUnknownQuantity, "NONE", "NONE"));
  }

  void end_function() {
    out_.end_values();
    out_.end_dataset();
  }

  const ExchangeRun& run_;
  CsvWriter file_;
  UffRecords out_;
  int n_pairs_ = 0;
};

}  // namespace

void write_uff(const ExchangeRun& run, const std::string& path) { UffWriter(run, path).write(); }

}  // namespace drivers
