// SPDX-License-Identifier: BSD-3-Clause
// Points into voxels: a counting sort that reads the cloud three times and keeps 4 bytes per point on the way.
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/morton.h>
#include <pcl_bsh/hierarchy/parallel.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/voxel_edge.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl_bsh {
namespace {

constexpr std::uint32_t kNoVoxel = 0xffffffffu;
constexpr std::size_t kChunkPoints = 1 << 16; // points a thread takes at least: below that, one thread is faster

template <class T>
struct Coordinates {
  T x, y, z;
  bool finite() const { return std::abs(x) <= kMax && std::abs(y) <= kMax && std::abs(z) <= kMax; }
  static constexpr T kMax = std::numeric_limits<T>::max();
};

/// Reads points of a view as they are stored.
template <class T>
class Reader {
public:
  explicit Reader(const PointsView& view)
  : data_(static_cast<const unsigned char*>(view.data)),
    stride_(view.stride),
    offset_(view.offset),
    indices_(view.indices)
  {
  }

  std::uint32_t record(std::size_t i) const
  {
    return static_cast<std::uint32_t>(indices_ ? indices_[i] : static_cast<std::int32_t>(i));
  }

  Coordinates<T> operator()(std::uint32_t record) const
  {
    const unsigned char* base = data_ + stride_ * record;
    Coordinates<T> c;
    std::memcpy(&c.x, base + offset_[0], sizeof(T));
    std::memcpy(&c.y, base + offset_[1], sizeof(T));
    std::memcpy(&c.z, base + offset_[2], sizeof(T));
    return c;
  }

private:
  const unsigned char* data_;
  std::size_t stride_;
  std::array<std::size_t, 3> offset_;
  const std::int32_t* indices_;
};

/// The cell number of a coordinate, counted from the lowest cell. Deterministic is all it needs to be: a point that
/// rounding puts into the neighbouring voxel is at home there, for bounds and origins follow the points.
template <class K>
class CellNumbers {
public:
  CellNumbers(double edge, const Bounds& bounds) : inverse_(static_cast<K>(1.0 / edge))
  {
    for (std::size_t k = 0; k < 3; ++k) base_[k] = std::floor(static_cast<K>(bounds.low[k]) * inverse_);
  }

  template <class T>
  std::uint64_t operator()(const Coordinates<T>& c) const
  {
    return number(c.x, 0) << 42 | number(c.y, 1) << 21 | number(c.z, 2);
  }

private:
  std::uint64_t number(double value, std::size_t k) const
  {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(static_cast<K>(value) * inverse_ - base_[k]));
  }

  K inverse_;
  std::array<K, 3> base_;
};

std::uint64_t mortonOf(std::uint64_t cell)
{
  return mortonCode(cell >> 42, cell >> 21 & 0x1fffff, cell & 0x1fffff);
}

/// A voxel as one chunk of points sees it.
template <class T>
struct Bin {
  std::uint64_t cell = 0;
  std::uint32_t count = 0;
  std::uint32_t voxel = 0; // global number, known after merging; then the chunk's cursor lives in `next`
  std::uint32_t next = 0;
  std::array<T, 3> low, high;

  void add(const Coordinates<T>& c)
  {
    ++count;
    low[0] = std::min(low[0], c.x), high[0] = std::max(high[0], c.x);
    low[1] = std::min(low[1], c.y), high[1] = std::max(high[1], c.y);
    low[2] = std::min(low[2], c.z), high[2] = std::max(high[2], c.z);
  }
};

/// Finds or adds the bin of a cell: open addressing, doubled when half full.
template <class T>
class BinTable {
public:
  BinTable() : slots_(1024, kNoVoxel) {}

  std::uint32_t find(std::uint64_t cell)
  {
    for (std::size_t i = hash(cell);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kNoVoxel) return add(cell, i);
      if (bins[slots_[i]].cell == cell) return slots_[i];
    }
  }

  std::vector<Bin<T>> bins;

private:
  std::size_t hash(std::uint64_t cell) const { return (cell * 0x9e3779b97f4a7c15u >> 40) & (slots_.size() - 1); }

  std::uint32_t add(std::uint64_t cell, std::size_t slot)
  {
    const auto bin = static_cast<std::uint32_t>(bins.size());
    bins.emplace_back();
    bins.back().cell = cell;
    bins.back().low.fill(std::numeric_limits<T>::infinity());
    bins.back().high.fill(-std::numeric_limits<T>::infinity());
    slots_[slot] = bin;
    if (2 * bins.size() > slots_.size()) grow();
    return bin;
  }

  void grow()
  {
    slots_.assign(2 * slots_.size(), kNoVoxel);
    for (std::uint32_t bin = 0; bin < bins.size(); ++bin) {
      std::size_t i = hash(bins[bin].cell);
      while (slots_[i] != kNoVoxel) i = (i + 1) & (slots_.size() - 1);
      slots_[i] = bin;
    }
  }

  std::vector<std::uint32_t> slots_;
};

/// Stores a point of the cloud as the frame has it.
template <class T>
class ToLocal {
public:
  explicit ToLocal(const LocalFrame& frame) : plain_(frame.unit == 1.0), inverse_(1.0 / frame.unit)
  {
    for (std::size_t k = 0; k < 3; ++k)
      origin_[k] = static_cast<T>(frame.origin[k]), scaled_[k] = frame.origin[k] * inverse_;
  }

  PointRecord operator()(const Coordinates<T>& c, std::uint32_t record) const
  {
    return {local(c.x, 0), local(c.y, 1), local(c.z, 2), record};
  }

private:
  float local(T value, std::size_t k) const
  {
    if (plain_) return static_cast<float>(value - origin_[k]);
    return roundToFloat(static_cast<double>(value) * inverse_ - scaled_[k]);
  }

  std::array<T, 3> origin_;
  bool plain_;
  double inverse_;
  std::array<double, 3> scaled_;
};

template <class T>
Bounds boundsOf(const PointsView& view, std::size_t chunks, unsigned threads)
{
  const Reader<T> read(view);
  struct Part {
    std::array<T, 3> low, high;
    std::size_t finite = 0;
  };
  std::vector<Part> parts(chunks);
  parallelFor(chunks, threads, [&](std::size_t chunk) {
    Bin<T> bin;
    bin.low.fill(std::numeric_limits<T>::infinity());
    bin.high.fill(-std::numeric_limits<T>::infinity());
    for (std::size_t i = chunk * view.size() / chunks; i < (chunk + 1) * view.size() / chunks; ++i) {
      const Coordinates<T> c = read(read.record(i));
      if (c.finite()) bin.add(c);
    }
    parts[chunk] = {bin.low, bin.high, bin.count};
  });
  Bounds bounds;
  bounds.low.fill(std::numeric_limits<double>::infinity());
  bounds.high.fill(-std::numeric_limits<double>::infinity());
  for (const Part& part : parts) {
    bounds.finite += part.finite;
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.low[k] = std::min(bounds.low[k], static_cast<double>(part.low[k]));
      bounds.high[k] = std::max(bounds.high[k], static_cast<double>(part.high[k]));
    }
  }
  return bounds;
}

/// Gives every voxel that some chunk saw its number (in Morton order), frame and place in the buffer, and every chunk
/// its cursors, so that a voxel's points stand in the order of the cloud however many chunks there are.
template <class T>
void mergeBins(std::vector<BinTable<T>>& chunks, VoxelSorting& result)
{
  struct Entry {
    std::uint64_t key;
    std::uint32_t chunk, bin;
  };
  std::vector<Entry> entries;
  for (std::uint32_t chunk = 0; chunk < chunks.size(); ++chunk)
    for (std::uint32_t bin = 0; bin < chunks[chunk].bins.size(); ++bin)
      entries.push_back({mortonOf(chunks[chunk].bins[bin].cell), chunk, bin});
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.chunk < b.chunk; });

  for (std::size_t i = 0; i < entries.size(); ++i) result.voxel_count += i == 0 || entries[i].key != entries[i - 1].key;
  result.voxels = std::make_unique<Voxel[]>(result.voxel_count);
  result.buffer.reset(new float[4 * result.size + kBlockPadding * result.voxel_count]);

  std::size_t voxel = 0, point = 0;
  for (std::size_t i = 0; i < entries.size(); ++voxel) {
    Voxel& v = result.voxels[voxel];
    v.key = entries[i].key;
    v.begin = static_cast<std::uint32_t>(point);
    v.block = result.buffer.get() + 4 * point + kBlockPadding * voxel;
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (; i < entries.size() && entries[i].key == v.key; ++i) {
      Bin<T>& bin = chunks[entries[i].chunk].bins[entries[i].bin];
      bin.voxel = static_cast<std::uint32_t>(voxel);
      bin.next = v.count;
      v.count += bin.count;
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], static_cast<double>(bin.low[k]));
        high[k] = std::max(high[k], static_cast<double>(bin.high[k]));
      }
    }
    v.frame = frameBetween(low, high, std::is_same_v<T, float>);
    point += v.count;
  }
}

/// Points stand in the view's order, so that without a subset the first is the lowest.
std::uint32_t lowestRecord(const Voxel& voxel, const PointsView& view)
{
  const auto* points = reinterpret_cast<const PointRecord*>(voxel.block);
  std::uint32_t lowest = points->record;
  if (view.indices)
    for (std::uint32_t i = 1; i < voxel.count; ++i) lowest = std::min(lowest, points[i].record);
  return lowest;
}

template <class T, class K>
void distribute(const PointsView& view, const Bounds& bounds, std::size_t chunk_count, unsigned threads,
                VoxelSorting& result)
{
  const Reader<T> read(view);
  const CellNumbers<K> cell_of(result.edge, bounds);
  const auto chunkBegin = [&](std::size_t chunk) { return chunk * view.size() / chunk_count; };

  std::vector<std::uint32_t> bin_of(view.size());
  std::vector<BinTable<T>> chunks(chunk_count);
  parallelFor(chunk_count, threads, [&](std::size_t chunk) {
    BinTable<T>& table = chunks[chunk];
    std::uint64_t last_cell = ~std::uint64_t{0};
    std::uint32_t bin = 0;
    for (std::size_t i = chunkBegin(chunk); i < chunkBegin(chunk + 1); ++i) {
      const Coordinates<T> c = read(read.record(i));
      if (!c.finite()) {
        bin_of[i] = kNoVoxel;
        continue;
      }
      const std::uint64_t cell = cell_of(c);
      if (cell != last_cell) bin = table.find(last_cell = cell);
      table.bins[bin].add(c);
      bin_of[i] = bin;
    }
  });

  mergeBins(chunks, result);

  parallelFor(chunk_count, threads, [&](std::size_t chunk) {
    struct Target {
      ToLocal<T> to_local;
      PointRecord* next;
    };
    std::vector<Target> targets;
    for (const Bin<T>& bin : chunks[chunk].bins) {
      const Voxel& voxel = result.voxels[bin.voxel];
      targets.push_back({ToLocal<T>(voxel.frame), reinterpret_cast<PointRecord*>(voxel.block) + bin.next});
    }
    for (std::size_t i = chunkBegin(chunk); i < chunkBegin(chunk + 1); ++i) {
      if (bin_of[i] == kNoVoxel) continue;
      Target& target = targets[bin_of[i]];
      const std::uint32_t record = read.record(i);
      *target.next++ = target.to_local(read(record), record);
    }
  });
  for (std::size_t v = 0; v < result.voxel_count; ++v) result.voxels[v].lowest = lowestRecord(result.voxels[v], view);
}

template <class T>
VoxelSorting sortPoints(const PointsView& view, const HierarchyOptions& options)
{
  const unsigned threads = threadCount(options.threads);
  const std::size_t chunks = threads == 1 ? 1 : std::clamp<std::size_t>(view.size() / kChunkPoints, 1, threads);
  VoxelSorting result;
  const Bounds bounds = boundsOf<T>(view, chunks, threads);
  result.size = bounds.finite;
  if (result.size == 0) return result;
  result.frame = frameBetween(bounds.low, bounds.high, std::is_same_v<T, float>);
  result.edge =
      options.voxel_edge > 0.0 ? voxelEdgeFromRequest(options.voxel_edge, bounds) : voxelEdgeFromDensity(view, bounds);
  const bool float_cells = std::is_same_v<T, float> && result.edge >= 0x1p-60 && result.edge <= 0x1p100;
  if (float_cells)
    distribute<T, float>(view, bounds, chunks, threads, result);
  else
    distribute<T, double>(view, bounds, chunks, threads, result);
  return result;
}

} // namespace

VoxelSorting sortIntoVoxels(const PointsView& view, const HierarchyOptions& options)
{
  return view.scalar == Scalar::float32 ? sortPoints<float>(view, options) : sortPoints<double>(view, options);
}

} // namespace pcl_bsh
