// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/trace.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "clouds.h"
#include "support/every_allocation.h"
#include "support/made_meshes.h"
#include "support/question.h"
#include "support/verdicts.h"

#include <bit>
#include <tuple>

namespace pcl_bsh::test {
namespace {

constexpr SphereFit kFits[] = {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal};

const Cloud& scan()
{
  static const Cloud cloud = richCloud(1, 400);
  return cloud;
}
const Cloud& model()
{
  static const Cloud cloud = richCloud(2, 300);
  return cloud;
}
const Cloud& scanOfBalls()
{
  static const Cloud cloud = richCloud(3, 300, true);
  return cloud;
}

std::unique_ptr<FreshPair> freshPair()
{
  return std::make_unique<FreshPair>(scan(), model());
}

test::Question request(unsigned threads = 1, Flagged flagged = Flagged::both)
{
  test::Question request;
  request.clearance = 0.05;
  request.threads = threads;
  request.flagged = flagged;
  return request;
}

auto answerOf(const AnyResult& result)
{
  return std::tuple(result.verdict, result.pair);
}
auto answerOf(const FlagsResult& result)
{
  return std::tuple(result.a, result.b, result.colliding_a, result.colliding_b);
}
auto answerOf(const DistanceResult& result)
{
  return std::tuple(result.distance, result.pair);
}
auto bitsOf(const std::vector<float>& values)
{
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}
auto answerOf(const TrajectoryResult& result)
{
  std::vector<std::size_t> poses;
  for (const PoseSummary& pose : result.poses) poses.push_back(pose.colliding_points);
  return std::tuple(result.flags, bitsOf(result.distance), result.first_pose, result.closest_pose, result.closest_point,
                    poses, result.first_contact ? result.first_contact->fraction : -1.0);
}

TEST(AllocationFailure, OfFlagsWithEachFitAndRadii)
{
  for (const SphereFit fit : kFits) {
    for (const Cloud* cloud : {&scan(), &scanOfBalls()}) {
      const auto make = [&] { return std::make_unique<FreshPair>(*cloud, model(), fit); };
      const auto ask = [](const auto& pair) {
        return answerOf(collisionFlags(pair->placedA(), pair->placedB(), request()));
      };
      const auto fresh = make();
      EXPECT_EQ(ask(fresh), answerOf(brute_force::collisionFlags(fresh->placedA(), fresh->placedB(), request())));
      EXPECT_GT(failEachAllocation(make, ask), 50u);
    }
  }
}

TEST(AllocationFailure, OfFlagsLeavesAUsableResult)
{
  struct Subject {
    std::unique_ptr<FreshPair> pair = freshPair();
    FlagsResult result;
  };
  const FlagsResult right = [] {
    const auto pair = freshPair();
    return brute_force::collisionFlags(pair->placedA(), pair->placedB(), request());
  }();
  failEachAllocation([] { return Subject(); },
                     [&](Subject& subject) {
                       try {
                         collisionFlags(subject.pair->placedA(), subject.pair->placedB(), request(), subject.result);
                       }
                       catch (const std::bad_alloc&) {
                         EXPECT_TRUE(subject.result.a.empty() && subject.result.b.empty());
                         EXPECT_EQ(subject.result.colliding_a + subject.result.colliding_b, 0u);
                         throw;
                       }
                       return answerOf(subject.result) == answerOf(right);
                     });
}

TEST(AllocationFailure, OfLabelsLeavesAnEmptyResult)
{
  const TestMesh box = boxMesh(1.0, 0.75, 0.5);
  const Solid solid(box.trianglesView());
  struct Subject {
    std::unique_ptr<FreshPair> pair = freshPair();
    LabelsResult result;
  };
  const auto make = [] {
    Subject subject;
    subject.result.labels = {1, 2};
    subject.result.inside = subject.result.on_surface = 1;
    return subject;
  };
  EXPECT_GT(failEachAllocation(make,
                               [&](Subject& subject) {
                                 LabelsResult& result = subject.result;
                                 try {
                                   labelPoints(subject.pair->placedA(), solid, result);
                                 }
                                 catch (const std::bad_alloc&) {
                                   EXPECT_TRUE(result.labels.empty());
                                   EXPECT_EQ(result.inside + result.on_surface, 0u);
                                   throw;
                                 }
                                 return std::tuple(result.labels, result.inside, result.on_surface);
                               }),
            1u);
}

TEST(AllocationFailure, OfCollidingIndices)
{
  struct Subject {
    std::unique_ptr<FreshPair> pair = freshPair();
    CollidingIndices result;
  };
  const auto ask = [](Subject& subject, const FlagsRequest& asked) {
    collidingIndices(subject.pair->placedA(), subject.pair->placedB(), asked, subject.result);
    return std::tuple(subject.result.a, subject.result.b, subject.result.undecided_a, subject.result.undecided_b);
  };
  for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::level(1), Accuracy::nodePairs(2000)}) {
    test::Question asked = request();
    asked.accuracy = accuracy;
    failEachAllocation([] { return Subject(); }, [&](Subject& subject) { return ask(subject, asked); });
  }
  failEachAllocation([] { return Subject(); }, [&](Subject& subject) { return ask(subject, request(2, Flagged::a)); });
}

TEST(AllocationFailure, OfContactsLeavesAUsableResult)
{
  struct Subject {
    std::unique_ptr<FreshPair> pair = freshPair();
    ContactsResult result;
  };
  failEachAllocation([] { return Subject(); },
                     [&](Subject& subject) {
                       try {
                         nearestContacts(subject.pair->placedA(), subject.pair->placedB(), {0.05, 20}, subject.result);
                       }
                       catch (const std::bad_alloc&) {
                         EXPECT_FALSE(subject.result.complete);
                         throw;
                       }
                       return std::tuple(subject.result.contacts.size(), subject.result.complete);
                     });
}

TEST(AllocationFailure, OfFlagsInThreads)
{
  for (const Flagged side : {Flagged::a, Flagged::b})
    failEachAllocation(freshPair, [&](const auto& pair) {
      return answerOf(collisionFlags(pair->placedA(), pair->placedB(), request(2, side)));
    });
}

TEST(AllocationFailure, OfAnyCollisionAndTraces)
{
  for (const double clearance : {0.0, 0.05}) {
    test::Question asked = request();
    asked.clearance = clearance;
    failEachAllocation(
        freshPair, [&](const auto& pair) { return answerOf(anyCollision(pair->placedA(), pair->placedB(), asked)); });
    failEachAllocation(freshPair, [&](const auto& pair) {
      const CollisionTrace trace = traceCollision(pair->placedA(), pair->placedB(), asked);
      return std::tuple(answerOf(trace.result), trace.a.size(), trace.b.size());
    });
  }
}

TEST(AllocationFailure, OfSearchesInThreads)
{
  std::vector<Point3> below, above; // which face each other, so that the searches are long enough to be shared
  for (int i = 0; i < 2500; ++i) {
    const double x = i % 50, y = 1.0 * (i / 50), bump = 0.3 * std::sin(1.0 * i);
    below.push_back({x, y, bump});
    above.push_back({x, y, 2 + bump});
  }
  const Cloud cloud_a(below), cloud_b(above);
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  const auto pair = [&] { return std::pair<Placed, Placed>(a, b); };
  test::Question asked = request(2);
  asked.clearance = 1.2;
  EXPECT_GT(closestPair(a, b, asked).work.node_pairs, 5000u);
  failEachAllocation(pair,
                     [&](const auto& placed) { return answerOf(anyCollision(placed.first, placed.second, asked)); });
  failEachAllocation(pair,
                     [&](const auto& placed) { return answerOf(closestPair(placed.first, placed.second, asked)); });
}

TEST(AllocationFailure, OfManyPoses)
{
  const FreshPair any(scan(), model());
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 9; ++i) // near each other, so that they share a search, from colliding to free
    poses.push_back(Eigen::Isometry3d(Eigen::Translation3d(0.3 * i, 0.01 * (i % 3), 0.0)) * any.T_world_b);
  for (const unsigned threads : {1u, 2u}) {
    failEachAllocation(freshPair, [&](const auto& pair) {
      return anyCollisionAtPoses(pair->placedA(), pair->b, poses, request(threads)).flags;
    });
    failEachAllocation(freshPair, [&](const auto& pair) {
      const DistancesAtPoses found = closestPairAtPoses(pair->placedA(), pair->b, poses, request(threads));
      return std::tuple(found.distances, found.pairs);
    });
  }
}

TEST(AllocationFailure, OfDistancesContactsAndPairs)
{
  failEachAllocation(freshPair,
                     [](const auto& pair) { return answerOf(closestPair(pair->placedA(), pair->placedB())); });
  failEachAllocation(freshPair, [](const auto& pair) {
    const ContactsResult found = nearestContacts(pair->placedA(), pair->placedB(), {request().clearance, 20});
    std::vector<double> answer{found.complete ? 1.0 : 0.0};
    for (const Contact& contact : found.contacts) answer.insert(answer.end(), {contact.distance, contact.normal.x()});
    return answer;
  });
  failEachAllocation(freshPair, [](const auto& pair) {
    PairsWithin found = pairsWithin(pair->placedA(), pair->placedB(), {request().clearance, 100000});
    std::sort(found.pairs.begin(), found.pairs.end());
    return std::tuple(found.pairs, found.complete);
  });
}

TEST(AllocationFailure, OfLessThanExactQueries)
{
  for (const Accuracy& accuracy : {Accuracy::tolerance(0.01), Accuracy::level(1), Accuracy::nodePairs(2000)}) {
    test::Question asked = request();
    asked.accuracy = accuracy;
    failEachAllocation(freshPair, [&](const auto& pair) {
      return std::tuple(answerOf(anyCollision(pair->placedA(), pair->placedB(), asked)),
                        answerOf(collisionFlags(pair->placedA(), pair->placedB(), asked)));
    });
    failEachAllocation(freshPair, [&](const auto& pair) {
      const DistanceResult found = closestPair(pair->placedA(), pair->placedB(), asked);
      return std::tuple(found.distance, found.interval.lower, found.interval.upper);
    });
  }
}

TEST(AllocationFailure, OfPointDistancesLeavesAUsableResult)
{
  struct Subject {
    std::unique_ptr<FreshPair> pair = freshPair();
    PointDistances result;
  };
  for (const unsigned threads : {1u, 2u}) {
    PointDistancesRequest asked;
    asked.max_distance = 0.5;
    asked.threads = threads;
    asked.accuracy = threads == 1 ? Accuracy::exact() : Accuracy::level(2);
    failEachAllocation([] { return Subject(); },
                       [&](Subject& subject) {
                         const Placed a = subject.pair->placedA(), b = subject.pair->placedB();
                         try {
                           pointDistances(a, b, asked, subject.result);
                         }
                         catch (const std::bad_alloc&) {
                           EXPECT_TRUE(subject.result.distance.empty() && subject.result.closest_point.empty());
                           throw;
                         }
                         return std::tuple(subject.result.closest_point, subject.result.measured,
                                           subject.result.undecided, subject.result.greatest_pair);
                       });
  }
  failEachAllocation(freshPair, [](const auto& pair) {
    const SymmetricDistances found = symmetricDistances(pair->placedA(), pair->placedB());
    return std::tuple(found.a.closest_point, found.b.closest_point, found.hausdorff_pair);
  });
}

TEST(AllocationFailure, OfTheHausdorffDistance)
{
  for (const unsigned threads : {1u, 2u}) {
    HausdorffRequest asked;
    asked.threads = threads;
    failEachAllocation(freshPair, [&](const auto& pair) {
      const HausdorffDistance found = hausdorffDistance(pair->placedA(), pair->placedB(), asked);
      return std::tuple(found.distance, found.pair);
    });
  }
}

TEST(AllocationFailure, OfTriangles)
{
  const Cloud corners = richCloud(4, 30);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i + 2 < 30; i += 3) triangles.push_back({i, i + 1, i + 2});
  const TrianglesView view{corners.view(), triangles[0].data(), triangles.size()};
  failEachAllocation([] { return 0; },
                     [&](int) {
                       const PointsView balls = viewOf(view);
                       return std::vector<float>(balls.radii, balls.radii + balls.count);
                     });
  failEachAllocation([] { return 0; }, [&](int) { return looseVertices(view); });
}

TEST(AllocationFailure, OfClustersClashesAndSpacing)
{
  const auto fresh = [] { return std::make_unique<SphereHierarchy>(scan().view(), fineOptions()); };
  failEachAllocation(fresh, [](const auto& cloud) {
    const Clusters clusters = euclideanClusters(*cloud, 0.1);
    return std::tuple(clusters.of, clusters.sizes);
  });
  failEachAllocation(fresh, [](const auto& cloud) {
    const Spacing spacing = spacingOf(*cloud);
    return std::tuple(spacing.samples, spacing.median, spacing.wide);
  });
  const TrajectoryResult found = [] {
    const auto pair = freshPair();
    TrajectoryRequest asked;
    asked.clearance = 0.1;
    asked.distances = asked.first_poses = asked.closest_poses = true;
    return collideAlong(pair->placedA(), pair->b, {pair->T_world_b}, asked);
  }();
  failEachAllocation([] { return 0; },
                     [&](int) {
                       std::vector<Clash> clashes = findClashes(scan().view(), found, 0.2);
                       const std::vector<Clash> earlier(clashes.begin() + 1, clashes.end());
                       compareWithEarlier(clashes, earlier, 0.1);
                       std::vector<std::string> ids;
                       for (const Clash& clash : clashes) ids.push_back(clash.id);
                       return ids;
                     });
}

std::vector<Eigen::Isometry3d> somePoses()
{
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 5; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0.4 * i - 3.0, 0.1, 0.05 * i));
    pose.rotate(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()));
    poses.push_back(pose);
  }
  return poses;
}

TEST(AllocationFailure, OfTrajectories)
{
  TrajectoryRequest everything;
  everything.clearance = 0.05;
  everything.distances = everything.first_poses = everything.closest_poses = everything.pose_summaries = true;
  TrajectoryRequest in_threads = everything;
  in_threads.threads = 2;
  TrajectoryRequest swept;
  swept.clearance = 0.05;
  swept.swept = 0.01;
  swept.first_poses = true;
  TrajectoryRequest at_level;
  at_level.clearance = 0.05;
  at_level.accuracy = Accuracy::level(2);
  const std::vector<Eigen::Isometry3d> poses = somePoses();
  for (const TrajectoryRequest& asked : {everything, in_threads, swept, at_level})
    failEachAllocation(
        freshPair, [&](const auto& pair) { return answerOf(collideAlong(pair->placedA(), pair->b, poses, asked)); });
}

TEST(AllocationFailure, OfManyMotions)
{
  const std::vector<Eigen::Isometry3d> poses = somePoses();
  std::vector<PoseMotion> motions;
  for (std::uint32_t k = 1; k < poses.size(); ++k) motions.insert(motions.end(), {{k - 1, k}, {k, 0}});
  for (const unsigned threads : {1u, 2u}) {
    MotionsRequest asked;
    asked.clearance = 0.01;
    asked.swept = 0.002;
    asked.threads = threads;
    failEachAllocation(freshPair, [&](const auto& pair) {
      return anyCollisionOnMotions(pair->placedA(), pair->b, poses, motions, asked).flags;
    });
  }
}

TEST(AllocationFailure, LeaksNothing)
{
  EXPECT_EQ(leakedBy([] {
              for (std::size_t k = 1; k < 400; k += 7) {
                const auto pair = freshPair();
                const FailingAllocation failing(k);
                try {
                  collisionFlags(pair->placedA(), pair->placedB(), request());
                }
                catch (const std::bad_alloc&) {
                }
              }
            }),
            0);
}

} // namespace
} // namespace pcl_bsh::test
