#include "core/simulation/structure/modal_form.h"

#include <gtest/gtest.h>

#include <complex>
#include <vector>

#include "core/simulation/structure/beam_builders.h"
#include "core/simulation/structure/structure_builders.h"

namespace core::simulation {
namespace {

std::vector<StructureModel> models() {
  const ShearBuilding frame{{10.0, 8.0, 12.0}, {1.8e4, 1.2e4, 1.5e4}, 0.0, {}};
  return {shear_frame(frame, ModalDamping{{0.01, 0.03}}), shear_frame(frame, Dashpots{{4.0, 0.0, 40.0}}),
          shear_frame(frame, Dashpots{{5000.0, 0.0, 0.0}}),  // one mode does not oscillate
          cantilever({30.0e3, 8, 3.0e8, 160.0, 250.0}, ModalDamping{{0.01}}),
          cantilever({30.0e3, 8, 3.0e8, 160.0, 250.0}, Dashpots{std::vector<double>(8, 50.0)})};
}

ModalForm form_of(const StructureModel& model) { return modal_form(model.mass, model.damping, model.stiffness); }

TEST(ModalForm, RespondsAsTheMatricesDo) {
  for (const StructureModel& model : models()) {
    const ModalForm form = form_of(model);
    const Eigen::VectorXcd force = model.displacement.row(1).transpose().cast<std::complex<double>>();
    for (const double w : {1.0, 5.1, 30.0, 120.0}) {
      const Eigen::VectorXcd q = response_at(model, w, force);
      const Eigen::VectorXcd z = modal_response(form, w, form.shapes.transpose() * force);
      EXPECT_LT((form.shapes * z - q).norm(), 1e-7 * q.norm()) << w;
    }
  }
}

// Each pole and its shape solve (s^2 M + s C + K) q = 0.
TEST(ModalForm, FindsEveryPole) {
  for (const StructureModel& model : models()) {
    const Poles poles = poles_of(form_of(model));
    ASSERT_EQ(poles.s.size(), 2 * model.n_coordinates());
    for (Eigen::Index i = 0; i < poles.s.size(); ++i) {
      const std::complex<double> s = poles.s(i);
      const Eigen::VectorXcd q = poles.shapes.col(i);
      const Eigen::VectorXcd inertia = s * s * (model.mass * q), elastic = model.stiffness * q;
      const Eigen::VectorXcd left = inertia + s * (model.damping * q) + elastic;
      EXPECT_LT(left.norm(), 1e-6 * (elastic.norm() + inertia.norm())) << "pole " << s;
    }
  }
}

TEST(ModalForm, KnowsProportionalDamping) {
  const std::vector<StructureModel> all = models();
  EXPECT_TRUE(form_of(all[0]).diagonal);
  EXPECT_FALSE(form_of(all[1]).diagonal);
  EXPECT_TRUE(form_of(all[3]).diagonal);
  EXPECT_FALSE(form_of(all[4]).diagonal);
  EXPECT_LT(modes_of(all[2]).size(), 3U);
}

}  // namespace
}  // namespace core::simulation
