// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/slabs.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <Eigen/Eigenvalues>

#include <memory>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/hierarchy/slabs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/point_lanes-inl.h>

#ifndef PCL_BSH_HIERARCHY_SLABS_ONCE
#define PCL_BSH_HIERARCHY_SLABS_ONCE
namespace pcl_bsh {
namespace {

/// How the points below child i of a node spread. In eight sums side by side on every instruction set: the same points
/// give the same bits.
Eigen::Matrix3d covarianceOf(const Voxel& voxel, const Node& node, std::uint32_t i)
{
  constexpr std::uint32_t kSums = 8;
  enum { x, y, z, xx, xy, xz, yy, yz, zz, kMoments };
  float sums[kMoments][kSums] = {};
  const std::uint32_t begin = node.begin[i], end = node.begin[i + 1];
  const auto add = [&](std::uint32_t from, std::uint32_t count) {
    for (std::uint32_t k = 0; k < count; ++k) {
      const float px = voxel.x()[from + k] - node.x[i], py = voxel.y()[from + k] - node.y[i],
                  pz = voxel.z()[from + k] - node.z[i];
      sums[x][k] += px, sums[y][k] += py, sums[z][k] += pz;
      sums[xx][k] += px * px, sums[xy][k] += px * py, sums[xz][k] += px * pz;
      sums[yy][k] += py * py, sums[yz][k] += py * pz, sums[zz][k] += pz * pz;
    }
  };
  std::uint32_t from = begin;
  for (; from + kSums <= end; from += kSums) add(from, kSums);
  add(from, end - from);

  double moment[kMoments] = {};
  const double n = 1.0 / static_cast<double>(end - begin);
  for (int m = 0; m < kMoments; ++m)
    for (const float sum : sums[m]) moment[m] += static_cast<double>(sum) * n;
  Eigen::Matrix3d covariance;
  covariance << moment[xx], moment[xy], moment[xz], moment[xy], moment[yy], moment[yz], moment[xz], moment[yz],
      moment[zz];
  const Eigen::Vector3d mean(moment[x], moment[y], moment[z]);
  return covariance - mean * mean.transpose();
}

/// A principal axis of points, of length 1 within 2^-22; 0 where there is none.
Eigen::Vector3f principalAxis(const Eigen::Matrix3d& covariance, SlabAxis axis)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d direction = solver.eigenvectors().col(axis == SlabAxis::least ? 0 : 1);
  const double length = direction.norm();
  if (!(length > 0.5 && length < 2.0)) return Eigen::Vector3f::Zero();
  return (direction / length).cast<float>();
}

} // namespace
} // namespace pcl_bsh
#endif

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// Largest |n . (x - c)|, in float arithmetic: it errs by less than 8 u |x - c|, half of kRadiusMargin. Reads whole
/// vectors.
HWY_INLINE float thickness(const Voxel& voxel, const Node& node, std::uint32_t i, const Eigen::Vector3f& normal)
{
  const LaneTag d;
  const LaneVector nx = hn::Set(d, normal.x()), ny = hn::Set(d, normal.y()), nz = hn::Set(d, normal.z());
  const LaneVector cx = hn::Set(d, node.x[i]), cy = hn::Set(d, node.y[i]), cz = hn::Set(d, node.z[i]);
  LaneVector most = hn::Zero(d);
  for (std::size_t k = node.begin[i]; k < node.begin[i + 1]; k += hn::Lanes(d)) {
    const LaneVector along = hn::Add(hn::Add(hn::Mul(hn::Sub(hn::LoadU(d, voxel.x() + k), cx), nx),
                                             hn::Mul(hn::Sub(hn::LoadU(d, voxel.y() + k), cy), ny)),
                                     hn::Mul(hn::Sub(hn::LoadU(d, voxel.z() + k), cz), nz));
    const auto points = hn::FirstN(d, std::min<std::size_t>(node.begin[i + 1] - k, hn::Lanes(d)));
    most = hn::Max(most, hn::IfThenElseZero(points, hn::Abs(along)));
  }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

} // namespace

void fitSlabsOnTarget(const Voxel& voxel, SlabAxis axis, Slabs* slabs)
{
  const double slack = storedSlack(voxel.frame);
  std::vector<Eigen::Vector3f> normals(voxel.nodes.size(), Eigen::Vector3f::Zero()); // of all that is below each node
  for (std::size_t n = 0; n < voxel.nodes.size(); ++n) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (!node.isLeaf(i)) normals[node.child[i]] = principalAxis(covarianceOf(voxel, node, i), axis);
      const Eigen::Vector3f& normal = normals[node.isLeaf(i) ? n : node.child[i]];
      slabs[n].x[i] = normal.x();
      slabs[n].y[i] = normal.y();
      slabs[n].z[i] = normal.z();
      const double stored = static_cast<double>(thickness(voxel, node, i, normal));
      slabs[n].h[i] =
          roundUp((stored + kRadiusMargin * static_cast<double>(node.r[i]) + slack) * (1.0 + kRadiusMargin));
    }
  }
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(fitSlabsOnTarget);

const Slabs* LazySlabs::fit(const Voxel& voxel, BuildWork& work)
{
  auto slabs = std::make_unique<Slabs[]>(voxel.nodes.size()); // all zero
  HWY_DYNAMIC_DISPATCH(fitSlabsOnTarget)(voxel, axis_, slabs.get());
  bool kept = false;
  const Slabs* const known = slabs_.keep(std::move(slabs), kept);
  if (kept) work.volumes_built += voxel.nodes.size() - 1; // every node but the root is a child that is no leaf
  return known;
}

} // namespace pcl_bsh
#endif
