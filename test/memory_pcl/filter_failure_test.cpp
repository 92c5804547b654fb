// SPDX-License-Identifier: BSD-3-Clause
// Allocations of PCL's classes fail too, except for the points of typed clouds: those are Eigen's, not operator new's.
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "../filters/clouds.h"
#include "contents.h"
#include "support/every_allocation.h"
#include "support/verdicts.h"

#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>

namespace pcl_bsh::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Blob = pcl::PCLPointCloud2;
using Filter = CollisionFilter<pcl::PointXYZ>;
using BlobFilter = CollisionFilter<Blob>;

constexpr double kClearance = 0.1;
const std::string kFrame = "a frame's name, longer than what a string holds without allocating";

const Points& scan()
{
  static const Points points = [] {
    Points made = randomPoints(240, 1);
    made[7].y() = made[100].x() = std::numeric_limits<double>::quiet_NaN();
    return made;
  }();
  return points;
}
const Points& obstacle()
{
  static const Points points = randomPoints(120, 2, {0.3, 0.2, 0.1});
  return points;
}

Cloud::Ptr scanCloud()
{
  auto cloud = typedCloud<pcl::PointXYZ>(scan());
  cloud->width = 24, cloud->height = 10;
  cloud->header.frame_id = kFrame;
  return cloud;
}
Blob::Ptr scanBlob()
{
  auto blob = fieldCloud<double>(scan());
  blob->header.frame_id = kFrame;
  return blob;
}
Cloud::Ptr obstacleCloud()
{
  return typedCloud<pcl::PointXYZ>(obstacle());
}

std::vector<Eigen::Isometry3d> poses()
{
  return {Eigen::Isometry3d::Identity(), somePose()};
}

/// Whether the points collide at any of the poses, by a double loop.
std::vector<Verdict> truth(const std::vector<Eigen::Isometry3d>& at)
{
  std::vector<Verdict> flags(scan().size(), Verdict::free);
  for (const Eigen::Isometry3d& pose : at) {
    const std::vector<Verdict> one = doubleLoop(scan(), obstacle(), pose, kClearance);
    for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = graver(flags[i], one[i]);
  }
  return flags;
}

enum class Mode { plain, negative, organised, trajectory, swept, threads, subset };
constexpr Mode kModes[] = {Mode::plain, Mode::negative, Mode::organised, Mode::trajectory,
                           Mode::swept, Mode::threads,  Mode::subset};

void ask(CollisionSettings& query, Mode mode)
{
  query.setClearance(kClearance);
  if (mode == Mode::trajectory || mode == Mode::swept) query.setTrajectory(poses());
  if (mode == Mode::swept) query.setSwept(0.01);
}
void ask(DistanceSettings& query, Mode)
{
  query.setFilterLimits(0.05, kClearance);
}

template <typename AnyFilter, typename AnyCloud>
void set(AnyFilter& filter, const std::shared_ptr<AnyCloud>& input, Mode mode)
{
  filter.setInputCloud(input);
  filter.setObstacleCloud(obstacleCloud());
  ask(filter, mode);
  filter.setNegative(mode == Mode::negative);
  filter.setKeepOrganized(mode == Mode::organised);
  if (mode == Mode::threads) filter.setNumberOfThreads(2);
  if (mode == Mode::subset) filter.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{3, 7, 150, 20, 21, 22}));
}

/// Makes each allocation of act(subject) fail in turn, then checks, with all the memory there is.
/// @param check called with the subject and whether std::bad_alloc came
template <typename Make, typename Act, typename Check>
void underEachFailure(const Make& make, const Act& act, const Check& check)
{
  bool ever_thrown = false;
  act(*make()); // with all that is allocated once in a process
  for (const Shortage shortage : {Shortage::once, Shortage::lasting}) {
    for (std::size_t k = 1;; k = nextFailure(k, shortage)) {
      releaseRetainedMemory(); // scratch is allocated anew
      const auto subject = make();
      bool thrown = false, failed = false;
      {
        const FailingAllocation failing(k, shortage);
        try {
          act(*subject);
        }
        catch (const std::bad_alloc&) {
          thrown = true;
        }
        failed = failing.hasHappened();
      }
      SCOPED_TRACE("allocation " + std::to_string(k) + (thrown ? " threw" : " threw nothing"));
      check(*subject, thrown);
      ever_thrown = ever_thrown || thrown;
      if (!failed) {
        EXPECT_FALSE(thrown);
        break;
      }
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_TRUE(ever_thrown) << "nothing was tried";
}

template <typename AnyFilter, typename AnyCloud>
struct Subject {
  Subject(const std::shared_ptr<AnyCloud>& cloud, Mode mode) : input(cloud) { set(filter, input, mode); }

  AnyFilter filter{true};
  std::shared_ptr<AnyCloud> input;
  AnyCloud output;
  pcl::Indices kept{1, 2, 3};
};
using CloudSubject = Subject<Filter, Cloud>;
using BlobSubject = Subject<BlobFilter, Blob>;

class FilterAllocationFailure : public testing::Test {
protected:
  // PCL prints a line when there is no memory for the numbers of all points, and goes on without them.
  FilterAllocationFailure() { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  ~FilterAllocationFailure() override { pcl::console::setVerbosityLevel(pcl::console::L_INFO); }

  /// Filters make()'s input into its output, which stays as it was upon an error.
  template <typename Make>
  static void failIntoCloud(const Make& make)
  {
    auto undisturbed = make();
    const auto input = contentsOf(*undisturbed->input), output = contentsOf(undisturbed->output);
    undisturbed->filter.filter(undisturbed->output);
    const auto expected = contentsOf(undisturbed->output);
    const pcl::Indices removed = *undisturbed->filter.getRemovedIndices();

    underEachFailure(
        make, [](auto& subject) { subject.filter.filter(subject.output); },
        [&](auto& subject, bool thrown) {
          EXPECT_TRUE(contentsOf(*subject.input) == input);
          if (thrown) {
            EXPECT_TRUE(contentsOf(subject.output) == output);
            auto copy = subject.filter;
            subject.filter.filter(subject.output);
            auto copied_output = subject.output;
            copy.filter(copied_output);
            EXPECT_TRUE(contentsOf(copied_output) == expected);
            EXPECT_EQ(*copy.getRemovedIndices(), removed);
          }
          EXPECT_TRUE(contentsOf(subject.output) == expected);
          EXPECT_EQ(*subject.filter.getRemovedIndices(), removed);
        });
  }

  template <typename Make>
  static void failInPlace(const Make& make)
  {
    auto undisturbed = make();
    const auto input = contentsOf(*undisturbed->input);
    undisturbed->filter.filter(undisturbed->output);
    const auto expected = contentsOf(undisturbed->output);

    underEachFailure(
        make, [](auto& subject) { subject.filter.filter(*subject.input); },
        [&](auto& subject, bool thrown) {
          if (thrown) {
            EXPECT_TRUE(contentsOf(*subject.input) == input);
            subject.filter.filter(*subject.input);
          }
          EXPECT_TRUE(contentsOf(*subject.input) == expected);
        });
  }
};

TEST_F(FilterAllocationFailure, IntoClouds)
{
  for (const Mode mode : kModes) failIntoCloud([mode] { return std::make_unique<CloudSubject>(scanCloud(), mode); });
}

TEST_F(FilterAllocationFailure, IntoBlobs)
{
  for (const Mode mode : kModes) failIntoCloud([mode] { return std::make_unique<BlobSubject>(scanBlob(), mode); });
}

TEST_F(FilterAllocationFailure, IntoFieldsOfBlobs)
{
  for (const Mode mode : {Mode::plain, Mode::trajectory})
    failIntoCloud([mode] {
      auto subject = std::make_unique<BlobSubject>(scanBlob(), mode);
      subject->filter.setKeepFlagged(true);
      return subject;
    });
}

TEST_F(FilterAllocationFailure, InPlace)
{
  for (const Mode mode : {Mode::plain, Mode::organised}) {
    failInPlace([mode] { return std::make_unique<CloudSubject>(scanCloud(), mode); });
    failInPlace([mode] { return std::make_unique<BlobSubject>(scanBlob(), mode); });
  }
}

TEST_F(FilterAllocationFailure, IntoIndices)
{
  for (const Mode mode : {Mode::plain, Mode::negative, Mode::trajectory}) {
    const std::vector<Verdict> flags =
        truth(mode == Mode::trajectory ? poses() : std::vector{Eigen::Isometry3d::Identity()});
    const pcl::Indices expected = where(flags, mode == Mode::negative, scan());
    ASSERT_FALSE(expected.empty());
    ASSERT_LT(expected.size(), scan().size() - 2);
    const auto fail = [&](const auto& make) {
      underEachFailure(
          make, [](auto& subject) { subject.filter.filter(subject.kept); },
          [&](auto& subject, bool thrown) {
            if (thrown) {
              EXPECT_EQ(subject.kept, (pcl::Indices{1, 2, 3}));
              subject.filter.filter(subject.kept);
            }
            EXPECT_EQ(subject.kept, expected);
            EXPECT_EQ(subject.filter.getRemovedIndices()->size(), scan().size() - expected.size());
          });
    };
    fail([mode] { return std::make_unique<CloudSubject>(scanCloud(), mode); });
    fail([mode] { return std::make_unique<BlobSubject>(scanBlob(), mode); });
  }
}

TEST_F(FilterAllocationFailure, OfFlagsAndTrajectories)
{
  for (const Mode mode : {Mode::plain, Mode::trajectory, Mode::swept})
    failEachAllocation([mode] { return std::make_unique<CloudSubject>(scanCloud(), mode); },
                       [](const auto& subject) {
                         std::vector<Verdict> flags{Verdict::sparse};
                         subject->filter.computeFlags(flags);
                         TrajectoryResult result;
                         subject->filter.computeTrajectory(result);
                         return std::tuple(flags, result.flags, bitsOf(result.distance), result.first_pose,
                                           result.closest_pose, result.poses.size());
                       });
}

/// A setting is as before, or is set.
TEST_F(FilterAllocationFailure, OfSettings)
{
  const pcl::Indices at_first = where(truth({Eigen::Isometry3d::Identity(), somePose()}), false, scan());
  const pcl::Indices at_second = where(truth({somePose()}), false, scan());
  ASSERT_NE(at_first, at_second);
  failEachAllocation([] { return std::make_unique<CloudSubject>(scanCloud(), Mode::trajectory); },
                     [&](const auto& subject) {
                       std::vector<Eigen::Isometry3d> second{somePose()};
                       subject->filter.setTrajectory(second);
                       subject->filter.setObstacleCloud(obstacleCloud());
                       subject->filter.setProgress([second](double) { return !second.empty(); });
                       subject->filter.filter(subject->kept);
                       return subject->kept == at_second;
                     });
  underEachFailure([] { return std::make_unique<CloudSubject>(scanCloud(), Mode::trajectory); },
                   [](auto& subject) {
                     subject.filter.setTrajectory({6, somePose()});
                   },
                   [&](auto& subject, bool thrown) {
                     subject.filter.filter(subject.kept);
                     EXPECT_EQ(subject.kept, thrown ? at_first : at_second);
                   });
}

/// The input that was set before stays.
TEST_F(FilterAllocationFailure, OfInputsOfBlobs)
{
  underEachFailure(
      [] { return std::make_unique<BlobSubject>(std::make_shared<Blob>(), Mode::plain); },
      [cloud = scanBlob()](auto& subject) { subject.filter.setInputCloud(cloud); },
      [](auto& subject, bool thrown) { EXPECT_EQ(subject.filter.getInputCloud() == subject.input, thrown); });
}

/// The indices that were set before stay.
TEST_F(FilterAllocationFailure, OfRectangles)
{
  for (const bool set_before : {false, true}) {
    const auto make = [set_before] {
      auto subject = std::make_unique<CloudSubject>(scanCloud(), Mode::plain);
      if (set_before) subject->filter.setIndices(0, 20, 1, 3);
      return subject;
    };
    const auto kept = [](CloudSubject& subject) {
      subject.filter.filter(subject.kept);
      return subject.kept;
    };
    const auto set_rectangle = [](CloudSubject& subject) { subject.filter.setIndices(0, 4, 1, 9); };
    const pcl::Indices of_former = kept(*make());
    const auto undisturbed = make();
    set_rectangle(*undisturbed);
    const pcl::Indices of_rectangle = kept(*undisturbed);
    ASSERT_NE(of_former, of_rectangle);
    underEachFailure(make, set_rectangle, [&](CloudSubject& subject, bool thrown) {
      EXPECT_EQ(kept(subject), thrown ? of_former : of_rectangle);
    });
  }
}

/// Two filters that have found something, each with an obstacle, a trajectory and a listener of its own.
template <typename AnyFilter, typename AnyCloud>
struct Pair {
  explicit Pair(const std::function<std::shared_ptr<AnyCloud>()>& input)
  : from(input(), Mode::trajectory),
    to(input(), Mode::negative)
  {
    const std::vector<int> listener(100, 1);
    from.filter.setProgress([listener](double) { return !listener.empty(); });
    to.filter.setObstacleCloud(typedCloud<pcl::PointXYZ>(randomPoints(40, 9)));
    for (auto* const subject : {&from, &to}) subject->filter.filter(subject->kept);
  }

  Subject<AnyFilter, AnyCloud> from, to;
};

/// A filter that could not become a copy is what it was, all of it, and shares nothing that either writes.
template <typename AnyFilter, typename AnyCloud>
void failAssignments(const std::function<std::shared_ptr<AnyCloud>()>& input)
{
  const auto make = [&] { return std::make_unique<Pair<AnyFilter, AnyCloud>>(input); };
  const auto pair = make();
  const pcl::Indices from_kept = pair->from.kept, from_removed = *pair->from.filter.getRemovedIndices();
  const pcl::Indices to_kept = pair->to.kept, to_removed = *pair->to.filter.getRemovedIndices();
  ASSERT_NE(from_kept, to_kept);
  ASSERT_NE(from_removed, to_removed);

  underEachFailure(
      make, [](auto& subject) { subject.to.filter = subject.from.filter; },
      [&](auto& subject, bool thrown) {
        auto& [from, to] = subject;
        EXPECT_EQ(*to.filter.getRemovedIndices(), thrown ? to_removed : from_removed);
        EXPECT_NE(to.filter.getRemovedIndices(), from.filter.getRemovedIndices());
        EXPECT_NE(to.filter.getIndices(), from.filter.getIndices());
        EXPECT_EQ(to.filter.getInputCloud(), thrown ? to.input : from.input);
        EXPECT_EQ(to.filter.getNegative(), thrown);
        EXPECT_EQ(to.filter.getQuestion().path.has_value(), !thrown);
        to.filter.filter(to.kept);
        EXPECT_EQ(to.kept, thrown ? to_kept : from_kept);
        EXPECT_EQ(*from.filter.getRemovedIndices(), from_removed);
        from.filter.filter(from.kept);
        EXPECT_EQ(from.kept, from_kept);
        EXPECT_EQ(*to.filter.getRemovedIndices(), thrown ? to_removed : from_removed);
      });
  underEachFailure(
      make, [](auto& subject) { AnyFilter copy(subject.from.filter); },
      [&](auto& subject, bool) {
        EXPECT_EQ(*subject.from.filter.getRemovedIndices(), from_removed);
        subject.from.filter.filter(subject.from.kept);
        EXPECT_EQ(subject.from.kept, from_kept);
      });
}

TEST_F(FilterAllocationFailure, OfCopies)
{
  failAssignments<Filter, Cloud>(scanCloud);
  failAssignments<BlobFilter, Blob>(scanBlob);
}

using DistanceSubject = Subject<DistanceFilter<pcl::PointXYZ>, Cloud>;
using DistanceBlobSubject = Subject<DistanceFilter<Blob>, Blob>;

TEST_F(FilterAllocationFailure, OfDistances)
{
  for (const Mode mode : {Mode::plain, Mode::negative, Mode::threads, Mode::subset})
    failIntoCloud([mode] { return std::make_unique<DistanceSubject>(scanCloud(), mode); });
  for (const Mode mode : {Mode::plain, Mode::organised})
    failIntoCloud([mode] { return std::make_unique<DistanceBlobSubject>(scanBlob(), mode); });
  failInPlace([] { return std::make_unique<DistanceBlobSubject>(scanBlob(), Mode::plain); });
  failEachAllocation([] { return std::make_unique<DistanceSubject>(scanCloud(), Mode::plain); },
                     [](const auto& subject) {
                       PointDistances result;
                       subject->filter.computeDistances(result);
                       return std::tuple(bitsOf(result.distance), result.closest_point, result.greatest);
                     });
}

/// Through a reference to PCL's class, whose filter() and setInputCloud() are called.
template <typename PointT, typename AnySubject, typename AnyCloud>
void failThroughPcl(const std::shared_ptr<AnyCloud>& cloud, Mode mode)
{
  const auto make = [&] { return std::make_unique<AnySubject>(cloud, mode); };
  const auto undisturbed = make();
  undisturbed->filter.filter(undisturbed->output);
  undisturbed->filter.filter(undisturbed->kept);
  ASSERT_FALSE(undisturbed->kept.empty());
  ASSERT_LT(undisturbed->kept.size(), scan().size());
  const auto into_cloud = [](AnySubject& subject) {
    pcl::Filter<PointT>& base = subject.filter;
    base.filter(subject.output);
  };
  const auto into_indices = [](AnySubject& subject) {
    pcl::FilterIndices<PointT>& base = subject.filter;
    base.filter(subject.kept);
  };
  underEachFailure(make, into_cloud, [&](AnySubject& subject, bool thrown) {
    if (thrown) into_cloud(subject);
    EXPECT_TRUE(contentsOf(subject.output) == contentsOf(undisturbed->output));
  });
  underEachFailure(make, into_indices, [&](AnySubject& subject, bool thrown) {
    if (thrown) into_indices(subject);
    EXPECT_EQ(subject.kept, undisturbed->kept);
  });
  if constexpr (!std::is_same_v<AnyCloud, Blob>) { // PCL's setInputCloud() is virtual
    const auto make_without_input = [&] {
      auto subject = make();
      subject->filter.setInputCloud(std::make_shared<AnyCloud>());
      return subject;
    };
    const auto set_and_filter = [&](AnySubject& subject) {
      pcl::Filter<PointT>& base = subject.filter;
      base.setInputCloud(cloud);
      base.filter(subject.output);
    };
    underEachFailure(make_without_input, set_and_filter, [&](AnySubject& subject, bool thrown) {
      if (thrown) set_and_filter(subject);
      EXPECT_TRUE(contentsOf(subject.output) == contentsOf(undisturbed->output));
    });
  }
}

TEST_F(FilterAllocationFailure, ThroughPclsClasses)
{
  for (const Mode mode : {Mode::plain, Mode::negative, Mode::organised, Mode::subset}) {
    failThroughPcl<pcl::PointXYZ, CloudSubject>(scanCloud(), mode);
    failThroughPcl<Blob, BlobSubject>(scanBlob(), mode);
    failThroughPcl<pcl::PointXYZ, DistanceSubject>(scanCloud(), mode);
    failThroughPcl<Blob, DistanceBlobSubject>(scanBlob(), mode);
  }
}

/// PCL numbers the points anew: of an input that has grown since it was set, and where indices were taken away.
TEST_F(FilterAllocationFailure, OfPointsThatPclNumbers)
{
  const auto grown = [] {
    const Cloud::Ptr cloud = scanCloud();
    auto subject = std::make_unique<CloudSubject>(cloud, Mode::plain);
    for (const pcl::PointXYZ& point : *obstacleCloud()) cloud->push_back(point);
    return subject;
  };
  const auto unset = [] {
    auto subject = std::make_unique<CloudSubject>(scanCloud(), Mode::subset);
    subject->filter.setIndices(pcl::IndicesPtr());
    return subject;
  };
  const auto filtered = [](const auto& subject) {
    subject->filter.filter(subject->output);
    subject->filter.filter(subject->kept);
    return std::tuple(contentsOf(subject->output), subject->kept);
  };
  EXPECT_GT(failEachAllocation(grown, filtered), 0U);
  EXPECT_GT(failEachAllocation(unset, filtered), 0U);
}

TEST_F(FilterAllocationFailure, OfCopiesOfDistances)
{
  const auto make = [] {
    auto pair = std::make_unique<std::pair<DistanceSubject, DistanceSubject>>(
        std::piecewise_construct, std::forward_as_tuple(scanCloud(), Mode::plain),
        std::forward_as_tuple(scanCloud(), Mode::negative));
    const std::vector<int> listener(100, 1);
    pair->first.filter.setProgress([listener](double) { return !listener.empty(); });
    for (DistanceSubject* const subject : {&pair->first, &pair->second}) subject->filter.filter(subject->kept);
    return pair;
  };
  const auto pair = make();
  const pcl::Indices from_kept = pair->first.kept, to_kept = pair->second.kept;
  const pcl::Indices to_removed = *pair->second.filter.getRemovedIndices();
  ASSERT_NE(from_kept, to_kept);
  underEachFailure(
      make, [](auto& subject) { subject.second.filter = subject.first.filter; },
      [&](auto& subject, bool thrown) {
        auto& [from, to] = subject;
        EXPECT_EQ(*to.filter.getRemovedIndices() == to_removed, thrown);
        EXPECT_NE(to.filter.getRemovedIndices(), from.filter.getRemovedIndices());
        EXPECT_EQ(to.filter.getInputCloud(), thrown ? to.input : from.input);
        to.filter.filter(to.kept);
        EXPECT_EQ(to.kept, thrown ? to_kept : from_kept);
        from.filter.filter(from.kept);
        EXPECT_EQ(from.kept, from_kept);
      });
}

TEST_F(FilterAllocationFailure, LeaksNothing)
{
  for (const Mode mode : {Mode::plain, Mode::trajectory})
    EXPECT_EQ(leakedBy([mode] {
                underEachFailure([mode] { return std::make_unique<BlobSubject>(scanBlob(), mode); },
                                 [](auto& subject) { subject.filter.filter(subject.output); }, [](auto&, bool) {});
              }),
              0);
}

} // namespace
} // namespace pcl_bsh::test
