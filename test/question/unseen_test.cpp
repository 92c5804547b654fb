// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/scan_origins.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/model_shift.h>
#include <pcl_bsh/seen/unseen_points.h>

#include "solid/meshes.h"
#include "support/made_scans.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A room with a pillar, scanned from one place or from two, as one cloud; and three points to be placed into it.
class Unseen : public testing::Test {
protected:
  struct Record {
    double x, y, z;
    std::uint8_t scan;
    float sigma;
  };

  Unseen()
  {
    test::MadeRoom room{{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(8, 6, 3)}, {}};
    room.boxes.emplace_back(Eigen::Vector3d(3, 2.5, 0), Eigen::Vector3d(3.5, 3.5, 3));
    test::Random random(1);
    for (std::uint8_t scan = 0; scan < 2; ++scan) {
      const Eigen::Vector3d origin(scan == 0 ? 1 : 7, 3, 1.5);
      const std::vector<double> ends = test::makeScan(room, {origin, 0.02, -1.57, 1.57}, random).returns;
      for (std::size_t i = 0; i < ends.size(); i += 3) {
        const Record record{ends[i], ends[i + 1], ends[i + 2], static_cast<std::uint8_t>(scan + 5), 0.05f};
        if (scan == 0) first_.push_back(record);
        both_.push_back(record);
      }
    }
    question.clearance = 0.1;
    question.seen = true;
    question.origin = ScanOrigins::of({1, 3, 1.5});
    question.wanted.flags = true;
  }

  static Shape shapeOf(const std::vector<Record>& records)
  {
    PointsView view = viewOf(&records.front().x, records.size(), sizeof(Record));
    return {"room.ptx", view, {{"scan", offsetof(Record, scan), 2, 1}, {"sigma", offsetof(Record, sigma), 7, 1}}};
  }

  Shape modelShape() const { return {"model", viewOf(model_.data(), model_.size() / 3)}; }

  Answer asked(const std::vector<Record>& records)
  {
    Shape room = shapeOf(records), model = modelShape();
    return ask(question, room, model);
  }

  std::string refusalOf(const std::vector<Record>& records)
  {
    try {
      asked(records);
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  }

  Question question;
  std::vector<Record> first_, both_;
  /// Before the pillar; behind it; on its surface.
  std::vector<double> model_ = {2, 3, 1.5, 5, 3, 1.5, 3, 3, 1.5};
};

TEST_F(Unseen, IsFreeOfCollisionsAndNotSeen)
{
  const Answer found = asked(first_);
  EXPECT_EQ(found.obstacle_flags, test::verdictsOf({0, 4, 1})); // colliding wins over unseen, unseen over free
  EXPECT_EQ(found.unseen.count, 1u);
  EXPECT_THAT(found.unseen.at_poses, ElementsAre(1u));
  EXPECT_EQ(found.unseen.first_pose, 0u);
  ASSERT_EQ(found.unseen.angles.size(), 1u);
  EXPECT_NEAR(found.unseen.angles[0], 0.03, 0.003); // reported as measured
}

/// The ceiling gives nothing back. A point above it is seen where the beams' range is told, and reaches behind its
/// ball.
TEST_F(Unseen, BeamsWithoutAReturnSeeUpToTheirRange)
{
  struct Beam {
    Record record;
    std::array<float, 3> beam;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Beam> beams;
  for (const Record& one : both_) {
    if (one.z < 2.999) {
      beams.push_back({one, {}});
      continue;
    }
    const Eigen::Vector3f way = (Eigen::Vector3d(one.x, one.y, one.z) - Eigen::Vector3d(one.scan == 5 ? 1 : 7, 3, 1.5))
                                    .cast<float>(); // of any length
    beams.push_back({{nan, nan, nan, one.scan, 0.05f}, {way.x(), way.y(), way.z()}});
  }
  model_ = {2, 1, 5, 6, 1, 5};
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5");
  std::vector<RecordField> fields = {{"scan", offsetof(Record, scan), 2, 1}};
  const auto found = [&](std::optional<double> beyond) {
    PointsView view = viewOf(&beams.front().record.x, beams.size(), sizeof(Beam));
    Shape room("room.e57", view, fields), model = modelShape();
    question.seen_beyond = beyond;
    return ask(question, room, model).obstacle_flags;
  };
  EXPECT_EQ(found({}), test::verdictsOf({4, 4}));
  EXPECT_THAT([&] { found(5.0); },
              testing::ThrowsMessage<InvalidInput>(
                  HasSubstr("room.e57: field 'beam_x' of beams without a return is missing: leave out `seen_beyond`")));
  for (std::size_t k = 0; k < 3; ++k)
    fields.push_back(
        {std::string(beam_field_names[k]), static_cast<std::uint32_t>(offsetof(Beam, beam) + k * sizeof(float)), 7, 1});
  EXPECT_EQ(found({}), test::verdictsOf({4, 4}));
  EXPECT_EQ(found(4.1), test::verdictsOf({4, 4})) << "from (1, 3, 1.5), 4.153 away";
  EXPECT_EQ(found(4.5), test::verdictsOf({0, 0})) << "behind the ball of the clearance and the angle between beams";
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5");
  for (Beam& beam : beams) // returns have origins
    if (std::isfinite(beam.record.x)) beam.record.scan = 5;
  EXPECT_THAT([&] { found(5.0); }, testing::ThrowsMessage<InvalidInput>(HasSubstr("is of scan 6 in field 'scan'")));
}

TEST_F(Unseen, IsAskedForOnly)
{
  question.seen = false;
  question.origin = {};
  const Answer found = asked(first_);
  EXPECT_TRUE(found.obstacle_flags.empty());
  EXPECT_EQ(found.unseen.count, 0u);
}

/// Distances have no unseen places.
TEST_F(Unseen, IsToldBesideCollisionsOnly)
{
  question.wanted = {};
  question.wanted.distances = true;
  const Answer found = asked(first_);
  EXPECT_TRUE(found.obstacle_flags.empty());
  EXPECT_TRUE(found.unseen.at_poses.empty());
  question.wanted = {};
  question.wanted.obstacle_indices = true;
  EXPECT_EQ(asked(first_).unseen.count, 1u);
}

/// A point that is nowhere is of no scan, and no part of what a scan's own uncertain place moves.
TEST_F(Unseen, IsNotOfPointsThatAreNotFinite)
{
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5");
  both_.push_back({NAN, 0, 0, 77, 0.05f});
  EXPECT_EQ(asked(both_).obstacle_flags, test::verdictsOf({0, 0, 1}));
  question.origin = ScanOrigins::of({1, 3, 1.5});
  model_ = {2, 3, 1.5, 2.7, 3, 1.5, NAN, 3, 1.5};
  question.input_pose_uncertainty = {0.0, 0.01, {2.7, 3, 1.5}};
  const std::vector<Verdict> flags = asked(first_).obstacle_flags;
  EXPECT_EQ(flags, test::verdictsOf({0, 0, 0}));
  model_ = {NAN, 3, 1.5};
  EXPECT_EQ(asked(first_).obstacle_flags, test::verdictsOf({0}));
  EXPECT_EQ(shiftOf({0.1, 0.0}, CornerBox(viewOf(model_.data(), 1)), Eigen::Isometry3d::Identity()), 0.0);
  model_ = {};
  EXPECT_EQ(asked(first_).unseen.at_poses, std::vector<std::size_t>{0});
}

/// A mesh that closes, but is nowhere, or at one place, or as thin as a sheet: the last two have a surface.
TEST_F(Unseen, TheInsideOfWhatHasNoVolume)
{
  const auto inside = [&](const std::vector<double>& corners) {
    const std::vector<std::uint32_t> faces = {0, 1, 2, 0, 2, 1};
    question.solid = true;
    Shape room = shapeOf(first_);
    Shape mesh("mesh", viewOf(TrianglesView{viewOf(corners.data(), 3), faces.data(), 2}));
    const Answer found = ask(question, room, mesh);
    return std::pair(found.unseen.inside.at(0), found.obstacle_flags);
  };
  EXPECT_EQ(inside({NAN, 3, 1, 5, 4, 1, 5, 3, 2}).first, 0.0);
  const auto [of_place, at_place] = inside({5, 3, 1.5, 5, 3, 1.5, 5, 3, 1.5});
  EXPECT_EQ(at_place, test::verdictsOf({4, 4}));
  EXPECT_EQ(of_place, 0.0);
  const auto [of_sheet, at_sheet] = inside({5, 2.8, 1.4, 5, 3.2, 1.4, 5, 3, 1.6});
  EXPECT_EQ(at_sheet, test::verdictsOf({4, 4}));
  EXPECT_GT(of_sheet, 0.0) << "of the cubes that it crosses";
}

TEST_F(Unseen, OneScannerThatSeesItSuffices)
{
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5");
  const Answer found = asked(both_);
  EXPECT_EQ(found.obstacle_flags, test::verdictsOf({0, 0, 1}));
  EXPECT_EQ(found.unseen.angles.size(), 2u);
}

TEST_F(Unseen, ReportsAtEachPoseAndCanBeCancelledThere)
{
  question.path.emplace(8, Eigen::Isometry3d::Identity());
  std::size_t reports = 0, last = 1000;
  question.progress = [&](double) { return ++reports < last; };
  const auto reportsOf = [&](bool seen) {
    reports = 0;
    question.seen = seen;
    question.origin = seen ? ScanOrigins::of({1, 3, 1.5}) : ScanOrigins();
    asked(first_);
    return reports;
  };
  const std::size_t of_collisions = reportsOf(false), all = reportsOf(true);
  EXPECT_GE(all, of_collisions + 8);
  for (last = 1; last <= all; ++last) EXPECT_THROW(reportsOf(true), Cancelled) << last << " of " << all;
}

/// An origin in another frame than the scan: as two clouds whose boxes never meet.
TEST_F(Unseen, AnOriginFarFromTheScanIsToldOf)
{
  std::vector<Record> some;
  for (std::size_t i = 0; i < both_.size(); i += 101) some.push_back(both_[i]);
  question.seen_angle = 0.2;
  const auto warned = [&] {
    std::string all;
    for (const Warning& warning : asked(some).warnings) all += warning.text + "\n";
    return all;
  };
  for (const char* const origin : {"1,3,1.5", "100,3,1.5", "-40,50,0", "scan:5=1,3,1.5;6=7,3,1.5"}) {
    question.origin = ScanOrigins::parse(origin); // as far as ten times the room's 10.4 m
    EXPECT_EQ(warned(), "") << origin;
  }
  for (const char* const origin :
       {"431234.5,5412345.25,300", "1000,3000,1500", "-200,0,0", "scan:6=7000,3000,1500", "0,0,1e9"}) {
    const bool of_one = origin[0] == 's';
    question.origin = ScanOrigins::parse(of_one ? "scan:5=1,3,1.5;6=7000,3000,1500" : origin);
    EXPECT_THAT(warned(), AllOf(HasSubstr("`origin` " + std::string(of_one ? origin : "")),
                                HasSubstr("box of room.ptx"), HasSubstr("one coordinate system and one unit")))
        << origin;
  }
  question.seen = false;
  question.origin = {};
  question.seen_angle = {};
  EXPECT_EQ(warned(), "");
}

/// It saw nothing: above all not what the other one did.
TEST_F(Unseen, AScannerWithoutPointsSeesNothing)
{
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5");
  const Answer found = asked(first_);
  EXPECT_EQ(found.obstacle_flags, test::verdictsOf({0, 4, 1}));
}

TEST_F(Unseen, IsToldOfEachPoseOfAPath)
{
  question.path.emplace();
  model_ = {2, 3, 1.5, 1.5, 3, 1.5, 1, 3, 1.5};
  for (const double x : {0.5, 3.0, 1.0, 0.5}) // before the pillar, behind it, the first at its surface
    question.path->emplace_back(Eigen::Translation3d(x, 0, 0));
  const Answer found = asked(first_);
  EXPECT_THAT(found.unseen.at_poses, ElementsAre(0u, 3u, 0u, 0u));
  EXPECT_EQ(found.unseen.first_pose, 1u);
  EXPECT_EQ(found.obstacle_flags, test::verdictsOf({1, 4, 4})); // the gravest
  EXPECT_EQ(found.unseen.count, 2u);
}

/// Data kept of the input between two questions belongs to no other origin, angle or uncertainty.
TEST_F(Unseen, EachQuestionIsAnsweredAsIfItWereTheFirst)
{
  model_.clear();
  for (int i = 0; i < 150; ++i) model_.insert(model_.end(), {0.5 + 0.5 * (i % 15), 0.3 + 0.54 * (i / 15), 1.5});
  std::vector<Record> scans;
  for (std::size_t i = 0; i < both_.size(); i += 7) scans.push_back(both_[i]);
  question.seen_angle = 0.1;
  const Question usual = question;
  const std::vector<std::function<void()>> changes = {
      [&] {
        question.origin = ScanOrigins::of({1, 2.5, 1.5});
      },
      [&] { question.origin = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5"); },
      [&] { question.seen_angle = 0.2; },
      [&] { question.seen_angle.reset(); },
      [&] { question.uncertainty = 0.2; },
      [&] {
        question.uncertainty = {"sigma", 4.0};
      },
      [&] { question.input_pose_uncertainty = {0.1}; },
      [&] { question.clearance = 0.2; },
      [&] { question.pose.translation().x() = 0.1; },
      [&] { question.pose_of_input.translation().x() = 0.1; },
  };
  Shape room = shapeOf(scans), model = modelShape();
  const Answer first = asked(scans);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SCOPED_TRACE(i);
    question = usual;
    EXPECT_EQ(ask(question, room, model).obstacle_flags, first.obstacle_flags);
    changes[i]();
    const Answer expected = asked(scans), kept = ask(question, room, model);
    EXPECT_EQ(kept.obstacle_flags, expected.obstacle_flags);
    EXPECT_EQ(kept.unseen.angles, expected.unseen.angles);
    EXPECT_NE(expected.obstacle_flags, first.obstacle_flags) << "else it tells nothing";
  }
}

TEST_F(Unseen, UncertainPointsStayUndecided)
{
  model_ = {2, 3, 1.5, 5, 3, 1.5, 2.85, 3, 1.5}; // the last may be within the clearance
  question.obstacle_uncertainty = 0.08;
  EXPECT_EQ(asked(first_).obstacle_flags, test::verdictsOf({0, 4, 2}));
}

TEST_F(Unseen, HoldsWhereverTheScanTrulyIs)
{
  model_ = {2, 3, 1.5, 2.7, 3, 1.5, 2.7, 3, 1.5}; // the pillar begins at 3
  const auto flags = [&] { return asked(first_).obstacle_flags; };
  EXPECT_EQ(flags(), test::verdictsOf({0, 0, 0}));
  question.input_pose_uncertainty = {0.15};
  EXPECT_EQ(flags(), test::verdictsOf({0, 4, 4})) << "free all the same, but not seen up to the pillar";
  question.input_pose_uncertainty = {0.0, 0.1, {1, 3, 1.5}};
  EXPECT_EQ(flags(), test::verdictsOf({0, 4, 4})) << "turned about the scanner";
  question.input_pose_uncertainty = {0.0, 0.01, {2.7, 3, 1.5}};
  EXPECT_EQ(flags()[1], Verdict::free) << "turned about the place";
  question.input_pose_uncertainty = {0.25};
  EXPECT_EQ(flags()[1], Verdict::undecided);
  model_[3] = 2.6; // scanner, beams and pillar move together: 0.3 of the 0.4 to the pillar are taken
  question.input_pose_uncertainty = {0.2};
  question.seen_angle = 0.03; // which takes 0.06
  EXPECT_EQ(flags()[1], Verdict::free);
}

TEST_F(Unseen, IsAskedOfScansThatStandInAWorld)
{
  question.pose_of_input = Eigen::Translation3d(10, 20, 30) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  question.pose = question.pose_of_input;
  model_ = {2, 3, 1.5, 5, 3, 1.5, 2.95, 3, 1.5};
  EXPECT_EQ(asked(first_).obstacle_flags, test::verdictsOf({0, 4, 1}));
}

/// A box before the pillar that holds nothing; one about the pillar, whose walls are all seen by one scanner or
/// another.
TEST_F(Unseen, IsTheInsideOfASolidToo)
{
  const auto inside = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    std::vector<double> corners;
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 3; ++k) corners.push_back((i >> k & 1) ? high[k] : low[k]);
    const std::vector<std::uint32_t> faces = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                              2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    TrianglesView triangles;
    triangles.vertices = viewOf(corners.data(), 8);
    triangles.corners = faces.data();
    triangles.count = 12;
    question.solid = true;
    Shape room = shapeOf(both_), box("box", viewOf(triangles));
    const Answer found = ask(question, room, box);
    EXPECT_EQ(found.unseen.inside.size(), 1u);
    return std::pair(found.unseen.count, found.unseen.inside.at(0));
  };
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5");
  question.clearance = 0.05;
  const auto [free_walls, free_inside] = inside({1.5, 1.0, 1.0}, {2.5, 2.0, 2.0});
  EXPECT_EQ(free_walls, 0u);
  EXPECT_EQ(free_inside, 0.0);
  const auto [walls, hidden] = inside({2.6, 2.1, 0.8}, {3.9, 3.9, 2.2});
  EXPECT_GT(hidden, 0.1); // of the pillar's 0.7
  EXPECT_LT(hidden, 2.0);
}

/// Two boxes, and bounds that are mostly in neither. The inside is cubes that either box holds a part of, each in a
/// ball, as they are placed.
TEST_F(Unseen, TheInsideOfASolidIsThatOfItsCubes)
{
  const std::vector<Eigen::AlignedBox3d> boxes = {{Eigen::Vector3d(-0.5, -0.4, -0.2), Eigen::Vector3d(0.1, 0.1, 0.0)},
                                                  {Eigen::Vector3d(0.2, 0.15, 0.1), Eigen::Vector3d(0.46, 0.4, 0.31)}};
  test::ClosedMesh mesh;
  for (const Eigen::AlignedBox3d& box : boxes) {
    test::ClosedMesh unit = test::boxMesh();
    for (std::size_t i = 0; i < unit.xyz.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i % 3);
      unit.xyz[i] = unit.xyz[i] == 0.0 ? box.min()[k] : box.max()[k];
    }
    mesh.add(unit);
  }
  const Eigen::AlignedBox3d bounds = boxes[0].merged(boxes[1]);
  question.pose_of_input = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  question.path.emplace();
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(2.5, 3, 1.4), Eigen::Vector3d(3.2, 3.7, 1.5), // partly behind it
        Eigen::Vector3d(3.7, 4.0, 1.2), Eigen::Vector3d(1, 3, 1), Eigen::Vector3d(20, 3, 1)})
    question.path->push_back(question.pose_of_input * Eigen::Translation3d(at) *
                             Eigen::AngleAxisd(at.x(), Eigen::Vector3d::UnitZ()));
  question.solid = true;
  Shape room = shapeOf(first_), solid("solid", viewOf(mesh.view()));
  const PointsView returns = viewOf(&first_.front().x, first_.size(), sizeof(Record));
  const SeenSpace space({{Point3{1, 3, 1.5}, returns}});
  const SphereHierarchy scan(returns);
  for (const auto& [clearance, edge] : {std::pair(0.0, 0.96 / 48), {0.03, 0.03}, {0.1, 0.1}, {0.2, 0.96 / 8}}) {
    const Eigen::Array3i count = (bounds.sizes().array() / edge).ceil().cast<int>();
    const auto radius = static_cast<float>(0.5 * std::sqrt(3.0) * edge * (1.0 + 1e-6));
    std::vector<Eigen::Vector3d> within; // the bounds
    for (int i = 0; i < count.prod(); ++i) {
      const Eigen::Array3d place(i % count[0], i / count[0] % count[1], i / count[0] / count[1]);
      const Eigen::Vector3d middle = bounds.min() + edge * (place + 0.5).matrix();
      const auto holds = [&](const auto& box) { return box.exteriorDistance(middle) <= static_cast<double>(radius); };
      if (std::any_of(boxes.begin(), boxes.end(), holds))
        within.push_back(middle.cwiseMax(bounds.min()).cwiseMin(bounds.max()));
    }
    std::vector<Point3> middles;
    for (const Eigen::Vector3d& middle : within) middles.push_back({middle[0], middle[1], middle[2]});
    const std::vector<float> radii(middles.size(), radius);
    PointsView view = viewOf(middles.front().data(), middles.size());
    view.radii = radii.data();
    const SphereHierarchy balls(view);
    std::vector<double> inside;
    for (const Eigen::Isometry3d& pose : *question.path) {
      FlagsRequest touching;
      touching.flagged = Flagged::b;
      FlagsResult found = collisionFlags({scan, question.pose_of_input}, {balls, pose}, touching);
      UnseenRequest request;
      request.clearance = clearance;
      request.kinds = true;
      inside.push_back(
          static_cast<double>(
              markUnseen(space, {balls, question.pose_of_input.inverse() * pose}, request, found.b).in_shadow) *
          edge * edge * edge);
    }
    question.clearance = clearance;
    EXPECT_THAT(ask(question, room, solid).unseen.inside, testing::Pointwise(testing::DoubleNear(1e-9), inside))
        << clearance;
    EXPECT_GT(inside[1], 0.0);
    EXPECT_LT(inside[1], inside[4]);
  }
}

TEST(UnseenAnswer, TheFirstPoseIsThatOfTheFirstThatHasAny)
{
  Answer::Unseen unseen;
  std::vector<Verdict> gravest = test::verdictsOf({0, 0});
  unseen.addPose(test::verdictsOf({0, 1}), false, gravest);
  EXPECT_FALSE(unseen.first_pose);
  for (int i = 0; i < 2; ++i) unseen.addPose(test::verdictsOf({4, 4}), false, gravest);
  EXPECT_EQ(unseen.first_pose, 1u);
  EXPECT_THAT(unseen.at_poses, ElementsAre(0u, 2u, 2u));
  EXPECT_EQ(unseen.count, 1u) << "the other one collides";
  EXPECT_TRUE(unseen.where.empty()) << "nobody asked for it";
}

TEST_F(Unseen, TellsWhichAtEachPose)
{
  question.path = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(0, -1.5, 0))};
  question.wanted.unseen_places = true;
  const Answer found = asked(first_);
  EXPECT_THAT(found.unseen.where, ElementsAre(std::vector{false, true, false}, std::vector<bool>()));
}

TEST_F(Unseen, NeedsToKnowWhereScannersStood)
{
  question.origin = {};
  EXPECT_EQ(refusalOf(first_),
            "room.ptx: does not say where its scanner stood: give `origin`, as X,Y,Z in its frame, or "
            "a file that has it (.ptx, .e57, .pcd with VIEWPOINT, .ply with camera)");
  question.origin = ScanOrigins::parse("scan:5=1,3,1.5");
  EXPECT_THAT(refusalOf(both_), HasSubstr("is of scan 6 in field 'scan', which has no origin: give one for each scan"));
  question.origin = ScanOrigins::parse("id:5=1,3,1.5");
  EXPECT_EQ(refusalOf(first_),
            "room.ptx: field 'id' that numbers its scans is missing: give one of its fields: scan, sigma");
}

TEST_F(Unseen, RefusesWhatDoesNotGoTogether)
{
  question.path = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0))};
  question.swept = 0.1;
  EXPECT_THAT(refusalOf(first_), HasSubstr("seen: is about poses"));
  question.swept = 0.0;
  question.seen = false;
  EXPECT_THAT(refusalOf(first_), HasSubstr("origin: is given, but not `seen`"));
  question.origin = {};
  question.seen_angle = 0.01;
  EXPECT_THAT(refusalOf(first_), HasSubstr("seen_angle: is given, but not `seen`"));
}

TEST(ScanOrigins, AreEqualWhereFieldsAndAllOriginsAre)
{
  const ScanOrigins one = ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5");
  EXPECT_EQ(one, ScanOrigins::parse("scan:5=1,3,1.5;6=7,3,1.5"));
  for (const char* const other :
       {"scans:5=1,3,1.5;6=7,3,1.5", "scan:5=1,3,1.5;7=7,3,1.5", "scan:5=1,3,1.5;6=7,3,2", "scan:5=1,3,1.5"})
    EXPECT_FALSE(one == ScanOrigins::parse(other)) << other;
}

TEST(ScanOrigins, ReadTheirText)
{
  for (const char* text : {"", "1,2.5,-3", "scan:0=1,2,3;7=4,5,6"}) EXPECT_EQ(ScanOrigins::parse(text).text(), text);
  for (const char* wrong : {"1,2", "x", "scan:", ":0=1,2,3", "scan:0=1,2", "scan:0=1,2,3;0=1,2,3", "nan,0,0", "scan:5",
                            "scan:x=1,2,3", "scan:=1,2,3", "scan:1,2=1,2,3", "scan:0=1,2,3;", "1,2,3m"}) {
    try {
      ScanOrigins::parse(wrong);
      ADD_FAILURE() << wrong;
    }
    catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr("give X,Y,Z")) << wrong;
    }
  }
}

} // namespace
} // namespace pcl_bsh
