// SPDX-License-Identifier: BSD-3-Clause
#include "support/verdicts.h"

#include <examples/tunnel/tunnel.h>

#include <pcl_bsh/collide.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::tunnel {
namespace {

PointsView viewOf(const std::vector<Eigen::Vector3f>& points)
{
  return pcl_bsh::viewOf(points.front().data(), points.size());
}

/// Where a point lies, as seen from the track beside it.
struct Place {
  double station = 0;
  double outline = 0; ///< distance to the wagon's cross-section there
  bool straight = false;
};

Place placeOf(const Track& track, const Eigen::Vector3f& point)
{
  Place place;
  double nearest = 1e300;
  for (double station = 0; station <= track_length; station += 0.25) {
    const double along = std::abs((track.at(station).inverse() * point.cast<double>()).x());
    const double distance = (track.at(station).translation() - point.cast<double>()).norm();
    if (distance < 10 && along < nearest) nearest = along, place.station = station;
  }
  const Eigen::Vector3d seen = track.at(place.station).inverse() * point.cast<double>();
  place.outline = distanceToWagonOutline(seen.y(), seen.z());
  place.straight = true; // all along the wagon, wherever it stands beside this place
  for (double ahead = -wagon_length; ahead <= wagon_length; ahead += 1) {
    place.straight = place.straight && Track::curvature(place.station + ahead) == 0;
  }
  return place;
}

TEST(TunnelSize, InProportion)
{
  const Size full = Size::atScale(1), tenth = Size::atScale(0.1);
  EXPECT_EQ(full.scan, 18920000u);
  EXPECT_EQ(full.wagon, 2500000u);
  EXPECT_EQ(full.poses, 19392u);
  EXPECT_EQ(tenth.scan, 1892000u);
  EXPECT_EQ(tenth.wagon, 250000u);
  EXPECT_EQ(tenth.poses, 1939u);
  for (const double scale : {0.0, -1.0, 101.0, std::nan("")}) EXPECT_THROW(Size::atScale(scale), std::invalid_argument);
}

TEST(TunnelPassage, HoldsWhatWasAskedFor)
{
  const Size size{20000, 3000, 50};
  const Passage run = makePassage(size), again = makePassage(size);
  EXPECT_EQ(run.scan.size(), size.scan);
  EXPECT_EQ(run.wagon.size(), size.wagon);
  ASSERT_EQ(run.poses.size(), size.poses);
  EXPECT_EQ(run.scan, again.scan);
  EXPECT_EQ(run.wagon, again.wagon);
  double length = 0;
  for (std::size_t i = 1; i < run.poses.size(); ++i) {
    length += (run.poses[i].translation() - run.poses[i - 1].translation()).norm();
  }
  EXPECT_NEAR(length, track_length - wagon_length, 1.0);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : run.wagon) box.extend(p);
  EXPECT_NEAR(box.sizes().x(), wagon_length, 0.1);
  EXPECT_NEAR(box.sizes().y(), 2.9, 0.1);
}

TEST(TunnelTrack, WagonsMiddleLeavesTheTrackInABend)
{
  const Track track;
  const auto leaves = [&](double station) {
    return (track.at(station).inverse() * track.wagonAt(station).translation()).y();
  };
  EXPECT_NEAR(leaves(60), 0, 1e-4) << "straight";
  EXPECT_NEAR(leaves(220), pivot_distance * pivot_distance / (8 * 175), 1e-3) << "left bend: to the left";
  EXPECT_NEAR(leaves(600), -pivot_distance * pivot_distance / (8 * 210), 1e-3) << "right bend: to the right";
}

TEST(TunnelPassage, BendsShowCollisionsThatTheCrossSectionDoesNot)
{
  const Passage run = makePassage(Size::atScale(0.02));
  const SphereHierarchy scan(viewOf(run.scan)), wagon(viewOf(run.wagon));
  FlagsRequest request;
  request.clearance = clearance;
  std::vector<Verdict> collides(run.scan.size(), Verdict::free);
  for (const Eigen::Isometry3d& pose : run.poses) {
    const FlagsResult here = collisionFlags({scan}, {wagon, pose}, request);
    if (here.colliding_a == 0) continue;
    for (std::size_t i = 0; i < collides.size(); ++i) collides[i] = graver(collides[i], here.a[i]);
  }

  const Track track;
  std::size_t lamps = 0, only_in_bends = 0;
  for (std::size_t i = 0; i < collides.size(); ++i) {
    if (collides[i] == Verdict::free) continue;
    const Place place = placeOf(track, run.scan[i]);
    if (place.outline > clearance + 0.01) {
      ++only_in_bends;
      EXPECT_FALSE(place.straight) << "station " << place.station;
    }
    else if (place.straight) {
      ++lamps;
    }
  }
  EXPECT_GT(only_in_bends, 500u) << "walls that the cross-section clears";
  EXPECT_GT(lamps, 3u) << "lamps that reach in anywhere";
  EXPECT_LT(lamps, 200u);
}

TEST(TightTunnel, HoldsWhatWasAskedForInAnyOrder)
{
  const Size size{20000, 3000, 50};
  const Passage run = makePassage(size, Course::tight);
  EXPECT_EQ(run.scan.size(), size.scan);
  EXPECT_EQ(run.wagon.size(), size.wagon);
  EXPECT_EQ(run.poses.size(), size.poses);
  EXPECT_EQ(run.scan, makePassage(size, Course::tight).scan);
  double apart = 0;
  for (std::size_t i = 1; i < run.scan.size(); ++i) apart += (run.scan[i] - run.scan[i - 1]).norm();
  EXPECT_GT(apart / static_cast<double>(run.scan.size()), 100.0)
      << "neighbours in the cloud are not neighbours in space";
}

TEST(TightTunnel, GrazesTheWagonAlongTheBend)
{
  const Passage run = makePassage(Size::atScale(0.05), Course::tight);
  const SphereHierarchy scan(viewOf(run.scan)), wagon(viewOf(run.wagon));
  TrajectoryRequest request;
  const auto within = [&](double distance) {
    request.clearance = distance;
    return collideAlong({scan}, wagon, run.poses, request).colliding;
  };
  const std::size_t nearest = within(0.04), near = within(0.07);
  EXPECT_GT(near - nearest, 3000u) << "points that pass between 4 and 7 cm";
  EXPECT_LT(near, run.scan.size() / 20);
}

/// The node pairs of flags in a tight tunnel, at each of the clearances.
std::vector<double> worksAt(double scale, double poses, const std::vector<double>& clearances)
{
  Size size = Size::atScale(scale);
  size.poses = static_cast<std::size_t>(poses * static_cast<double>(size.poses));
  const Passage run = makePassage(size, Course::tight);
  const SphereHierarchy scan(viewOf(run.scan)), wagon(viewOf(run.wagon));
  std::vector<double> works;
  for (const double distance : clearances) {
    TrajectoryRequest request;
    request.clearance = distance;
    works.push_back(static_cast<double>(collideAlong({scan}, wagon, run.poses, request).work.node_pairs));
  }
  return works;
}

double workAt(double scale, double poses = 1.0)
{
  return worksAt(scale, poses, {clearance}).front();
}

/// Three times as many points of scan and wagon and three times as many poses: little more than three times the work.
TEST(TightTunnel, NodePairsGrowLittleMoreThanThePoints)
{
  const double small = workAt(0.02);
  EXPECT_LT(small, 3.6e6) << "of 378,400 points";
  EXPECT_LT(workAt(0.06), 3.6 * small);
}

TEST(TightTunnel, ListsOfClashesAndSweptMotionAreAFewTimesTheWorkOfFlags)
{
  const Passage run = makePassage(Size::atScale(0.02), Course::tight);
  const SphereHierarchy scan(viewOf(run.scan)), wagon(viewOf(run.wagon));
  TrajectoryRequest request;
  request.clearance = clearance;
  const auto work = [&] {
    return static_cast<double>(collideAlong({scan}, wagon, run.poses, request).work.node_pairs);
  };
  const double flags = work();
  request.first_poses = request.distances = request.closest_poses = request.pose_summaries = true;
  EXPECT_LT(work(), 1.2 * flags);
  request.pose_summaries = false;
  request.swept = 0.01;
  EXPECT_LT(work(), 3.3 * flags);
}

/// Where the model is dense along the path, a point collides with several of its points at each pose. One of them is
/// enough, and another pair is compared only where it may be the nearest.
TEST(TightTunnel, FewPairsOfADenseModelAreComparedAtEachPose)
{
  Size size = Size::atScale(0.01);
  size.wagon *= 40;
  size.poses *= 40;
  const Passage run = makePassage(size, Course::tight);
  const SphereHierarchy scan(viewOf(run.scan)), wagon(viewOf(run.wagon));
  TrajectoryRequest request;
  request.clearance = clearance;
  request.first_poses = request.distances = request.closest_poses = request.pose_summaries = true;
  const TrajectoryResult clashes = collideAlong({scan}, wagon, run.poses, request);
  std::size_t contacts = 0;
  for (const PoseSummary& pose : clashes.poses) contacts += pose.colliding_points;
  EXPECT_GT(contacts, 10 * clashes.colliding);
  EXPECT_LT(clashes.work.leaf_pairs, 1.8 * static_cast<double>(contacts)) << "2.6 if each is compared at its pose";
  EXPECT_LT(clashes.work.leaf_pairs, 20 * clashes.colliding) << "23 on arcs as loose as those of flags";
  EXPECT_LT(clashes.work.exact_decisions, 8 * clashes.colliding) << "11 where the nearest do not come first";
  request.pose_summaries = false;
  request.swept = 0.01;
  const TrajectoryResult swept = collideAlong({scan}, wagon, run.poses, request);
  EXPECT_LT(swept.work.exact_decisions, 12 * swept.colliding) << "24 if all that come near are judged";
}

TEST(TightTunnel, TenTimesThePosesAreLittleMoreWork)
{
  EXPECT_LT(workAt(0.02, 10), 2.0 * workAt(0.02));
}

TEST(TightTunnel, NoClearanceIsMuchMoreWork)
{
  std::vector<double> works = worksAt(0.02, 1, {0.0, 0.1, 0.2, 0.3, 0.4});
  std::sort(works.begin(), works.end());
  EXPECT_LT(works.back(), 2.0 * works[works.size() / 2]) << "the dearest against the median";
}

} // namespace
} // namespace pcl_bsh::tunnel
