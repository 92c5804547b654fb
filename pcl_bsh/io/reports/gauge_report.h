// SPDX-License-Identifier: BSD-3-Clause
// A gauging run for people and programs: tables by chainage, infringements, JSON, and a page with drawings.
#pragma once

#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/io/reports/gauge_list.h>
#include <pcl_bsh/track/gauge_table.h>
#include <pcl_bsh/track/origin_path.h>
#include <pcl_bsh/track/seen_outline.h>
#include <pcl_bsh/track/tracks.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Points of a scan near one section.
struct GaugeSection {
  std::string name;                ///< for people, and of its file
  std::size_t track = 0;           ///< its number
  double distance = 0.0;           ///< along its axis
  std::optional<Infringing> worst; ///< drawn with its clearance
  std::vector<SectionPoint> points;
};

struct GaugeReport {
  std::string scan;
  std::string unit;                    ///< of lengths; empty: not known
  std::string coordinate_system;       ///< of the scan; empty: not known
  const std::vector<Track>& tracks;    ///< at least one
  std::vector<std::string> axis_files; ///< of each track
  std::vector<GaugeTable> tables;      ///< of each track
  AxisReach reach;
  double limit = 0.0;     ///< clearances up to this are infringements
  double thickness = 0.1; ///< of sections
  double cluster_distance = 0.5;
  std::array<std::size_t, 6> counts{}; ///< points of each state, as they are told
  std::size_t infringing = 0;          ///< points
  std::vector<Infringement> infringements = {};
  std::vector<GaugeSection> sections = {};
  std::vector<ListedInfringement> listed = {}; ///< of listedOf(); then those that are gone
  std::string previous = {};                   ///< file name of the list that it is compared with, or empty
  std::string origin_path = {};                ///< file name of the scanner's path; empty: beams are not known
  double seen_spacing = 0.0;                   ///< of beams, for `seen`
  std::vector<SeenOutline> seen = {};          ///< of each track, where beams are known; else none
  OutsidePath outside = {};                    ///< points whose time the path does not have

  std::size_t placed() const { return counts[0] + counts[1]; } ///< points that have a place at an axis
  bool named() const { return !tracks.front().name.empty(); }  ///< whether files tell the tracks' names
  std::size_t parts() const;                                   ///< of all tables
  std::size_t partsWithoutData() const;                        ///< those without a point, and without a beam
  std::size_t partsUnseen() const;                             ///< those with a profile that is `unseen`
};

/// Whether a part of the axis has data of an envelope, and whether it is clear. Where beams are known, a part is unseen
/// rather than clear if no beam crossed one of its sectors, and a part without points can be clear.
enum class PartState : std::uint8_t { no_data, clear, infringed, unseen };
PartState stateOf(const GaugeReport& report, std::size_t track, std::size_t part, std::size_t envelope);
const char* textOf(PartState state);

/// Writes a .csv with a line for each part of each track and envelope that counts there. Cells without data are empty.
/// @throws files::FileError
void writeGaugeTable(const std::filesystem::path& path, const GaugeReport& report);

/// Writes a .csv with a line for each listed infringement, the worst first, those that are gone last and without rank.
/// @throws files::FileError
void writeInfringements(const std::filesystem::path& path, const GaugeReport& report);

/// The whole report in JSON, null where there is no data.
Json gaugeJson(const GaugeReport& report);

/// A page that opens alone in a browser. @throws files::FileError
void writeGaugePage(const std::filesystem::path& path, const GaugeReport& report);

} // namespace pcl_bsh::io
