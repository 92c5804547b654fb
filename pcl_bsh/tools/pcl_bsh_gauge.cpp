// SPDX-License-Identifier: BSD-3-Clause
// How far is a scan from what must stay free along a track? From an axis, profiles and a scan to tables and drawings.
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/gauge/gauge_options.h>
#include <pcl_bsh/tools/gauge/scan.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/gauge_fields.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/reports/gauge_drawings.h>
#include <pcl_bsh/io/reports/picture.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/tracks/origin_file.h>
#include <pcl_bsh/search/selected_records.h>
#include <pcl_bsh/track/bogies.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using Options = cli::GaugeOptions;

constexpr auto program = cli::gauge_program;
constexpr std::size_t most_worst_sections = 12, most_section_points = 20'000;

void warnOfFile(const Options& options, const fs::path& file, const std::vector<std::string>& remarks)
{
  if (cli::tellsAbout(options)) cli::warnOfFile(program, file, remarks);
}

std::vector<Track> readAxes(const Options& options)
{
  std::vector<Track> tracks;
  for (const cli::GaugeAxis& axis : options.axes) {
    std::vector<std::string> remarks;
    tracks.push_back({axis.name, io::readAxis(axis.file, axis.settings, &remarks), {}});
    warnOfFile(options, axis.file, remarks);
  }
  return tracks;
}

void readEnvelopes(const Options& options, std::vector<Track>& tracks)
{
  for (const io::EnvelopeFiles& files : options.profiles) {
    std::vector<std::string> remarks;
    io::addEnvelope(files, tracks, options.profile_unit, remarks);
    warnOfFile(options, files.profile, remarks);
  }
}

/// A text to follow a chainage: the track that it belongs to; empty where the track has no name.
std::string ofTrack(const Track& track)
{
  return track.name.empty() ? "" : " of track " + track.name;
}

/// Sections that are wanted: at given chainages, and at the worst places.
std::vector<io::GaugeSection> sectionsOf(const Options& options, const io::GaugeReport& report)
{
  std::vector<io::GaugeSection> sections;
  for (const double chainage : options.at) {
    const std::size_t before = sections.size();
    for (std::size_t t = 0; t < report.tracks.size(); ++t)
      for (const double distance : report.tracks[t].axis.distancesAt(chainage))
        sections.push_back({"Section " + std::to_string(sections.size() + 1), t, distance, std::nullopt, {}});
    if (sections.size() > before) continue;
    std::string given;
    for (const Track& track : report.tracks)
      given += (given.empty() ? "" : ", or ") + io::numberText(track.axis.chainage(0.0)) + " to " +
               io::numberText(track.axis.chainage(track.axis.length())) + ofTrack(track);
    throw cli::UsageError("--at: " + io::numberText(chainage) + ": the axis has no such chainage: give one from " +
                          given);
  }
  for (std::size_t i = 0; i < std::min(report.infringements.size(), most_worst_sections); ++i) {
    const Infringing& worst = report.infringements[i].worst;
    sections.push_back({"Infringement " + std::to_string(i + 1), worst.track, worst.place.distance, worst, {}});
  }
  return sections;
}

/// Reads the scan once more for the points near sections.
void fillSections(const Options& options, cli::GaugeScan& scan, io::GaugeReport& report)
{
  if (report.sections.empty()) return;
  cli::Step step("Drawing sections");
  std::vector<Point3> origins;
  for (const io::GaugeSection& section : report.sections)
    origins.push_back(report.tracks[section.track].axis.frame(section.distance).origin);
  const double near = options.reach.offset + options.thickness + 1.0; // cant moves the middle between the rails
  std::vector<std::optional<AxisPlaces>> of_tracks;
  scan.forEachBatchNear(origins, near, [&](const cli::GaugeScan::Batch& batch) {
    for (std::size_t i = 0; i < batch.points.count; ++i) {
      const Point3 p = batch.points.point(static_cast<std::uint32_t>(i));
      of_tracks.assign(report.tracks.size(), std::nullopt);
      for (std::size_t s = 0; s < origins.size(); ++s) {
        if (!(std::abs(p[0] - origins[s][0]) <= near && std::abs(p[1] - origins[s][1]) <= near)) continue;
        io::GaugeSection& section = report.sections[s];
        std::optional<AxisPlaces>& places = of_tracks[section.track];
        if (!places) places = report.tracks[section.track].axis.nearest(p, options.reach);
        const auto add = [&](const AxisPlace& at) {
          if (std::abs(at.distance - section.distance) <= options.thickness / 2 &&
              section.points.size() < most_section_points)
            section.points.push_back({at.offset, at.height});
        };
        if (hasPlace(places->state)) add(places->best);
        if (places->state == PlaceState::two_places) add(places->second);
      }
    }
    step.share(batch.done);
  });
  for (io::GaugeSection& section : report.sections) // batches come in any order
    std::sort(section.points.begin(), section.points.end(), [](const SectionPoint& a, const SectionPoint& b) {
      return std::pair(a.offset, a.height) < std::pair(b.offset, b.height);
    });
  step.done(counted(report.sections.size(), "section"));
}

void writeSections(const Options& options, const io::GaugeReport& report)
{
  if (options.sections.empty()) return;
  const files::OutputFolder made(options.sections);
  for (const io::GaugeSection& section : report.sections) {
    std::string name = section.name;
    for (char& c : name) c = c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const std::string drawing = io::sectionDrawing(report, section);
    const auto write = [&](const char* extension, const std::string& content) {
      files::replaceFile(options.sections / (name + extension), [&](std::ostream& out) { out << content; });
    };
    write(".svg", drawing);
    if (options.pictures) write(".png", io::pngOf(drawing, 3.0));
  }
}

void summarise(const Options& options, const io::GaugeReport& report)
{
  std::ostream& out = options.files.summary();
  out << counted(report.infringements.size(), "infringement") << " of " << counted(report.infringing, "point");
  if (!report.previous.empty()) out << ", " << io::stateCounts(report.listed);
  if (!report.infringements.empty()) {
    const Infringing& worst = report.infringements.front().worst;
    const Track& track = report.tracks[worst.track];
    out << ", the worst " << io::numberText(worst.clearance, std::chars_format::fixed, 3) << " at chainage "
        << io::numberText(track.axis.chainage(worst.place.distance), std::chars_format::fixed, 3) << ofTrack(track);
  }
  out << "; " << counted(report.placed(), "point") << " at the axis, " << report.counts[2] + report.counts[3]
      << " beyond its ends, " << report.counts[4] << " too far";
  if (report.counts[5] > 0) out << ", " << report.counts[5] << " not finite";
  if (const std::size_t no_data = report.partsWithoutData(); no_data > 0)
    out << "; no data in " << no_data << " of " << counted(report.parts(), "part");
  if (const std::size_t unseen = report.partsUnseen(); unseen > 0)
    out << "; a side is unseen in " << unseen << " of " << counted(report.parts(), "part");
  if (report.outside.points > 0) out << "; " << counted(report.outside.points, "point") << " without an origin";
  out << '\n';
}

/// @throws files::FileError naming the scan
TimeField timesOf(const Options& options, const pcl::PCLPointCloud2& fields)
{
  try {
    return timeFieldOf(fields, options.time_field);
  }
  catch (const InvalidInput& error) {
    throw files::FileError(options.input, error.wrong(), "--time-field: " + error.remedy());
  }
}

void compare(const Options& options, std::vector<Track> tracks)
{
  readEnvelopes(options, tracks);
  for (const Track& track : tracks) io::namingTrack(track, [&] { track.axis.requireReach(options.reach); });
  std::optional<io::GaugeList> earlier;
  if (!options.previous.empty()) earlier = io::readGaugeList(options.previous, options.limit);
  std::vector<GaugeTable> tables = io::tablesOf(tracks, options.step);
  std::optional<io::BeamOrigins> origins;
  if (!options.origin_path.empty()) origins = io::BeamOrigins{io::readOriginPath(options.origin_path), {}};
  if (!options.output.empty()) io::requireWritableCloud(options.output);
  options.written.requireWritable();

  std::unique_ptr<cli::GaugeScan> scan;
  {
    cli::Step step("Opening " + options.input.string());
    scan = cli::openScan(options);
    step.done(counted(scan->points(), "point"));
  }
  warnOfFile(options, options.input, scan->facts().remarks);
  GaugeFields fields(tracks);
  if (!options.output.empty()) withFields(withoutRecords(scan->whole()), fields.fields()); // fails before the run
  if (origins) origins->times = timesOf(options, scan->whole());

  io::GaugeReport report{options.input.string(),
                         options.reading.unitOfReports(options.unit, scan->facts().unit),
                         scan->facts().coordinate_system.name,
                         tracks,
                         {},
                         std::move(tables),
                         options.reach,
                         options.limit,
                         options.thickness,
                         options.cluster_distance,
                         {},
                         0,
                         {}};
  for (const cli::GaugeAxis& axis : options.axes) report.axis_files.push_back(axis.file.string());
  if (origins) {
    report.origin_path = options.origin_path.string();
    report.seen_spacing = options.seen_spacing;
    report.seen = io::seenOf(tracks, {options.step, options.seen_spacing});
  }
  io::GaugeRun run(report, options.threads, origins ? &*origins : nullptr);
  std::optional<cli::Step> step;
  if (cli::tellsAbout(options)) step.emplace("Gauging");
  scan->forEachBatch([&](const cli::GaugeScan::Batch& batch) {
    const GaugedTracks found = run.add(batch.points, batch.first, batch.numbers);
    if (!options.output.empty()) fields.add(tracks, found);
    if (step) step->share(batch.done);
  });
  scan->join(run);
  if (!step) return;
  const std::vector<std::string> remarks = run.finish(options.previous, earlier);
  step->done(counted(report.infringing, "infringing point"));
  warnOfFile(options, options.previous, remarks);
  if (report.outside.points > 0) warnOfFile(options, options.input, {io::outsideRemark(report.outside, origins->path)});
  if (options.draws()) {
    report.sections = sectionsOf(options, report);
    fillSections(options, *scan, report);
  }

  if (!options.output.empty())
    io::writeCloud(options.output, withFields(scan->whole(), fields.fields()), scan->facts().viewpoint,
                   scan->facts().las);
  options.written.write(report);
  writeSections(options, report);
  summarise(options, report);
}

void makePoses(const Options& options, const Axis& axis)
{
  if (options.poses.empty()) return;
  const double first = frontPivotOf(axis, options.pivots, 0.0);
  const std::vector<Eigen::Isometry3d> poses = posesAlong(axis, options.pivots, first, axis.length(), options.step);
  io::writePoses(options.poses, poses);
  options.files.summary() << counted(poses.size(), "pose") << " of a vehicle on two pivots\n";
}

int runGauge(const Options& options)
{
  options.files.requireApart();
  std::vector<Track> tracks = readAxes(options);
  if (cli::tellsAbout(options)) makePoses(options, tracks.front().axis);
  if (options.input.empty()) return 0;
  try {
    compare(options, std::move(tracks));
  }
  catch (const std::exception& error) {
    cli::endOtherRanks(options, error.what());
    throw;
  }
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, cli::parseGaugeOptions, runGauge, argc, argv);
}
