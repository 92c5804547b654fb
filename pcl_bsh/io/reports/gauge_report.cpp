// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/gauge_report.h>

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/text/number_text.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace pcl_bsh::io {
namespace {

constexpr std::array table_sectors = {std::pair{Sector::left, "left"}, std::pair{Sector::above, "above"},
                                      std::pair{Sector::right, "right"}, std::pair{Sector::below, "below"}};

std::string cellOf(double clearance)
{
  return std::isfinite(clearance) ? numberText(clearance) : "";
}

/// A part of a track, and an envelope that counts there.
struct TablePart {
  const Track& track;
  const GaugeTable& table;
  const SeenOutline* seen;            ///< null: beams are not known
  std::size_t number, part, envelope; ///< numbers of the track, its part and its envelope
  double chainage_from, chainage_to;  ///< at a jump it ends with the chainage before
  PartState state;

  const std::string& envelopeName() const { return track.envelopes[envelope].name(); }
  double smallest() const { return table.smallest(part, envelope); }
  double smallest(Sector sector) const { return table.smallest(part, envelope, sector); }
};

template <typename Use>
void forEachPart(const GaugeReport& report, const Use& use)
{
  for (std::size_t t = 0; t < report.tracks.size(); ++t) {
    const Track& track = report.tracks[t];
    const GaugeTable& table = report.tables[t];
    for (std::size_t part = 0; part < table.parts(); ++part) {
      const double from = table.from(part), to = table.to(part), middle = track.axis.chainage(0.5 * (from + to));
      for (std::size_t e = 0; e < track.envelopes.size(); ++e)
        if (track.envelopes[e].countsAt(middle) || std::isfinite(table.smallest(part, e)))
          use(TablePart{track, table, report.seen.empty() ? nullptr : &report.seen[t], t, part, e,
                        track.axis.chainage(from), track.axis.chainage(std::nextafter(to, from)),
                        stateOf(report, t, part, e)});
    }
  }
}

Json jsonOf(const Axis& axis, const std::string& file)
{
  return {{"file", file},
          {"length", axis.length()},
          {"chainage_from", axis.chainage(0.0)},
          {"chainage_to", axis.chainage(axis.length())},
          {"gap", axis.fit().gap},
          {"deviation", axis.fit().deviation}};
}

Json namesOf(const std::vector<Envelope>& envelopes)
{
  Json names = Json::array();
  for (const Envelope& envelope : envelopes) names.push_back(envelope.name());
  return names;
}

Json jsonOf(const ListedInfringement& listed)
{
  const Clash& clash = listed.clash;
  Json json = {{"id", clash.id}, {"status", nameOf(clash.status)}};
  if (!listed.track.empty()) json["track"] = listed.track;
  json.update({{"envelope", listed.envelope},
               {"chainage_from", listed.chainage_from},
               {"chainage_to", listed.chainage_to},
               {"chainage", listed.chainage},
               {"distance", listed.distance},
               {"offset", listed.offset},
               {"height", listed.height},
               {"clearance", clash.distance},
               {"points", clash.points},
               {"record", listed.record},
               {"at", clash.place},
               {"box", {{"min", clash.low}, {"max", clash.high}}}});
  return json;
}

} // namespace

std::size_t GaugeReport::parts() const
{
  std::size_t all = 0;
  for (const GaugeTable& table : tables) all += table.parts();
  return all;
}

std::size_t GaugeReport::partsWithoutData() const
{
  std::size_t without = 0;
  for (std::size_t t = 0; t < tables.size(); ++t)
    for (std::size_t part = 0; part < tables[t].parts(); ++part) {
      bool has_data = tables[t].points(part) > 0;
      for (std::size_t e = 0; !seen.empty() && !has_data && e < tracks[t].envelopes.size(); ++e)
        has_data = seen[t].share(part, e) > 0.0;
      without += !has_data;
    }
  return without;
}

std::size_t GaugeReport::partsUnseen() const
{
  std::set<std::pair<std::size_t, std::size_t>> unseen;
  if (seen.empty()) return 0;
  forEachPart(*this, [&](const TablePart& part) {
    if (part.state == PartState::unseen) unseen.emplace(part.number, part.part);
  });
  return unseen.size();
}

PartState stateOf(const GaugeReport& report, std::size_t track, std::size_t part, std::size_t envelope)
{
  const double least = report.tables[track].smallest(part, envelope);
  if (least <= report.limit) return PartState::infringed;
  if (report.seen.empty()) return std::isfinite(least) ? PartState::clear : PartState::no_data;
  const SeenOutline& seen = report.seen[track];
  if (!std::isfinite(least) && !(seen.share(part, envelope) > 0.0)) return PartState::no_data;
  return seen.isUnseen(part, envelope) ? PartState::unseen : PartState::clear;
}

const char* textOf(PartState state)
{
  constexpr std::array texts = {"no data", "clear", "infringed", "unseen"};
  return texts[static_cast<std::size_t>(state)];
}

void writeGaugeTable(const std::filesystem::path& path, const GaugeReport& report)
{
  files::replaceFile(path, [&](std::ostream& out) {
    if (report.named()) out << "track,";
    out << "chainage_from,chainage_to,distance_from,distance_to,envelope,state,points,smallest,left,above,right,"
           "below"
        << (report.seen.empty() ? "" : ",seen,seen_left,seen_above,seen_right,seen_below") << '\n';
    forEachPart(report, [&](const TablePart& row) {
      if (report.named()) out << csvText(row.track.name) << ',';
      out << numberText(row.chainage_from) << ',' << numberText(row.chainage_to) << ','
          << numberText(row.table.from(row.part)) << ',' << numberText(row.table.to(row.part)) << ','
          << csvText(row.envelopeName()) << ',' << textOf(row.state) << ',' << row.table.points(row.part) << ','
          << cellOf(row.smallest());
      for (const auto& [sector, name] : table_sectors) out << ',' << cellOf(row.smallest(sector));
      if (row.seen) {
        out << ',' << cellOf(row.seen->share(row.part, row.envelope));
        for (const auto& [sector, name] : table_sectors)
          out << ',' << cellOf(row.seen->share(row.part, row.envelope, sector));
      }
      out << '\n';
    });
  });
}

void writeInfringements(const std::filesystem::path& path, const GaugeReport& report)
{
  files::replaceFile(path, [&](std::ostream& out) {
    out << "rank,id,status," << (report.named() ? "track," : "")
        << "envelope,chainage_from,chainage_to,chainage,distance,offset,height,clearance,points,record,x,y,z\n";
    std::size_t rank = 0;
    for (const ListedInfringement& listed : report.listed) {
      const Clash& clash = listed.clash;
      if (isPresent(clash.status)) out << ++rank;
      out << ',' << csvText(clash.id) << ',' << nameOf(clash.status) << ',';
      if (report.named()) out << csvText(listed.track) << ',';
      out << csvText(listed.envelope);
      for (const double value : {listed.chainage_from, listed.chainage_to, listed.chainage, listed.distance,
                                 listed.offset, listed.height, clash.distance})
        out << ',' << numberText(value);
      out << ',' << clash.points << ',' << listed.record;
      for (const double value : clash.place) out << ',' << numberText(value);
      out << '\n';
    }
  });
}

Json gaugeJson(const GaugeReport& report)
{
  Json json = {{"program", reportProgram()}, {"date", reportDate()}, {"scan", report.scan}};
  if (!report.named()) json["axis"] = jsonOf(report.tracks.front().axis, report.axis_files.front());
  json.update(
      {{"unit", report.unit},
       {"coordinate_system", report.coordinate_system},
       {"limit", report.limit},
       {"cluster_distance", report.cluster_distance},
       {"previous", orNull(report.previous)},
       {"reach", {{"offset", report.reach.offset}, {"below", report.reach.below}, {"above", report.reach.above}}},
       {"points",
        {{"at_one_place", report.counts[0]},
         {"at_two_places", report.counts[1]},
         {"before_the_beginning", report.counts[2]},
         {"behind_the_end", report.counts[3]},
         {"too_far", report.counts[4]},
         {"not_finite", report.counts[5]},
         {"infringing", report.infringing}}}});
  if (!report.seen.empty()) {
    json["points"]["outside_origin_path"] = report.outside.points;
    json["origin_path"] = report.origin_path;
    json["seen_spacing"] = report.seen_spacing;
  }
  if (report.named()) {
    Json& tracks = json["tracks"] = Json::array();
    for (std::size_t t = 0; t < report.tracks.size(); ++t)
      tracks.push_back({{"name", report.tracks[t].name},
                        {"axis", jsonOf(report.tracks[t].axis, report.axis_files[t])},
                        {"envelopes", namesOf(report.tracks[t].envelopes)}});
  }
  else {
    json["envelopes"] = namesOf(report.tracks.front().envelopes);
  }
  Json& infringements = json["infringements"] = Json::array();
  for (const ListedInfringement& listed : report.listed) infringements.push_back(jsonOf(listed));
  Json& table = json["table"] = Json::array();
  forEachPart(report, [&](const TablePart& part) {
    Json row = Json::object();
    if (report.named()) row["track"] = part.track.name;
    row.update({{"chainage_from", part.chainage_from},
                {"chainage_to", part.chainage_to},
                {"envelope", part.envelopeName()},
                {"state", textOf(part.state)},
                {"points", part.table.points(part.part)},
                {"smallest", orNull(part.smallest())}});
    for (const auto& [sector, name] : table_sectors) row[name] = orNull(part.smallest(sector));
    if (part.seen) {
      Json& seen = row["seen"] = Json::object();
      seen["all"] = orNull(part.seen->share(part.part, part.envelope));
      for (const auto& [sector, name] : table_sectors)
        seen[name] = orNull(part.seen->share(part.part, part.envelope, sector));
    }
    table.push_back(std::move(row));
  });
  return json;
}

} // namespace pcl_bsh::io
