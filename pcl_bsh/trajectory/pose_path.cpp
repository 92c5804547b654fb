// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/pose_path.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/exact/compensated_sum.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr double kExcessRounding = 0x1p-48;  ///< of R'R - I, whose entries are sums of products up to 1
constexpr double kStretchRounding = 0x1p-50; ///< of differences of stretches, which are about 1
constexpr double kRigid = 0x1p-47;           ///< rounding alone makes no stretch that exceeds this

double distance(const Point3& a, const Point3& b)
{
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

double excess(const Eigen::Matrix3d& rotation)
{
  if (rotation == Eigen::Matrix3d::Identity()) return 0.0;
  const Eigen::Matrix3d e = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  return e.cwiseAbs().rowwise().sum().maxCoeff() + kExcessRounding;
}

std::vector<PolarDecomposition> partsOf(const std::vector<Eigen::Isometry3d>& poses)
{
  std::vector<PolarDecomposition> parts;
  parts.reserve(poses.size());
  for (const Eigen::Isometry3d& pose : poses) parts.emplace_back(pose.linear());
  return parts;
}

bool isUnstretched(const PolarDecomposition& parts)
{
  return (parts.stretch - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRigid;
}

} // namespace

Eigen::Isometry3d poseBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction,
                              const Point3& pivot)
{
  const Eigen::Vector3d turn = shorterTurn(from.linear(), to.linear());
  if (fraction > 0.0 && fraction < 1.0 && isHalfTurn(turn))
    throw InvalidInput(Input::pose, "motion between two poses", "half a turn, both directions are as short",
                       "give a pose between them");
  return RigidMotion(from, to, {pivot[0], pivot[1], pivot[2]}, turn).at(fraction);
}

Point3 carried(const Eigen::Isometry3d& pose, const Point3& p)
{
  Point3 result;
  for (int i = 0; i < 3; ++i) {
    CompensatedSum sum;
    for (int j = 0; j < 3; ++j) sum.addProduct(pose.matrix()(i, j), p[static_cast<std::size_t>(j)]);
    sum.add(pose.matrix()(i, 3));
    result[static_cast<std::size_t>(i)] = sum.value();
  }
  return result;
}

PosePath::PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses,
                   const Point3& center, Progress& progress)
{
  for (std::size_t k = 0; k < model_poses.size(); ++k) {
    progress.tick(4);
    if (k == 0 || model_poses[k].matrix() != model_poses[k - 1].matrix())
      add(scan_pose, model_poses[k], model_poses[k].linear(), center, static_cast<std::uint32_t>(k), 0.0);
  }
  skew += excess(scan_pose.linear());
  divideAll(progress);
}

PosePath::PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses,
                   const Point3& center, const Sweep& sweep, Progress& progress)
: is_swept(true),
  stray(sweep.stray),
  size_(sweep.size)
{
  const std::vector<PolarDecomposition> parts = partsOf(model_poses);
  poses.reserve(static_cast<std::size_t>(plan(model_poses, parts, sweep, progress)));
  const bool rigid = std::all_of(parts.begin(), parts.end(), isUnstretched);
  if (!rigid) stretches_.reserve(poses.capacity());
  const Eigen::Vector3d pivot(sweep.pivot[0], sweep.pivot[1], sweep.pivot[2]);
  for (std::size_t k = 0; k < model_poses.size(); ++k) {
    const std::size_t next = std::min(k + 1, model_poses.size() - 1);
    const Step& step = steps_[k];
    const RigidMotion motion(model_poses[k], model_poses[next], pivot, step.turn);
    for (double i = 0; i < step.cuts; ++i) {
      progress.tick(8);
      const double fraction = i / step.cuts;
      add(scan_pose, motion.at(fraction), rotationBy(fraction * step.turn) * parts[k].rotation, center,
          static_cast<std::uint32_t>(k), fraction);
      if (rigid) continue;
      const Eigen::Matrix3d stretch = // symmetric: rows are columns
          (1.0 - fraction) * parts[k].stretch + fraction * parts[next].stretch;
      std::copy(stretch.data(), stretch.data() + 9, stretches_.emplace_back().begin());
    }
  }
  skew += excess(scan_pose.linear());
  intervals.reserve(2 * poses.size());
  divideAll(progress);
}

void PosePath::check(const std::vector<Eigen::Isometry3d>& model_poses, const Sweep& sweep, Progress& progress)
{
  PosePath().plan(model_poses, partsOf(model_poses), sweep, progress);
}

double PosePath::plan(const std::vector<Eigen::Isometry3d>& model_poses, const std::vector<PolarDecomposition>& parts,
                      const Sweep& sweep, Progress& progress)
{
  double total = 0.0, most = 0.0, longest = 0.0;
  std::size_t worst = 0;
  double worst_angle = 0.0, worst_way = 0.0;
  steps_.resize(model_poses.size());
  for (std::size_t k = 0; k + 1 < model_poses.size(); ++k) {
    progress.tick(8);
    Step& step = steps_[k];
    step.turn = shorterTurnOfRotations(parts[k].rotation, parts[k + 1].rotation);
    step.begin = carried(model_poses[k], sweep.pivot);
    step.end = carried(model_poses[k + 1], sweep.pivot);
    const double turned = step.turn.norm();
    const double angle = turned == 0.0 ? 0.0 : turned * (1.0 + kMotionRounding) + kMotionRounding;
    const double way = distance(step.begin, step.end) * (1.0 + kMotionRounding);
    if (isHalfTurn(step.turn)) {
      throw InvalidInput(Input::swept, "swept motion",
                         plainText("from pose ", k, " to the next the model turns by half a turn (", angle,
                                   " rad), both directions are as short"),
                         "give a pose between them")
          .withIndex(k);
    }
    const double reach = sweep.radius + sweep.reach + way;
    const Bow whole = bowSeenByBody(angle, way); // of parts, it falls with the square of their number
    const double cuts = step.cuts =
        std::max(1.0, std::ceil(std::sqrt((whole.turn * reach + whole.drift) / sweep.stray)));
    step.bow = bowSeenByBody(angle / cuts, way / cuts);
    longest = std::max(longest, (way + angle * reach) / cuts);
    total += cuts;
    if (cuts <= most) continue;
    most = cuts;
    worst = k;
    worst_angle = angle;
    worst_way = way;
  }
  if (!steps_.empty()) steps_.back().cuts = 1.0; // itself
  if (!steps_.empty()) total += 1.0;
  if (total <= kMostPoses) {
    const double instants = 0x1p-52 * total * longest;
    if (instants <= sweep.rounding) return total;
    throw InvalidInput(Input::swept, "swept",
                       plainText("too small: a double tells an instant among ", total,
                                 " parts of the motion, each as long as ", longest, ", within a length of ", instants,
                                 ", and ", sweep.rounding, " is needed"),
                       "give a larger tolerance, or fewer poses");
  }
  throw InvalidInput(Input::swept, "swept",
                     plainText("too small, the motion would be cut into ", total, " parts, ", kMostPoses,
                               " are the most; from pose ", worst, " to the next the model turns by ", worst_angle,
                               " rad and moves by ", worst_way),
                     "give a larger tolerance, fewer poses, or poses that are nearer to each other")
      .withIndex(worst);
}

void PosePath::add(const Eigen::Isometry3d& scan_pose, const Eigen::Isometry3d& pose, const Eigen::Matrix3d& rotation,
                   const Point3& center, std::uint32_t given, double fraction)
{
  const Eigen::Matrix3d back = rotation.transpose(), turn = back * scan_pose.linear();
  PathPose& added = poses.emplace_back();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      added.back[static_cast<std::size_t>(3 * i + j)] = back(i, j);
      added.turn[static_cast<std::size_t>(3 * i + j)] = roundToFloat(turn(i, j));
    }
  added.center = carried(pose, center);
  added.given = given;
  added.fraction = fraction;
  for (const double x : added.center) far = std::max(far, std::abs(x));
  skew = std::max(skew, excess(pose.linear()));
}

void PosePath::divideAll(Progress& progress)
{
  progress.begin(kPathDone, poses.size());
  if (!poses.empty()) divide(0, static_cast<std::uint32_t>(poses.size() - 1), progress);
  progress.end();
}

std::uint32_t PosePath::divide(std::uint32_t first, std::uint32_t last, Progress& progress)
{
  progress.tick(last - first + 1, last - first < 2 ? std::max(last - first, 1u) : 0);
  const auto index = static_cast<std::uint32_t>(intervals.size());
  intervals.emplace_back();
  intervals[index].first = first;
  intervals[index].last = last;
  bound(intervals[index]);
  // Between two poses points move in straight lines by definition; when swept, the bow is as small as it needs to be.
  if (last - first < 2) return index;
  const std::uint32_t middle = first + (last - first) / 2;
  const std::uint32_t left = divide(first, middle, progress);
  const std::uint32_t right = divide(is_swept ? middle : middle + 1, last, progress);
  intervals[index].left = left;
  intervals[index].right = right;
  return index;
}

void PosePath::bound(PathInterval& interval) const
{
  const std::uint32_t first = interval.first, last = interval.last;
  const Point3& pivot = interval.pivot = poses[first + (last - first) / 2].center;
  const PathPose &from = poses[first], &to = poses[last];
  const Point3 from_seen = from.see(pivot), to_seen = to.see(pivot);
  const PathPose& middle = poses[interval.middle()];
  const Point3 middle_seen = middle.see(pivot);
  // Twelve numbers for each pose: R', and where it sees the pivot.
  const auto number = [](const PathPose& pose, const Point3& seen, std::size_t i) {
    return i < 9 ? pose.back[i] : seen[i - 9];
  };
  const double at_middle = last > first ? static_cast<double>(interval.middle() - first) / (last - first) : 0.0;
  const double bent = at_middle > 0.0 ? 1.0 / (at_middle * (1.0 - at_middle)) : 0.0; // times t (1 - t) there: 1
  double line[2] = {0.0, 0.0}, bend[2] = {0.0, 0.0}, bow[12], bow_squared[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < 12; ++i) {
    bow[i] = bent * (number(middle, middle_seen, i) -
                     ((1.0 - at_middle) * number(from, from_seen, i) + at_middle * number(to, to_seen, i)));
    bow_squared[i / 9] += bow[i] * bow[i];
  }
  double extent = distance(from.center, pivot) + distance(to.center, pivot);
  for (std::uint32_t k = first + 1; k < last; ++k) {
    const double t = static_cast<double>(k - first) / (last - first);
    const Point3 seen = poses[k].see(pivot);
    double from_line[2] = {0.0, 0.0}, from_bend[2] = {0.0, 0.0};
    for (std::size_t i = 0; i < 12; ++i) {
      const double strays =
          number(poses[k], seen, i) - ((1.0 - t) * number(from, from_seen, i) + t * number(to, to_seen, i));
      const double left = strays - t * (1.0 - t) * bow[i];
      from_line[i / 9] += strays * strays;
      from_bend[i / 9] += left * left;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      line[i] = std::max(line[i], from_line[i]);
      bend[i] = std::max(bend[i], from_bend[i]);
    }
    extent = std::max(extent, distance(poses[k].center, pivot));
  }
  interval.turn = std::sqrt(line[0]) * (1.0 + kMotionRounding) + (last > first ? kMotionRounding : 0.0);
  interval.drift = std::sqrt(line[1]) * (1.0 + kMotionRounding) + kMotionRounding * extent;
  interval.bend_turn = std::sqrt(bend[0]) * (1.0 + kMotionRounding) + (last > first ? 4 * kMotionRounding : 0.0);
  interval.bend_drift = std::sqrt(bend[1]) * (1.0 + kMotionRounding) + 4 * kMotionRounding * extent;
  if (!is_swept || first == last) return;
  double bow_drift = 0.0, bow_turn = 0.0;
  for (std::uint32_t k = first; k < last; ++k) {
    const Step& step = steps_[poses[k].given];
    if (step.bow.drift == 0.0 && step.bow.turn == 0.0) continue;
    const double fraction = poses[k].fraction;
    const double away = std::max(distance(step.pivotAt(fraction), pivot),
                                 distance(step.pivotAt(std::min(1.0, fraction + 1.0 / step.cuts)), pivot));
    bow_drift = std::max(bow_drift, step.bow.drift + step.bow.turn * away);
    bow_turn = std::max(bow_turn, step.bow.turn);
  }
  interval.drift += bow_drift * (1.0 + kMotionRounding);
  interval.turn += bow_turn * (1.0 + kMotionRounding);
  // From one pose to the next, the parabola itself bows by a share of its own bow.
  const double share = (1.0 + kMotionRounding) / (4.0 * (last - first) * (last - first));
  interval.bend_drift += (bow_drift + std::sqrt(bow_squared[1]) * share) * (1.0 + kMotionRounding);
  interval.bend_turn += (bow_turn + std::sqrt(bow_squared[0]) * share) * (1.0 + kMotionRounding);
  if (stretches_.empty()) return;
  const double stretch = stretchStray(first, last);
  interval.drift += stretch;
  interval.bend_drift += stretch;
}

/// Bounds how far the model's points stray from straight lines because poses that are not quite rigid stretch the
/// model, each differently.
double PosePath::stretchStray(std::uint32_t first, std::uint32_t last) const
{
  double most = 0.0;
  for (std::uint32_t k = first + 1; k < last; ++k) {
    const double t = static_cast<double>(k - first) / (last - first);
    double squared = 0.0;
    for (std::size_t i = 0; i < 9; ++i) {
      const double difference = stretches_[k][i] - ((1.0 - t) * stretches_[first][i] + t * stretches_[last][i]);
      squared += difference * difference;
    }
    most = std::max(most, squared);
  }
  return (std::sqrt(most) * (1.0 + kMotionRounding) + kStretchRounding) * size_;
}

} // namespace pcl_bsh
