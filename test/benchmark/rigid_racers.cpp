// SPDX-License-Identifier: BSD-3-Clause
#include "rigid_racers.h"

#include "peer/uniform_grid.h"
#if PCL_BSH_BENCH_FCL
#include "peer/fcl_boxes.h"
#endif

#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <optional>
#include <stdexcept>

namespace pcl_bsh::bench {
namespace {

Eigen::Isometry3d toEigen(const RigidPose& pose)
{
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Map<const Rows>(pose.rotation.data());
  result.translation() = Eigen::Map<const Eigen::Vector3d>(pose.translation.data());
  return result;
}

/// Poses as a query reads them, made as they are asked for.
struct PosesOf {
  const std::vector<RigidPose>& poses;
  std::size_t size() const { return poses.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const { return toEigen(poses[i]); }
};

class OurRacer : public RigidRacer {
public:
  void build(const Points& a, const Points& b, double d) override
  {
    a_.emplace(viewOf(&a.data()->x, a.size()));
    b_.emplace(viewOf(&b.data()->x, b.size()));
    a_->buildAll();
    b_->buildAll();
    request_.clearance = d;
  }

  bool any(const RigidPose& pose) const override
  {
    return counted(anyCollision({*a_}, {*b_, toEigen(pose)}, request_)).verdict == Verdict::colliding;
  }

  bool measuresDistance() const override { return true; }
  double distance(const RigidPose& pose) const override
  {
    return counted(closestPair({*a_}, {*b_, toEigen(pose)})).distance;
  }

  bool takesMotions() const override { return true; }
  std::size_t anyOnEachMotion(const Roadmap& map, std::size_t count) const override
  {
    TrajectoryRequest request;
    request.clearance = request_.clearance;
    request.swept = kMotionTolerance * request_.clearance;
    std::size_t colliding = 0;
    for (std::size_t m = 0; m < count; ++m) {
      const auto [from, to] = map.motions[m];
      const std::vector<Eigen::Isometry3d> ends = {toEigen(map.poses[from]), toEigen(map.poses[to])};
      colliding += counted(collideAlong({*a_}, *b_, ends, request)).colliding > 0 ? 1 : 0;
    }
    return colliding;
  }
  std::size_t anyOnMotions(const Roadmap& map, std::size_t count, unsigned threads) const override
  {
    MotionsRequest request;
    request.clearance = request_.clearance;
    request.swept = kMotionTolerance * request_.clearance;
    request.threads = threads;
    std::vector<PoseMotion> motions;
    for (std::size_t m = 0; m < count; ++m) motions.push_back({map.motions[m].first, map.motions[m].second});
    const AnyOnMotions found = anyCollisionOnMotions({*a_}, *b_, PosesOf{map.poses}, motions, request);
    work_ += found.work;
    answers_ += count;
    return found.colliding;
  }

  std::string remark() override
  {
    if (answers_ == 0) return "";
    const std::string words = std::to_string(work_.node_pairs / answers_) + " node pairs, " +
                              std::to_string(work_.updates() / answers_) + " updates, " +
                              std::to_string(work_.leaf_pairs / answers_) + " leaf pairs a question";
    work_ = {};
    answers_ = 0;
    return words;
  }

private:
  static constexpr double kMotionTolerance = 0.1; ///< of the clearance

  template <typename Result>
  const Result& counted(const Result& result) const
  {
    work_ += result.work;
    ++answers_;
    return result;
  }

  std::optional<SphereHierarchy> a_, b_;
  AnyRequest request_;
  mutable Work work_;
  mutable std::size_t answers_ = 0;
};

#if PCL_BSH_BENCH_FCL
class FclRacer : public RigidRacer {
public:
  void build(const Points& a, const Points& b, double d) override
  {
    a_.emplace(a);
    b_.emplace(b);
    d_ = d;
  }

  bool any(const RigidPose& pose) const override { return a_->any(*b_, pose, d_); }
  bool measuresDistance() const override { return true; }
  double distance(const RigidPose& pose) const override { return a_->distance(*b_, pose); }

private:
  std::optional<FclBoxes> a_, b_;
  double d_ = 0.0;
};
#endif

class PointwiseRacer : public RigidRacer {
public:
  explicit PointwiseRacer(std::unique_ptr<ExistencePeer> peer) : peer_(std::move(peer)) {}

  void build(const Points& a, const Points& b, double d) override
  {
    b_ = &b;
    d_ = static_cast<float>(d);
    peer_->adopt(a);
    peer_->build(a, d_);
  }

  bool any(const RigidPose& pose) const override { return anyPosed(*peer_, *b_, pose, d_); }
  bool slow() const override { return true; }

private:
  std::unique_ptr<ExistencePeer> peer_;
  const Points* b_ = nullptr;
  float d_ = 0.0f;
};

} // namespace

std::vector<std::string> availableRigidRacers()
{
#if PCL_BSH_BENCH_FCL
  return {"pcl_bsh", "fcl", "grid", "nanoflann", "pcl_kdtree"};
#else
  return {"pcl_bsh", "grid", "nanoflann", "pcl_kdtree"};
#endif
}

std::unique_ptr<RigidRacer> makeRigidRacer(const std::string& name)
{
  if (name == "pcl_bsh") return std::make_unique<OurRacer>();
#if PCL_BSH_BENCH_FCL
  if (name == "fcl") return std::make_unique<FclRacer>();
#endif
  if (name == "grid") return std::make_unique<PointwiseRacer>(std::make_unique<UniformGrid>());
  if (name == "nanoflann") return std::make_unique<PointwiseRacer>(makeNanoflannTree());
  if (name == "pcl_kdtree") return std::make_unique<PointwiseRacer>(makePclKdTree());
  throw std::invalid_argument("racer '" + name + "' is not available: see --help");
}

} // namespace pcl_bsh::bench
