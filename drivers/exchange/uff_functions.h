#pragma once

#include <string>
#include <vector>

namespace drivers {

// One time response of a universal file.
struct UffResponse {
  std::string title, entity, remark;  // ID line 1, response entity, ID line 5
  int node = 0, direction = 0;
  bool even = true;
  double first_s = 0.0, step_s = 0.0;  // of an even one
  std::vector<double> t_s;             // of an uneven one
  std::vector<double> value;
  std::string unit;  // "" = not stated
};

// All time responses (function type 1) of data sets 58, in order. Throws FileError "PATH:LINE: ...".
[[nodiscard]] std::vector<UffResponse> read_uff_responses(const std::string& path);

}  // namespace drivers
