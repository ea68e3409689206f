#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/fuzz/make_corpus.h"

namespace tests::fuzz {
namespace {

// Two modes, and what does not repeat: at step k of channel c.
double sample(int k, int c) {
  const double t = 2.0 * std::numbers::pi * k / 32.0, sign = c == 1 ? -1.0 : 1.0;
  return std::sin(1.9 * t + 0.1 * std::sin(0.037 * k * k)) + 0.4 * sign * std::sin(5.2 * t + std::sin(0.011 * k * k)) +
         0.01 * std::sin(12.9898 * k + 78.233 * c);
}

std::string table(const char* head, const char* separator, int n_rows) {
  std::string text = head;
  for (int k = 0; k < n_rows; ++k)
    text += fmt::format("{:.3f}{}{:.4f}{}{:.4f}\n", k / 32.0, separator, sample(k, 0), separator, sample(k, 1));
  return text;
}

std::string options(unsigned chosen) {
  return {static_cast<char>(chosen), static_cast<char>(chosen >> 8U), static_cast<char>(chosen >> 16U)};
}

void put_piece(std::string& out, char kind, const std::string& content) {
  out += kind;
  out += static_cast<char>(content.size() >> 8U);
  out += static_cast<char>(content.size() & 0xFFU);
  out += content;
}

// Two regions of two points that go with `sample`.
std::string tracks(int n_frames, int first) {
  std::string text =
      "# hovermodal tracks, version 1\n# image_size_px: 100 x 80\n# rate_hz: 32\n# readout_ms: 0\n"
      "# regions: base,roof\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
  for (int k = 0; k < n_frames; ++k) {
    for (int p = 0; p < 4; ++p) {
      const double moved = p < 2 ? 0.0 : sample(first + k, p - 2);
      text += fmt::format("{},{:.6f},{},{},{:.3f},{},0.01\n", k, k / 32.0, p, p < 2 ? "base" : "roof",
                          20.0 + 30.0 * (p % 2) + moved, p < 2 ? 60 : 20);
    }
  }
  return text;
}

constexpr const char* kConfig =
    "camera: {driver: file, source: none, rate_hz: 32}\nregions:\n  - {name: base, rect: [10, 50, 60, 20], role: "
    "base}\n"
    "  - {name: roof, rect: [10, 10, 60, 20]}\nscale: {adaptive: false}\ntracking: {min_points: 2}\n";

}  // namespace

void write_programs() {
  keep("identify", "table", options(0) + table("t_s,a,b\n", ",", 180));
  keep("identify", "segments", options(1U << 9U | 1U << 11U | 1U << 2U) + table("t_s;ax [m/s^2];floor\n", ";", 120));
  keep("identify", "no_names", options(1U << 4U | 1U << 1U | 1U << 7U | 1U << 3U | 1U) + table("", " ", 120));
  keep("identify", "merged", options(1U << 16U | 1U << 9U | 1U << 21U) + table("t_s,a,b\n", ",", 150));
  keep("identify", "delays",
       options(1U << 8U | 1U << 14U | 1U << 18U | 1U << 19U | 1U) + table("# rate_hz: 32\nframe\ta\tb\n", "\t", 120));

  std::string two, one;
  for (int flight = 0; flight < 2; ++flight) {
    put_piece(two, 't', tracks(48, 400 * flight));
    put_piece(two, 'c', kConfig);
    put_piece(two, 'd', "");
  }
  keep("batch", "two_flights", two);
  put_piece(one, 't', tracks(40, 0));
  put_piece(one, 'c', std::string(kConfig) + "spectrum: {segment: 16}\n");
  keep("batch", "one_flight", one);
  std::string without;
  put_piece(without, 't', tracks(3, 0));
  put_piece(without, 'd', "");
  put_piece(without, 'r', "no record");
  keep("batch", "no_configuration", without);
}

}  // namespace tests::fuzz
