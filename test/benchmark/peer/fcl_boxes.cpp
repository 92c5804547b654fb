// SPDX-License-Identifier: BSD-3-Clause
#include "fcl_boxes.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>

#include <limits>
#include <utility>

namespace pcl_bsh::bench {

using Box = fcl::OBBRSS<double>;
using Vector = fcl::Vector3<double>;
using Matrix = fcl::Matrix3<double>;

struct FclBoxes::Model {
  fcl::BVHModel<Box> tree;
};

namespace {

/// Two trees and where the second stands: what both descents share.
struct Pair {
  const fcl::BVHModel<Box>& a;
  const fcl::BVHModel<Box>& b;
  Matrix rotation;
  Vector translation;

  bool leaves(int ia, int ib) const { return a.getBV(ia).isLeaf() && b.getBV(ib).isLeaf(); }

  /// FCL's own rule: open the larger box, but never a leaf.
  bool opensFirst(int ia, int ib) const
  {
    const auto& node_a = a.getBV(ia);
    const auto& node_b = b.getBV(ib);
    return node_b.isLeaf() || (!node_a.isLeaf() && node_a.bv.size() > node_b.bv.size());
  }

  double squaredDistance(int ia, int ib) const
  {
    const Vector& p = a.vertices[a.getBV(ia).primitiveId()];
    const Vector& q = b.vertices[b.getBV(ib).primitiveId()];
    return (rotation * q + translation - p).squaredNorm();
  }
};

struct AnyDescent : Pair {
  double d;

  bool apart(int ia, int ib) const
  {
    const auto& box_a = a.getBV(ia).bv.obb;
    const auto& box_b = b.getBV(ib).bv.obb;
    const Matrix r = box_a.axis.transpose() * (rotation * box_b.axis);
    const Vector t = box_a.axis.transpose() * (rotation * box_b.To + translation - box_a.To);
    return fcl::obbDisjoint<double>(r, t, box_a.extent + Vector::Constant(d), box_b.extent);
  }

  bool visit(int ia, int ib) const
  {
    if (apart(ia, ib)) return false;
    if (leaves(ia, ib)) return squaredDistance(ia, ib) <= d * d;
    if (opensFirst(ia, ib)) return visit(a.getBV(ia).leftChild(), ib) || visit(a.getBV(ia).rightChild(), ib);
    return visit(ia, b.getBV(ib).leftChild()) || visit(ia, b.getBV(ib).rightChild());
  }
};

struct DistanceDescent : Pair {
  double best = std::numeric_limits<double>::infinity();

  double bound(std::pair<int, int> nodes) const
  {
    return fcl::distance(rotation, translation, a.getBV(nodes.first).bv.rss, b.getBV(nodes.second).bv.rss);
  }

  void visit(int ia, int ib)
  {
    if (leaves(ia, ib)) {
      best = std::min(best, std::sqrt(squaredDistance(ia, ib)));
      return;
    }
    std::pair<int, int> near = {ia, ib}, far = {ia, ib};
    if (opensFirst(ia, ib))
      near.first = a.getBV(ia).leftChild(), far.first = a.getBV(ia).rightChild();
    else
      near.second = b.getBV(ib).leftChild(), far.second = b.getBV(ib).rightChild();
    double near_bound = bound(near), far_bound = bound(far);
    if (far_bound < near_bound) std::swap(near, far), std::swap(near_bound, far_bound);
    if (near_bound < best) visit(near.first, near.second);
    if (far_bound < best) visit(far.first, far.second);
  }
};

Pair makePair(const fcl::BVHModel<Box>& a, const fcl::BVHModel<Box>& b, const RigidPose& pose)
{
  Pair pair{a, b, Matrix(), Vector(pose.translation[0], pose.translation[1], pose.translation[2])};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pair.rotation(i, j) = pose.rotation[static_cast<std::size_t>(3 * i + j)];
  return pair;
}

} // namespace

FclBoxes::FclBoxes(const Points& points) : model_(std::make_unique<Model>())
{
  std::vector<Vector> vertices;
  vertices.reserve(points.size());
  for (const Point& p : points) vertices.emplace_back(p.x, p.y, p.z);
  model_->tree.beginModel(0, static_cast<int>(vertices.size()));
  model_->tree.addSubModel(vertices);
  model_->tree.endModel();
}

FclBoxes::~FclBoxes() = default;
FclBoxes::FclBoxes(FclBoxes&&) noexcept = default;

bool FclBoxes::any(const FclBoxes& other, const RigidPose& pose, double d) const
{
  return AnyDescent{makePair(model_->tree, other.model_->tree, pose), d}.visit(0, 0);
}

double FclBoxes::distance(const FclBoxes& other, const RigidPose& pose) const
{
  DistanceDescent descent{makePair(model_->tree, other.model_->tree, pose)};
  descent.visit(0, 0);
  return descent.best;
}

} // namespace pcl_bsh::bench
