// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/contact_normal.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace pcl_bsh {
namespace {

/// A place with a share below this of a triangle counts as being at the border.
constexpr double kBorder = 1e-9;

/// Distances below this share of a triangle's size have no direction.
constexpr double kNoDirection = 1e-12;

/// Whether a place of a triangle is at none of its borders.
bool isWithin(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& normal, const Eigen::Vector3d& place)
{
  const double whole = (t[1] - t[0]).cross(t[2] - t[0]).dot(normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = (t[(k + 1) % 3] - t[k]).cross(place - t[k]).dot(normal);
    if (!(part > kBorder * whole)) return false;
  }
  return whole > 0.0;
}

/// The normal of a record, in the world; 0 where it has no direction.
Eigen::Vector3d givenNormal(const NormalField& field, const Placed& placed, std::uint32_t record)
{
  std::array<float, 3> n;
  std::memcpy(n.data(), reinterpret_cast<const unsigned char*>(field.normals) + field.stride * record, sizeof n);
  return (placed.pose.linear() * Eigen::Vector3d(n[0], n[1], n[2])).stableNormalized();
}

/// Neighbours of a record of a cloud.
struct Neighborhood {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(); ///< in the world
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero(); ///< mean square, in the world's axes
  std::size_t count = 0;
};

Neighborhood around(const Placed& placed, std::uint32_t record, double radius, Neighbors& found)
{
  const PointsView& view = placed.hierarchy().view();
  const Eigen::Vector3d center = vectorOf(view.point(record));
  RadiusOptions unsorted;
  unsorted.sorted = false;
  radiusSearch(placed.hierarchy(), view.point(record), radius, found, unsorted);
  Neighborhood all;
  all.count = found.indices.size();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::int32_t i : found.indices) mean += vectorOf(view.point(static_cast<std::uint32_t>(i))) - center;
  mean /= static_cast<double>(all.count);
  for (const std::int32_t i : found.indices) {
    const Eigen::Vector3d off = vectorOf(view.point(static_cast<std::uint32_t>(i))) - center - mean;
    all.spread += off * off.transpose();
  }
  const Eigen::Matrix3d turn = placed.pose.linear();
  all.spread = turn * (all.spread / static_cast<double>(all.count)) * turn.transpose();
  all.middle = placed.pose * (center + mean);
  return all;
}

/// Returns the normal of a plane fitted to b's points about the contact, or the direction between both places where
/// they have no plane.
SurfaceNormal fittedNormal(const Channel& channel, const Candidate& of, const Eigen::Vector3d& way, double fit,
                           Neighbors& scratch)
{
  const Neighborhood own = around(channel.surface, of.pair.b, fit, scratch);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(own.spread);
  const Eigen::Vector3d spreads = axes.eigenvalues();
  if (own.count < 3 || !(spreads[1] > kBorder * spreads[2])) return {way.stableNormalized(), 0.0};
  Eigen::Vector3d normal = axes.eigenvectors().col(0);
  const double to_probe = normal.dot(around(channel.probe, of.pair.a, fit, scratch).middle - own.middle);
  if (to_probe < 0.0 || (to_probe == 0.0 && normal.dot(way) < 0.0)) normal = -normal;
  return {normal, std::sqrt(std::max(spreads[0], 0.0))};
}

} // namespace

SurfaceNormal normalOfTriangle(const Channel& channel, const Candidate& of, const Eigen::Vector3d& nearest)
{
  std::array<Eigen::Vector3d, 3> corners;
  const auto given = channel.surface.hierarchy().view().triangles->triangle(of.pair.b);
  for (std::size_t k = 0; k < 3; ++k) corners[k] = channel.surface.pose * vectorOf(given[k]);
  const Eigen::Vector3d front = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  const Eigen::Vector3d way = of.is_enclosed ? nearest - of.place : of.place - nearest;
  const double size = std::max((corners[1] - corners[0]).norm(), (corners[2] - corners[0]).norm());
  const bool has_way = way.norm() > kNoDirection * (size + nearest.norm());
  if (!front.isZero(0.0) && (!has_way || isWithin(corners, front, nearest)))
    return {has_way && front.dot(way) < 0.0 ? (-front).eval() : front, 0.0};
  return {way.stableNormalized(), 0.0};
}

SurfaceNormal normalOfPoints(const Collider::Parts& a, const Collider::Parts& b, const Channel& channel,
                             const Candidate& of, double fit, Neighbors& scratch)
{
  const Eigen::Vector3d way =
      of.place - channel.surface.pose * vectorOf(channel.surface.hierarchy().view().point(of.pair.b));
  if (a.thing.view().areBalls() || b.thing.view().areBalls()) return {way.stableNormalized(), 0.0};
  if (b.normals.normals) return {givenNormal(b.normals, channel.surface, of.pair.b), 0.0};
  if (a.normals.normals) return {-givenNormal(a.normals, channel.probe, of.pair.a), 0.0};
  return fittedNormal(channel, of, way, fit, scratch);
}

} // namespace pcl_bsh
