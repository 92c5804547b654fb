// SPDX-License-Identifier: BSD-3-Clause
// The storage of a SphereHierarchy: one buffer of points in voxel order, the voxels, and the tree above them.
#pragma once

#include <pcl_bsh/base/large_buffer.h>
#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/geometry/local_frame.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/build/point_runs.h>
#include <pcl_bsh/hierarchy/build_work.h>
#include <pcl_bsh/hierarchy/node.h>
#include <pcl_bsh/hierarchy/own_uncertainties.h>
#include <pcl_bsh/hierarchy/slabs.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/uncertainty_range.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

namespace pcl_bsh {

/// A point before its voxel is built: local coordinates and where it came from.
struct PointRecord {
  float x, y, z;
  std::uint32_t record;
};
static_assert(sizeof(PointRecord) == 4 * sizeof(float));

/// A cube of the voxel grid, or of an octree: [low, low + edge] on each axis.
struct Cube {
  Point3 low;
  double edge;

  /// @param o its bits choose the upper half of x, y and z, the lowest for x
  Cube octant(std::uint32_t o) const noexcept
  {
    Cube half{low, 0.5 * edge};
    for (std::size_t k = 0; k < 3; ++k) half.low[k] += (o >> k & 1) != 0 ? half.edge : 0.0;
    return half;
  }
};

/// In place of a voxel's number: there is no such voxel.
inline constexpr std::uint32_t kNoVoxel = 0xffffffffu;

/// In place of a voxel's number, where nodes or frames are meant: the tree above the voxels.
inline constexpr std::uint32_t kAboveVoxels = kNoVoxel;

/// The unit of lazy building and of local precision.
struct Voxel {
  enum State : std::uint8_t { sorted, building, built };

  LocalFrame frame;
  std::uint64_t key = 0;    ///< Morton code of its place in the voxel grid
  std::uint32_t begin = 0;  ///< its first point, counted over all voxels
  std::uint32_t lowest = 0; ///< smallest record number of its points
  std::uint32_t count = 0;  ///< its points, at least 1
  float radius = 0.0f; ///< of a sphere around the frame's origin that holds all of its points, in the frame's units
  float largest_radius = 0.0f; ///< of its points, in the cloud's unit
  double leaf_radii = 0.0;     ///< sum over its leaves when last built; 0 until a refit asks
  /// x[count], y[count], z[count], record[count], once built; PointRecord[count] until then, unless they are listed
  float* block = nullptr;
  const std::uint32_t* list = nullptr; ///< its records as runs (point_runs.h), until it is built. Null: the block has
                                       ///< its points
  float* radii = nullptr;              ///< one per point in the order of x, once built; null when points have none
  std::vector<Node> nodes;             ///< nodes[0] is the root; empty until built
  std::vector<GivenSphere> given;      ///< see givenSpheres(); empty unless the voxel has crowded cells
  LazySlabs slabs{SlabAxis::least};    ///< of the nodes, once built and asked for
  LazySlabs cross_slabs{SlabAxis::second}; ///< made when a query first asks
  LazyUncertainties own_uncertainties;     ///< made when a query first asks
  bool was_read = false;                   ///< by Storage::readOnce()
  std::atomic<std::uint8_t> state{sorted};

  /// Becomes what the other voxel is. Neither may be visited meanwhile.
  void adopt(Voxel& other) noexcept
  {
    frame = other.frame;
    key = other.key;
    begin = other.begin;
    lowest = other.lowest;
    count = other.count;
    radius = other.radius;
    largest_radius = other.largest_radius;
    leaf_radii = other.leaf_radii;
    block = other.block;
    list = other.list;
    radii = other.radii;
    nodes = std::move(other.nodes);
    given = std::move(other.given);
    slabs.adopt(other.slabs);
    cross_slabs.adopt(other.cross_slabs);
    own_uncertainties.adopt(other.own_uncertainties);
    was_read = other.was_read;
    state.store(other.state.load(std::memory_order_relaxed), std::memory_order_relaxed);
  }

  /// A point of a built voxel as it was given; read from the voxel if its frame is lossless, else from the view.
  Point3 point(const PointsView& view, std::uint32_t i) const noexcept
  {
    if (!frame.lossless) return view.point(records()[i]);
    return {frame.origin[0] + static_cast<double>(x()[i]), frame.origin[1] + static_cast<double>(y()[i]),
            frame.origin[2] + static_cast<double>(z()[i])};
  }

  /// Whether the block holds nothing yet: points are to be read from the cloud.
  bool isListed() const noexcept { return list != nullptr; }

  /// Calls visit(record) for its points: in the order of the view until it is built, then in that of the block.
  template <class Visit>
  void forEachRecord(Visit&& visit) const
  {
    if (isListed()) return eachRecord(list, count, visit);
    const bool is_built = state.load(std::memory_order_acquire) == built;
    const auto* points = reinterpret_cast<const PointRecord*>(block);
    for (std::uint32_t i = 0; i < count; ++i) visit(is_built ? records()[i] : points[i].record);
  }

  /// Floats of its block and the padding behind it.
  std::size_t blockSize() const noexcept;

  const float* x() const noexcept { return block; }
  const float* y() const noexcept { return block + count; }
  const float* z() const noexcept { return block + 2 * std::size_t{count}; }
  const std::uint32_t* records() const noexcept
  {
    return reinterpret_cast<const std::uint32_t*>(block + 3 * std::size_t{count});
  }
};

class SphereHierarchy::Storage {
public:
  /// Sorts the points into voxels and builds the tree above them.
  Storage(const PointsView& points, const HierarchyOptions& options);

  /// The voxel with its octree and spheres. Builds it on the first call; other threads wait.
  /// @param work what this call built is added to it
  const Voxel& built(std::size_t voxel, BuildWork& work) const
  {
    const Voxel& v = voxels[voxel];
    if (v.state.load(std::memory_order_acquire) != Voxel::built) build(voxel, work);
    return v;
  }

  /// How many points a visit to the voxel would have to build.
  std::size_t pointsToBuild(std::size_t voxel) const
  {
    return voxels[voxel].state.load(std::memory_order_relaxed) == Voxel::built ? 0 : voxels[voxel].count;
  }

  /// Whether triangles of a voxel are about as long as all of it: then spheres of nodes are as large as the voxel's
  /// own, and two slabs tell where their triangles are.
  bool hasLongTriangles(std::size_t voxel) const
  {
    constexpr double kLong = 0.25; // radius of the largest ball, in radii of the voxel
    const Voxel& of = voxels[voxel];
    return view.triangles && double{of.largest_radius} > kLong * double{of.radius} * of.frame.unit;
  }

  /// Where a place lies in the voxel grid.
  struct GridPlace {
    std::uint32_t voxel; ///< whose cell the place is in, or kNoVoxel
    double margin;       ///< no point of another voxel is nearer than this, in the cloud's unit; negative: not known
  };

  /// Looks up a place by the voxels' keys: the cells that points were in when they were sorted. A refit() keeps moved
  /// points in their voxels, an update in those that it does not touch: the margin is less by `strayed`.
  GridPlace find(const Point3& place) const noexcept;

  /// Calls visit(record) for each point of a voxel, built or not.
  template <class Visit>
  void forEachRecord(std::size_t voxel, const Visit& visit) const
  {
    Voxel& v = voxels[voxel];
    if (!claim(v)) return v.forEachRecord(visit);
    const Claim claimed{v}; // other threads wait; released also where the visit throws
    v.forEachRecord(visit);
  }

  /// Calls read(voxel) where the voxel lists its points, is not built, and was not read like this before: one question
  /// needs no tree. Threads that want to build it wait meanwhile, so that read() must not wait for a voxel.
  /// @return what read() returned; false where it was not called
  template <class Read>
  bool readOnce(std::size_t voxel, const Read& read) const
  {
    Voxel& v = voxels[voxel];
    if (v.state.load(std::memory_order_acquire) == Voxel::built || !claim(v)) return false;
    const Claim claimed{v};
    if (v.was_read || !v.isListed()) return false;
    v.was_read = true;
    return read(static_cast<const Voxel&>(v));
  }

  PointsView view;
  HierarchyOptions options;
  double voxel_edge = 1.0;
  std::size_t size = 0; ///< finite points
  std::size_t voxel_count = 0;
  std::unique_ptr<Voxel[]> voxels;        ///< sorted by key
  double largest_radius = 0.0;            ///< of all points
  UncertaintyRange uncertainty;           ///< of all records
  std::array<double, 3> base = {0, 0, 0}; ///< cell number 0 of the voxel grid, in cells from the origin
  LocalFrame frame;                       ///< of `top`
  std::vector<Node> top; ///< the octree above the voxels: leaves are voxels; top[0] is the root; empty iff size == 0

  /// How far points lie outside the cells of their voxels, at most, on any axis, in cells; 0 as long as only rounding
  /// has put them there (kCellRounding). A refit() leaves moved points in their voxels and measures it.
  double strayed = 0.0;

  /// An upper bound of how far the range [low, high] reaches out of the cell of a key, on any axis, in cells.
  double shiftOf(std::uint64_t key, const std::array<double, 3>& low, const std::array<double, 3>& high) const noexcept;

  /// Another number after every change of the points; no two hierarchies of a process share one. For callers that
  /// remember answers.
  std::uint64_t revision = nextRevision();
  static std::uint64_t nextRevision() noexcept;

  double extent = 0.0; ///< sum of the voxels' radii when the points were sorted into them, in the cloud's unit

  /// Data of all voxels together: the tree above them, and where to find each.
  struct TopTree {
    std::vector<Node> top;
    std::vector<std::uint32_t> slots;
    double largest_radius = 0.0;
  };

  /// Makes the tree above measured voxels, in the order of their keys. @param reuse an earlier result: with as many
  /// voxels of equal keys, nothing is allocated
  static TopTree makeTopTree(const std::vector<Voxel*>& all, const LocalFrame& frame, TopTree reuse);

  TopTree takeTopTree() noexcept { return {std::move(top), std::move(slots_), largest_radius}; }
  void setTopTree(TopTree&& above) noexcept
  {
    top = std::move(above.top);
    slots_ = std::move(above.slots);
    largest_radius = above.largest_radius;
    revision = nextRevision();
  }

  /// All voxels, in order.
  std::vector<Voxel*> list() const;

  /// Sum of the voxels' radii.
  double sumOfRadii() const;

  LargeBuffer<std::uint32_t> lists; ///< every Voxel::list, of the voxels as sorted
  std::size_t list_words = 0;       ///< of it

  /// Every voxel's block, each followed by padding that vector loads may touch. The first holds the voxels as sorted;
  /// others those that an update made anew.
  std::vector<LargeBuffer<float>> buffers;
  std::vector<std::unique_ptr<float[]>> radii_buffers; ///< the memory of `radii`
  std::size_t floats_unused = 0;                       ///< in the buffers, left behind by updates

private:
  void build(std::size_t voxel, BuildWork& work) const;
  Cube cubeOf(std::uint64_t key) const noexcept;

  static std::size_t slotOf(std::uint64_t key, std::size_t slots) noexcept
  {
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> 32) & (slots - 1);
  }

  std::vector<std::uint32_t> slots_; ///< voxels by the hashes of their keys, or kNoVoxel: open addressing, half full

  /// Gives a claimed voxel back as it was when it goes out of scope.
  struct Claim {
    Voxel& voxel;
    ~Claim() { release(voxel, Voxel::sorted); }
  };

  /// Waits while another thread has the voxel. @return false when it is built: then no thread may change it
  static bool claim(Voxel& voxel);
  static void release(Voxel& voxel, Voxel::State state);
};

/// Cell numbers are computed in the cloud's scalar type. Rounding may put a point into the neighbouring voxel where the
/// face between them is nearer than kCellRounding (cell number + 2), in cells.
inline constexpr double kCellRounding = 0x1p-23;

/// Sets a voxel's `radius` and `largest_radius` by its frame and points, and drops its slabs and own uncertainties.
/// @pre its points' records are set
void measureVoxel(Voxel& voxel, const PointsView& view);

/// Voxel::radius of points in this frame.
float radiusOf(const LocalFrame& frame, float largest_radius);

/// The most voxels for so many points: more would take more memory than the points, and be no quicker.
inline std::size_t mostVoxels(std::size_t points) noexcept
{
  return std::max<std::size_t>(4096, points / 16);
}

/// Floats of padding behind each voxel's block: a whole leaf can be loaded from any point of it.
inline constexpr std::size_t kBlockPadding = kMaxLeafPoints;

/// Words behind a list of records that may be read.
inline constexpr std::size_t kListPadding = 6;

inline std::size_t Voxel::blockSize() const noexcept
{
  return 4 * std::size_t{count} + kBlockPadding;
}

/// The point as a frame stores it.
inline PointRecord storedIn(const LocalFrame& frame, const Point3& p, std::uint32_t record)
{
  const double inverse = 1.0 / frame.unit;
  float local[3];
  for (std::size_t k = 0; k < 3; ++k)
    local[k] = roundToFloat(frame.unit == 1.0 ? p[k] - frame.origin[k] : p[k] * inverse - frame.origin[k] * inverse);
  return {local[0], local[1], local[2], record};
}

/// Reads the voxel's points and turns them into cells and bounding spheres. When it throws, the voxel is sorted
/// still.
/// @param cube of the voxel in the grid
void buildVoxel(Voxel& voxel, const PointsView& view, const HierarchyOptions& options, const Cube& cube);

/// Gives the points of a built voxel other coordinates, in the order they are in, and fits its spheres to them. When it
/// throws, its block and its nodes are of no use any more.
void refitVoxel(Voxel& voxel, const PointRecord* points, const PointsView& view, SphereFit fit);

/// Distributes the finite points of the view over voxels: what Storage's constructor starts with.
struct VoxelSorting {
  double edge = 1.0;
  std::size_t size = 0;
  std::size_t voxel_count = 0;
  std::unique_ptr<Voxel[]> voxels;
  LargeBuffer<float> buffer;
  LargeBuffer<std::uint32_t> lists;
  std::size_t list_words = 0;
  std::array<double, 3> base = {0, 0, 0};
  LocalFrame frame; ///< of the whole cloud
};
VoxelSorting sortIntoVoxels(const PointsView& view, const HierarchyOptions& options);

/// The octree above voxels in the order of their keys, one at least, in the cloud's frame. Into the memory of `reuse`.
std::vector<Node> buildTop(const std::vector<Voxel*>& voxels, const LocalFrame& frame, std::vector<Node> reuse);

/// A frame's reach is rounded outward by this share of it, far above the errors of double arithmetic. kSmallestReach is
/// added, so that no coordinate other than 0 is stored beside a reach of 0.
inline constexpr double kReachGrowth = 0x1p-20;
inline constexpr double kSmallestReach = 0x1p-140;

/// The frame for points within [low, high]; its origin is a float where `float_origin` says so.
LocalFrame frameBetween(const std::array<double, 3>& low, const std::array<double, 3>& high, bool float_origin);

} // namespace pcl_bsh
