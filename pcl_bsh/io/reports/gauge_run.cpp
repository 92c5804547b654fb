// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/gauge_run.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/text/number_text.h>

#include <tuple>

namespace pcl_bsh::io {

std::vector<GaugeTable> tablesOf(const std::vector<Track>& tracks, double step)
{
  std::vector<GaugeTable> tables;
  for (const Track& track : tracks) tables.emplace_back(track.axis, track.envelopes.size(), step);
  return tables;
}

std::vector<SeenOutline> seenOf(const std::vector<Track>& tracks, const SeenCells& cells)
{
  std::vector<SeenOutline> seen;
  for (const Track& track : tracks) seen.emplace_back(track.axis, track.envelopes, cells);
  return seen;
}

std::string outsideRemark(const OutsidePath& outside, const OriginPath& path)
{
  if (outside.points == 0) return {};
  return counted(outside.points, "point") + " with a time that the origin path, from " + numberText(path.from()) +
         " to " + numberText(path.to()) + ", does not have, the first record " + std::to_string(outside.first) +
         " at " + numberText(outside.time) + ": no beam of theirs sees anything";
}

void GaugeRun::addOutside(const OutsidePath& outside)
{
  OutsidePath& all = report_.outside;
  if (all.points == 0 || (outside.points > 0 && outside.first < all.first)) {
    all.first = outside.first;
    all.time = outside.time;
  }
  all.points += outside.points;
}

GaugedTracks GaugeRun::add(const PointsView& points, std::uint64_t first, const std::uint64_t* numbers)
{
  const auto numberOf = [&](std::uint64_t record) { return numbers ? numbers[record - first] : record; };
  const GaugeRequest request{report_.reach, threads_};
  GaugedTracks found = gauge(points, report_.tracks, request);
  if (origins_) {
    OutsidePath outside;
    const std::vector<Point3> origins = originsOf(points, origins_->times, origins_->path, first, outside);
    if (outside.points > 0) outside.first = numberOf(outside.first);
    addOutside(outside);
    for (SeenOutline& seen : report_.seen) seen.add(points, origins, request);
  }
  const std::size_t known = infringing_.size();
  for (std::uint32_t track = 0; track < found.each.size(); ++track) {
    report_.tables[track].add(found.each[track], report_.tracks[track].envelopes);
    addInfringing(points, found.each[track], report_.limit, first, infringing_, track);
  }
  for (std::size_t i = known; i < infringing_.size(); ++i) infringing_[i].record = numberOf(infringing_[i].record);
  for (const double clearance : found.told.clearance) report_.infringing += clearance <= report_.limit;
  for (std::size_t state = 0; state < report_.counts.size(); ++state) report_.counts[state] += found.told.counts[state];
  return found;
}

std::vector<std::string> GaugeRun::finish(const std::filesystem::path& previous,
                                          const std::optional<GaugeList>& earlier)
{
  std::sort(infringing_.begin(), infringing_.end(), [](const Infringing& a, const Infringing& b) {
    return std::tuple(a.record, a.track) < std::tuple(b.record, b.track);
  });
  report_.infringements = infringementsOf(infringing_, report_.cluster_distance);
  report_.listed = listedOf(report_, infringing_);
  return earlier ? compareWithList(report_, previous, *earlier) : std::vector<std::string>();
}

void GaugeFiles::requireWritable() const
{
  for (const std::filesystem::path* file : {&table, &infringements, &report, &page})
    if (!file->empty()) files::requireWritable(*file);
}

void GaugeFiles::write(const GaugeReport& told) const
{
  if (!table.empty()) writeGaugeTable(table, told);
  if (!infringements.empty()) writeInfringements(infringements, told);
  if (!report.empty()) writeJson(report, gaugeJson(told));
  if (!page.empty()) writeGaugePage(page, told);
}

} // namespace pcl_bsh::io
