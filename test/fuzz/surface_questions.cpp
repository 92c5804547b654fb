// SPDX-License-Identifier: BSD-3-Clause
#include "surface_questions.h"

#include "bytes.h"
#include "geometry/edge_chains.h"
#include "questions.h"
#include "target.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/geometry/triangle/winding.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/solid/poses_inside.h>
#include <pcl_bsh/solid/triangle_labels.h>

#include "support/brute_force/depths.h"
#include "support/brute_force/labels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

namespace pcl_bsh::fuzz {
namespace {

using test::Random;

/// Throws a Finding that tells what differs; NaN equals NaN.
void requireSame(const std::vector<double>& found, const std::vector<double>& expected, const char* what)
{
  require(found.size() == expected.size(), what);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] == expected[i] || (std::isnan(found[i]) && std::isnan(expected[i]))) continue;
    std::ostringstream text;
    text.precision(17);
    text << what << ", record " << i << ": " << found[i] << " instead of " << expected[i];
    throw Finding(text.str());
  }
}

void requireSame(const PointDistances& found, const PointDistances& expected)
{
  requireSame(found.distance, expected.distance, "distances: differ");
  require(found.closest_point == expected.closest_point, "distances: other nearest records");
  require(found.measured == expected.measured && found.undecided == 0, "distances: counts");
  requireSame({found.greatest}, {expected.greatest}, "distances: another greatest");
  require(found.greatest_pair == expected.greatest_pair, "distances: another pair is the farthest");
}

/// Whether anything is left of the directed edges, summed up along their lines.
bool hasOpenEdges(const TrianglesView& triangles)
{
  std::map<std::pair<Point3, Point3>, std::int64_t> edges;
  const auto plain = [](Point3 p) {
    for (double& x : p) x += 0.0; // -0 is 0
    return p;
  };
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    const auto corners = triangles.triangle(i);
    if (!isFinite(corners)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 from = plain(corners[k]), to = plain(corners[(k + 1) % 3]);
      if (from < to)
        ++edges[{from, to}];
      else if (to < from)
        --edges[{to, from}];
    }
  }
  std::vector<test::Edge> left; // by those between equal places
  for (const auto& [edge, times] : edges)
    for (std::int64_t i = 0; i < std::abs(times); ++i)
      left.push_back(times > 0 ? test::Edge{edge.first, edge.second} : test::Edge{edge.second, edge.first});
  return !test::chainOf(left).empty();
}

/// By all triangles, each in exact arithmetic.
std::vector<std::uint8_t> labelsOf(const TrianglesView& triangles, const Eigen::Isometry3d& pose,
                                   const PlacedSolid& solid)
{
  const DefaultFloatEnvironment environment;
  const TrianglesView& of = solid.solid->triangles();
  const Winding winding(pose, solid.pose);
  std::vector<std::uint8_t> labels;
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    const auto corners = triangles.triangle(i);
    bool inside = false, on_surface = false;
    if (isFinite(corners))
      for (const Point3& p : corners) {
        const auto number =
            winding.number(p, of.count, [&](std::size_t t) { return of.triangle(static_cast<std::uint32_t>(t)); });
        inside = inside || (number && *number != 0);
        on_surface = on_surface || !number;
      }
    labels.push_back(labelOf(inside ? Label::inside : on_surface ? Label::surface : Label::outside));
  }
  return labels;
}

/// Labels of the records that a view names: all others are outside.
std::vector<std::uint8_t> expectedLabels(const Placed& a, const PlacedSolid& solid)
{
  const PointsView& view = a.hierarchy().view();
  if (!view.triangles) return brute_force::labelPoints(a, solid).labels;
  const std::vector<std::uint8_t> all = labelsOf(*view.triangles, a.pose, solid);
  std::vector<std::uint8_t> named(all.size(), labelOf(Label::outside));
  for (std::size_t i = 0; i < view.size(); ++i) named[view.record(i)] = all[view.record(i)];
  return named;
}

/// Triangles inside the obstacle: each interval meets the one that places of a grid bound, and holds the distance.
/// @param expected becomes what was found of those that are deeper than 0
void requireDepths(const Placed& a, const Placed& b, const PlacedSolid& solid, const PointDistances& found,
                   std::vector<double>& expected)
{
  constexpr unsigned steps = 6;
  const DeepSolid deep{*solid.solid, b.hierarchy(), solid.pose};
  for (const Depth& depth : brute_force::depthsIn(deep, QueriedRecords(a.hierarchy()), a.pose, steps).depths) {
    if (!(found.distance[depth.record] < 0.0) && depth.depth.lower == 0.0) continue; // it may meet the surface or not
    require(!found.interval.empty(), "solid obstacle: no intervals of triangles");
    const Interval& interval = found.interval[depth.record];
    require(interval.lower <= -depth.depth.lower && interval.upper >= -depth.depth.upper,
            "solid obstacle: another depth of a triangle");
    require(interval.lower <= found.distance[depth.record] && found.distance[depth.record] <= interval.upper,
            "solid obstacle: a depth outside of its interval");
    expected[depth.record] = found.distance[depth.record];
  }
}

/// Answers for a solid obstacle: the collisions with its surface, and the inside, where distances are negative.
void requireAnswers(const Placed& a, const Placed& b, const PlacedSolid& solid, const Question& question)
{
  const std::vector<std::uint8_t> labels = expectedLabels(a, solid);
  const auto enclosed = [&](std::size_t i) { return labels[i] != labelOf(Label::outside); };
  Shape input("input", a.hierarchy().view()), obstacle("obstacle", b.hierarchy().view());
  const Answer answer = ask(question, input, obstacle);
  FlagsRequest request;
  request.clearance = *question.clearance;
  const FlagsResult surface = brute_force::collisionFlags(a, b, request);
  require(answer.collisions.flags.size() == surface.a.size(), "solid obstacle: number of flags");
  for (std::size_t i = 0; i < surface.a.size(); ++i)
    require((answer.collisions.flags[i] == Verdict::colliding) == (enclosed(i) || surface.a[i] == Verdict::colliding),
            "solid obstacle: another flag");
  PointDistances expected = brute_force::pointDistances(a, b);
  if (a.hierarchy().view().triangles)
    requireDepths(a, b, solid, answer.distances.a, expected.distance);
  else
    for (std::size_t i = 0; i < labels.size(); ++i) { // of a ball, the depth is that of its far side
      const double depth = expected.distance[i] + 2.0 * a.hierarchy().view().ownRadius(static_cast<std::uint32_t>(i));
      if (enclosed(i) && depth > 0.0) expected.distance[i] = -depth;
    }
  requireSame(answer.distances.a.distance, expected.distance, "solid obstacle: other distances");
}

} // namespace

void askDistances(const Placed& a, const Placed& b, double unit, Random& random)
{
  PointDistancesRequest request;
  request.threads = static_cast<unsigned>(random.integer(1, 3));
  request.max_distance = random.chance(0.5) ? infinity : Questions::anyClearance(a, b, unit, random);
  const PointDistances expected = brute_force::pointDistances(a, b, request);
  requireSame(pointDistances(a, b, request), expected);

  PointDistancesRequest without_limit;
  const SymmetricDistances both = symmetricDistances(a, b);
  requireSame(both.a, brute_force::pointDistances(a, b));
  requireSame(both.b, brute_force::pointDistances(b, a));
  const HausdorffDistance hausdorff = hausdorffDistance(a, b);
  requireSame({hausdorff.distance}, {both.hausdorff}, "Hausdorff distance: differs");
  require(std::isnan(both.hausdorff) || hausdorff.pair == both.hausdorff_pair, "Hausdorff distance: another pair");

  constexpr int modes = 3;
  const int mode = random.integer(0, modes - 1);
  without_limit.accuracy = mode == 0   ? Accuracy::tolerance(unit * random.uniform(0, 0.2))
                           : mode == 1 ? Accuracy::level(static_cast<unsigned>(random.integer(0, 3)))
                                       : Accuracy::nodePairs(static_cast<std::uint64_t>(random.integer(0, 200)));
  const PointDistances roughly = pointDistances(a, b, without_limit);
  for (std::size_t i = 0; i < both.a.distance.size(); ++i) {
    if (std::isnan(both.a.distance[i])) continue;
    const Interval& enclosed = roughly.interval[i];
    require(enclosed.lower <= both.a.distance[i] && both.a.distance[i] <= enclosed.upper,
            "distances: not in the interval that the accuracy grants");
  }
}

void askSolid(const Placed& a, const Placed& b, double unit, Random& random)
{
  const TrianglesView* const triangles = b.hierarchy().view().triangles;
  if (!triangles) return;
  const bool open = hasOpenEdges(*triangles);
  std::optional<Solid> solid;
  try {
    solid.emplace(*triangles);
  }
  catch (const InvalidInput&) {
    return require(open, "solid: refused, though it closes");
  }
  require(!open, "solid: accepted, though it does not close");

  const auto threads = static_cast<unsigned>(random.integer(1, 3));
  const PlacedSolid placed{*solid, b.pose};
  const LabelsResult found = labelPoints(a, placed, threads), expected = brute_force::labelPoints(a, placed);
  require(found.labels == expected.labels, "labels: differ");
  require(found.inside == expected.inside && found.on_surface == expected.on_surface, "labels: counts");
  const auto enclosed = [](std::uint8_t label) { return label != labelOf(Label::outside); };
  const auto first = std::find_if(expected.labels.begin(), expected.labels.end(), enclosed);
  const std::optional<std::uint32_t> inside = firstInside(a, placed);
  require(inside.has_value() == (first != expected.labels.end()), "first inside: differs");
  if (inside) require(*inside == first - expected.labels.begin(), "first inside: another");
  require(anyInside(a, placed) == inside.has_value(), "any inside: differs");
  if (const TrianglesView* const of_a = a.hierarchy().view().triangles)
    require(labelTriangles(*of_a, a.pose, placed, threads) == labelsOf(*of_a, a.pose, placed),
            "labels of triangles: differ");

  std::vector<Eigen::Isometry3d> poses;
  std::vector<std::uint32_t> first_pose(expected.labels.size(), static_cast<std::uint32_t>(kNothing));
  Eigen::Isometry3d pose = b.pose;
  const auto count = static_cast<std::uint32_t>(random.integer(0, 4));
  for (std::uint32_t k = 0; k < count; ++k) {
    const LabelsResult there = brute_force::labelPoints(a, {*solid, pose});
    for (std::size_t i = 0; i < first_pose.size(); ++i)
      if (enclosed(there.labels[i])) first_pose[i] = std::min(first_pose[i], k);
    poses.push_back(pose);
    pose.pretranslate(Eigen::Vector3d{unit / 8 * random.integer(-2, 2), unit / 8 * random.integer(-2, 2), 0});
    if (random.chance(0.2)) pose.linear() = random.rotation().toRotationMatrix();
  }
  require(findPosesInside(a, *solid, poses, threads).first == first_pose, "poses inside: differ");

  if (b.hierarchy().view().indices) return; // a part of a surface
  Question question;
  question.solid = true;
  question.pose_of_input = a.pose;
  question.pose = b.pose;
  question.clearance = Questions::anyClearance(a, b, unit, random);
  question.threads = threads;
  question.wanted.flags = question.wanted.distances = true;
  requireAnswers(a, b, placed, question);
}

} // namespace pcl_bsh::fuzz
