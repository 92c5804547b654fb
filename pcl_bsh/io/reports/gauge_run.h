// SPDX-License-Identifier: BSD-3-Clause
// A gauging run, batch by batch, and the files that it makes: for the program and for pipelines.
//
//   GaugeRun run(report, threads);
//   run.add(points, first); // for each batch
//   remarks = run.finish(previous, earlier);
#pragma once

#include <pcl_bsh/io/reports/gauge_report.h>
#include <pcl_bsh/track/tracks.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Points of a batch. So many are read at once, and gauged between two checks whether to stop.
inline constexpr std::size_t gauge_batch_points = std::size_t{1} << 18;

/// Calls use(points, number of the first one) for each batch of a cloud, in order.
template <class Use>
void forEachGaugeBatch(const PointsView& all, const Use& use)
{
  for (std::size_t first = 0; first < all.count; first += gauge_batch_points) {
    PointsView batch = all;
    batch.data = static_cast<const unsigned char*>(all.data) + first * all.stride;
    batch.count = std::min(gauge_batch_points, all.count - first);
    use(batch, first);
  }
}

/// A table for each track. @param step length of a part @throws InvalidInput as GaugeTable does
std::vector<GaugeTable> tablesOf(const std::vector<Track>& tracks, double step);

/// Where the beams of a cloud's points come from.
struct BeamOrigins {
  OriginPath path;
  TimeField times;
};

/// The outlines of each track. @throws InvalidInput as SeenOutline does
std::vector<SeenOutline> seenOf(const std::vector<Track>& tracks, const SeenCells& cells);

/// A remark about points whose time a path does not have; empty where there are none.
std::string outsideRemark(const OutsidePath& outside, const OriginPath& path);

/// Gathers a report. It does not depend on how points are divided into batches, nor on the order of batches.
class GaugeRun {
public:
  /// @param origins null: beams are not known; else the report has `seen`. Borrowed
  GaugeRun(GaugeReport& report, unsigned threads, const BeamOrigins* origins = nullptr)
  : report_(report),
    threads_(threads),
    origins_(origins)
  {
  }

  /// @param first number of the batch's first point among all points
  /// @param numbers of each point, rising; null: they count on from `first`
  GaugedTracks add(const PointsView& points, std::uint64_t first, const std::uint64_t* numbers = nullptr);

  /// Joins the runs of several processes. Each of them calls it. @param all as GaugeTable::join() takes it
  template <class All>
  void join(const All& all)
  {
    for (GaugeTable& table : report_.tables) table.join(all);
    for (SeenOutline& seen : report_.seen) seen.join(all);
    infringing_ = all(infringing_);
    const std::vector<Sums> sums = all(std::vector<Sums>{{report_.counts, report_.infringing, report_.outside}});
    report_.counts = {};
    report_.infringing = 0;
    report_.outside = {};
    for (const Sums& of_one : sums) {
      for (std::size_t state = 0; state < report_.counts.size(); ++state) report_.counts[state] += of_one.counts[state];
      report_.infringing += of_one.infringing;
      addOutside(of_one.outside);
    }
  }

  /// Finds infringements, with their names and states. To be called after the last batch.
  /// @param earlier the list in the file `previous`, where there is one @return remarks about that file
  std::vector<std::string> finish(const std::filesystem::path& previous, const std::optional<GaugeList>& earlier);

private:
  struct Sums {
    std::array<std::size_t, 6> counts;
    std::size_t infringing;
    OutsidePath outside;
  };
  void addOutside(const OutsidePath& outside);

  GaugeReport& report_;
  unsigned threads_;
  const BeamOrigins* origins_;
  std::vector<Infringing> infringing_;
};

/// Where a report goes. An empty path: nowhere.
struct GaugeFiles {
  std::filesystem::path table, infringements, report, page;

  /// @throws files::FileError where one of them cannot be written
  void requireWritable() const;
  /// @throws files::FileError
  void write(const GaugeReport& told) const;
};

} // namespace pcl_bsh::io
