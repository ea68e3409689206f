#include "core/types/frame.h"

namespace core {

const char* to_string(ReadoutDirection direction) noexcept {
  switch (direction) {
    case ReadoutDirection::kDown:
      return "down";
    case ReadoutDirection::kUp:
      return "up";
    case ReadoutDirection::kLeft:
      return "left";
    case ReadoutDirection::kRight:
      return "right";
  }
  return "down";
}

}  // namespace core
