// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/gauge_run.h>

#include <pcl_bsh/io/files/replace_file.h>

#include <ostream>

namespace pcl_bsh::io {

GaugeRun::GaugeRun(GaugeReport& report, GaugeTable& table, unsigned threads)
: report_(report),
  table_(table),
  threads_(threads)
{
}

GaugedPoints GaugeRun::add(const PointsView& points, std::uint64_t first)
{
  GaugedPoints found = gauge(points, report_.axis, report_.envelopes, {report_.reach, threads_});
  table_.add(found, report_.envelopes);
  addInfringing(points, found, report_.limit, first, infringing_);
  for (std::size_t state = 0; state < found.counts.size(); ++state) report_.counts[state] += found.counts[state];
  return found;
}

std::vector<std::string> GaugeRun::finish(const std::filesystem::path& previous,
                                          const std::optional<GaugeList>& earlier)
{
  report_.infringing = infringing_.size();
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
  if (!report.empty()) files::replaceFile(report, [&](std::ostream& out) { out << printed(gaugeJson(told)); });
  if (!page.empty()) writeGaugePage(page, told);
}

} // namespace pcl_bsh::io
