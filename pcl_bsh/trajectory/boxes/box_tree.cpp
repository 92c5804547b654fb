// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/boxes/box_tree.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/vector3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double kVanishing = 0x1p-140; ///< above what underflows
constexpr float kNone = std::numeric_limits<float>::infinity();

/// Sets a child's box to [low, high] on an axis, moved by offset, widened for the rounding of both.
void place(BoxNode& node, std::uint32_t lane, std::size_t axis, double low, double high, double offset, double slack)
{
  const double margin = slack + kFewDoubleRoundings * (std::abs(offset) + std::abs(low) + std::abs(high)) + kVanishing;
  node.low[axis][lane] = roundDown(offset + low - margin);
  node.high[axis][lane] = roundUp(offset + high + margin);
}

/// The box of a child is the one around the boxes of the node below it.
void enclose(BoxNode& node, std::uint32_t lane, const BoxNode& below)
{
  const std::uint32_t count = below.count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = *std::min_element(below.low[axis], below.low[axis] + count);
    node.high[axis][lane] = *std::max_element(below.high[axis], below.high[axis] + count);
  }
}

/// A point of a voxel, and its place there.
struct PlacedPoint {
  Eigen::Array4f at; ///< x, y, z, and the bits of the place

  PlacedPoint(float x, float y, float z, std::uint32_t i) : at(x, y, z, std::bit_cast<float>(i)) {}

  std::uint32_t place() const { return std::bit_cast<std::uint32_t>(at[3]); }
};

/// A tree of boxes over a voxel's points, which come to stand in the order of its leaves.
class PointGrouping {
public:
  /// @param most points of a leaf. @param fit called as fit(node, lane, low, high, first) for each leaf: sets its box.
  /// All points of the leaf are between low and high, and `first` is one of them
  template <class Fit>
  PointGrouping(std::vector<PlacedPoint>& points, const float* stretch, std::size_t most, const Fit& fit)
  : points_(points),
    stretch_(stretch),
    most_(most)
  {
    begins.reserve(2 * points.size() / most + 2);
    group(measured(points_.begin(), points_.end()), fit);
    begins.push_back(static_cast<std::uint32_t>(points_.size()));
  }

  std::vector<BoxNode> boxes;
  std::vector<std::uint32_t> begins; ///< of leaves, then the end of the last one

private:
  using Place = std::vector<PlacedPoint>::iterator;

  struct Group {
    Place begin, end;
    Eigen::Array4f low, high; ///< of x, y, z; the fourth element of each is not used
    Eigen::Index axis = 0;    ///< along which it is divided
    float size = -1.0f;       ///< along that axis, divided by the stretch; negative: a leaf
  };

  static constexpr std::ptrdiff_t kLeastShare = 16; ///< each side needs more than one in so many points

  Group measured(Place begin, Place end) const
  {
    Group group{begin, end, Eigen::Array4f::Constant(kNone), Eigen::Array4f::Constant(-kNone)};
    for (Place point = begin; point != end; ++point) {
      group.low = group.low.min(point->at);
      group.high = group.high.max(point->at);
    }
    if (static_cast<std::size_t>(end - begin) <= most_) return group;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const float size = (group.high[axis] - group.low[axis]) / stretch_[axis];
      if (size <= group.size) continue;
      group.axis = axis;
      group.size = size;
    }
    return group;
  }

  /// Divides a group in the middle of its space. Where nearly all points are on one side, it divides in the middle of
  /// the points, so that the tree is never deep.
  Place divided(const Group& group) const
  {
    const Eigen::Index axis = group.axis;
    const float at = 0.5f * group.low[axis] + 0.5f * group.high[axis];
    const Place place =
        std::partition(group.begin, group.end, [&](const PlacedPoint& point) { return point.at[axis] < at; });
    const std::ptrdiff_t count = group.end - group.begin;
    if (kLeastShare * std::min(place - group.begin, group.end - place) > count) return place;
    const Place middle = group.begin + count / 2;
    std::nth_element(group.begin, middle, group.end,
                     [&](const PlacedPoint& a, const PlacedPoint& b) { return a.at[axis] < b.at[axis]; });
    return middle;
  }

  /// @return the node that it becomes
  template <class Fit>
  std::uint32_t group(const Group& whole, const Fit& fit)
  {
    Group parts[kNodeChildren] = {whole};
    std::uint32_t count = 1;
    while (count < kNodeChildren) {
      Group& largest =
          *std::max_element(parts, parts + count, [](const Group& a, const Group& b) { return a.size < b.size; });
      if (largest.size < 0.0f) break;
      const Place middle = divided(largest);
      parts[count++] = measured(middle, largest.end);
      largest = measured(largest.begin, middle);
    }
    // Leaves are numbered in the order of their points.
    std::sort(parts, parts + count, [](const Group& a, const Group& b) { return a.begin < b.begin; });
    const auto index = static_cast<std::uint32_t>(boxes.size());
    boxes.emplace_back().count = count;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const Group& part = parts[lane];
      if (part.size < 0.0f) {
        boxes[index].child[lane] = BoxNode::kLeaf | static_cast<std::uint32_t>(begins.size());
        begins.push_back(static_cast<std::uint32_t>(part.begin - points_.begin()));
        fit(boxes[index], lane, part.low, part.high, *part.begin);
        continue;
      }
      const std::uint32_t below = group(part, fit);
      boxes[index].child[lane] = below;
      enclose(boxes[index], lane, boxes[below]);
    }
    return index;
  }

  std::vector<PlacedPoint>& points_;
  const float* stretch_;
  const std::size_t most_;
};

/// Bounds the rounding of places of halved triangles, relative to the largest coordinate: each halving rounds once.
constexpr double kPartRoundings = 128 * kDoubleUnit;

double medianOf(std::vector<double>& numbers)
{
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  if (numbers.size() % 2 != 0) return *middle;
  return 0.5 * (*std::max_element(numbers.begin(), middle) + *middle);
}

constexpr std::size_t kRecordsForOrigin = 1024; // that are looked at
constexpr double kLarge = 64.0;                 // a record is large if its radius is so many times the median

/// Returns the middle of a cloud, or a place near most records where one record is much larger than most. The middle
/// may then be so far away from most records that floats would not tell them apart there.
Point3 originOf(const SphereHierarchy::Storage& storage)
{
  if (arePoints(storage.view) || storage.size == 0) return storage.frame.origin;
  std::vector<double> places[3], radii;
  const std::size_t step = storage.size / kRecordsForOrigin + 1;
  std::size_t i = 0;
  for (std::uint32_t v = 0; v < storage.voxel_count; ++v)
    storage.forEachRecord(v, [&](std::uint32_t record) {
      if (i++ % step != 0) return;
      const Point3 place = storage.view.point(record);
      for (std::size_t axis = 0; axis < 3; ++axis) places[axis].push_back(place[axis]);
      radii.push_back(storage.view.radius(record));
    });
  if (!(storage.largest_radius > kLarge * medianOf(radii))) return storage.frame.origin;
  return {medianOf(places[0]), medianOf(places[1]), medianOf(places[2])};
}

/// Parts of triangles that are thinner than this share of the model's radius are not divided.
constexpr double kThinShare = 0x1p-8;

} // namespace

BoxTree::BoxTree(const SphereHierarchy::Storage& of, const Travel& travel, const Division& division)
: storage(of),
  origin(originOf(of)),
  division_(division),
  voxels_(std::make_unique<Entry[]>(of.voxel_count))
{
  std::fill(low, low + 3, kNone);
  std::fill(high, high + 3, -kNone);
  for (std::size_t v = 0; v < storage.voxel_count; ++v) {
    const LocalFrame& frame = storage.voxels[v].frame;
    double slack = 0.0;
    for (int k = 0; k < 3; ++k) {
      slack += frame.slack(k) * frame.slack(k);
      voxel_reach = std::max(voxel_reach, frame.reach[static_cast<std::size_t>(k)] * frame.unit);
    }
    voxel_slack = std::max(voxel_slack, std::sqrt(slack) * (1.0 + kDoubleMargin) * frame.unit);
  }
  if (storage.size > 0) fitTop();
  setStretch(travel);
  division_.thin = std::max(division_.thin, kThinShare * radius);
}

void BoxTree::setStretch(const Travel& travel)
{
  const double all = travel.way[0] + travel.way[1] + travel.way[2] + travel.turned * radius;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double ratio = travel.way[axis] / (all - travel.way[axis]);
    stretch[axis] = ratio > 1.0 ? roundToFloat(std::min(ratio, kMostStretch)) : 1.0f; // 1 at rest, too
  }
}

Point3 BoxTree::offset(std::uint32_t index) const
{
  const Point3& at = storage.voxels[index].frame.origin;
  return {at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]};
}

void BoxTree::fitTop()
{
  top_.resize(storage.top.size());
  for (std::size_t n = top_.size(); n-- > 0;) { // children come after their parents
    const Node& node = storage.top[n];
    top_[n].count = node.count;
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) {
        top_[n].child[lane] = node.child[lane];
        enclose(top_[n], lane, top_[node.child[lane]]);
        continue;
      }
      top_[n].child[lane] = BoxNode::kLeaf | node.begin[lane];
      placeVoxel(top_[n], lane, node.begin[lane]);
    }
  }
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = *std::min_element(top_[0].low[axis], top_[0].low[axis] + storage.top[0].count);
    high[axis] = *std::max_element(top_[0].high[axis], top_[0].high[axis] + storage.top[0].count);
    const double reach = std::max(std::abs(static_cast<double>(low[axis])), std::abs(static_cast<double>(high[axis])));
    squared += reach * reach;
  }
  radius = std::sqrt(squared) * (1.0 + kDoubleMargin);
}

void BoxTree::placeVoxel(BoxNode& node, std::uint32_t lane, std::uint32_t index) const
{
  const Voxel& voxel = storage.voxels[index];
  const LocalFrame& frame = voxel.frame;
  const Point3 at = offset(index);
  Point3 low_end, high_end;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    high_end[axis] = frame.reach[axis] * frame.unit + voxel.largest_radius;
    low_end[axis] = -high_end[axis];
  }
  if (const TrianglesView* const triangles = storage.view.triangles) { // much smaller than their balls, perhaps
    low_end.fill(kNone), high_end.fill(-kNone);
    storage.forEachRecord(index, [&](std::uint32_t record) {
      for (const Point3& corner : triangles->triangle(record))
        for (std::size_t axis = 0; axis < 3; ++axis) {
          low_end[axis] = std::min(low_end[axis], corner[axis] - frame.origin[axis]);
          high_end[axis] = std::max(high_end[axis], corner[axis] - frame.origin[axis]);
        }
    });
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    place(node, lane, axis, low_end[axis], high_end[axis], at[axis],
          frame.slack(static_cast<int>(axis)) * frame.unit + kFewDoubleRoundings * std::abs(frame.origin[axis]));
}

const BoxedVoxel& BoxTree::voxel(std::uint32_t index, Work& work) const
{
  Entry& entry = voxels_[index];
  std::call_once(entry.once, [&] {
    const Voxel& built = storage.built(index, work);
    entry.boxed = arePoints(storage.view) ? BoxedVoxel(built, offset(index), stretch, storage.view.uncertainties)
                                          : BoxedVoxel(built, storage.view, origin, stretch, division_);
    for (const BoxNode& node : entry.boxed.boxes()) work.volumes_built += node.count;
  });
  return entry.boxed;
}

BoxedVoxel::BoxedVoxel(const Voxel& voxel, const Point3& offset, const float* stretch, const float* uncertainties)
{
  std::vector<PlacedPoint> points;
  points.reserve(voxel.count);
  for (const Node& node : voxel.nodes)
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) continue;
      const std::uint32_t end = node.begin[lane] + node.comparedPoints(lane);
      for (std::uint32_t i = node.begin[lane]; i < end; ++i)
        points.emplace_back(voxel.x()[i], voxel.y()[i], voxel.z()[i], i);
    }
  const double unit = voxel.frame.unit;
  PointGrouping grouping(points, stretch, kMaxLeafPoints,
                         [&](BoxNode& node, std::uint32_t lane, const Eigen::Array4f& low, const Eigen::Array4f& high,
                             const PlacedPoint&) {
                           for (std::size_t axis = 0; axis < 3; ++axis)
                             place(node, lane, axis, low[static_cast<Eigen::Index>(axis)] * unit,
                                   high[static_cast<Eigen::Index>(axis)] * unit, offset[axis],
                                   voxel.frame.slack(static_cast<int>(axis)) * unit);
                         });
  boxes_ = std::move(grouping.boxes);
  begins_ = std::move(grouping.begins);
  coordinates_.resize(3 * points.size() + kNodeChildren);
  records_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      coordinates_[axis * points.size() + i] = points[i].at[static_cast<Eigen::Index>(axis)];
    records_[i] = voxel.records()[points[i].place()];
    if (uncertainties) lengths_.push_back(uncertainties[records_[i]]);
  }
  if (uncertainties) lengths_.resize(lengths_.size() + kNodeChildren);
}

BoxedVoxel::BoxedVoxel(const Voxel& voxel, const PointsView& view, const Point3& origin, const float* stretch,
                       const Division& division)
{
  std::vector<BoxedPart> parts;
  for (const Node& node : voxel.nodes)
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) continue;
      const std::uint32_t end = node.begin[lane] + node.comparedPoints(lane);
      for (std::uint32_t i = node.begin[lane]; i < end; ++i) {
        const std::uint32_t record = voxel.records()[i];
        if (view.triangles) {
          Triangle3 corners = view.triangles->triangle(record);
          for (Point3& corner : corners) corner = corner - origin;
          parts.emplace_back(corners, record);
          continue;
        }
        const double radius = view.radius(record);
        const Point3 center = view.point(record) - origin, reach = {radius, radius, radius};
        parts.emplace_back(Triangle3{center - reach, center + reach, center}, record);
      }
    }
  const std::size_t whole = parts.size();
  if (view.triangles) divideThick(parts, division);
  is_divided_ = parts.size() > whole;

  std::vector<PlacedPoint> middles;
  middles.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    float middle[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
      middle[axis] = roundToFloat(0.5 * (parts[i].low()[axis] + parts[i].high()[axis]));
    middles.emplace_back(middle[0], middle[1], middle[2], static_cast<std::uint32_t>(i));
  }
  double largest = 0.0; // coordinate of a corner, and of the origin that was subtracted
  for (std::size_t axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, std::abs(origin[axis]));
    for (const BoxedPart& part : parts)
      for (const Point3& corner : part.corners) largest = std::max(largest, std::abs(corner[axis]));
  }
  PointGrouping grouping(
      middles, stretch, 1,
      [&](BoxNode& node, std::uint32_t lane, const Eigen::Array4f&, const Eigen::Array4f&, const PlacedPoint& middle) {
        const BoxedPart& part = parts[middle.place()];
        const Point3 low = part.low(), high = part.high();
        for (std::size_t axis = 0; axis < 3; ++axis)
          place(node, lane, axis, low[axis], high[axis], 0.0, kPartRoundings * largest);
      });
  boxes_ = std::move(grouping.boxes);
  begins_ = std::move(grouping.begins);
  records_.resize(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) records_[i] = parts[middles[i].place()].record;
}

} // namespace pcl_bsh
