// SPDX-License-Identifier: BSD-3-Clause
// Records that solids hold during a motion, against many instants of it: labels there are those of brute force.
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"
#include "solid/meshes.h"
#include "support/brute_force/labels.h"
#include "support/random.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::at;
using test::Random;

constexpr int instants = 40;
constexpr double tolerance = 1e-3;

/// A solid of some bodies and what passes it, each on one leg.
class Passing {
public:
  explicit Passing(std::uint64_t seed) : random_(seed)
  {
    const int kind = random_.integer(0, 3);
    if (kind == 0) addBody(test::bumpyMesh(5, 0.2), 1.0, {-0.5, -0.5, -0.5});
    if (kind == 1) addBody(test::boxMesh(), 1.0, {-0.5, -0.5, -0.5});
    if (kind == 2) { // a hollow
      addBody(test::boxMesh(), 1.0, {-0.5, -0.5, -0.5});
      addBody(test::boxMesh(), 0.6, {-0.3, -0.3, -0.3}, true);
    }
    if (kind == 3) { // one inside of the other, and one that overlaps it
      addBody(test::boxMesh(), 1.2, {-0.6, -0.6, -0.6});
      addBody(test::boxMesh(), 0.3, {-0.1, -0.1, -0.1});
      addBody(test::boxMesh(), 0.7, {0.3, -0.3, -0.3});
    }
    solid_ = std::make_shared<SphereHierarchy>(viewOf(whole_.view()));
    if (random_.chance(0.5)) {
      const double size = random_.chance(0.5) ? 0.1 : 0.5;
      other_mesh_.add(test::boxMesh(), size, {-size / 2, -size / 2, -size / 2});
      other_ = std::make_shared<SphereHierarchy>(viewOf(other_mesh_.view()));
    }
    else {
      std::vector<Point3> points;
      for (int i = random_.integer(1, 12); i > 0; --i) points.push_back(random_.point([&] { return small(); }));
      test::Cloud cloud(points, test::Layout{Scalar::float64, 0, 0});
      if (random_.chance(0.3)) cloud.setRadii(std::vector<float>(points.size(), 0.05f));
      other_ = shelf_.add(std::move(cloud));
    }
    whole_solid_.emplace(whole_.view());
    for (const test::ClosedMesh& body : bodies_) {
      solids_.emplace_back(body.view());
      surfaces_.push_back(std::make_shared<SphereHierarchy>(viewOf(body.view())));
    }
    std::vector<Point3> places;
    for (std::uint32_t record = 0; record < other_->view().count; ++record) {
      const Corners corners = cornersOf(other_->view(), record);
      for (std::uint32_t k = 0; k < corners.count; ++k) {
        places.push_back(corners.at[k]);
        record_of_place_.push_back(record);
      }
    }
    places_ = shelf_.add(places);
    options_.clearance = random_.chance(0.5) ? 0.0 : 0.05;
    options_.tolerance = tolerance;
    options_.effects.swept = options_.effects.first_contact = true;
    motion_of_other_ = motionThrough();
    if (random_.chance(0.3)) motion_of_solid_ = VelocityMotion{{0.3, 0, 0}, {0, 0, random_.uniform(-1, 1)}};
  }

  void check()
  {
    Scene scene(options_);
    SceneObject solid = object("solid", solid_);
    solid.parts[0].solid = true;
    solid.motion = motion_of_solid_;
    scene.add(solid);
    SceneObject other = object("other", other_, start_);
    other.motion = motion_of_other_;
    scene.add(other);
    const SceneResult result = scene.step(1.0);
    flags_of_solid.assign(solid_->view().count, Verdict::free);
    flags_of_other.assign(other_->view().count, Verdict::free);
    for (const FlaggedPart& part : result.swept) (part.object == 0 ? flags_of_solid : flags_of_other) = part.flags;
    std::array<Leg, 2> legs;
    for (ObjectId id = 0; id < 2; ++id) legs[id].from = legs[id].to = scene[id].pose;
    for (const SweptMotion& swept : result.swept_motions) legs[swept.object] = swept.leg;
    for (int i = 0; i <= instants; ++i) {
      const double s = static_cast<double>(i) / instants;
      compareAt(legs[0].at(s), legs[1].at(s), s, result);
    }
    passed += holds_.size();
    for (std::uint32_t i = 0; i < flags_of_solid.size(); ++i) {
      const auto enclosed = holds_.find(bodyOf(i));
      if (enclosed != holds_.end()) {
        EXPECT_EQ(flags_of_solid[i], Verdict::colliding)
            << "triangle " << i << ", whose body holds something at " << enclosed->second;
      }
      const bool may_be = near_of_solid_.count(i) > 0 || about_.count(bodyOf(i)) > 0;
      EXPECT_TRUE(may_be || flags_of_solid[i] == Verdict::free) << "triangle " << i;
    }
    for (std::uint32_t i = 0; i < flags_of_other.size(); ++i) {
      const bool may_be = near_of_other_.count(i) > 0;
      EXPECT_TRUE(may_be || flags_of_other[i] == Verdict::free) << "record " << i;
    }
    only_touched += !holds_.empty() ? 0 : !near_of_solid_.empty();
  }

  std::size_t passed = 0, only_touched = 0;
  std::vector<Verdict> flags_of_solid, flags_of_other;

private:
  double small() { return random_.uniform(-0.1, 0.1); }

  void addBody(const test::ClosedMesh& mesh, double scale, const Point3& shift, bool flip = false)
  {
    bodies_.emplace_back();
    bodies_.back().add(mesh, scale, shift, flip);
    whole_.add(mesh, scale, shift, flip);
  }

  std::size_t bodyOf(std::uint32_t triangle) const
  {
    std::size_t body = 0;
    for (std::size_t left = triangle; left >= bodies_[body].corners.size() / 3; ++body)
      left -= bodies_[body].corners.size() / 3;
    return body;
  }

  /// Passes the middle, or near it, or begins or ends there.
  Motion motionThrough()
  {
    const Eigen::Vector3d way =
        4.0 * Eigen::Vector3d(random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1));
    const Eigen::Vector3d middle =
        Eigen::Vector3d(random_.uniform(-0.4, 0.4), random_.uniform(-0.4, 0.4), random_.uniform(-0.4, 0.4));
    const double share = random_.chance(0.3) ? 0.0 : 0.5;
    start_.translation() = middle - share * way;
    start_.linear() = random_.pose(0.0).linear();
    return VelocityMotion{way, {random_.uniform(-2, 2), random_.uniform(-2, 2), 0}};
  }

  void compareAt(const Eigen::Isometry3d& of_solid, const Eigen::Isometry3d& of_other, double s,
                 const SceneResult& result)
  {
    const double step = 12.0 / instants; // nothing is faster
    FlagsRequest request;
    request.flagged = Flagged::both;
    request.clearance = options_.clearance + tolerance + step;
    const FlagsResult wide = collisionFlags({*other_, of_other}, {*solid_, of_solid}, request);
    for (std::uint32_t i = 0; i < wide.a.size(); ++i)
      if (wide.a[i] != Verdict::free) near_of_other_.insert(i);
    for (std::uint32_t i = 0; i < wide.b.size(); ++i)
      if (wide.b[i] != Verdict::free) near_of_solid_.insert(i);
    const Placed places(*places_, of_other);
    const auto labels = brute_force::labelPoints(places, {*whole_solid_, of_solid}).labels;
    const auto distances = pointDistances(places, {*solid_, of_solid}).distance;
    for (std::size_t k = 0; k < labels.size(); ++k) {
      if (labels[k] == labelOf(Label::outside)) continue;
      near_of_other_.insert(record_of_place_[k]);
      EXPECT_NE(flags_of_other[record_of_place_[k]], Verdict::free) << "which is enclosed at " << s;
      ASSERT_FALSE(result.first_contact.empty());
      EXPECT_LE(result.first_contact[0].fraction, s);
    }
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      const auto in_body = brute_force::labelPoints(places, {solids_[body], of_solid}).labels;
      const auto from_body = pointDistances(places, {*surfaces_[body], of_solid}).distance;
      for (std::size_t k = 0; k < labels.size(); ++k) {
        const bool inside = in_body[k] == labelOf(Label::inside), enclosed = labels[k] == labelOf(Label::inside);
        const double near = tolerance + step;
        if ((inside || from_body[k] <= near) && (labels[k] != labelOf(Label::outside) || distances[k] <= near))
          about_.insert(body);
        if (inside && enclosed) holds_.emplace(body, s);
      }
    }
  }

  Random random_;
  std::deque<test::ClosedMesh> bodies_;
  test::ClosedMesh whole_, other_mesh_;
  test::Shelf shelf_;
  std::shared_ptr<SphereHierarchy> solid_, other_, places_; ///< places: points, or corners
  std::vector<std::uint32_t> record_of_place_;
  std::optional<Solid> whole_solid_;
  std::vector<Solid> solids_;                              ///< of the bodies
  std::vector<std::shared_ptr<SphereHierarchy>> surfaces_; ///< of the bodies
  SceneOptions options_;
  Eigen::Isometry3d start_ = Eigen::Isometry3d::Identity();
  Motion motion_of_solid_, motion_of_other_;
  std::map<std::size_t, double> holds_; ///< bodies that hold something, and when first
  std::set<std::size_t> about_;         ///< nearly so
  std::set<std::uint32_t> near_of_solid_, near_of_other_;
};

TEST(SweptSolids, AreThoseOfManyInstants)
{
  std::size_t passed = 0, only_touched = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Passing passing(seed);
    passing.check();
    passed += passing.passed;
    only_touched += passing.only_touched;
  }
  EXPECT_GT(passed, 30u);
  EXPECT_GT(only_touched, 0u);
}

/// Through a wall and out again: at neither end does the plate hold anything.
class Plate : public testing::Test {
protected:
  Plate()
  {
    mesh.add(test::boxMesh(), 1.0);
    for (std::size_t i = 0; i < mesh.xyz.size(); i += 3) mesh.xyz[i] *= 0.01;
    options.effects.swept = options.effects.first_contact = options.effects.any = true;
  }

  SceneResult pass(const Eigen::Vector3d& way, std::shared_ptr<SphereHierarchy> probe, const Eigen::Isometry3d& from)
  {
    Scene scene(options);
    SceneObject plate = object("plate", std::make_shared<SphereHierarchy>(viewOf(mesh.view())));
    plate.parts[0].solid = true;
    plate.fixed = true;
    scene.add(plate);
    SceneObject moves = object("probe", std::move(probe), from);
    moves.motion = VelocityMotion{way, {0, 0, 0}};
    scene.add(moves);
    return scene.step(1.0);
  }

  static std::size_t flagged(const SceneResult& result, ObjectId object)
  {
    for (const FlaggedPart& part : result.swept)
      if (part.object == object) return part.colliding + part.undecided;
    return 0;
  }

  test::ClosedMesh mesh;
  test::Shelf shelf;
  SceneOptions options;
};

TEST_F(Plate, IsAllFlaggedWhereAPointPassesIt)
{
  const SceneResult through = pass({2, 0, 0}, shelf.add(std::vector<Point3>{{0, 0, 0}}), at(-1, 0.3, 0.3));
  EXPECT_TRUE(through.any.empty());
  ASSERT_EQ(through.first_contact.size(), 1u);
  EXPECT_NEAR(through.first_contact[0].fraction, 0.5, 1e-4);
  EXPECT_EQ(flagged(through, 0), 12u);
  EXPECT_EQ(flagged(through, 1), 1u);
}

TEST_F(Plate, IsFlaggedWhereItIsNearWhereAPointPassesBesideIt)
{
  options.clearance = 0.1;
  const SceneResult beside = pass({0, 2, 0}, shelf.add(std::vector<Point3>{{0, 0, 0}}), at(0.1, -0.5, 0.1));
  ASSERT_EQ(beside.first_contact.size(), 1u);
  EXPECT_GT(flagged(beside, 0), 0u);
  EXPECT_LT(flagged(beside, 0), 12u);
}

TEST_F(Plate, IsUndecidedWhereAnUncertainPointMayPassIt)
{
  test::Cloud cloud({{0, 0, 0}}, test::Layout{Scalar::float64, 0, 0});
  cloud.setUncertainties(0.05, {});
  const SceneResult near = pass({0, 2, 0}, shelf.add(std::move(cloud)), at(0.05, -0.5, 0.1));
  ASSERT_EQ(near.swept.size(), 2u);
  EXPECT_EQ(near.swept[0].undecided, 12u);
}

/// A ball is enclosed where its middle is.
TEST_F(Plate, IsNotHeldByABallsRim)
{
  test::Cloud ball({{0, 0, 0}}, test::Layout{Scalar::float64, 0, 0});
  ball.setRadii({0.1f});
  const SceneResult beside = pass({0, 2, 0}, shelf.add(std::move(ball)), at(0.1, -0.5, 0.1));
  EXPECT_GT(flagged(beside, 0), 0u);
  EXPECT_LT(flagged(beside, 0), 12u);
}

} // namespace
} // namespace pcl_bsh
