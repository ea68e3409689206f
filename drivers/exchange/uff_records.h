#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "drivers/storage/csv_writer.h"

namespace drivers {

// Records of the universal file format (SDRC; the definitions are published by the University of Cincinnati, CEAS):
// lines of at most 80 columns with fields of fixed width.
class UffRecords {
 public:
  explicit UffRecords(CsvWriter& file) : file_(file) {}

  void begin_dataset(int number);
  void end_dataset();

  // Fields of one record, joined by the caller.
  void record(std::string_view fields);
  // A record of text, 80 columns; empty text becomes NONE, as the format asks.
  void text(std::string_view text);

  // Values of fixed width: 6 of E13.5 or 4 of E20.12 a line.
  void single(double value);
  void full(double value);
  void full_at(double abscissa, double value);  // E13.5, E20.12: two pairs a line
  void end_values();

 private:
  void value(std::string_view field, int n_a_line);
  CsvWriter& file_;
  int n_on_line_ = 0;
};

// ASCII, padded or cut to `width`; other characters become '?'.
[[nodiscard]] std::string uff_text(std::string_view text, std::size_t width);

}  // namespace drivers
