#include "drivers/storage/key_suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace drivers {
namespace {

// Levenshtein distance: insertions, deletions and changes that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, changed}));
    }
  }
  return row[b.size()];
}

std::string_view leaf(std::string_view path) { return path.substr(path.rfind('.') + 1); }

// All keys, and all sections that contain them.
std::set<std::string> all_paths(const std::vector<std::string>& keys) {
  std::set<std::string> paths;
  for (const std::string& key : keys) {
    for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1)) {
      const std::string section = key.substr(0, dot);
      paths.insert(section.ends_with("[]") ? section.substr(0, section.size() - 2) : section);
    }
    paths.insert(key);
  }
  return paths;
}

}  // namespace

std::string suggest_key(const std::string& path, const std::vector<std::string>& keys, std::string_view help_option) {
  constexpr std::size_t kMaxLength = 80;  // longer texts are similar to no key
  if (path.size() > kMaxLength) return fmt::format("see {}", help_option);
  const std::set<std::string> candidates = all_paths(keys);
  std::string best;
  std::size_t best_score = kMaxLength * 4;
  for (const std::string& candidate : candidates) {
    // A correct name in a wrong section counts almost like a typing error in the correct section.
    const std::size_t whole = edit_distance(path, candidate) * 2;
    const std::size_t by_leaf = edit_distance(leaf(path), leaf(candidate)) * 2 + 1;
    std::size_t score = std::min(whole, by_leaf);
    // "rate" for rate_hz: a forgotten ending is the most frequent mistake; of several, a unit is the shortest.
    if (path.size() > 2 && candidate.starts_with(path)) score = 0;
    const bool is_shorter = score == 0 && best_score == 0 && candidate.size() < best.size();
    if (score < best_score || is_shorter) best_score = score, best = candidate;
  }
  if (best_score <= std::max<std::size_t>(4, leaf(path).size())) {
    return fmt::format("did you mean `{}`? ({} lists all)", best, help_option);
  }
  std::vector<std::string> beside;
  const std::string section = path.substr(0, path.size() - leaf(path).size());
  for (const std::string& candidate : candidates) {
    if (candidate.starts_with(section) && candidate.find('.', section.size()) == std::string::npos) {
      beside.push_back(candidate.substr(section.size()));
    }
  }
  return fmt::format("known here: {}", fmt::join(beside, ", "));
}

}  // namespace drivers
