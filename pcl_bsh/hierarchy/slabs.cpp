// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/slabs.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
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

/// Places that slabs hold, in a voxel's frame: its stored points, or the corners of its triangles, one after another.
struct SlabPlaces {
  struct Set {
    const float *x, *y, *z; ///< one for each point of the voxel, and what vectors read behind them
  };

  SlabPlaces(const Voxel& voxel, const PointsView& view)
  {
    if (!view.triangles) {
      sets.push_back({voxel.x(), voxel.y(), voxel.z()});
      slack = storedSlack(voxel.frame);
      return;
    }
    const std::size_t stride = voxel.count + kBlockPadding;
    corners_.resize(9 * stride);
    LocalFrame frame = voxel.frame; // corners lie beyond its reach
    for (std::uint32_t i = 0; i < voxel.count; ++i) {
      const Triangle3 t = view.triangles->triangle(voxel.records()[i]);
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 3; ++k) {
          const double local = (t[c][k] - frame.origin[k]) / frame.unit;
          frame.reach[k] = std::max(frame.reach[k], std::abs(local));
          corners_[(3 * c + k) * stride + i] = roundToFloat(local);
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const float* const first = corners_.data() + 3 * c * stride;
      sets.push_back({first, first + stride, first + 2 * stride});
    }
    slack = storedSlack(frame);
  }

  std::vector<Set> sets;
  double slack; ///< between a place as given and as it is here

private:
  std::vector<float> corners_;
};

/// The covariance of the places below child i of a node. It has eight partial sums on every instruction set, so that
/// equal places give equal bits.
Eigen::Matrix3d covarianceOf(const SlabPlaces& places, const Node& node, std::uint32_t i)
{
  constexpr std::uint32_t kSums = 8;
  enum { x, y, z, xx, xy, xz, yy, yz, zz, kMoments };
  float sums[kMoments][kSums] = {};
  const std::uint32_t begin = node.begin[i], end = node.begin[i + 1];
  for (const SlabPlaces::Set& set : places.sets) {
    const auto add = [&](std::uint32_t from, std::uint32_t count) {
      for (std::uint32_t k = 0; k < count; ++k) {
        const float px = set.x[from + k] - node.x[i], py = set.y[from + k] - node.y[i],
                    pz = set.z[from + k] - node.z[i];
        sums[x][k] += px, sums[y][k] += py, sums[z][k] += pz;
        sums[xx][k] += px * px, sums[xy][k] += px * py, sums[xz][k] += px * pz;
        sums[yy][k] += py * py, sums[yz][k] += py * pz, sums[zz][k] += pz * pz;
      }
    };
    std::uint32_t from = begin;
    for (; from + kSums <= end; from += kSums) add(from, kSums);
    add(from, end - from);
  }

  double moment[kMoments] = {};
  const double n = 1.0 / static_cast<double>((end - begin) * places.sets.size());
  for (int m = 0; m < kMoments; ++m)
    for (const float sum : sums[m]) moment[m] += static_cast<double>(sum) * n;
  Eigen::Matrix3d covariance;
  covariance << moment[xx], moment[xy], moment[xz], moment[xy], moment[yy], moment[yz], moment[xz], moment[yz],
      moment[zz];
  const Eigen::Vector3d mean(moment[x], moment[y], moment[z]);
  return covariance - mean * mean.transpose();
}

/// A principal axis of points, of length 1 within 2^-22; 0 where they have no such axis.
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
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// Largest |n . (x - c)|, in float arithmetic: it errs by less than 8 u |x - c|, half of kRadiusMargin. Reads whole
/// vectors.
HWY_INLINE float thickness(const SlabPlaces& places, const Node& node, std::uint32_t i, const Eigen::Vector3f& normal)
{
  const LaneTag d;
  const LaneVector nx = hn::Set(d, normal.x()), ny = hn::Set(d, normal.y()), nz = hn::Set(d, normal.z());
  const LaneVector cx = hn::Set(d, node.x[i]), cy = hn::Set(d, node.y[i]), cz = hn::Set(d, node.z[i]);
  LaneVector most = hn::Zero(d);
  for (const SlabPlaces::Set& set : places.sets)
    for (std::size_t k = node.begin[i]; k < node.begin[i + 1]; k += hn::Lanes(d)) {
      const LaneVector along = hn::Add(
          hn::Add(hn::Mul(hn::Sub(hn::LoadU(d, set.x + k), cx), nx), hn::Mul(hn::Sub(hn::LoadU(d, set.y + k), cy), ny)),
          hn::Mul(hn::Sub(hn::LoadU(d, set.z + k), cz), nz));
      const auto counted = hn::FirstN(d, std::min<std::size_t>(node.begin[i + 1] - k, hn::Lanes(d)));
      most = hn::Max(most, hn::IfThenElseZero(counted, hn::Abs(along)));
    }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

} // namespace

/// @return how many normals were found
std::uint64_t fitSlabsOnTarget(const Voxel& voxel, const PointsView& view, SlabAxis axis, Slabs* slabs)
{
  const SlabPlaces places(voxel, view);
  std::vector<Eigen::Vector3f> normals(voxel.nodes.size(), Eigen::Vector3f::Zero()); // of all that is below each node
  std::uint64_t found = 0;
  for (std::size_t n = 0; n < voxel.nodes.size(); ++n) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      Eigen::Vector3f& normal = normals[node.isLeaf(i) ? n : node.child[i]];
      Eigen::Vector3f own = normal;
      if (!node.isLeaf(i) || view.triangles) { // a few triangles say how they lie, as a few points do not
        own = principalAxis(covarianceOf(places, node, i), axis);
        if (!node.isLeaf(i)) normal = own;
        ++found;
      }
      slabs[n].x[i] = own.x();
      slabs[n].y[i] = own.y();
      slabs[n].z[i] = own.z();
      const double stored = static_cast<double>(thickness(places, node, i, own));
      slabs[n].h[i] =
          roundUp((stored + kRadiusMargin * static_cast<double>(node.r[i]) + places.slack) * (1.0 + kRadiusMargin));
    }
  }
  return found;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(fitSlabsOnTarget);

const Slabs* LazySlabs::fit(const Voxel& voxel, const PointsView& view, BuildWork& work)
{
  auto slabs = std::make_unique<Slabs[]>(voxel.nodes.size()); // all zero
  const std::uint64_t found = HWY_DYNAMIC_DISPATCH(fitSlabsOnTarget)(voxel, view, axis_, slabs.get());
  bool kept = false;
  const Slabs* const known = slabs_.keep(std::move(slabs), kept);
  if (kept) work.volumes_built += found;
  return known;
}

} // namespace pcl_bsh
#endif
