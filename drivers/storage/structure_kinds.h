#pragma once

#include <optional>
#include <string>

#include "core/structure/declared_frame.h"
#include "drivers/storage/structure_value.h"
#include "drivers/storage/yaml.h"

namespace drivers {

// A structure of another kind than a shear frame, from the section `structure` of a structure file. Files that it names
// are relative to the folder of `file`. Throws FileError.
[[nodiscard]] core::structure::DeclaredFrame parse_structure_kind(const YamlNode& section, const std::string& file);

// The key `temperature` of any kind; empty: not there.
[[nodiscard]] std::optional<core::structure::TemperatureLaw> parse_temperature(const StructureMap& map);

// "shear_frame, beam, ...", and the keys of every kind but shear_frame, for a reader.
[[nodiscard]] const char* structure_kinds();
[[nodiscard]] std::string structure_kinds_help();

}  // namespace drivers
