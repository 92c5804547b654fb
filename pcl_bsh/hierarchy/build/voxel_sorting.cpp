// SPDX-License-Identifier: BSD-3-Clause
// Which points are in which voxel: a counting sort. Where points follow each other in long runs, as in a scan, it lists
// runs, and points are read again where a voxel is built: what no query visits is never copied. Points in another order
// are copied at once, since later each of them would be a miss of the caches.
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/build/voxel_edge.h>
#include <pcl_bsh/hierarchy/frame_between.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/hierarchy/build/voxel_sorting.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/hierarchy/build/cell_numbers-inl.h>
#include <pcl_bsh/hierarchy/build/local_points-inl.h>
#include <pcl_bsh/hierarchy/build/voxel_bins-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// The point at which a chunk first asks the watcher. Chunks ask at once, so that many small chunks ask often enough.
/// The first chunk asks later, so that a small cloud never asks.
std::size_t firstToAsk(std::size_t chunk, std::size_t begin)
{
  return chunk == 0 ? begin + kPairsOfPulse : begin;
}

constexpr std::size_t kChunkPoints = 1 << 16; // points a thread takes at least: below that, one thread is faster

template <class T>
class VoxelSorter {
public:
  VoxelSorter(const PointsView& view, const HierarchyOptions& options)
  : view_(view),
    options_(options),
    read_(view),
    threads_(threadCount(options.threads)),
    chunk_count_(threads_ == 1 ? 1 : std::clamp<std::size_t>(view.size() / kChunkPoints, 1, threads_))
  {
  }

  VoxelSorting run()
  {
    // A sample's bounds will do, unless some point lies far outside, or voxels get too many. Then bounds and edges come
    // from all points, not from results of chunks that gave up.
    if (!fillBins(sampleBounds(), 0.0)) {
      const Bounds bounds = findBounds();
      if (bounds.finite == 0) return std::move(result_);
      for (double least_edge = 0.0; !fillBins(bounds, least_edge); least_edge = 2 * result_.edge)
        if (!(least_edge < 0x1p1006)) throw std::logic_error("SphereHierarchy: voxels do not reach over the cloud");
    }
    mergeBins();
    result_.lists ? listRecords() : movePoints();
    for (std::size_t v = 0; v < result_.voxel_count; ++v) result_.voxels[v].lowest = lowestRecord(result_.voxels[v]);
    return std::move(result_);
  }

private:
  template <class Body>
  void eachPoint(std::size_t chunk, const Body& body) const
  {
    const std::int32_t* const indices = view_.indices;
    const std::size_t end = chunkEnd(chunk);
    for (std::size_t i = chunkBegin(chunk); i < end; ++i)
      body(i, indices ? static_cast<std::uint32_t>(indices[i]) : static_cast<std::uint32_t>(i));
  }

  std::size_t chunkBegin(std::size_t chunk) const { return chunk * view_.size() / chunk_count_; }
  std::size_t chunkEnd(std::size_t chunk) const { return chunkBegin(chunk + 1); }

  Bounds findBounds() const
  {
    std::vector<Bin<T>> parts(chunk_count_);
    parallelFor(chunk_count_, threads_, [&](std::size_t chunk) {
      GivenPoint<T> low = GivenPoint<T>::load(parts[chunk].low), high = GivenPoint<T>::load(parts[chunk].high);
      eachPoint(chunk, [&](std::size_t, std::uint32_t record) {
        const GivenPoint<T> p = read_(record);
        if (!p.finite()) return;
        low = min(low, p);
        high = max(high, p);
        ++parts[chunk].count;
      });
      low.store(parts[chunk].low);
      high.store(parts[chunk].high);
    });
    Bounds bounds;
    for (const Bin<T>& part : parts) {
      bounds.finite += part.count;
      widen(bounds, part);
    }
    return bounds;
  }

  static void widen(Bounds& bounds, const Bin<T>& bin)
  {
    const auto corner = [](const T* c) {
      return Point3{static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
    };
    bounds.add(corner(bin.low), corner(bin.high));
  }

  Bounds sampleBounds() const
  {
    Bin<T> bin;
    const std::size_t sample = sampleSize(view_);
    for (std::size_t i = 0; i < sample; ++i) {
      const GivenPoint<T> p = read_(sampleRecord(view_, i));
      if (p.finite()) bin.add(p);
    }
    Bounds bounds;
    if (sample > 0) bounds.finite = bin.count * (view_.size() / sample);
    widen(bounds, bin);
    return bounds;
  }

  /// Counts the points of every cell. @return false when there are no bounds, or points too far outside of them, or
  /// more cells than voxels may be.
  bool fillBins(const Bounds& bounds, double least_edge)
  {
    if (bounds.finite == 0) return false;
    const std::size_t most = mostVoxels(view_.size());
    result_.edge = options_.voxel_edge > 0.0 ? voxelEdgeFromRequest(options_.voxel_edge, bounds)
                                             : voxelEdgeFromDensity(view_, bounds);
    // Cell numbers are computed in T: the inverse of the edge must not overflow.
    result_.edge = std::max({result_.edge, static_cast<double>(std::numeric_limits<T>::min()) * 0x1p20, least_edge});
    result_.base = CellNumbers<T>::baseOf(result_.edge, bounds);
    const CellNumbers<T> cell_of(result_.edge, result_.base);
    if (!runs_) runs_ = makeBuffer<std::uint32_t>(view_.size());
    chunks_.assign(chunk_count_, BinTable<T>());
    moveBeginsToRuns(cell_of);
    std::vector<std::uint8_t> gave_up(chunk_count_, 0);
    parallelFor(chunk_count_, threads_, [&](std::size_t chunk) {
      BinTable<T>& table = chunks_[chunk];
      RunWriter write(runs_.get() + begins_[chunk]);
      const GivenPoint<T> nowhere = GivenPoint<T>::of(std::numeric_limits<T>::quiet_NaN());
      GivenPoint<T> cell_of_run = nowhere, low = nowhere, high = nowhere;
      std::uint32_t bin = kNoBin;
      std::size_t first = begins_[chunk];
      const auto endRun = [&](std::size_t end) {
        if (end == first) return;
        const auto points = static_cast<std::uint32_t>(end - first);
        if (bin != kNoBin) table.bins[bin].add(low, high, points, wordsOf(first, end));
        write({bin, points});
        first = end;
      };
      const std::int32_t* const indices = view_.indices;
      const std::size_t end = begins_[chunk + 1];
      Pulse pulse;
      for (std::size_t i = first, ask = firstToAsk(chunk, i); i < end; ++i) {
        if (i >= ask) pulse.count(kPairsOfPulse), ask = i + kPairsOfPulse;
        const GivenPoint<T> p = read_(indices ? static_cast<std::uint32_t>(indices[i]) : static_cast<std::uint32_t>(i));
        const GivenPoint<T> numbers = cell_of.numbers(p);
        if (sameXyz(numbers, cell_of_run)) {
          low = min(low, p);
          high = max(high, p);
          continue;
        }
        endRun(i);
        const std::uint64_t cell = CellNumbers<T>::together(numbers);
        if (cell == kOutsideGrid) {
          if (p.finite()) {
            gave_up[chunk] = 1;
            return;
          }
          bin = kNoBin;
          cell_of_run = nowhere;
          continue;
        }
        bin = table.find(cell);
        if (table.bins.size() > most) {
          gave_up[chunk] = 1;
          return;
        }
        cell_of_run = numbers;
        low = high = p;
      }
      endRun(end);
    });
    return std::find(gave_up.begin(), gave_up.end(), 1) == gave_up.end() && countCells() <= most;
  }

  /// Calls visit(run) for the runs of records that points [begin, end) of the view are.
  template <class Visit>
  void eachRunOf(std::size_t begin, std::size_t end, Visit&& visit) const
  {
    if (view_.indices)
      eachRun(
          begin, end, [&](std::size_t i) { return view_.record(i); }, visit);
    else
      visit(Run{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)});
  }

  std::uint32_t wordsOf(std::size_t begin, std::size_t end) const
  {
    std::uint32_t words = 0;
    eachRunOf(begin, end, [&](const Run& run) { words += run.words(); });
    return words;
  }

  /// Has chunks begin where runs of points in one cell do, so that runs are the same for any number of chunks.
  void moveBeginsToRuns(const CellNumbers<T>& cell_of)
  {
    begins_.assign(chunk_count_ + 1, view_.size());
    const auto numbersOf = [&](std::size_t i) { return cell_of.numbers(read_(view_.record(i))); };
    for (std::size_t chunk = 0; chunk < chunk_count_; ++chunk) {
      std::size_t begin = std::max(chunkBegin(chunk), chunk > 0 ? begins_[chunk - 1] : 0);
      if (begin > 0)
        for (const auto before = numbersOf(begin - 1); begin < view_.size() && sameXyz(numbersOf(begin), before);)
          ++begin;
      begins_[chunk] = begin;
    }
  }

  /// The number of cells that hold points. Cells that chunks share may count several times, as long as the sum is at
  /// most mostVoxels().
  std::size_t countCells() const
  {
    std::size_t bins = 0;
    for (const BinTable<T>& chunk : chunks_) bins += chunk.bins.size();
    if (bins <= mostVoxels(view_.size())) return bins;
    std::vector<std::uint64_t> cells;
    cells.reserve(bins);
    for (const BinTable<T>& chunk : chunks_)
      for (const Bin<T>& bin : chunk.bins) cells.push_back(bin.cell);
    std::sort(cells.begin(), cells.end());
    return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
  }

  /// Gives every voxel that some chunk saw its number (in Morton order), frame and place in the buffer, so that a
  /// voxel's points stand in the order of the cloud however many chunks there are.
  void mergeBins()
  {
    struct Entry {
      std::uint64_t key;
      std::uint32_t chunk;
      Bin<T>* bin;
    };
    std::vector<Entry> entries;
    for (std::uint32_t chunk = 0; chunk < chunks_.size(); ++chunk)
      for (Bin<T>& bin : chunks_[chunk].bins) entries.push_back({CellNumbers<T>::morton(bin.cell), chunk, &bin});
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.chunk < b.chunk; });

    for (std::size_t i = 0; i < entries.size(); ++i)
      result_.voxel_count += i == 0 || entries[i].key != entries[i - 1].key;
    std::size_t words = 0;
    for (const Entry& entry : entries) {
      result_.size += entry.bin->count;
      words += entry.bin->words;
    }
    result_.voxels = std::make_unique<Voxel[]>(result_.voxel_count);
    result_.buffer = makeBuffer<float>(4 * result_.size + kBlockPadding * result_.voxel_count);

    if (words <= result_.size / 2) {
      result_.list_words = words + kListPadding;
      result_.lists = makeBuffer<std::uint32_t>(result_.list_words);
      std::fill_n(result_.lists.get() + words, kListPadding, 0u);
    }
    std::uint32_t* list = result_.lists.get();

    const float largest_radius = largestRadiusOf(view_);
    std::size_t point = 0;
    Bounds all;
    auto entry = entries.begin();
    for (std::size_t v = 0; v < result_.voxel_count; ++v) {
      Voxel& voxel = result_.voxels[v];
      voxel.key = entry->key;
      voxel.begin = static_cast<std::uint32_t>(point);
      voxel.block = result_.buffer.get() + 4 * point + kBlockPadding * v;
      voxel.list = list;
      Bounds bounds;
      for (; entry != entries.end() && entry->key == voxel.key; ++entry) {
        entry->bin->voxel = static_cast<std::uint32_t>(v);
        entry->bin->first = voxel.count;
        entry->bin->list = list;
        if (list) list += entry->bin->words;
        voxel.count += entry->bin->count;
        widen(bounds, *entry->bin);
        widen(all, *entry->bin);
      }
      voxel.frame = frameBetween(bounds.low, bounds.high, std::is_same_v<T, float>, largest_radius);
      point += voxel.count;
    }
    if (result_.size > 0) result_.frame = frameBetween(all.low, all.high, std::is_same_v<T, float>, largest_radius);
  }

  /// Every voxel's records, in the order of the view.
  void listRecords()
  {
    parallelFor(chunk_count_, threads_, [&](std::size_t chunk) {
      std::vector<RunWriter> lists;
      lists.reserve(chunks_[chunk].bins.size());
      for (const Bin<T>& bin : chunks_[chunk].bins) lists.emplace_back(bin.list);
      Pulse pulse;
      RunReader read_run(runs_.get() + begins_[chunk]);
      for (std::size_t i = begins_[chunk], ask = firstToAsk(chunk, i); i < begins_[chunk + 1];) {
        if (i >= ask) pulse.count(kPairsOfPulse), ask = i + kPairsOfPulse;
        const Run run = read_run();
        if (run.number != kNoBin) eachRunOf(i, i + run.points, lists[run.number]);
        i += run.points;
      }
    });
  }

  /// Every voxel's points, in the order of the view.
  void movePoints()
  {
    parallelFor(chunk_count_, threads_, [&](std::size_t chunk) {
      Pulse pulse;
      std::vector<Target> targets;
      targets.reserve(chunks_[chunk].bins.size());
      for (const Bin<T>& bin : chunks_[chunk].bins) {
        const Voxel& voxel = result_.voxels[bin.voxel];
        targets.push_back({reinterpret_cast<PointRecord*>(voxel.block) + bin.first, LocalPlace<T>(voxel.frame)});
      }
      RunReader read_run(runs_.get() + begins_[chunk]);
      for (std::size_t i = begins_[chunk], ask = firstToAsk(chunk, i); i < begins_[chunk + 1];) {
        if (i >= ask) pulse.count(kPairsOfPulse), ask = i + kPairsOfPulse;
        const Run run = read_run();
        if (run.number != kNoBin) {
          Target& target = targets[run.number];
          for (std::size_t k = i; k < i + run.points; ++k) {
            const std::uint32_t record = view_.record(k);
            storePoint(target.place(read_(record)), record, *target.next++);
          }
        }
        i += run.points;
      }
    });
  }

  /// Where the next point of a voxel goes. Points in random order take another one each: of floats, one cache line.
  struct alignas(64) Target {
    PointRecord* next;
    LocalPlace<T> place;
  };

  /// Points stand in the view's order, so that without a subset the first is the lowest.
  std::uint32_t lowestRecord(const Voxel& voxel) const
  {
    if (!view_.indices)
      return voxel.isListed() ? RunReader(voxel.list)().number
                              : reinterpret_cast<const PointRecord*>(voxel.block)->record;
    std::uint32_t lowest = 0xffffffffu;
    voxel.forEachRecord([&](std::uint32_t record) { lowest = std::min(lowest, record); });
    return lowest;
  }

  const PointsView& view_;
  const HierarchyOptions& options_;
  const Reader<T> read_;
  const unsigned threads_;
  const std::size_t chunk_count_;
  std::vector<std::size_t> begins_; // of the chunks, and the end
  LargeBuffer<std::uint32_t> runs_; // each chunk's runs begin at the number of its first point
  std::vector<BinTable<T>> chunks_;
  VoxelSorting result_;
};

} // namespace

VoxelSorting sortFloats(const PointsView& view, const HierarchyOptions& options)
{
  return VoxelSorter<float>(view, options).run();
}
VoxelSorting sortDoubles(const PointsView& view, const HierarchyOptions& options)
{
  return VoxelSorter<double>(view, options).run();
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(sortFloats);
HWY_EXPORT(sortDoubles);

VoxelSorting sortIntoVoxels(const PointsView& view, const HierarchyOptions& options)
{
  return view.scalar == Scalar::float32 ? HWY_DYNAMIC_DISPATCH(sortFloats)(view, options)
                                        : HWY_DYNAMIC_DISPATCH(sortDoubles)(view, options);
}

} // namespace pcl_bsh
#endif
