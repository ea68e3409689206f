#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tests::fuzz {

// One seed, a file of the target's folder.
void keep(const std::string& target, const std::string& name, const std::vector<std::uint8_t>& bytes);
void keep(const std::string& target, const std::string& name, const std::string& text);

void write_texts();     // configurations, calibrations, scenes, tables
void write_exchange();  // files of other programs
void write_programs();  // inputs of commands

}  // namespace tests::fuzz
