#pragma once

#include <matio.h>

#include <memory>

namespace drivers {

struct MatCloser {
  void operator()(mat_t* file) const noexcept { Mat_Close(file); }
};
struct MatVariableFree {
  void operator()(matvar_t* variable) const noexcept { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, MatCloser>;
using MatVariable = std::unique_ptr<matvar_t, MatVariableFree>;

}  // namespace drivers
