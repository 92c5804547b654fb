// SPDX-License-Identifier: BSD-3-Clause
// The numbers of the page; gauge_page.html has the page itself.
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_values.h>
#include <pcl_bsh/io/reports/gauge_drawings.h>
#include <pcl_bsh/io/reports/gauge_report.h>
#include <pcl_bsh/io/reports/page_text.h>

#include "gauge_page.html.h"

namespace pcl_bsh::io {
namespace {

constexpr std::size_t most_rows = 50, most_gaps = 20;

Data rowsOf(const GaugeReport& report)
{
  if (report.listed.empty()) return false;
  List rows;
  for (const ListedInfringement& listed : report.listed) {
    if (rows.size() == most_rows) break;
    const Clash& clash = listed.clash;
    rows.push_back(Object{{"rank", isPresent(clash.status) ? std::to_string(rows.size() + 1) : ""},
                          {"id", plain(clash.id)},
                          {"class", nameOf(clash.status)},
                          {"status", inWords(clash.status)},
                          {"track", textOrNone(listed.track)},
                          {"envelope", plain(listed.envelope)},
                          {"chainage", coordinate(listed.chainage)},
                          {"from", coordinate(listed.chainage_from)},
                          {"to", coordinate(listed.chainage_to)},
                          {"clearance", coordinate(clash.distance)},
                          {"offset", coordinate(listed.offset)},
                          {"height", coordinate(listed.height)},
                          {"points", std::to_string(clash.points)},
                          {"at", coordinates(clash.place)}});
  }
  const std::size_t more = report.listed.size() - rows.size();
  return Object{{"list", rows}, {"more", more > 0 ? Data(std::to_string(more)) : Data(false)}};
}

/// Chainages of parts where an envelope counts and has that state, neighbours joined.
Data chainagesOf(const GaugeReport& report, std::size_t t, std::size_t envelope, PartState state)
{
  const Track& track = report.tracks[t];
  const GaugeTable& table = report.tables[t];
  std::string text;
  std::size_t gaps = 0;
  for (std::size_t part = 0; part < table.parts(); ++part) {
    const auto isGap = [&](std::size_t p) {
      const double middle = 0.5 * (table.from(p) + table.to(p));
      return stateOf(report, t, p, envelope) == state &&
             track.envelopes[envelope].countsAt(track.axis.chainage(middle));
    };
    if (!isGap(part)) continue;
    const std::size_t first = part;
    while (part + 1 < table.parts() && isGap(part + 1)) ++part;
    if (++gaps <= most_gaps)
      text += (gaps == 1 ? "" : ", ") + number(track.axis.chainage(table.from(first)), 9) + " to " +
              number(track.axis.chainage(table.to(part)), 9);
  }
  if (gaps > most_gaps) text += " and " + std::to_string(gaps - most_gaps) + " more";
  return textOrNone(text);
}

/// Where beams came from, if that is known.
Data beamsOf(const GaugeReport& report)
{
  if (report.seen.empty()) return false;
  return Object{{"path", plain(report.origin_path)},
                {"unseen", std::to_string(report.partsUnseen())},
                {"spacing", number(report.seen_spacing)},
                {"outside", std::to_string(report.outside.points)}};
}

/// The axes and their chainages.
std::string alongOf(const GaugeReport& report)
{
  std::string text;
  for (std::size_t t = 0; t < report.tracks.size(); ++t) {
    const auto& [name, axis, envelopes] = report.tracks[t];
    text += (t == 0 ? "" : "; ") +
            (name.empty() ? plain(report.axis_files[t]) : plain(name) + " (" + plain(report.axis_files[t]) + ")");
    text += ", chainage " + coordinate(axis.chainage(0.0)) + " to " + coordinate(axis.chainage(axis.length()));
  }
  return text;
}

} // namespace

void writeGaugePage(const std::filesystem::path& path, const GaugeReport& report)
{
  List envelopes, sections;
  for (std::size_t t = 0; t < report.tracks.size(); ++t)
    for (std::size_t e = 0; e < report.tracks[t].envelopes.size(); ++e)
      envelopes.push_back(Object{{"track", textOrNone(report.tracks[t].name)},
                                 {"name", plain(report.tracks[t].envelopes[e].name())},
                                 {"chart", clearanceChart(report, t, e)},
                                 {"map", clearanceMap(report, t, e)},
                                 {"seen", report.seen.empty() ? Data(false) : Data(seenMap(report, t, e))},
                                 {"gaps", chainagesOf(report, t, e, PartState::no_data)},
                                 {"unseen", chainagesOf(report, t, e, PartState::unseen)}});
  for (const GaugeSection& section : report.sections)
    sections.push_back(Object{{"drawing", sectionDrawing(report, section)}});
  const Object page = {{"style", pageStyle()},
                       {"scan", plain(report.scan)},
                       {"along", alongOf(report)},
                       {"named", report.named()},
                       {"unit", textOrNone(report.unit)},
                       {"coordinate_system", textOrNone(report.coordinate_system)},
                       {"program", reportProgram()},
                       {"date", reportDate()},
                       {"infringements", std::to_string(report.infringements.size())},
                       {"infringing", std::to_string(report.infringing)},
                       {"worst", report.infringements.empty()
                                     ? Data(false)
                                     : Data(coordinate(report.infringements.front().worst.clearance))},
                       {"limit", number(report.limit)},
                       {"placed", std::to_string(report.placed())},
                       {"no_data", std::to_string(report.partsWithoutData())},
                       {"parts", std::to_string(report.parts())},
                       {"beams", beamsOf(report)},
                       {"two", std::to_string(report.counts[1])},
                       {"before", std::to_string(report.counts[2])},
                       {"behind", std::to_string(report.counts[3])},
                       {"far", std::to_string(report.counts[4])},
                       {"not_finite", std::to_string(report.counts[5])},
                       {"rows", rowsOf(report)},
                       {"previous", textOrNone(report.previous)},
                       {"states", stateCounts(report.listed)},
                       {"envelopes", envelopes},
                       {"sections", sections.empty() ? Data(false) : Data(Object{{"list", sections}})}};
  const std::string html = rendered("gauge_page.html", gauge_page_html, page);
  files::replaceFile(path, [&](std::ostream& out) { out << html; });
}

} // namespace pcl_bsh::io
