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
  if (entry.has("track")) listed.track = entry.at("track").text();
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

ListedTrack trackFrom(const JsonReader& entry, const std::string& name)
{
  ListedTrack track{name, entry.at("axis").at("length").number(0), {}};
  for (const JsonReader& envelope : entry.at("envelopes").elements()) track.envelopes.push_back(envelope.text());
  return track;
}

/// Why an earlier infringement of a track is not found any more.
ClashStatus statusOfGone(const GaugeReport& report, std::size_t of_track, const ListedInfringement& gone)
{
  const Track& track = report.tracks[of_track];
  const GaugeTable& table = report.tables[of_track];
  const auto envelope = std::find_if(track.envelopes.begin(), track.envelopes.end(),
                                     [&](const Envelope& candidate) { return candidate.name() == gone.envelope; });
  const AxisPlaces places = track.axis.nearest(gone.clash.place, report.reach);
  if (envelope == track.envelopes.end() || !hasPlace(places.state)) return ClashStatus::not_visited;
  const auto counts = [&](const AxisPlace& at) { return envelope->countsAt(track.axis.chainage(at.distance)); };
  const auto isSeen = [&](const AxisPlace& at) {
    const auto sector = static_cast<Sector>(envelope->aroundOf({at.offset, at.height}));
    const auto number = static_cast<std::size_t>(envelope - track.envelopes.begin());
    const std::size_t part = table.partOf(at.distance);
    return report.seen.empty() ? std::isfinite(table.smallest(part, number, sector))
                               : report.seen[of_track].share(part, number, sector) > 0.0;
  };
  const bool best_counts = counts(places.best);
  const bool second_counts = places.state == PlaceState::two_places && counts(places.second);
  if (!best_counts && !second_counts) return ClashStatus::not_visited;
  return (best_counts && isSeen(places.best)) || (second_counts && isSeen(places.second)) ? ClashStatus::resolved
                                                                                          : ClashStatus::not_scanned;
}

/// Adds remarks on how the earlier run of a track differs from this one.
void addRemarks(const GaugeReport& report, const Track& now, const ListedTrack& former,
                std::vector<std::string>& remarks)
{
  const std::string of = now.name.empty() ? "" : " of track '" + now.name + "'";
  if (std::abs(former.axis_length - now.axis.length()) > report.cluster_distance)
    remarks.push_back("lists infringements along an axis" + of + ' ' + numberText(former.axis_length) +
                      " long, now it is " + numberText(now.axis.length()) +
                      ": chainages of those that are gone are of the earlier axis");
  for (const std::string& envelope : former.envelopes)
    if (std::none_of(now.envelopes.begin(), now.envelopes.end(),
                     [&](const Envelope& given) { return given.name() == envelope; }))
      remarks.push_back("lists infringements of the profile '" + envelope + "'" + of +
                        ", which is not given now: those that are gone are called not_visited, and not resolved");
}

/// compareWithEarlier() for the infringements of one track.
void compareTrack(GaugeReport& report, std::size_t number, const GaugeList& earlier)
{
  const Track& track = report.tracks[number];
  const auto ofTrack = [&](const std::vector<ListedInfringement>& all) {
    std::vector<Clash> clashes;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].track != track.name) continue;
      clashes.push_back(all[i].clash);
      clashes.back().scan_point = static_cast<std::uint32_t>(i);
    }
    return clashes;
  };
  std::vector<Clash> now = ofTrack(report.listed);
  const std::size_t present = now.size();
  compareWithEarlier(now, ofTrack(earlier.infringements), report.cluster_distance);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i < present) {
      report.listed[now[i].scan_point].clash = now[i];
      continue;
    }
    ListedInfringement gone = earlier.infringements[now[i].scan_point];
    gone.clash.status = statusOfGone(report, number, gone);
    report.listed.push_back(std::move(gone));
  }
}

} // namespace

std::vector<ListedInfringement> listedOf(const GaugeReport& report, const std::vector<Infringing>& points)
{
  std::vector<ListedInfringement> listed(report.infringements.size());
  for (std::size_t t = 0; t < report.tracks.size(); ++t) {
    const Track& track = report.tracks[t];
    std::vector<Clash> clashes;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      if (report.infringements[i].worst.track != t) continue;
      clashes.push_back(clashOf(report.infringements[i], points));
      clashes.back().scan_point = static_cast<std::uint32_t>(i);
    }
    nameClashes(clashes, report.cluster_distance);
    for (Clash& clash : clashes) {
      const Infringement& infringement = report.infringements[clash.scan_point];
      const Infringing& worst = infringement.worst;
      ListedInfringement& entry = listed[clash.scan_point];
      if (!track.name.empty()) clash.id = track.name + ':' + clash.id;
      entry.clash = std::move(clash);
      entry.track = track.name;
      entry.envelope = track.envelopes[static_cast<std::size_t>(worst.envelope)].name();
      entry.chainage_from = track.axis.chainage(infringement.from);
      entry.chainage_to = track.axis.chainage(infringement.to);
      entry.chainage = track.axis.chainage(worst.place.distance);
      entry.distance = worst.place.distance;
      entry.offset = worst.place.offset;
      entry.height = worst.place.height;
      entry.record = worst.record;
    }
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
  if (reader.has("tracks"))
    for (const JsonReader& track : reader.at("tracks").elements())
      list.tracks.push_back(trackFrom(track, track.at("name").text()));
  else
    list.tracks.push_back(trackFrom(reader, ""));
  for (const JsonReader& entry : reader.at("infringements").elements())
    list.infringements.push_back(infringementFrom(entry));
  return list;
}

std::vector<std::string> compareWithList(GaugeReport& report, const std::filesystem::path& file,
                                         const GaugeList& earlier)
{
  report.previous = file.string();
  std::vector<std::string> remarks;
  for (std::size_t t = 0; t < report.tracks.size(); ++t) compareTrack(report, t, earlier);
  const auto trackCalled = [&](const std::string& name) {
    return std::find_if(report.tracks.begin(), report.tracks.end(),
                        [&](const Track& track) { return track.name == name; });
  };
  for (const ListedTrack& former : earlier.tracks) {
    const auto now = trackCalled(former.name);
    if (now != report.tracks.end())
      addRemarks(report, *now, former, remarks);
    else
      remarks.push_back("lists infringements of " +
                        (former.name.empty() ? "a track without a name" : "the track '" + former.name + "'") +
                        ", which is not given now: they are called not_visited, and not resolved");
  }
  for (ListedInfringement gone : earlier.infringements) {
    if (gone.clash.status == ClashStatus::resolved || trackCalled(gone.track) != report.tracks.end()) continue;
    gone.clash.status = ClashStatus::not_visited;
    report.listed.push_back(std::move(gone));
  }
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
