// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/clash_values.h>
#include <pcl_bsh/io/reports/gauge_list.h>

#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/reports/clash_list.h>
#include <pcl_bsh/io/reports/gauge_report.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh::io {
namespace {

/// The box about the points of an infringement, and what else a comparison needs.
Clash clashOf(const Infringement& infringement, const std::vector<Infringing>& points)
{
  Clash clash;
  Extent box{infringement.worst.at, infringement.worst.at};
  for (const std::size_t member : infringement.members) box.add({points[member].at, points[member].at});
  clash.low = box.low;
  clash.high = box.high;
  clash.points = clash.certain_points = infringement.members.size();
  clash.place = infringement.worst.at;
  clash.distance = infringement.worst.clearance;
  return clash;
}

ListedInfringement infringementFrom(const JsonReader& entry)
{
  const auto numberAt = [&](const char* key) { return entry.at(key).number(); };
  ListedInfringement listed;
  Clash& clash = listed.clash;
  clash.id = entry.at("id").text();
  clash.status = statusFrom(entry.at("status"));
  clash.points = clash.certain_points = static_cast<std::size_t>(entry.at("points").whole(1, max_points));
  const Extent box = boxFrom(entry.at("box"));
  clash.low = box.low;
  clash.high = box.high;
  clash.place = pointFrom(entry.at("at"));
  clash.distance = numberAt("clearance");
  listed.envelope = entry.at("envelope").text();
  listed.chainage_from = numberAt("chainage_from");
  listed.chainage_to = numberAt("chainage_to");
  listed.chainage = numberAt("chainage");
  listed.distance = numberAt("distance");
  listed.offset = numberAt("offset");
  listed.height = numberAt("height");
  listed.record = entry.at("record").whole(0, std::uint64_t{1} << 53);
  return listed;
}

/// Why an earlier infringement is not found any more.
ClashStatus statusOfGone(const GaugeReport& report, const ListedInfringement& gone)
{
  const auto envelope = std::find_if(report.envelopes.begin(), report.envelopes.end(),
                                     [&](const Envelope& candidate) { return candidate.name() == gone.envelope; });
  const AxisPlaces places = report.axis.nearest(gone.clash.place, report.reach);
  if (envelope == report.envelopes.end() || !hasPlace(places.state)) return ClashStatus::not_visited;
  const auto counts = [&](const AxisPlace& at) { return envelope->countsAt(report.axis.chainage(at.distance)); };
  const auto isSeen = [&](const AxisPlace& at) {
    const auto sector = static_cast<Sector>(envelope->aroundOf({at.offset, at.height}));
    const auto number = static_cast<std::size_t>(envelope - report.envelopes.begin());
    return std::isfinite(report.table.smallest(report.table.partOf(at.distance), number, sector));
  };
  const bool best_counts = counts(places.best);
  const bool second_counts = places.state == PlaceState::two_places && counts(places.second);
  if (!best_counts && !second_counts) return ClashStatus::not_visited;
  return (best_counts && isSeen(places.best)) || (second_counts && isSeen(places.second)) ? ClashStatus::resolved
                                                                                          : ClashStatus::not_scanned;
}

} // namespace

std::vector<ListedInfringement> listedOf(const GaugeReport& report, const std::vector<Infringing>& points)
{
  std::vector<Clash> clashes;
  for (const Infringement& infringement : report.infringements) {
    clashes.push_back(clashOf(infringement, points));
    clashes.back().scan_point = static_cast<std::uint32_t>(clashes.size() - 1);
  }
  nameClashes(clashes, report.cluster_distance);
  std::vector<ListedInfringement> listed(clashes.size());
  for (Clash& clash : clashes) {
    const Infringement& infringement = report.infringements[clash.scan_point];
    const Infringing& worst = infringement.worst;
    ListedInfringement& entry = listed[clash.scan_point];
    entry.clash = std::move(clash);
    entry.envelope = report.envelopes[static_cast<std::size_t>(worst.envelope)].name();
    entry.chainage_from = report.axis.chainage(infringement.from);
    entry.chainage_to = report.axis.chainage(infringement.to);
    entry.chainage = report.axis.chainage(worst.place.distance);
    entry.distance = worst.place.distance;
    entry.offset = worst.place.offset;
    entry.height = worst.place.height;
    entry.record = worst.record;
  }
  return listed;
}

GaugeList readGaugeList(const std::filesystem::path& path, double limit)
{
  const FileBytes file(path);
  GaugeList list = parseGaugeList(file.view(), path.string());
  if (list.limit != limit)
    throw files::FileError(
        path, "lists infringements with --limit " + numberText(list.limit) + ", now it is " + numberText(limit),
        "ask with the same limit, or compare with another report");
  return list;
}

GaugeList parseGaugeList(std::string_view text, const std::string& name)
{
  const std::string beginning = name + ": is no report of a gauging run"; // which JsonReader refers to
  const Json json = parseJson(text, beginning);
  const JsonReader reader(json, beginning);
  GaugeList list;
  list.limit = reader.at("limit").number();
  list.axis_length = reader.at("axis").at("length").number(0);
  for (const JsonReader& envelope : reader.at("envelopes").elements()) list.envelopes.push_back(envelope.text());
  for (const JsonReader& entry : reader.at("infringements").elements())
    list.infringements.push_back(infringementFrom(entry));
  return list;
}

std::vector<std::string> compareWithList(GaugeReport& report, const std::filesystem::path& file,
                                         const GaugeList& earlier)
{
  std::vector<std::string> remarks;
  if (std::abs(earlier.axis_length - report.axis.length()) > report.cluster_distance)
    remarks.push_back("lists infringements along an axis " + numberText(earlier.axis_length) + " long, now it is " +
                      numberText(report.axis.length()) + ": chainages of those that are gone are of the earlier axis");
  for (const std::string& envelope : earlier.envelopes)
    if (std::none_of(report.envelopes.begin(), report.envelopes.end(),
                     [&](const Envelope& now) { return now.name() == envelope; }))
      remarks.push_back("lists infringements of the profile '" + envelope +
                        "', which is not given now: those that are gone are called not_visited, and not resolved");

  std::vector<Clash> now, before;
  const auto add = [](std::vector<Clash>& to, const std::vector<ListedInfringement>& from) {
    for (const ListedInfringement& listed : from) {
      to.push_back(listed.clash);
      to.back().scan_point = static_cast<std::uint32_t>(to.size() - 1);
    }
  };
  add(now, report.listed);
  add(before, earlier.infringements);
  compareWithEarlier(now, before, report.cluster_distance);
  const std::size_t present = report.listed.size();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i < present) {
      report.listed[i].clash = now[i];
      continue;
    }
    ListedInfringement gone = earlier.infringements[now[i].scan_point];
    gone.clash.status = statusOfGone(report, gone);
    report.listed.push_back(std::move(gone));
  }
  report.previous = file.string();
  return remarks;
}

std::string stateCounts(const std::vector<ListedInfringement>& listed)
{
  std::string text;
  for (std::size_t i = 0; i < clash_statuses; ++i) {
    const auto status = static_cast<ClashStatus>(i);
    const auto count = std::count_if(listed.begin(), listed.end(),
                                     [&](const ListedInfringement& one) { return one.clash.status == status; });
    if (count == 0 && status > ClashStatus::resolved) continue; // rare ones
    text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + inWords(status);
  }
  return text;
}

} // namespace pcl_bsh::io
