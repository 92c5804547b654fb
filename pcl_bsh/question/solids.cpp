// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/solids.h>

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/poses_inside.h>
#include <pcl_bsh/solid/triangle_labels.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

bool isHeld(std::uint8_t label)
{
  return label != labelOf(Label::outside);
}

const Solid& solidOf(Shape& obstacle)
{
  if (!obstacle.isSurface())
    throw InvalidOption("solid", obstacle.name() + " has no faces", "give a mesh that closes, or leave it out");
  return obstacle.solid();
}

/// What is inside at a pose touches there, no later.
void takeContact(std::optional<FirstContact>& contact, std::size_t pose)
{
  if (!contact || contact->pose >= pose) contact = FirstContact{pose, 0.0};
}

/// A verdict of the surface where the part is inside.
void add(Verdict& verdict, bool uncertain)
{
  if (verdict == Verdict::free || !uncertain) verdict = Verdict::colliding;
}

} // namespace

SolidObstacle::SolidObstacle(const Question& question, Shape& obstacle, const Placed& a, const Placed& b)
: question_(question),
  solid_(solidOf(obstacle)),
  a_(a),
  b_(b)
{
}

std::vector<std::uint8_t> SolidObstacle::labels(const Eigen::Isometry3d& pose, Work* work) const
{
  if (const TrianglesView* const triangles = a_.hierarchy().view().triangles)
    return labelTriangles(*triangles, a_.pose, {solid_, pose}, question_.threads);
  LabelsResult found = labelPoints(a_, {solid_, pose}, question_.threads);
  if (work) *work += found.work;
  return std::move(found.labels);
}

void SolidObstacle::addTo(TrajectoryResult& flags, Work& work)
{
  if (flags.flags.empty()) return;
  for (const std::uint32_t record : inside(&work)) add(flags.flags[record], question_.isUncertain());
  flags.colliding = countOf(flags.flags, Verdict::colliding);
  flags.undecided = countOf(flags.flags, Verdict::undecided);
}

void SolidObstacle::addToPath(TrajectoryResult& found, Work& work) const
{
  const std::vector<Eigen::Isometry3d> poses = question_.poses();
  std::vector<std::uint32_t> first;
  if (a_.hierarchy().view().triangles) {
    first.assign(a_.hierarchy().view().count, kNothing);
    for (std::uint32_t k = 0; k < poses.size(); ++k) {
      const std::vector<std::uint8_t> at_pose = labels(poses[k], nullptr);
      for (std::size_t i = 0; i < first.size(); ++i)
        if (isHeld(at_pose[i])) first[i] = std::min(first[i], k);
    }
  }
  else {
    PosesInside inside = findPosesInside(a_, solid_, poses, question_.threads);
    work += inside.work;
    first = std::move(inside.first);
  }
  const bool certain = !question_.isUncertain();
  const auto takeFirst = [](auto& pose, std::uint32_t held) {
    if (pose < 0 || pose > static_cast<std::int32_t>(held)) pose = static_cast<std::int32_t>(held);
  };
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] == kNothing) continue;
    if (!found.flags.empty()) add(found.flags[i], !certain);
    if (!found.first_pose.empty()) takeFirst(found.first_pose[i], first[i]);
    if (certain && !found.certain_pose.empty()) takeFirst(found.certain_pose[i], first[i]);
    const bool is_less = !found.distance.empty() && !(found.distance[i] <= 0.0f);
    if (is_less) found.distance[i] = 0.0f;
    if (is_less && !found.closest_pose.empty()) found.closest_pose[i] = static_cast<std::int32_t>(first[i]);
    if (question_.swept > 0.0) takeContact(found.first_contact, first[i]);
    if (question_.swept > 0.0 && certain && !found.certain_pose.empty()) takeContact(found.certain_contact, first[i]);
  }
  found.colliding = countOf(found.flags, Verdict::colliding);
  found.undecided = countOf(found.flags, Verdict::undecided);
  for (std::size_t k = 0; k < found.poses.size(); ++k) { // of the union, which only all flags tell
    FlagsResult surface =
        collisionFlags(a_, {b_.hierarchy(), poses[k]}, {question_.clearance.value_or(0.0), Side::a, question_});
    const std::vector<std::uint8_t> at_pose = labels(poses[k], nullptr);
    for (std::size_t i = 0; i < at_pose.size(); ++i) {
      if (!isHeld(at_pose[i])) continue;
      add(surface.a[i], !certain);
      found.poses[k].distance = std::min(found.poses[k].distance, 0.0);
      found.poses[k].colliding = true;
    }
    found.poses[k].colliding_points = countOf(surface.a, Verdict::colliding);
    found.poses[k].undecided_points = countOf(surface.a, Verdict::undecided);
  }
}

const std::vector<std::uint32_t>& SolidObstacle::inside(Work* work)
{
  if (inside_) return *inside_;
  const std::vector<std::uint8_t> found = labels(b_.pose, work);
  inside_.emplace();
  for (std::uint32_t i = 0; i < found.size(); ++i)
    if (isHeld(found[i])) inside_->push_back(i);
  return *inside_;
}

PointDistances SolidObstacle::depths(const std::vector<std::uint32_t>& records) const
{
  std::vector<std::int32_t> subset(records.begin(), records.end());
  PointsView view = a_.hierarchy().view();
  view.indices = subset.data();
  view.index_count = subset.size();
  PointDistancesRequest request;
  request.threads = question_.threads;
  const SphereHierarchy held(view);
  return pointDistances({held, a_.pose}, b_, request);
}

void SolidObstacle::turn(PointDistances& found)
{
  const std::vector<std::uint32_t>& records = inside(&found.work);
  std::vector<std::uint32_t> deep; // beyond what was asked for
  for (const std::uint32_t record : records)
    if (std::isnan(found.distance[record])) deep.push_back(record);
  if (!deep.empty()) {
    const PointDistances measured = depths(deep);
    for (const std::uint32_t record : deep) {
      found.distance[record] = measured.distance[record];
      found.closest_point[record] = measured.closest_point[record];
      if (!found.interval.empty()) found.interval[record] = {measured.distance[record], measured.distance[record]};
      found.measured += !std::isnan(measured.distance[record]);
    }
  }
  for (const std::uint32_t record : records) {
    if (found.distance[record] > 0.0) found.distance[record] = -found.distance[record];
    if (!found.interval.empty())
      found.interval[record] = {-found.interval[record].upper, -found.interval[record].lower};
  }
  found.greatest = std::numeric_limits<double>::quiet_NaN();
  found.greatest_pair.reset();
  for (std::uint32_t i = 0; i < found.distance.size(); ++i) {
    if (!(found.distance[i] > found.greatest) && !(std::isnan(found.greatest) && !std::isnan(found.distance[i])))
      continue;
    found.greatest = found.distance[i];
    found.greatest_pair = PointPair{i, found.closest_point[i]};
  }
}

void SolidObstacle::turn(DistanceResult& closest)
{
  const std::vector<std::uint32_t>& records = inside(&closest.work);
  if (records.empty()) return;
  const PointDistances measured = depths(records);
  if (!(measured.greatest > 0.0)) return;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  closest.distance = -measured.greatest;
  closest.pair = measured.greatest_pair;
  closest.interval = {std::nextafter(closest.distance, -infinity), std::nextafter(closest.distance, infinity)};
}

} // namespace pcl_bsh
