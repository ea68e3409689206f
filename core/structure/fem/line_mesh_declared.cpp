// LineMesh: what is declared of it.
#include <utility>

#include "core/structure/fem/line_mesh.h"

namespace core::structure {

std::size_t LineMesh::add_node(double x_m, double z_m) {
  nodes_.push_back({x_m, z_m});
  return nodes_.size() - 1;
}

std::size_t LineMesh::add_parameter(ModelParameter parameter) {
  parameters_.push_back(std::move(parameter));
  return parameters_.size() - 1;
}

std::size_t LineMesh::add_bar(std::size_t from, std::size_t to, const Bar& bar, std::optional<std::size_t> part) {
  bars_.push_back({from, to, bar, part});
  return bars_.size() - 1;
}

void LineMesh::add_tension(std::size_t bar, const std::function<double(double)>& newton, std::size_t parameter,
                           bool is_weight) {
  tensions_.push_back({bar, parameter, newton, is_weight ? 0 : -1});
}

void LineMesh::add_spring(std::size_t node, Motion motion, std::size_t parameter, Law law, double least) {
  springs_.push_back({node, parameter, motion, law, least});
}

void LineMesh::add_mass(std::size_t node, double kg, std::optional<std::size_t> parameter) {
  masses_.push_back({node, kg, parameter});
}

void LineMesh::add_uniform_restraint(double factor, std::size_t parameter, int power) {
  restraints_.push_back({factor, parameter, power});
}

void LineMesh::add_shear(std::size_t bar, double newton, std::size_t parameter, double least, int functions) {
  shears_.push_back({bar, parameter, newton, least, functions});
}

void LineMesh::add_rigid_end(std::size_t bar, bool is_last, std::size_t parameter, double most_m) {
  rigid_ends_.push_back({bar, parameter, is_last, most_m});
}

void LineMesh::add_link(std::size_t from, std::size_t to, std::size_t parameter) {
  links_.push_back({from, to, parameter});
}

}  // namespace core::structure
