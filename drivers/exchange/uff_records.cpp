#include "drivers/exchange/uff_records.h"

namespace drivers {

std::string uff_text(std::string_view text, std::size_t width) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // continues a character that is already a '?'
    out.push_back(byte >= 0x20U && byte < 0x7FU ? c : '?');
  }
  out.resize(width, ' ');
  return out;
}

void UffRecords::begin_dataset(int number) {
  record("    -1");
  record(fmt::format("{:6d}", number));
}

void UffRecords::end_dataset() { record("    -1"); }

void UffRecords::record(std::string_view fields) {
  append_text(file_.buffer(), fields);
  file_.buffer().push_back('\n');
  (void)file_.end_line();
}

void UffRecords::text(std::string_view text) { record(uff_text(text.empty() ? "NONE" : text, 80)); }

void UffRecords::value(std::string_view field, int n_a_line) {
  append_text(file_.buffer(), field);
  if (++n_on_line_ >= n_a_line) end_values();
}

void UffRecords::single(double value) { this->value(fmt::format("{:13.5E}", value), 6); }
void UffRecords::full(double value) { this->value(fmt::format("{:20.12E}", value), 4); }
void UffRecords::full_at(double abscissa, double value) {
  this->value(fmt::format("{:13.5E}{:20.12E}", abscissa, value), 2);
}

void UffRecords::end_values() {
  if (n_on_line_ == 0) return;
  n_on_line_ = 0;
  record("");
}

}  // namespace drivers
