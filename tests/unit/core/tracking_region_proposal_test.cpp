#include "core/tracking/region_proposal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/simulation/presets.h"
#include "core/simulation/render/renderer.h"
#include "core/simulation/track_generator.h"
#include "core/tracking/rest_rectangle.h"

namespace {

using core::ProposedRegion;
using core::SurveyedPoint;
using core::Vector2;

constexpr double kRate_hz = 25.0;
constexpr int kWidth_px = 800, kHeight_px = 600, kFrames = 200;
constexpr double kNoise_px = 0.02;

double wave(double t_s, double freq_hz) { return std::sin(2.0 * std::numbers::pi * freq_hz * t_s); }

// A hovering camera before a wall, and plates in front of it that move sideways.
class Made {
 public:
  // moves(t_s): px along u, at a place.
  template <class Moves>
  void add_plate(double left, double top, double width, double height, const Moves& moves) {
    for (double v = top + 5.0; v < top + height; v += 9.0) {
      for (double u = left + 5.0; u < left + width; u += 9.0) {
        add({u, v}, [&](double t_s) { return Vector2{moves(t_s, Vector2{u, v}), 0.0}; });
      }
    }
    plates_.push_back({left, top, left + width, top + height});
  }
  void add_wall(double spacing_px = 14.0) {
    for (double v = 8.0; v < kHeight_px; v += spacing_px) {
      for (double u = 8.0; u < kWidth_px; u += spacing_px) {
        const auto covers = [&](const core::Box& b) {
          return u > b.left - 12.0 && u < b.right + 12.0 && v > b.top - 12.0 && v < b.bottom + 12.0;
        };
        if (std::none_of(plates_.begin(), plates_.end(), covers)) add({u, v}, [](double) { return Vector2{}; });
      }
    }
  }
  [[nodiscard]] core::RegionProposal propose(const core::RegionProposalConfig& config = {}) const {
    return core::propose_regions(points_, kRate_hz, kWidth_px, kHeight_px, config);
  }
  [[nodiscard]] const std::vector<core::Box>& plates() const { return plates_; }

 private:
  template <class Moves>
  void add(const Vector2& at, const Moves& moves) {
    SurveyedPoint point{at, kNoise_px, {}};
    std::normal_distribution<double> noise(0.0, kNoise_px);
    for (int i = 0; i < kFrames; ++i) {
      const double t_s = i / kRate_hz, turn = 0.002 * std::sin(0.7 * t_s), zoom = 0.003 * std::sin(2.0 * t_s);
      const Vector2 away{at.u - 400.0, at.v - 300.0}, own = moves(t_s);
      point.motion.push_back({own.u + 15.0 * std::sin(1.3 * t_s) + zoom * away.u - turn * away.v + noise(random_),
                              own.v + 9.0 * std::sin(1.9 * t_s) + zoom * away.v + turn * away.u + noise(random_)});
    }
    points_.push_back(std::move(point));
  }

  std::vector<SurveyedPoint> points_;
  std::vector<core::Box> plates_;
  std::mt19937 random_{1};
};

using Own = std::function<Vector2(double t_s)>;

// A wall of faint texture, ten times as noisy as the plates before it.
core::RegionProposal proposed_before_faint_wall(const std::vector<Own>& plates, int n_frames) {
  std::vector<SurveyedPoint> points;
  std::mt19937 random(2);
  std::normal_distribution<double> gauss;
  const auto add = [&](double u, double v, double sigma_px, const Own& own) {
    SurveyedPoint point{{u, v}, sigma_px, {}};
    for (int i = 0; i < n_frames; ++i) {
      const Vector2 moved = own(i / kRate_hz);
      point.motion.push_back({moved.u + sigma_px * gauss(random), moved.v + sigma_px * gauss(random)});
    }
    points.push_back(std::move(point));
  };
  for (double v = 8.0; v < kHeight_px; v += 14.0) {
    for (double u = 8.0; u < kWidth_px; u += 14.0) {
      if (v < 250.0 || v > 350.0) add(u, v, 0.1, [](double) { return Vector2{}; });
    }
  }
  for (std::size_t k = 0; k < plates.size(); ++k) {
    for (double v = 285.0; v < 320.0; v += 9.0) {
      for (double u = 0.0; u < 60.0; u += 9.0) add(60.0 + 180.0 * static_cast<double>(k) + u, v, 0.01, plates[k]);
    }
  }
  return core::propose_regions(points, kRate_hz, kWidth_px, kHeight_px, {});
}

bool is_within(const core::Region& region, const core::Box& box, double margin_px = 2.0) {
  return region.u_px >= box.left - margin_px && region.v_px >= box.top - margin_px &&
         region.u_px + region.width_px <= box.right + margin_px &&
         region.v_px + region.height_px <= box.bottom + margin_px;
}

void expect_apart(const core::RegionProposal& proposal) {
  std::vector<core::Region> all;
  for (const ProposedRegion& one : proposal.regions) all.push_back(one.region);
  if (proposal.rest) all.push_back(proposal.rest->region);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const core::Region &a = all[i], &b = all[j];
      EXPECT_TRUE(a.u_px >= b.u_px + b.width_px || b.u_px >= a.u_px + a.width_px || a.v_px >= b.v_px + b.height_px ||
                  b.v_px >= a.v_px + a.height_px)
          << a.name << " " << b.name;
    }
  }
}

TEST(RegionProposal, FindsEachFloorAndTheWallBehind) {
  Made made;
  for (int floor = 0; floor < 4; ++floor) {
    made.add_plate(300, 60 + 140 * floor, 200, 40, [floor](double t_s, const Vector2&) {
      return (4.0 - floor) * 0.3 * wave(t_s, 2.1) + 0.1 * floor * wave(t_s, 6.3);
    });
  }
  made.add_wall();
  const auto proposal = made.propose();
  ASSERT_EQ(proposal.regions.size(), 4U) << proposal.remark;
  for (const ProposedRegion& one : proposal.regions) {
    const bool lies_on_one = std::any_of(made.plates().begin(), made.plates().end(),
                                         [&](const core::Box& plate) { return is_within(one.region, plate); });
    EXPECT_TRUE(lies_on_one) << one.region.name << " " << one.region.u_px << " " << one.region.v_px;
    EXPECT_GE(one.region.width_px, 150.0);
    EXPECT_EQ(one.region.axis_deg, 0.0);
    EXPECT_EQ(one.region.name, "part" + std::to_string(1 + static_cast<int>((500.0 - one.region.v_px) / 140.0)));
  }
  ASSERT_TRUE(proposal.rest);
  EXPECT_EQ(proposal.rest->region.role, core::RegionRole::kBackground);
  EXPECT_LT(proposal.rest->motion_px, 0.1);
  expect_apart(proposal);
}

// The few points of a plain wall are farther apart than those of a part.
TEST(RegionProposal, FindsAStaticWallOfSparseTexture) {
  Made made;
  for (int floor = 0; floor < 3; ++floor) {
    made.add_plate(300, 100 + 180 * floor, 200, 40,
                   [floor](double t_s, const Vector2&) { return (3.0 - floor) * 5.0 * wave(t_s, 2.1); });
  }
  made.add_wall(40.0);
  const auto proposal = made.propose();
  ASSERT_TRUE(proposal.rest) << proposal.remark;
  ASSERT_EQ(proposal.regions.size(), 3U);
  for (const ProposedRegion& one : proposal.regions) {
    EXPECT_TRUE(std::any_of(made.plates().begin(), made.plates().end(),
                            [&](const core::Box& plate) { return is_within(one.region, plate); }));
    EXPECT_GE(one.region.width_px, 150.0);
  }
  core::RegionProposalConfig near;
  near.groups.rest_reach = 0.0;
  EXPECT_FALSE(made.propose(near).rest);
}

TEST(RegionProposal, DividesADeckThatBends) {
  Made made;
  made.add_plate(100, 280, 600, 40, [](double t_s, const Vector2& at) {
    return 1.5 * std::sin(std::numbers::pi * (at.u - 100.0) / 600.0) * wave(t_s, 3.0);
  });
  made.add_wall();
  const auto proposal = made.propose();
  EXPECT_GE(proposal.regions.size(), 3U);
  for (const ProposedRegion& one : proposal.regions) {
    EXPECT_TRUE(is_within(one.region, made.plates().front()));
    EXPECT_LE(one.region.width_px, 0.3 * kWidth_px + 1.0);
  }
  expect_apart(proposal);
}

TEST(RegionProposal, APlateIsMeasuredByItsOwnNoiseNotByTheWalls) {
  const auto faint = [](double t_s) { return Vector2{0.15 * wave(t_s, 3.0), 0.0}; };
  EXPECT_EQ(proposed_before_faint_wall({faint, faint, faint}, 300).regions.size(), 3U);
}

// The camera's drift moves a nearer plate before the wall, without a peak in its spectrum.
TEST(RegionProposal, TheAxisIsThatOfTheVibrationNotOfTheCamerasDrift) {
  std::mt19937 random(4);
  std::normal_distribution<double> gauss;
  std::vector<double> drift(300);
  double speed = 0.0;
  for (std::size_t i = 1; i < drift.size(); ++i) {
    speed = 0.8 * speed + 0.06 * gauss(random);
    drift[i] = 0.9 * drift[i - 1] + speed;
  }
  const auto moves = [&](double share) {
    return Own([&drift, share](double t_s) {
      return Vector2{drift[static_cast<std::size_t>(std::lround(t_s * kRate_hz))], share * 0.2 * wave(t_s, 7.6)};
    });
  };
  const auto proposal = proposed_before_faint_wall({moves(1.0), moves(0.7), moves(-0.8), moves(1.1)}, 300);
  ASSERT_EQ(proposal.regions.size(), 4U) << proposal.remark;
  for (const ProposedRegion& one : proposal.regions) EXPECT_EQ(one.region.axis_deg, 90.0) << one.region.name;
}

TEST(RegionProposal, SaysThatEverythingRests) {
  Made made;
  made.add_plate(300, 200, 200, 100, [](double, const Vector2&) { return 0.0; });
  made.add_wall();
  const auto proposal = made.propose();
  EXPECT_TRUE(proposal.regions.empty());
  EXPECT_THAT(proposal.remark, ::testing::HasSubstr("nothing moves"));
}

TEST(RegionProposal, WithoutAWallPartsAreToldApartByTheirOwnMotion) {
  Made made;
  for (int floor = 0; floor < 3; ++floor) {
    made.add_plate(350, 100 + 150 * floor, 120, 40,
                   [floor](double t_s, const Vector2&) { return (3.0 - floor) * 0.5 * wave(t_s, 3.0); });
  }
  const auto proposal = made.propose();
  EXPECT_EQ(proposal.regions.size(), 3U);
  EXPECT_FALSE(proposal.rest);
  EXPECT_THAT(proposal.remark, ::testing::HasSubstr("no static region is in view"));
}

TEST(RegionProposal, OfNoPointsNothingIsProposed) {
  const auto proposal = core::propose_regions({}, kRate_hz, kWidth_px, kHeight_px, {});
  EXPECT_TRUE(proposal.regions.empty());
  EXPECT_THAT(proposal.remark, ::testing::HasSubstr("no corner"));
}

TEST(RegionProposal, RanksByTheNoiseToBeExpected) {
  Made made;
  made.add_plate(100, 100, 60, 40, [](double t_s, const Vector2&) { return wave(t_s, 3.0); });
  made.add_plate(400, 300, 220, 60, [](double t_s, const Vector2&) { return wave(t_s, 4.0); });
  made.add_wall();
  const auto proposal = made.propose();
  ASSERT_EQ(proposal.regions.size(), 2U);
  EXPECT_GT(proposal.regions[0].n_points, proposal.regions[1].n_points);
  EXPECT_LT(proposal.regions[0].noise_px, proposal.regions[1].noise_px);
}

// Rendered frames: include the seeder, the tracker, and the plates' own edges.
TEST(RegionProposal, OnDrawnFramesEveryRegionLiesOnAPartOfTheStructure) {
  namespace sim = core::simulation;
  sim::Scene scene = sim::make_paper_scene(1, 60.0);
  sim::set_image_size(scene, 960, 540);
  const sim::Renderer renderer(scene);
  sim::Renderer::Scratch scratch = renderer.make_scratch();
  std::vector<std::uint8_t> pixels(960 * 540);
  const core::GrayView view{pixels.data(), 960, 540, 960};
  std::optional<core::RegionSurvey> survey;
  core::RegionSurveyConfig config;
  config.klt.window_px = 15;
  for (std::uint64_t n = 0; n < 90; ++n) {
    renderer.render(n, pixels.data(), scratch);
    if (n == 0) {
      survey.emplace(view, config);
    } else {
      survey->add(view);
    }
  }
  const auto proposal = core::propose_regions(survey->take_points(), scene.camera.rate_hz, 960, 540, {});
  const auto declared = sim::tracking_regions(renderer.motion());
  std::size_t n_found = 0;
  for (const auto& [body, region] : declared) {
    if (body < 0) continue;
    const core::Box plate{region.u_px - 10.0, region.v_px - 10.0, region.u_px + region.width_px + 10.0,
                          region.v_px + region.height_px + 10.0};
    for (const ProposedRegion& one : proposal.regions) n_found += is_within(one.region, plate) ? 1U : 0U;
  }
  std::string all;
  for (const ProposedRegion& one : proposal.regions)
    all += one.region.name + " " + std::to_string(one.region.u_px) + " " + std::to_string(one.region.v_px) + " " +
           std::to_string(one.region.width_px) + " " + std::to_string(one.region.height_px) + "\n";
  EXPECT_EQ(n_found, 7U) << all;
  EXPECT_EQ(proposal.regions.size(), 7U) << proposal.remark;
  ASSERT_TRUE(proposal.rest);
  expect_apart(proposal);
}

}  // namespace
