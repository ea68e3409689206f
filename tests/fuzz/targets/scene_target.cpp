#include <stdexcept>

#include "core/structure/declared_frame.h"
#include "drivers/storage/scene/scene_file.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {
namespace {

void read_frame(const std::string& text) {
  try {
    core::structure::validate(drivers::parse_structure(text, "fuzz"));
  } catch (const drivers::FileError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

void read_scene(const std::string& text) {
  drivers::SceneFile scene;
  try {
    scene = drivers::parse_scene(text, "fuzz");
  } catch (const std::invalid_argument& error) {
    require(*error.what() != '\0', "a refusal says why");
    return;
  }
  // No catch: a refusal would be a violation.
  const std::string kept = drivers::scene_text(scene);
  require(drivers::scene_text(drivers::parse_scene(kept, "kept")) == kept, "written and read, it is the same");
}

// A scene, and the same text as a structure.
void run(Bytes bytes) {
  const std::string text = text_of(bytes);
  read_frame(text);
  read_scene(text);
}

const Registration kTarget("scene", &run);

}  // namespace
}  // namespace tests::fuzz
