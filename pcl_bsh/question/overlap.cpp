// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/overlap.h>

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/ask.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double kOpenShare = 0x1p-8; ///< of the upper end
constexpr std::size_t kMostOpenParts = std::size_t{1} << 18;
constexpr int kMostHalvings = 40;
/// Times the greatest coordinate: a bound of how far kMostHalvings halvings move a corner by rounding. Each halving
/// rounds three coordinates by 2^-53 of it.
constexpr double kCornerError = 0x1p-44;
/// A pose is rigid within 1e-6, and doubles of lengths are off by far less.
constexpr double kRigid = 1.0 + 0x1p-18;

/// A triangle that was halved some times.
struct TrianglePart {
  std::array<Eigen::Vector3d, 3> corners; ///< in the surface's frame, rounded
  double area = 0.0;                      ///< at the pose
  double area_error = 0.0;
};

std::vector<TrianglePart> partsOf(const TrianglesView& triangles, const Eigen::Isometry3d& pose)
{
  std::vector<TrianglePart> parts;
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    const Triangle3 places = triangles.triangle(i);
    if (!isFinite(places)) continue;
    TrianglePart part;
    for (std::size_t k = 0; k < 3; ++k) part.corners[k] = Eigen::Vector3d(places[k].data());
    const Eigen::Vector3d one = pose.linear() * (part.corners[1] - part.corners[0]),
                          other = pose.linear() * (part.corners[2] - part.corners[0]);
    part.area = 0.5 * one.cross(other).norm();
    part.area_error = 0x1p-48 * one.norm() * other.norm(); // of some twenty roundings
    parts.push_back(part);
  }
  return parts;
}

Point3 middleOf(const TrianglePart& part)
{
  const Eigen::Vector3d middle = (part.corners[0] + part.corners[1] + part.corners[2]) / 3.0;
  return {middle.x(), middle.y(), middle.z()};
}

/// How far places of the part are from a place at most, at the pose.
double reachOf(const TrianglePart& part, const Point3& from)
{
  double reach = 0.0, greatest = 0.0;
  for (const Eigen::Vector3d& corner : part.corners) {
    reach = std::max(reach, (corner - Eigen::Vector3d(from.data())).norm());
    greatest = std::max(greatest, corner.cwiseAbs().maxCoeff());
  }
  return (reach + kCornerError * greatest) * kRigid;
}

/// Halves a part across its longest edge.
void halve(const TrianglePart& part, std::vector<TrianglePart>& halves)
{
  const auto edge = [&](std::size_t k) { return (part.corners[(k + 1) % 3] - part.corners[k]).squaredNorm(); };
  const std::size_t longest = edge(0) >= edge(1) ? (edge(0) >= edge(2) ? 0 : 2) : (edge(1) >= edge(2) ? 1 : 2);
  const Eigen::Vector3d middle = 0.5 * part.corners[longest] + 0.5 * part.corners[(longest + 1) % 3];
  for (const std::size_t end : {longest, (longest + 1) % 3}) {
    TrianglePart half = part;
    half.corners[end] = middle;
    half.area *= 0.5;
    half.area_error *= 0.5;
    halves.push_back(half);
  }
}

/// Distances of places from a solid: below 0 inside.
std::vector<double> distancesOf(const Question& question, const std::vector<Point3>& places, Shape& solid)
{
  Question asked;
  asked.threads = question.threads;
  asked.pose_of_input = question.pose_of_input;
  asked.pose = question.pose;
  asked.solid = true;
  asked.wanted.distances = true;
  Shape middles("parts of a surface", viewOf(places.front().data(), places.size()));
  return ask(asked, middles, solid).distances.a.distance;
}

} // namespace

Interval areaWithin(const Question& question, Shape& surface, Shape& solid)
{
  std::vector<TrianglePart> open = partsOf(
      *surface.hierarchy(question.uncertaintyOfInput(), question.threads).view().triangles, question.pose_of_input);
  double inside = 0.0, error = 0.0, undecided = 0.0;
  std::size_t terms = 1;
  const auto add = [&](const TrianglePart& part, double& sum) {
    sum += part.area;
    error += part.area_error;
    ++terms;
  };
  for (int halvings = 0; !open.empty(); ++halvings) {
    std::vector<Point3> places;
    for (const TrianglePart& part : open) places.push_back(middleOf(part));
    const std::vector<double> distances = distancesOf(question, places, solid);
    std::vector<TrianglePart> still;
    double open_area = 0.0;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const double reach = reachOf(open[i], places[i]); // a part farther from the surface is on one side as a whole
      if (distances[i] < -reach) add(open[i], inside);
      if (!(std::abs(distances[i]) <= reach)) continue;
      still.push_back(open[i]);
      open_area += open[i].area;
    }
    open.clear();
    if (open_area <= kOpenShare * (inside + open_area) || 2 * still.size() > kMostOpenParts ||
        halvings == kMostHalvings)
      for (const TrianglePart& part : still) add(part, undecided);
    else
      for (const TrianglePart& part : still) halve(part, open);
  }
  const double rounding = error + static_cast<double>(terms) * 0x1p-52 * (inside + undecided);
  return {std::max(0.0, inside - rounding), inside + undecided + rounding};
}

} // namespace pcl_bsh
