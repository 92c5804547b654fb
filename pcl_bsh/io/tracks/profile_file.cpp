// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/profile_file.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/tracks/number_table.h>

#include <pcl_bsh/base/invalid_input.h>

#include <algorithm>

namespace pcl_bsh::io {
namespace {

constexpr auto form_of_a_profile = "give a corner in each line, in columns offset and height, or a drawing as .dxf";

} // namespace

std::vector<SectionPoint> readProfile(const std::filesystem::path& path, std::optional<double> unit,
                                      std::vector<std::string>* remarks)
{
  const FileBytes file(path);
  std::vector<std::string> found;
  std::vector<SectionPoint> corners = namingFile(path, form_of_a_profile, [&] {
    std::vector<SectionPoint> read;
    if (inSmallLetters(path.extension().string()) == ".dxf") {
      std::optional<double> own;
      read = parseDxf(file.view(), own, found);
      if (!unit) unit = own;
      if (unit.value_or(1.0) != 1.0) found.push_back("its lengths are multiplied by " + numberText(*unit));
    }
    else {
      const NumberTable table =
          numberTable(file.view(), {{{"offset", "x", "u"}}, {{"height", "z", "y", "v", "h"}}}, true);
      for (const std::vector<double>& row : table.rows) read.push_back({row[0], row[1]});
    }
    for (SectionPoint& corner : read) corner = {corner.offset * unit.value_or(1.0), corner.height * unit.value_or(1.0)};
    return simplePolygon(std::move(read));
  });
  if (remarks) *remarks = std::move(found);
  return corners;
}

WideningTable readWidening(const std::filesystem::path& path, const Axis& axis)
{
  const FileBytes file(path);
  return namingFile(path, "give columns chainage, left and right", [&] {
    const NumberTable table = numberTable(file.view(), {{{"chainage", "station"}}, {{"left"}}, {{"right"}}}, false);
    std::vector<Knot> left, right;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const std::vector<double>& row = table.rows[i];
      const std::vector<double> at = axis.distancesAt(row[0]);
      if (at.size() != 1)
        table.lines[i].fail("has the chainage " + numberText(row[0]) + ", which the axis has " +
                                (at.empty() ? "not" : "more than once"),
                            "give chainages that the axis has once");
      if (!(row[1] >= 0.0 && row[2] >= 0.0))
        table.lines[i].fail("widens by " + numberText(row[1]) + " and " + numberText(row[2]),
                            "give lengths of 0 or more");
      if (!left.empty() && !(at[0] > left.back().at))
        table.lines[i].fail("has the chainage " + numberText(row[0]) + ", not behind the line before",
                            "list chainages in the order of the axis");
      left.push_back({at[0], row[1]});
      right.push_back({at[0], row[2]});
    }
    if (left.empty()) throw FormatError("holds no line of numbers", "give one at least");
    return WideningTable{Piecewise::through(left, Piecewise::Ends::held),
                         Piecewise::through(right, Piecewise::Ends::held)};
  });
}

bool countsOn(const EnvelopeFiles& files, const std::string& track)
{
  return files.tracks.empty() || std::find(files.tracks.begin(), files.tracks.end(), track) != files.tracks.end();
}

Envelope readEnvelope(const EnvelopeFiles& files, const Axis& axis, std::optional<double> unit,
                      std::vector<std::string>* remarks)
{
  EnvelopeDescription description;
  description.name = files.name.empty() ? files.profile.stem().string() : files.name;
  description.corners = readProfile(files.profile, unit, remarks);
  description.ranges = files.ranges;
  description.vehicle = files.vehicle;
  if (!files.widening.empty()) {
    WideningTable table = readWidening(files.widening, axis);
    description.left = std::move(table.left);
    description.right = std::move(table.right);
  }
  Envelope envelope(std::move(description));
  if (files.vehicle) overthrowOf(*files.vehicle, axis.smallestRadius()); // fails now, not at a point
  return envelope;
}

std::string addEnvelope(const EnvelopeFiles& files, std::vector<Track>& tracks, std::optional<double> unit,
                        std::vector<std::string>& remarks)
{
  std::string name;
  for (Track& track : tracks) {
    if (!countsOn(files, track.name)) continue;
    remarks.clear();
    namingTrack(track, [&] { track.envelopes.push_back(readEnvelope(files, track.axis, unit, &remarks)); });
    name = track.envelopes.back().name();
  }
  return name;
}

} // namespace pcl_bsh::io
