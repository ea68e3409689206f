#pragma once

#include <string>

#include "core/structure/declared_frame.h"

namespace drivers {

// The known properties of a structure, in YAML: `structure: {kind: shear_frame, storeys: 6}`. structure_keys_help()
// lists the keys. Throws FileError "FILE:LINE: key: what; remedy" on anything else.
[[nodiscard]] core::structure::DeclaredFrame read_structure(const std::string& path);
[[nodiscard]] core::structure::DeclaredFrame parse_structure(const std::string& text, const std::string& name);

// One line a key: name, meaning, unit.
[[nodiscard]] std::string structure_keys_help();

}  // namespace drivers
