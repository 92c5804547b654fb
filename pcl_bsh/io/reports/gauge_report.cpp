// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/gauge_report.h>

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/text/number_text.h>

#include <cmath>
#include <utility>

namespace pcl_bsh::io {
namespace {

constexpr std::array table_sectors = {std::pair{Sector::left, "left"}, std::pair{Sector::above, "above"},
                                      std::pair{Sector::right, "right"}, std::pair{Sector::below, "below"}};

bool countsIn(const GaugeReport& report, std::size_t part, std::size_t envelope)
{
  const double middle = 0.5 * (report.table.from(part) + report.table.to(part));
  return report.envelopes[envelope].countsAt(report.axis.chainage(middle)) ||
         std::isfinite(report.table.smallest(part, envelope));
}

std::string cellOf(double clearance)
{
  return std::isfinite(clearance) ? numberText(clearance) : "";
}

Json jsonOf(double clearance)
{
  return std::isfinite(clearance) ? Json(clearance) : Json();
}

/// Chainages where a part begins and ends: at a jump it ends with the chainage before.
std::pair<double, double> chainagesOf(const GaugeReport& report, std::size_t part)
{
  const double from = report.table.from(part), to = report.table.to(part);
  return {report.axis.chainage(from), report.axis.chainage(std::nextafter(to, from))};
}

Json jsonOf(const ListedInfringement& listed)
{
  const Clash& clash = listed.clash;
  return {{"id", clash.id},
          {"status", nameOf(clash.status)},
          {"envelope", listed.envelope},
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
          {"box", {{"min", clash.low}, {"max", clash.high}}}};
}

} // namespace

PartState stateOf(const GaugeReport& report, std::size_t part, std::size_t envelope)
{
  const double least = report.table.smallest(part, envelope);
  return !std::isfinite(least) ? PartState::no_data : least <= report.limit ? PartState::infringed : PartState::clear;
}

const char* textOf(PartState state)
{
  return state == PartState::no_data ? "no data" : state == PartState::clear ? "clear" : "infringed";
}

void writeGaugeTable(const std::filesystem::path& path, const GaugeReport& report)
{
  files::replaceFile(path, [&](std::ostream& out) {
    out << "chainage_from,chainage_to,distance_from,distance_to,envelope,state,points,smallest,left,above,right,"
           "below\n";
    for (std::size_t part = 0; part < report.table.parts(); ++part) {
      const auto [from, to] = chainagesOf(report, part);
      for (std::size_t e = 0; e < report.envelopes.size(); ++e) {
        if (!countsIn(report, part, e)) continue;
        out << numberText(from) << ',' << numberText(to) << ',' << numberText(report.table.from(part)) << ','
            << numberText(report.table.to(part)) << ',' << csvText(report.envelopes[e].name()) << ','
            << textOf(stateOf(report, part, e)) << ',' << report.table.points(part) << ','
            << cellOf(report.table.smallest(part, e));
        for (const auto& [sector, name] : table_sectors) out << ',' << cellOf(report.table.smallest(part, e, sector));
        out << '\n';
      }
    }
  });
}

void writeInfringements(const std::filesystem::path& path, const GaugeReport& report)
{
  files::replaceFile(path, [&](std::ostream& out) {
    out << "rank,id,status,envelope,chainage_from,chainage_to,chainage,distance,offset,height,clearance,points,record,"
           "x,y,z\n";
    std::size_t rank = 0;
    for (const ListedInfringement& listed : report.listed) {
      const Clash& clash = listed.clash;
      if (isPresent(clash.status)) out << ++rank;
      out << ',' << clash.id << ',' << nameOf(clash.status) << ',' << csvText(listed.envelope);
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
  Json json = {
      {"program", reportProgram()},
      {"date", reportDate()},
      {"scan", report.scan},
      {"axis",
       {{"file", report.axis_file},
        {"length", report.axis.length()},
        {"chainage_from", report.axis.chainage(0.0)},
        {"chainage_to", report.axis.chainage(report.axis.length())},
        {"gap", report.axis.fit().gap},
        {"deviation", report.axis.fit().deviation}}},
      {"unit", report.unit},
      {"coordinate_system", report.coordinate_system},
      {"limit", report.limit},
      {"cluster_distance", report.cluster_distance},
      {"previous", report.previous.empty() ? Json() : Json(report.previous)},
      {"reach", {{"offset", report.reach.offset}, {"below", report.reach.below}, {"above", report.reach.above}}},
      {"points",
       {{"at_one_place", report.counts[0]},
        {"at_two_places", report.counts[1]},
        {"before_the_beginning", report.counts[2]},
        {"behind_the_end", report.counts[3]},
        {"too_far", report.counts[4]},
        {"not_finite", report.counts[5]},
        {"infringing", report.infringing}}}};
  Json& envelopes = json["envelopes"] = Json::array();
  for (const Envelope& envelope : report.envelopes) envelopes.push_back(envelope.name());
  Json& infringements = json["infringements"] = Json::array();
  for (const ListedInfringement& listed : report.listed) infringements.push_back(jsonOf(listed));
  Json& table = json["table"] = Json::array();
  for (std::size_t part = 0; part < report.table.parts(); ++part) {
    const auto [from, to] = chainagesOf(report, part);
    for (std::size_t e = 0; e < report.envelopes.size(); ++e) {
      if (!countsIn(report, part, e)) continue;
      Json row = {{"chainage_from", from},
                  {"chainage_to", to},
                  {"envelope", report.envelopes[e].name()},
                  {"state", textOf(stateOf(report, part, e))},
                  {"points", report.table.points(part)},
                  {"smallest", jsonOf(report.table.smallest(part, e))}};
      for (const auto& [sector, name] : table_sectors) row[name] = jsonOf(report.table.smallest(part, e, sector));
      table.push_back(std::move(row));
    }
  }
  return json;
}

} // namespace pcl_bsh::io
