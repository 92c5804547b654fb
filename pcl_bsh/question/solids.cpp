// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/solids.h>

#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/question/enclosed.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/solid/poses_inside.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh {
namespace {

const SolidBodies& solidOf(Shape& shape, const char* option)
{
  if (!shape.isSurface())
    throw InvalidOption(option, shape.name() + " has no faces", "give a mesh that closes, or leave it out");
  return shape.solid();
}

/// A record that is inside at a pose touches there at the latest: takes the pose, unless an earlier contact is known.
void takeContact(std::optional<FirstContact>& contact, std::size_t pose)
{
  if (!contact || contact->pose >= pose) contact = FirstContact{pose, 0.0};
}

void count(FlagsResult& found)
{
  found.colliding_a = countOf(found.a, Verdict::colliding);
  found.colliding_b = countOf(found.b, Verdict::colliding);
  found.undecided_a = countOf(found.a, Verdict::undecided);
  found.undecided_b = countOf(found.b, Verdict::undecided);
}

/// Takes the graver verdict of each record.
void merge(std::vector<Verdict>& verdicts, const std::vector<Verdict>& others)
{
  for (std::size_t i = 0; i < others.size(); ++i) verdicts[i] = graver(verdicts[i], others[i]);
}

} // namespace

Solids::Solids(const Question& question, Shape& input, Shape& obstacle, const Placed& a, const Placed& b)
: question_(question),
  a_(a),
  b_(b),
  uncertain_(areUncertain(a, b))
{
  if (question.solid) pairings_.push_back({true, solidOf(obstacle, "solid"), input.queried(), {}});
  if (question.input_solid) pairings_.push_back({false, solidOf(input, "input_solid"), obstacle.queried(), {}});
}

Solids::Records Solids::enclosedAt(const Pairing& pair, const Eigen::Isometry3d& pose, Work& work) const
{
  return enclosedBy({pair.solid.whole(), poseOfSolid(pair, pose)}, pair.queried, poseOfQueried(pair, pose),
                    question_.threads, &work);
}

const Solids::Records& Solids::enclosed(Pairing& pair, Work& work)
{
  if (!pair.enclosed) pair.enclosed = enclosedAt(pair, b_.pose, work);
  return *pair.enclosed;
}

/// Adds the records that one solid holds. @param found has the verdicts of the surfaces
void Solids::add(const Pairing& pair, const Eigen::Isometry3d& pose, const Records& enclosed, FlagsResult& found) const
{
  addEnclosed(pair.solid, poseOfSolid(pair, pose), pair.queried, poseOfQueried(pair, pose), enclosed, uncertain_,
              pair.of_obstacle ? found.a : found.b, pair.of_obstacle ? found.b : found.a, &found.work);
}

FlagsRequest Solids::request(FlagsRequest request) const
{
  if (uncertain_ && !none()) request.flagged = Flagged::both;
  return request;
}

void Solids::addTo(FlagsResult& found)
{
  const std::vector<Verdict> a = found.a, b = found.b; // of the surfaces, for each of two solids
  for (Pairing& pair : pairings_) {
    FlagsResult of_pair;
    of_pair.a = a;
    of_pair.b = b;
    add(pair, b_.pose, enclosed(pair, found.work), of_pair);
    found.work += of_pair.work;
    merge(found.a, of_pair.a);
    merge(found.b, of_pair.b);
  }
  count(found);
}

void Solids::addTo(AnyResult& found, const Eigen::Isometry3d& pose)
{
  for (const Pairing& pair : pairings_) {
    if (found.verdict == Verdict::colliding) return;
    const Eigen::Isometry3d of_solid = poseOfSolid(pair, pose), of_queried = poseOfQueried(pair, pose);
    std::optional<PointPair> met;
    if (uncertain_ && found.verdict == Verdict::undecided) {
      const FlagsResult surface = flagsOfQueried(pair, pose);
      found.work += surface.work;
      const Records certain =
          certainlyEnclosed(enclosedAt(pair, pose, found.work), pair.of_obstacle ? surface.a : surface.b);
      if (!certain.empty())
        met = PointPair{certain.front(),
                        holderOf(pair.solid, of_solid, pair.queried, of_queried, certain.front(), &found.work)};
    }
    else {
      met = findEnclosed(pair.solid, of_solid, pair.queried, of_queried, &found.work);
    }
    if (!met) continue;
    found.verdict = Verdict::colliding;
    found.pair = pair.of_obstacle ? *met : PointPair{met->b, met->a};
    found.interval = {-std::numeric_limits<double>::infinity(), 0.0};
  }
}

/// Returns the verdicts of the queried thing against the surface of the solid.
FlagsResult Solids::flagsOfQueried(const Pairing& pair, const Eigen::Isometry3d& pose) const
{
  return collisionFlags(
      a_, {b_.hierarchy(), pose},
      {question_.clearance.value_or(0.0), pair.of_obstacle ? Flagged::a : Flagged::b, question_.threads});
}

Solids::FirstPoses Solids::firstPoses(const Pairing& pair, Work& work) const
{
  const std::vector<Eigen::Isometry3d> poses = question_.poses();
  if (!uncertain_ && pair.of_obstacle && !pair.queried.isSurface()) {
    PosesInside inside = findPosesInside(a_, pair.solid.whole(), poses, question_.threads);
    work += inside.work;
    return {inside.first, inside.first};
  }
  const std::size_t count = a_.hierarchy().view().count;
  FirstPoses first = {std::vector<std::uint32_t>(count, kNothing), std::vector<std::uint32_t>(count, kNothing)};
  for (std::uint32_t k = 0; k < poses.size(); ++k) {
    const Records enclosed = enclosedAt(pair, poses[k], work);
    if (enclosed.empty()) continue;
    Records certain = enclosed;
    if (uncertain_) {
      const FlagsResult surface = flagsOfQueried(pair, poses[k]);
      work += surface.work;
      certain = certainlyEnclosed(enclosed, pair.of_obstacle ? surface.a : surface.b);
    }
    const auto note = [&](const Records& records, std::vector<std::uint32_t>& poses_of) {
      const Records of_input =
          pair.of_obstacle ? records : holdersOf(pair.solid, a_.pose, pair.queried, poses[k], records, &work);
      for (const std::uint32_t record : of_input) poses_of[record] = std::min(poses_of[record], k);
    };
    note(enclosed, first.possible);
    note(certain, first.certain);
  }
  return first;
}

/// Finds the other record of a pair, for records of the input. For a record that is enclosed at its pose, it is a
/// triangle of the body that holds it. For a triangle whose body holds something there, it is the first record of the
/// obstacle that the body holds. Enclosed records of a pose are found once.
/// @param at poses and records @param others of the records: set
void Solids::findOthers(const Pairing& pair, std::vector<PoseRecord> at, const std::vector<Eigen::Isometry3d>& poses,
                        std::vector<std::uint32_t>& others, Work& work) const
{
  std::sort(at.begin(), at.end());
  for (auto first = at.begin(); first != at.end();) {
    const std::uint32_t pose = first->first;
    const auto last = std::find_if(first, at.end(), [&](const PoseRecord& other) { return other.first != pose; });
    if (pair.of_obstacle) {
      for (; first != last; ++first)
        others[first->second] = holderOf(pair.solid, poses[pose], pair.queried, a_.pose, first->second, &work);
      continue;
    }
    for (auto i = first; i != last; ++i) others[i->second] = kNothing;
    std::size_t left = static_cast<std::size_t>(last - first);
    for (const std::uint32_t enclosed : enclosedAt(pair, poses[pose], work)) {
      const Records holders = holdersOf(pair.solid, a_.pose, pair.queried, poses[pose], {enclosed}, &work);
      for (auto i = first; i != last; ++i) {
        if (others[i->second] != kNothing || !std::binary_search(holders.begin(), holders.end(), i->second)) continue;
        others[i->second] = enclosed;
        --left;
      }
      if (left == 0) break;
    }
    first = last;
  }
}

void Solids::addToPath(TrajectoryResult& found, Work& work, const Point3& pivot) const
{
  const auto takeFirst = [](std::vector<std::int32_t>& poses, std::size_t i, std::uint32_t pose) {
    if (!poses.empty() && (poses[i] < 0 || poses[i] > static_cast<std::int32_t>(pose)))
      poses[i] = static_cast<std::int32_t>(pose);
  };
  if (none()) return;
  const std::vector<Eigen::Isometry3d> poses = question_.poses();
  std::vector<double> at_poses(found.poses.size(), 0.0);
  for (const Pairing& pair : pairings_) {
    const FirstPoses first = firstPoses(pair, work);
    for (std::size_t i = 0; i < first.possible.size(); ++i) {
      if (first.possible[i] == kNothing) continue;
      const bool certain = first.certain[i] != kNothing;
      if (!found.flags.empty())
        found.flags[i] = graver(found.flags[i], certain ? Verdict::colliding : Verdict::undecided);
      takeFirst(found.first_pose, i, first.possible[i]);
      if (certain) takeFirst(found.certain_pose, i, first.certain[i]);
      if (question_.swept > 0.0) takeContact(found.first_contact, first.possible[i]);
      if (question_.swept > 0.0 && certain && !found.certain_pose.empty())
        takeContact(found.certain_contact, first.certain[i]);
    }
    addDepths(pair, first, poses, pivot, found, at_poses, work);
  }
  found.colliding = countOf(found.flags, Verdict::colliding);
  found.undecided = countOf(found.flags, Verdict::undecided);
  for (std::size_t k = 0; k < found.poses.size(); ++k) addToSummary(found.poses[k], poses[k], at_poses[k], work);
}

/// Counts the union of records near the surface and records that are enclosed. Only the flags of all records tell it.
void Solids::addToSummary(PoseSummary& summary, const Eigen::Isometry3d& pose, double depth, Work& work) const
{
  if (depth > 0.0) summary.distance = std::min(summary.distance, -depth);
  bool any = false;
  FlagsResult joined;
  for (const Pairing& pair : pairings_) {
    const Records enclosed = enclosedAt(pair, pose, work);
    any |= !enclosed.empty();
    if (enclosed.empty()) continue;
    FlagsResult found = collisionFlags(a_, {b_.hierarchy(), pose},
                                       request({question_.clearance.value_or(0.0), Flagged::a, question_.threads}));
    add(pair, pose, enclosed, found);
    work += found.work;
    if (joined.a.empty())
      joined.a = std::move(found.a);
    else
      merge(joined.a, found.a);
  }
  if (!any) return;
  summary.distance = std::min(summary.distance, 0.0);
  summary.colliding_points = countOf(joined.a, Verdict::colliding);
  summary.undecided_points = countOf(joined.a, Verdict::undecided);
  summary.colliding = summary.colliding_points > 0;
}

namespace {

/// Calls add(solids) with both things as they are placed. Does nothing where neither is solid.
template <class Add>
void withSolids(const Question& question, Shape& input, Shape& obstacle, const Add& add)
{
  if (!question.solid && !question.input_solid) return;
  const Placed b(obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads), question.pose);
  const Placed a(input.hierarchy(question.uncertaintyOfInput(), question.threads), question.pose_of_input);
  Solids solids(question, input, obstacle, a, b);
  add(solids);
}

} // namespace

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, TrajectoryResult& found, const Point3& pivot)
{
  withSolids(question, input, obstacle, [&](const Solids& solids) { solids.addToPath(found, found.work, pivot); });
}

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, const std::vector<Eigen::Isometry3d>& poses,
                 std::vector<Verdict>& verdicts)
{
  withSolids(question, input, obstacle, [&](Solids& solids) {
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      AnyResult at_pose;
      at_pose.verdict = verdicts[i];
      solids.addTo(at_pose, poses[i]);
      verdicts[i] = at_pose.verdict;
    }
  });
}

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, const std::vector<Eigen::Isometry3d>& poses,
                 std::vector<double>& distances, std::vector<PointPair>& pairs)
{
  if (pairs.empty()) return; // one of them has nothing that could be enclosed
  withSolids(question, input, obstacle, [&](Solids& solids) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      DistanceResult closest;
      closest.distance = distances[i];
      closest.pair = pairs[i];
      solids.turn(closest, poses[i]);
      distances[i] = closest.distance;
      pairs[i] = *closest.pair;
    }
  });
}

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, DistanceResult& closest)
{
  withSolids(question, input, obstacle, [&](Solids& solids) { solids.turn(closest); });
}

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, PointDistances& distances)
{
  withSolids(question, input, obstacle, [&](Solids& solids) {
    SymmetricDistances both;
    both.a = std::move(distances);
    solids.turn(both, false);
    distances = std::move(both.a);
  });
}

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, AnyResult& found)
{
  withSolids(question, input, obstacle, [&](Solids& solids) { solids.addTo(found); });
}

void addEnclosed(const Question& question, Shape& input, Shape& obstacle, FlagsResult& found)
{
  withSolids(question, input, obstacle, [&](Solids& solids) { solids.addTo(found); });
}

DistanceResult closestPair(const Placed& a, const Placed& b, const SolidDistanceRequest& request)
{
  DistanceResult closest = closestPair(a, b, static_cast<const DistanceRequest&>(request));
  if (!request.solid && !request.input_solid) return closest;
  Question question;
  question.pose = b.pose;
  question.pose_of_input = a.pose;
  question.threads = request.threads;
  question.solid = request.solid;
  question.input_solid = request.input_solid;
  const auto shape = [](const char* name, const SphereHierarchy& hierarchy) {
    return Shape(name, {std::shared_ptr<const void>(), &hierarchy});
  };
  Shape input = shape("a", a.hierarchy()), obstacle = shape("b", b.hierarchy());
  addEnclosed(question, input, obstacle, closest);
  return closest;
}

} // namespace pcl_bsh
