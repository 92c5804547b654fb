// SPDX-License-Identifier: BSD-3-Clause
// Cells that beams crossed: against beams walked in small steps, and against things that stop them.
#include <pcl_bsh/track/seen_outline.h>

#include <pcl_bsh/base/invalid_input.h>

#include "made_lines.h"
#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace pcl_bsh {
namespace {

const std::vector<SectionPoint> notched = {{-1.6, 0.1}, {1.6, 0.1},  {1.7, 3.1}, {0.9, 4.3},
                                           {0, 3.6},    {-0.9, 4.3}, {-1.7, 3.1}};

Eigen::Vector3d inSpace(const Axis& axis, const AxisPlace& place)
{
  const AxisFrame frame = axis.frame(place.distance);
  return Eigen::Vector3d(frame.origin.data()) + place.offset * Eigen::Vector3d(frame.right.data()) +
         place.height * Eigen::Vector3d(frame.up.data());
}

Point3 pointOf(const Eigen::Vector3d& p)
{
  return {p.x(), p.y(), p.z()};
}

Axis bendingAxis()
{
  AxisDescription description;
  description.plan = test::sCurve({500000, 4000000, 0.4});
  description.grades = {{0, 30}, {140, 34, 40}, {280, 30}};
  description.cants = {{20, 0}, {50, 0.12}, {110, 0.12}, {170, -0.12}, {230, -0.12}, {260, 0}};
  return Axis(description);
}

std::vector<Envelope> profiles()
{
  return {Envelope({"notched", notched}),
          Envelope({"wagon", {{-1.4, 0.2}, {1.4, 0.2}, {1.5, 3}, {0, 4}, {-1.5, 3}}, {}, {}, {}, Vehicle{14, 2}})};
}

/// Beams of a scanner that moves along the axis, and of one beside it.
struct Beams {
  std::vector<Point3> origins, points;

  void add(const Point3& origin, const Point3& end)
  {
    origins.push_back(origin);
    points.push_back(end);
  }
  PointsView view() const { return viewOf(points.front().data(), points.size()); }
};

/// @param length of a beam @param ahead the most that it goes along the axis, of its length
std::pair<Eigen::Vector3d, Eigen::Vector3d> randomBeam(const Axis& axis, test::Random& random, double length,
                                                       double ahead)
{
  const bool beside = random.uniform(0, 1) < 0.2;
  const double distance = random.uniform(0, axis.length());
  const AxisPlace from{distance, beside ? random.uniform(3, 5) : random.uniform(-0.5, 0.5), random.uniform(1, 3)};
  const double angle = beside ? random.uniform(2.6, 3.7) : random.uniform(0, 2 * std::numbers::pi);
  const AxisFrame frame = axis.frame(distance);
  const Eigen::Vector3d way = std::cos(angle) * Eigen::Vector3d(frame.right.data()) +
                              std::sin(angle) * Eigen::Vector3d(frame.up.data()) +
                              random.uniform(-ahead, ahead) * Eigen::Vector3d(frame.along.data());
  return {inSpace(axis, from), length * way.normalized()};
}

using Cell = std::pair<std::size_t, std::size_t>; // row, column

std::set<Cell> crossedOf(const SeenOutline& seen, std::size_t envelope)
{
  std::set<Cell> crossed;
  for (std::size_t row = 0; row < seen.rows(); ++row)
    for (std::size_t column = 0; column < seen.columns(envelope); ++column)
      if (seen.isCrossed(envelope, row, column)) crossed.emplace(row, column);
  return crossed;
}

/// The column of a place next to an outline, by the nearest middle of one.
std::size_t nearestColumn(const SeenOutline& seen, std::size_t envelope, std::size_t row, const AxisPlace& at)
{
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t column = 0; column < seen.columns(envelope); ++column) {
    const AxisPlace middle = seen.middleOf(envelope, row, column);
    const double apart = std::hypot(middle.offset - at.offset, middle.height - at.height);
    if (apart < least) {
      least = apart;
      best = column;
    }
  }
  return best;
}

TEST(SeenOutline, CellsAreThoseOfBeamsWalkedInSmallSteps)
{
  const Axis axis = bendingAxis();
  const std::vector<Envelope> envelopes = profiles();
  constexpr double spacing = 0.3;
  const AxisReach reach{20, 10, 10};
  test::Random random(7);
  std::size_t both = 0, missed = 0, elsewhere = 0, overlooked = 0;
  for (int i = 0; i < 500; ++i) {
    const auto [origin, way] = randomBeam(axis, random, random.uniform(1, 9), i % 3 == 0 ? 2.0 : 0.1);
    Beams beam;
    beam.add(pointOf(origin), pointOf(origin + way));
    SeenOutline seen(axis, envelopes, {1.0, spacing});
    seen.add(beam.view(), beam.origins, {reach, 1});
    for (std::size_t e = 0; e < envelopes.size(); ++e) {
      std::set<Cell> crossed = crossedOf(seen, e);
      bool is_whole = true, has_before = false, was_inside = false;
      for (int step = 0; step < 8000; ++step) {
        const AxisPlaces places = axis.nearest(pointOf(origin + step / 8000.0 * way), reach);
        if (!hasPlace(places.state)) {
          is_whole = has_before = false;
          continue;
        }
        std::vector<SectionPoint> room;
        const AxisPlace& at = places.best;
        const bool inside =
            signedDistance(envelopes[e].outlineAt(axis, at.distance, room), {at.offset, at.height}) <= 0.0;
        if (has_before && was_inside != inside) {
          // a step is up to 1.2 mm: a neighbour may be the right one where a border is nearer
          const auto row = static_cast<std::size_t>(at.distance / 0.25);
          const std::size_t column = nearestColumn(seen, e, row, at);
          const auto found = std::find_if(crossed.begin(), crossed.end(), [&](const Cell& cell) {
            const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
            const std::size_t round = apart(cell.second, column);
            return apart(cell.first, row) <= 1 && std::min(round, seen.columns(e) - round) <= 1;
          });
          if (found == crossed.end()) {
            ++missed;
          }
          else {
            elsewhere += *found != Cell{row, column};
            crossed.erase(found);
            ++both;
          }
        }
        has_before = true;
        was_inside = inside;
      }
      if (is_whole) overlooked += crossed.size();
    }
  }
  EXPECT_GT(both, 700u);
  EXPECT_LE(overlooked, 2u) << "by steps, where a beam cuts a corner";
  EXPECT_LT(missed, both / 50) << "a crossing that is overlooked is not seen; there are few";
  EXPECT_LT(elsewhere, both / 20) << "next to borders of cells";
}

TEST(SeenOutline, NoBeamIsSeenWhereAThingFillsACell)
{
  const Axis axis = bendingAxis();
  const std::vector<Envelope> envelopes = {profiles()[0]};
  constexpr double spacing = 0.25;
  test::Random random(11);
  std::size_t judged = 0, seen_beside = 0;
  for (int world = 0; world < 10; ++world) {
    SeenOutline seen(axis, envelopes, {0.5, spacing});
    const double from = random.uniform(2, axis.length() - 8);
    const auto first_row = static_cast<std::size_t>(from / spacing), last_row = first_row + 16;
    std::vector<Cell> cells;
    std::vector<Eigen::Vector3d> things;
    for (int k = 0; k < 12; ++k) {
      const int last_column = static_cast<int>(seen.columns(0)) - 1;
      const Cell cell{first_row + static_cast<std::size_t>(random.integer(0, 15)),
                      static_cast<std::size_t>(random.integer(0, last_column))};
      cells.push_back(cell);
      things.push_back(inSpace(axis, seen.middleOf(0, cell.first, cell.second)));
    }
    constexpr double radius = 0.5 * 1.4142135623730952 * spacing * 1.06; // the outline is longer outside of a bend
    Beams beams;
    for (int i = 0; i < 60'000; ++i) {
      const double distance = random.uniform(from - 1, from + 5);
      const Eigen::Vector3d origin = inSpace(axis, {distance, random.uniform(-0.3, 0.3), random.uniform(1.5, 2.5)});
      const double angle = random.uniform(0, 2 * std::numbers::pi);
      const AxisFrame frame = axis.frame(distance);
      const Eigen::Vector3d way =
          (std::cos(angle) * Eigen::Vector3d(frame.right.data()) + std::sin(angle) * Eigen::Vector3d(frame.up.data()) +
           random.uniform(-0.3, 0.3) * Eigen::Vector3d(frame.along.data()))
              .normalized();
      double range = i % 10 == 0 ? 60.0 : 7.0; // some end beyond the axis' reach
      for (const Eigen::Vector3d& thing : things) {
        const double along = way.dot(thing - origin), square = (thing - origin).squaredNorm() - along * along;
        if (square > radius * radius) continue;
        const double hit = along - std::sqrt(radius * radius - square);
        if (hit > 0) range = std::min(range, hit);
      }
      beams.add(pointOf(origin), pointOf(origin + range * way));
    }
    seen.add(beams.view(), beams.origins, {{}, 1});
    for (const Cell& cell : cells) {
      EXPECT_FALSE(seen.isCrossed(0, cell.first, cell.second)) << world << ": " << cell.first << ' ' << cell.second;
      ++judged;
    }
    for (std::size_t row = first_row; row < last_row; ++row)
      for (std::size_t column = 0; column < seen.columns(0); ++column) seen_beside += seen.isCrossed(0, row, column);
  }
  EXPECT_EQ(judged, 120u);
  EXPECT_GT(seen_beside, 10u * 16 * 40) << "most others";
}

TEST(SeenOutline, SharesOfASectorAreThoseOfItsCells)
{
  AxisDescription description;
  description.plan = {{10.5, 0, 0, AxisStart{0, 0, 0}}};
  const Axis axis(description);
  const std::vector<Envelope> envelopes = {Envelope({"box", {{-2, 0}, {2, 0}, {2, 4}, {-2, 4}}}),
                                           Envelope({"there", {{-2, 0}, {2, 0}, {2, 4}, {-2, 4}}, {{5, 10.5}}})};
  SeenOutline seen(axis, envelopes, {1.0, 0.5});
  EXPECT_EQ(seen.rows(), 22u);
  EXPECT_EQ(seen.columns(0), 32u);
  Beams beams;
  beams.add({0.2, 0, 2}, {0.2, 5, 2.1});   // to the left
  beams.add({0.3, 0, 2}, {0.3, 5, 2.2});   // into the same cell
  beams.add({0.7, 0, 2}, {0.7, 500, 2.3}); // far beyond the reach
  beams.add({0.2, 0, 2}, {0.2, 0, 3.9});   // ends inside
  beams.add({0.2, 0, 2}, {0.2, 0, 4});     // ends on the outline
  beams.add({0.2, 3, 1}, {0.2, -5, 1});    // from outside through both sides
  beams.add({0.2, 0, 2}, {0.2, 0, 2});     // goes nowhere
  beams.add({-3, 0, 2}, {0.2, 5, 2});      // from before the axis
  beams.add({std::nan(""), 0, 2}, {0.2, 5, 2});
  beams.add({10.2, 0, 2}, {10.2, 0, -1});
  seen.add(beams.view(), beams.origins, {{}, 1});
  EXPECT_EQ(seen.share(0, 0, Sector::left), 3.0 / 16) << "two that went to the left, one from there";
  EXPECT_EQ(seen.share(0, 0, Sector::right), 1.0 / 16);
  EXPECT_EQ(seen.share(0, 0, Sector::above), 0);
  EXPECT_EQ(seen.share(0, 0), 4.0 / 64);
  EXPECT_EQ(seen.share(10, 0, Sector::below), 1.0 / 8) << "the last part is half as long";
  EXPECT_EQ(seen.share(0, 1), 0) << "the other counts from 5 on";
  EXPECT_EQ(seen.share(10, 1, Sector::below), 1.0 / 8);
  EXPECT_TRUE(seen.isUnseen(0, 0));
  for (const Point3& end : {Point3{3.2, 5, 2}, {3.2, -5, 2}, {3.2, 0, 5}, {3.2, 0, -1}}) beams.add({3.2, 0, 2}, end);
  seen.add(beams.view(), beams.origins, {{}, 1});
  EXPECT_FALSE(seen.isUnseen(3, 0)) << "a beam through each side";
  EXPECT_TRUE(seen.isUnseen(4, 0));
}

TEST(SeenOutline, CellsDoNotDependOnThreadsAndBatches)
{
  const Axis axis = bendingAxis();
  const std::vector<Envelope> envelopes = profiles();
  test::Random random(3);
  Beams beams;
  for (int i = 0; i < 20'000; ++i) {
    const auto [origin, way] = randomBeam(axis, random, 8, 0.3);
    beams.add(pointOf(origin), pointOf(origin + way));
  }
  SeenOutline one(axis, envelopes, {1.0, 0.2}), two(axis, envelopes, {1.0, 0.2}), parts(axis, envelopes, {1.0, 0.2});
  one.add(beams.view(), beams.origins, {{}, 1});
  two.add(beams.view(), beams.origins, {{}, 2});
  for (std::size_t first = 0; first < 20'000; first += 5000) {
    const std::vector<Point3> origins(beams.origins.begin() + static_cast<std::ptrdiff_t>(first),
                                      beams.origins.begin() + static_cast<std::ptrdiff_t>(first + 5000));
    parts.add(viewOf(beams.points[first].data(), 5000), origins, {{}, 1});
  }
  for (std::size_t e = 0; e < 2; ++e) {
    const std::set<Cell> crossed = crossedOf(one, e);
    EXPECT_GT(crossed.size(), 10'000u);
    EXPECT_EQ(crossedOf(two, e), crossed);
    EXPECT_EQ(crossedOf(parts, e), crossed);
  }
}

TEST(SeenOutline, RefusesSpacingsWithoutMeaning)
{
  AxisDescription description;
  description.plan = {{1000, 0, 0, AxisStart{0, 0, 0}}};
  const Axis axis(description);
  for (const double spacing : {0.0, -1.0, std::nan(""), 1e-5})
    EXPECT_THROW(SeenOutline(axis, profiles(), {1.0, spacing}), InvalidInput) << spacing;
}

} // namespace
} // namespace pcl_bsh
