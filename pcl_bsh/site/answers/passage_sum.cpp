// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/answers/passage_sum.h>
#include <pcl_bsh/site/answers/tile_query.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh::site {

namespace {

/// Stands for no contact: later than all poses. Its number, like the numbers of poses, is exact as a double.
constexpr FirstContact no_contact = {std::size_t{1} << 53, 1.0};

/// None where no rank has a contact.
std::optional<FirstContact> earliestOfAllRanks(const FirstContact& own)
{
  const double pose = leastOfAllRanks(static_cast<double>(own.pose));
  const bool mine = static_cast<double>(own.pose) == pose;
  const FirstContact earliest = {static_cast<std::size_t>(pose), leastOfAllRanks(mine ? own.fraction : 1.0)};
  return earliest.pose == no_contact.pose ? std::nullopt : std::optional(earliest);
}

/// Adds the summaries of other points of the site.
void addPoses(std::vector<PoseSummary>& poses, const std::vector<PoseSummary>& more)
{
  poses.resize(std::max(poses.size(), more.size()));
  for (std::size_t k = 0; k < more.size(); ++k) poses[k] += more[k];
}

void append(std::vector<double>& numbers, const std::vector<PoseSummary>& poses)
{
  for (const PoseSummary& pose : poses) {
    numbers.insert(numbers.end(), {pose.colliding ? 1.0 : 0.0, static_cast<double>(pose.colliding_points),
                                   static_cast<double>(pose.undecided_points), pose.distance});
  }
}

std::vector<PoseSummary> posesOf(const std::vector<double>& numbers, std::size_t begin, std::size_t end)
{
  std::vector<PoseSummary> poses;
  for (std::size_t i = begin; i < end; i += 4) {
    poses.push_back({numbers[i] != 0.0, static_cast<std::size_t>(numbers[i + 1]),
                     static_cast<std::size_t>(numbers[i + 2]), numbers[i + 3]});
  }
  return poses;
}

std::vector<PoseSummary> summedOverAllRanks(const std::vector<PoseSummary>& own)
{
  const std::vector<PoseSummary> all = gatheredFromAllRanks(own);
  std::vector<PoseSummary> sum(own.size());
  for (std::size_t i = 0; i < all.size(); ++i) sum[i % own.size()] += all[i];
  return sum;
}

} // namespace

std::vector<Point3> cornersOf(const Site& site)
{
  if (!site.bounds) return {};
  return {site.bounds->low, site.bounds->high};
}

TrajectoryRequest alongPath(const QuestionPart& part)
{
  const Question& question = part.question;
  const Wanted& of_all = question.wanted;
  auto wanted = wantedOf<TrajectoryRequest>(question);
  const bool closest = of_all.closest && !question.accuracy.stopsEarly(); // a search that stops early has no distances
  wanted.distances = of_all.contacts || of_all.first_poses || closest;
  wanted.first_poses = wanted.closest_poses = wanted.distances;
  wanted.swept = question.sweptTolerance();
  wanted.pose_summaries = of_all.poses;
  return wanted;
}

PathReach pathReach(const TrajectoryRequest& request)
{
  PathReach reach;
  reach.distance = request.clearance + request.swept.value_or(0.0); // colliding is what comes within both
  reach.moves = request.swept.has_value();
  return reach;
}

void refusePassage(const Site& site, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                   const TrajectoryRequest& request)
{
  const std::vector<Point3> corners = cornersOf(site);
  const SphereHierarchy scan(viewOf(corners.empty() ? nullptr : corners.front().data(), corners.size()));
  collideAlong({scan}, model, poses, request);
}

FirstContact earlier(const FirstContact& a, const FirstContact& b)
{
  return std::pair(b.pose, b.fraction) < std::pair(a.pose, a.fraction) ? b : a;
}

PassageSum::PassageSum(const QuestionPart& part, std::size_t poses)
: clashes_(part.means.clashes),
  least_(infinity),
  first_(infinity),
  contact_(no_contact),
  certain_(no_contact)
{
  if (part.question.wanted.poses) poses_.resize(poses);
}

std::vector<double> PassageSum::numbersOf(const Tile& tile, const pcl::PCLPointCloud2& cloud,
                                          const CollidingRecords& some, const std::vector<MetPoint>* met) const
{
  const TrajectoryResult& found = some.found;
  double nearest = infinity, earliest = infinity;
  for (std::size_t i = 0; i < found.distance.size(); ++i) {
    if (found.flags[i] == Verdict::free) continue;
    nearest = std::min(nearest, double{found.distance[i]});
    earliest = std::min(earliest, static_cast<double>(found.first_pose[i]));
  }
  std::vector<double> numbers = {static_cast<double>(found.colliding), static_cast<double>(found.undecided), nearest,
                                 earliest};
  for (const auto& contact : {found.first_contact, found.certain_contact})
    numbers.insert(numbers.end(),
                   {static_cast<double>(contact.value_or(no_contact).pose), contact.value_or(no_contact).fraction});
  append(numbers, found.poses);
  if (clashes_ == nullptr) return numbers;
  const std::vector<double> of_clashes = clashes_->numbersOf(tile, cloud, some, met);
  numbers.insert(numbers.end(), of_clashes.begin(), of_clashes.end());
  return numbers;
}

void PassageSum::add(const std::vector<double>& numbers)
{
  colliding_ += static_cast<std::uint64_t>(numbers[0]);
  undecided_ += static_cast<std::uint64_t>(numbers[1]);
  least_ = std::min(least_, numbers[2]);
  first_ = std::min(first_, numbers[3]);
  contact_ = earlier(contact_, {static_cast<std::size_t>(numbers[4]), numbers[5]});
  certain_ = earlier(certain_, {static_cast<std::size_t>(numbers[6]), numbers[7]});
  const std::size_t end = 8 + 4 * poses_.size();
  addPoses(poses_, posesOf(numbers, 8, end));
  if (clashes_ != nullptr) clashes_->add(numbers, end);
}

void PassageSum::tell(SiteAnswer& answer)
{
  TrajectoryResult& found = answer.collisions;
  found.colliding = sumOfAllRanks(colliding_);
  found.undecided = sumOfAllRanks(undecided_);
  if (!poses_.empty()) found.poses = summedOverAllRanks(poses_);
  answer.closest.distance = leastOfAllRanks(least_);
  if (const double first = leastOfAllRanks(first_); first < infinity)
    answer.first_pose = static_cast<std::size_t>(first);
  found.first_contact = earliestOfAllRanks(contact_);
  found.certain_contact = earliestOfAllRanks(certain_);
}

} // namespace pcl_bsh::site
