// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/unseen.h>

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/question/model_shift.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/solid/labels.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pcl_bsh {

void Answer::Unseen::addPose(const std::vector<Verdict>& found, bool with_places, std::vector<Verdict>& gravest,
                             UnseenKinds of)
{
  at_poses.push_back(countOf(found, Verdict::unseen));
  if (at_poses.back() > 0 && !first_pose) first_pose = at_poses.size() - 1;
  for (std::size_t i = 0; i < found.size(); ++i) gravest[i] = graver(gravest[i], found[i]);
  count = countOf(gravest, Verdict::unseen);
  shadow_at_poses.push_back(static_cast<std::size_t>(std::count(of.in_shadow.begin(), of.in_shadow.end(), true)));
  shadow.resize(gravest.size());
  in_shadow = 0;
  for (std::size_t i = 0; i < gravest.size(); ++i) {
    if (i < of.in_shadow.size() && of.in_shadow[i]) shadow[i] = true;
    if (shadow[i] && gravest[i] == Verdict::unseen) ++in_shadow;
  }
  if (!with_places) return;
  where.emplace_back();
  kinds.emplace_back();
  if (at_poses.back() == 0) return;
  for (const Verdict verdict : found) where.back().push_back(verdict == Verdict::unseen);
  kinds.back() = std::move(of);
}

namespace {

/// The inside of a solid as cubes of a grid, each within a ball.
class Enclosed {
public:
  Enclosed(Shape& obstacle, const CornerBox& bounds, const Question& question)
  {
    const SphereHierarchy& surface = obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads);
    if (bounds.box.isEmpty()) return;
    const double longest = bounds.box.sizes().maxCoeff();
    edge_ = std::max({longest / 48.0, std::min(longest / 8.0, question.clearance.value_or(0.0)),
                      std::numeric_limits<double>::min()}); // a solid may be one place
    const Eigen::Array3i count = (bounds.box.sizes().array() / edge_).ceil().max(1.0).cast<int>();
    std::vector<Point3> middles;
    for (int x = 0; x < count[0]; ++x)
      for (int y = 0; y < count[1]; ++y)
        for (int z = 0; z < count[2]; ++z) {
          const Eigen::Vector3d middle = bounds.box.min() + edge_ * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
          middles.push_back({middle.x(), middle.y(), middle.z()});
        }
    const float radius = roundUp(0.5 * std::sqrt(3.0) * edge_ * (1.0 + 0x1p-20));
    const SphereHierarchy all(viewOf(middles.front().data(), middles.size()));
    const LabelsResult found = labelPoints({all}, {obstacle.solid().whole()}, question.threads);
    FlagsRequest near; // a cube that no surface meets is as a whole where its middle is
    near.clearance = static_cast<double>(radius);
    near.threads = question.threads;
    const FlagsResult meets = collisionFlags({all}, {surface}, near);
    for (std::size_t i = 0; i < middles.size(); ++i)
      if (found.labels[i] != labelOf(Label::outside) || meets.a[i] != Verdict::free)
        middles_.push_back(inBounds(middles[i], bounds.box));
    radii_.assign(middles_.size(), radius);
    PointsView view = viewOf(middles_.empty() ? nullptr : middles_.front().data(), middles_.size());
    view.radii = radii_.data();
    balls_.emplace(withUncertainty(view, {}, obstacle.name(), question.uncertaintyOfObstacle()));
  }

  double unseen(const SeenSpace& seen, const Placed& scan, const Eigen::Isometry3d& in_world,
                const Eigen::Isometry3d& in_scan, const UnseenRequest& request, FlagsRequest flags, Work& work) const
  {
    if (!balls_) return 0.0;
    flags.clearance = 0.0;
    FlagsResult found = collisionFlags(scan, {*balls_, in_world}, flags);
    const UnseenResult left = markUnseen(seen, {*balls_, in_scan}, request, found.b);
    work += found.work;
    work += left.work;
    return static_cast<double>(left.in_shadow) * edge_ * edge_ * edge_;
  }

private:
  /// Returns the place within the bounds that is nearest to a cube's middle. Cubes reach beyond the bounds, the solid
  /// does not. The ball about this place holds all of the cube that is within the bounds.
  static Point3 inBounds(const Point3& middle, const Eigen::AlignedBox3d& bounds)
  {
    const Eigen::Vector3d place = Eigen::Vector3d(middle.data()).cwiseMax(bounds.min()).cwiseMin(bounds.max());
    return {place.x(), place.y(), place.z()};
  }

  double edge_ = 0.0;
  std::vector<Point3> middles_;
  std::vector<float> radii_;
  std::optional<SphereHierarchy> balls_;
};

} // namespace

void lookAround(const Question& question, Shape& input, Shape& obstacle, Answer& answer)
{
  const SphereHierarchy& model = obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads);
  const Placed scan(input.hierarchy(question.uncertaintyOfInput(), question.threads), question.pose_of_input);
  const SeenSpace& seen =
      input.seen(question.origin, question.seen_angle, question.threads, question.seen_beyond.value_or(0.0));
  Answer::Unseen& unseen = answer.unseen;
  for (std::size_t i = 0; i < seen.size(); ++i) unseen.angles.push_back(seen.angle(i));
  FlagsRequest flags;
  flags.clearance = question.clearance.value_or(0.0);
  flags.threads = question.threads;
  flags.flagged = Flagged::b;
  UnseenRequest request;
  request.threads = question.threads;
  request.kinds = true;
  answer.obstacle_flags.assign(model.view().count, Verdict::free);
  const CornerBox bounds(model.view());
  std::optional<Enclosed> enclosed;
  if (question.solid) enclosed.emplace(obstacle, bounds, question);
  const Eigen::Isometry3d from_world = question.pose_of_input.inverse();
  const bool is_moved = !question.pose_of_input.matrix().isIdentity(0.0);
  FlagsResult found;
  const std::vector<Eigen::Isometry3d> poses = question.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (question.progress && !question.progress(1.0)) throw Cancelled(); // all but this is done
    const Eigen::Isometry3d in_scan = is_moved ? from_world * poses[k] : poses[k];
    double moves = shiftOf(question.input_pose_uncertainty, bounds, in_scan);
    if (is_moved) // the product of poses is rounded
      moves += 0x1p-44 * (in_scan.translation().lpNorm<1>() + bounds.ball.radius +
                          Eigen::Vector3d(bounds.ball.center.data()).lpNorm<1>() + poses[k].translation().lpNorm<1>() +
                          question.pose_of_input.translation().lpNorm<1>());
    request.clearance = flags.clearance + moves;
    collisionFlags(scan, {model, poses[k]}, flags, found);
    answer.work += found.work;
    request.parts = question.wanted.unseen_places;
    request.frame = poses[k];
    UnseenResult left = markUnseen(seen, {model, in_scan}, request, found.b);
    answer.work += left.work;
    unseen.addPose(found.b, question.wanted.unseen_places, answer.obstacle_flags, std::move(left.kinds));
    if (enclosed) unseen.inside.push_back(enclosed->unseen(seen, scan, poses[k], in_scan, request, flags, answer.work));
  }
}

} // namespace pcl_bsh
