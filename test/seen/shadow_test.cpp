// SPDX-License-Identifier: BSD-3-Clause
// An unseen place is in shadow, where no beam passed, or in the skin, where beams passed, but not by the margin.
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/seen/unseen_points.h>

#include "support/brute_force/unseen.h"
#include "support/made_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::MadeRoom;
using test::MadeScan;
using test::MadeScanner;
using test::Random;

struct Box {
  Eigen::AlignedBox3d shadow, skin;

  bool isNear(const Box& other) const { return near(shadow, other.shadow) && near(skin, other.skin); }

private:
  static bool near(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b)
  {
    if (a.isEmpty() || b.isEmpty()) return a.isEmpty() == b.isEmpty();
    return (a.min() - b.min()).cwiseAbs().maxCoeff() < 1e-9 && (a.max() - b.max()).cwiseAbs().maxCoeff() < 1e-9;
  }
};

/// Boxes of each record's parts: of those in shadow, and of the others.
std::map<std::uint32_t, Box> boxesOf(const UnseenKinds& kinds)
{
  std::map<std::uint32_t, Box> boxes;
  for (const UnseenPart& part : kinds.parts) {
    Eigen::AlignedBox3d& box = part.in_shadow ? boxes[part.record].shadow : boxes[part.record].skin;
    box.extend(Eigen::Vector3d(part.low.data()));
    box.extend(Eigen::Vector3d(part.high.data()));
  }
  return boxes;
}

/// Scanners in a room, and models in it.
class Shadow : public testing::Test {
protected:
  void scanFrom(const MadeScanner& scanner, Random& random)
  {
    made_.push_back(makeScan(room, scanner, random));
    origins_.push_back(scanner.origin);
  }

  std::vector<ScanBeams> scans() const
  {
    std::vector<ScanBeams> all;
    for (std::size_t s = 0; s < made_.size(); ++s) all.push_back(made_[s].scan(origins_[s]));
    return all;
  }

  SeenSpace space() const
  {
    SeenOptions options;
    options.angle = angle;
    return SeenSpace(scans(), options);
  }

  UnseenRequest asked(unsigned threads = 1) const
  {
    UnseenRequest request;
    request.clearance = clearance;
    request.threads = threads;
    request.kinds = request.parts = true;
    return request;
  }

  UnseenResult look(const Placed& model, unsigned threads = 1) const
  {
    std::vector<Verdict> verdicts(model.hierarchy().view().count, Verdict::free);
    return markUnseen(space(), model, asked(threads), verdicts);
  }

  void expectAsBruteForce(const Placed& model, const std::string& what)
  {
    std::vector<Verdict> verdicts(model.hierarchy().view().count, Verdict::free), expected = verdicts, plain = verdicts,
                                                                                  without_parts = verdicts;
    const UnseenResult found = markUnseen(space(), model, asked(), verdicts);
    const UnseenResult right = brute_force::markUnseen(scans(), angle, model, asked(), expected);
    EXPECT_EQ(verdicts, expected) << what;
    EXPECT_EQ(found.in_shadow, right.in_shadow) << what;
    EXPECT_EQ(found.kinds.in_shadow, right.kinds.in_shadow) << what;
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      EXPECT_TRUE(!found.kinds.in_shadow[i] || verdicts[i] == Verdict::unseen) << what << ": " << i;
    UnseenRequest request = asked();
    request.kinds = false;
    EXPECT_EQ(markUnseen(space(), model, request, plain).unseen, found.unseen) << what;
    EXPECT_EQ(plain, verdicts) << what;
    request.kinds = true, request.parts = false;
    EXPECT_EQ(markUnseen(space(), model, request, without_parts).kinds.in_shadow, found.kinds.in_shadow) << what;

    const auto boxes = boxesOf(found.kinds), right_boxes = boxesOf(right.kinds);
    for (const auto& [record, box] : boxes) {
      // Parts that brute force finds may be told as a whole, where all of it is in shadow.
      const auto of_right = right_boxes.find(record);
      ASSERT_NE(of_right, right_boxes.end()) << what << ": " << record;
      EXPECT_TRUE(box.isNear(of_right->second)) << what << ": " << record;
    }
    for (const auto& [record, box] : right_boxes) {
      if (boxes.count(record) > 0) continue;
      EXPECT_TRUE(box.skin.isEmpty() && found.kinds.in_shadow[record]) << what << ": " << record;
    }
    std::map<std::uint32_t, std::array<std::size_t, 2>> counts;
    for (const UnseenPart& part : found.kinds.parts) ++counts[part.record][part.in_shadow ? 1 : 0];
    for (const auto& [record, count] : counts) EXPECT_LE(std::max(count[0], count[1]), 64u) << what << ": " << record;
    in_shadow_ += found.in_shadow;
    in_skin_ += found.unseen - found.in_shadow;
    in_parts_ += boxes.size();
  }

  MadeRoom room = test::hallOfPillars();
  double angle = 0.1, clearance = 0.1;
  std::vector<MadeScan> made_;
  std::vector<Eigen::Vector3d> origins_;
  std::size_t in_shadow_ = 0, in_skin_ = 0, in_parts_ = 0;
};

TEST_F(Shadow, IsThatOfBruteForce)
{
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Random random(seed);
    made_.clear(), origins_.clear();
    for (int s = 0; s <= static_cast<int>(seed % 3); ++s)
      scanFrom({{random.uniform(1, 3) + 8 * s, random.uniform(1, 3), random.uniform(1, 2)},
                random.uniform(0.13, 0.16),
                random.uniform(-1.5, -0.5),
                random.uniform(0.3, 1.5),
                0.0,
                2.0 * test::kPi,
                seed % 2 == 0 ? 0.0 : 0.02},
               random);
    angle = 0.25; // few cells
    clearance = seed % 5 == 4 ? 0.0 : random.uniform(0.02, 0.2);
    Eigen::Isometry3d pose(Eigen::AngleAxisd(random.uniform(0, 6), Eigen::Vector3d::UnitZ()));
    pose.translation() = Eigen::Vector3d(random.uniform(4, 12), random.uniform(4, 8), random.uniform(0, 1));
    std::vector<double> places;
    for (int i = 0; i < 200; ++i)
      for (const double reach : {6.0, 5.0, 2.5}) places.push_back(reach * random.uniform(-1, 1));
    expectAsBruteForce({SphereHierarchy(viewOf(places.data(), places.size() / 3)), pose},
                       "points " + std::to_string(seed));
    std::vector<double> corners;
    for (int i = 0; i < 4; ++i) { // of triangles
      const double size = i % 2 == 0 ? 3.0 : 0.3;
      const Eigen::Vector3d middle(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(0, 3));
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) corners.push_back(middle[k] + size * random.uniform(-1, 1));
    }
    std::vector<std::uint32_t> faces(corners.size() / 3);
    for (std::uint32_t i = 0; i < faces.size(); ++i) faces[i] = i;
    const TrianglesView triangles{viewOf(corners.data(), faces.size()), faces.data(), faces.size() / 3};
    expectAsBruteForce({SphereHierarchy(viewOf(triangles)), pose}, "triangles " + std::to_string(seed));
  }
  EXPECT_GT(in_shadow_, 50u);
  EXPECT_GT(in_skin_, 100u);
  EXPECT_GT(in_parts_, 3u);
}

/// Rays of the made room decide, where no beam within the reach may.
TEST_F(Shadow, IsWhereNoRayComes)
{
  Random random(7);
  scanFrom({{2, 2, 1.5}, 0.02, -1.5, 1.5}, random);
  angle = 0.03;
  std::vector<Point3> places;
  for (int i = 0; i < 20000; ++i)
    places.push_back({random.uniform(-2, 22), random.uniform(-2, 14), random.uniform(-1, 6)});
  const UnseenResult found = look({SphereHierarchy(viewOf(places.front().data(), places.size()))});
  std::size_t lit = 0, dark = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector3d place(places[i].data()), way = place - origins_[0], direction = way.normalized();
    if (std::abs(std::asin(direction.z())) > 1.4) continue;
    bool all_pass = true, none_passes = true; // of the rays within the reach
    for (int k = 0; k < 400; ++k) {
      const Eigen::Vector3d side = direction.unitOrthogonal(), up = direction.cross(side);
      const double turn = 2.399963 * k, off = 1.25 * angle * std::sqrt(k / 399.0);
      const bool passes =
          room.cast(origins_[0], (direction + off * (std::cos(turn) * side + std::sin(turn) * up)).normalized()) >
          way.norm();
      all_pass = all_pass && passes;
      none_passes = none_passes && !passes;
    }
    if (all_pass) {
      EXPECT_FALSE(found.kinds.in_shadow[i]) << place.transpose();
      ++lit;
    }
    if (none_passes) {
      EXPECT_TRUE(found.kinds.in_shadow[i]) << place.transpose();
      ++dark;
    }
  }
  EXPECT_GT(lit, 3000u);
  EXPECT_GT(dark, 2000u);
}

/// A triangle above the floor, as far as beams are flat: in the skin. A part of another one is behind a wall.
TEST_F(Shadow, OfATriangleIsInParts)
{
  room = {{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(40, 20, 6)}, {}};
  Random random(1);
  scanFrom({{2, 10, 1.8}, 0.02, -1.3, 1.3}, random);
  angle = 0.03, clearance = 0.05;
  const double corners[] = {8, 8.5, 0.15, 20, 8.5, 0.15, 20, 11.5, 0.15, 10, 4, 1, 10, 16, 1, 10, 16, 3};
  const std::uint32_t faces[] = {0, 1, 2, 3, 4, 5};
  const SphereHierarchy model(viewOf(TrianglesView{viewOf(corners, 6), faces, 2}));
  UnseenResult found = look({model});
  EXPECT_EQ(found.unseen, 1u);
  EXPECT_EQ(found.in_shadow, 0u) << "beams pass between it and the floor";

  made_.clear(), origins_.clear();
  room.boxes.emplace_back(Eigen::Vector3d(5, 9.4, 0), Eigen::Vector3d(5.2, 10.6, 4));
  scanFrom({{2, 10, 1.8}, 0.02, -1.3, 1.3}, random);
  found = look({model});
  EXPECT_EQ(found.unseen, 2u);
  EXPECT_TRUE(found.kinds.in_shadow[1]);
  const Box box = boxesOf(found.kinds).at(1); // the wall hides 8.4 to 11.6; beams within 0.29 pass it
  EXPECT_LT(box.shadow.min().y(), 8.75);
  EXPECT_GT(box.shadow.max().y(), 11.25);
  EXPECT_GT(box.shadow.min().y(), 8.4 - 0.4);
  EXPECT_LT(box.shadow.max().y(), 11.6 + 0.4);
  const UnseenResult threaded = look({model}, 3);
  EXPECT_EQ(threaded.kinds.in_shadow, found.kinds.in_shadow);
  ASSERT_EQ(threaded.kinds.parts.size(), found.kinds.parts.size());
  for (std::size_t i = 0; i < found.kinds.parts.size(); ++i)
    EXPECT_EQ(threaded.kinds.parts[i].low, found.kinds.parts[i].low);
}

TEST_F(Shadow, IsEverythingWhereNobodyLooked)
{
  Random random(1);
  scanFrom({{2, 2, 1.5}, 0.02, -0.5, 0.5, 0.0, 1.0}, random);
  angle = 0.03;
  const Point3 places[] = {{1, 1, 1.5}, {2, 2, 4}, {2, 2, 1.5}, {3, 2.5, 1.5}, {1e200, 0, 0}, {std::nan(""), 0, 0}};
  const SphereHierarchy model(viewOf(places[0].data(), 6));
  EXPECT_EQ(look({model}).kinds.in_shadow, (std::vector<bool>{true, true, false, false, true, false}))
      << "behind, above, at the scanner, before it, beyond all numbers, nowhere";
  made_[0].returns.resize(3); // one beam sees nothing
  EXPECT_EQ(look({model}).in_shadow, 5u);
}

} // namespace
} // namespace pcl_bsh
