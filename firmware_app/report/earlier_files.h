#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace app {

inline constexpr int kEarlierResults = 3;  // that a program at the desk keeps in the folder of its result

// `made`, a folder inside `folder`, becomes `folder/STEM.1`; the one before it becomes STEM.2, and so on; of more than
// `keep` the oldest is removed. keep 0: `made` is removed. Throws std::filesystem::filesystem_error.
void number_earlier(const std::filesystem::path& folder, std::string_view stem, const std::filesystem::path& made,
                    int keep);

// Moves the files of an earlier result out of the way of a new one, into `folder/STEM.1`; does nothing if there are
// none. A name that ends in * stands for all that begin so. Called before the first file is written. Throws
// drivers::FileError.
void keep_earlier(const std::string& folder, std::string_view stem, const std::vector<std::string_view>& names);

// The same for modal.json, report.html and its pictures, into `folder/report.1`.
void keep_earlier_report(const std::string& folder);

}  // namespace app
