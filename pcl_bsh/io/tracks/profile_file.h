// SPDX-License-Identifier: BSD-3-Clause
// Outlines of envelopes from files, and tables of how they widen.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/track/envelope.h>
#include <pcl_bsh/track/tracks.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Reads the corners of a profile, in order round it. .dxf: one closed outline of LINE, LWPOLYLINE and POLYLINE among
/// the entities, x to the right and y up, in the unit that $INSUNITS says. Others: a corner in each line, in columns
/// offset and height, which a first line may name.
/// @param unit the file's unit, in the cloud's units; none: as the drawing says, else 1
/// @param remarks what users should know of how it was read, without the file's name
/// @throws files::FileError naming the file, the line, the value, and what to do; also for an outline that crosses
/// itself
std::vector<SectionPoint> readProfile(const std::filesystem::path& path, std::optional<double> unit = std::nullopt,
                                      std::vector<std::string>* remarks = nullptr);

/// The outline of a drawing. @param unit becomes that of $INSUNITS, where it says one @throws FormatError naming the
/// line
std::vector<SectionPoint> parseDxf(std::string_view text, std::optional<double>& unit,
                                   std::vector<std::string>& remarks);

/// How an envelope widens to its left and right.
struct WideningTable {
  Piecewise left, right;
};

/// Reads columns chainage, left and right. Values are linear between lines, and constant beyond the first and the last.
/// @throws files::FileError as readProfile() does, and for a chainage that the axis has not, or has twice
WideningTable readWidening(const std::filesystem::path& path, const Axis& axis);

/// The files of an envelope, and what no file says of it.
struct EnvelopeFiles {
  std::string name; ///< empty: the profile's file, without its extension
  std::filesystem::path profile;
  std::vector<std::string> tracks = {};          ///< names of those where it counts; none: all
  std::vector<ChainageRange> ranges = {};        ///< where it counts; none: everywhere
  std::filesystem::path widening = {};           ///< empty: none
  std::optional<Vehicle> vehicle = std::nullopt; ///< by whose overthrow it widens
};

bool countsOn(const EnvelopeFiles& files, const std::string& track);

/// @param unit, remarks as readProfile() has them @throws as readProfile(), readWidening(), Envelope and overthrowOf()
Envelope readEnvelope(const EnvelopeFiles& files, const Axis& axis, std::optional<double> unit = std::nullopt,
                      std::vector<std::string>* remarks = nullptr);

/// Calls `ask`, whose errors then name the track, if it has a name. @throws std::runtime_error
template <class Ask>
void namingTrack(const Track& track, const Ask& ask)
{
  const auto fail = [&](const std::exception& error) {
    throw std::runtime_error("track " + track.name + ": " + error.what());
  };
  if (track.name.empty()) return ask();
  try {
    ask();
  }
  catch (const InvalidInput& error) {
    fail(error);
  }
  catch (const files::FileError& error) {
    fail(error);
  }
}

/// Gives an envelope to each track that it counts on. @param remarks are replaced by those of readEnvelope(), which are
/// equal for each track
/// @return its name; empty where it counts on none
/// @throws as readEnvelope() does, naming the track
std::string addEnvelope(const EnvelopeFiles& files, std::vector<Track>& tracks, std::optional<double> unit,
                        std::vector<std::string>& remarks);

} // namespace pcl_bsh::io
