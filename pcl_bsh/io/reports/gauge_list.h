// SPDX-License-Identifier: BSD-3-Clause
// Infringements with names and states, and those of an earlier run.
//
//   report.listed = listedOf(report, points);
//   remarks = compareWithList(report, file, readGaugeList(file, report.limit));
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/track/gauge_table.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

struct GaugeReport;

/// An infringement as the run that found it tells it.
struct ListedInfringement {
  Clash clash;          ///< id, status, points and box; place and distance are the worst point and its clearance
  std::string track;    ///< its name; empty where there is only one
  std::string envelope; ///< the worst point's
  double chainage_from = 0.0, chainage_to = 0.0;
  double chainage = 0.0, distance = 0.0; ///< of the worst point along the axis
  double offset = 0.0, height = 0.0;     ///< of it, too
  std::uint64_t record = 0;              ///< number of the worst point in the whole scan
};

/// A track of an earlier run.
struct ListedTrack {
  std::string name; ///< empty where there was only one
  double axis_length = 0.0;
  std::vector<std::string> envelopes;
};

/// The list of an earlier run.
struct GaugeList {
  double limit = 0.0; ///< clearances up to this were infringements
  std::vector<ListedTrack> tracks;
  std::vector<ListedInfringement> infringements;
};

/// The report's infringements with ids, in their order; all are new. An id tells the place, as findClashes() has it,
/// behind the track's name, where it has one: `left:C12_-3_0`.
/// @param points those that infringementsOf() was given
std::vector<ListedInfringement> listedOf(const GaugeReport& report, const std::vector<Infringing>& points);

/// @param limit of this run
/// @throws files::FileError when the file cannot be read, or its limit is another one; JsonError naming the place that
///   no run would have written
GaugeList readGaugeList(const std::filesystem::path& path, double limit);

/// Parses what gaugeJson() wrote. @throws JsonError, whose message begins with `name`
GaugeList parseGaugeList(std::string_view text, const std::string& name);

/// Tells which infringements were in the earlier list of the same track, and appends those that are not found again.
/// Such a place is not_visited where its track is not given any more, it has no place at the axis, or its envelope does
/// not count there any more. It is not_scanned where the envelope's sector has no data in its part of the axis or,
/// where beams are known, none crossed it. Else it is resolved.
/// @return remarks about the file: another axis, a track or an envelope that is not compared any more
std::vector<std::string> compareWithList(GaugeReport& report, const std::filesystem::path& file,
                                         const GaugeList& earlier);

/// Counts states against the earlier list, as programs print it: "1 new, 2 persisting, 1 resolved".
std::string stateCounts(const std::vector<ListedInfringement>& listed);

} // namespace pcl_bsh::io
