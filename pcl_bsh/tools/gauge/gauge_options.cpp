// SPDX-License-Identifier: BSD-3-Clause
#include "gauge_options.h"

#include <pcl_bsh/tools/cli/command_line.h>

#include <pcl_bsh/io/reports/picture.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/parse_number.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::cli {
namespace {

constexpr auto gauge_footer =
    R"(A point's chainage is that of the axis' nearest place in plan. Its offset is to the right of the axis, its height above
it, both in the plane that cant turns. Its clearance is its distance from the profile's outline in that section, below 0
inside. A part of the axis without points has no data, and is not clear. TRACKS.md has the forms of all files.
INPUT may be any file of points that pcl_bsh_collide reads. Without OUTPUT a .las, .laz or binary .pcd is read part by
part, and may be larger than memory.
Exit code: 0 done, infringed or not; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: what of a scan reaches into a structure gauge along a line?
  pcl_bsh_gauge scan.las --axis line.xml --profile gauge.dxf --table table.csv --page gauging.html
Example: the same with two profiles, of which one is a vehicle's that widens in curves, and sections
  pcl_bsh_gauge scan.las marked.las --axis line.csv --profile gauge.csv --profile wagon.csv --vehicle wagon=19,3.7 \
      --sections sections --at 1200 --at 1350
Example: what infringes since last week, and what is gone?
  pcl_bsh_gauge w48.las --axis line.xml --profile gauge.dxf --report w48.json --previous w47.json
Example: both tracks of a line in one pass, and a profile that counts on one of them
  pcl_bsh_gauge scan.las --axis left=left.csv --axis right=right.csv --profile gauge.csv --profile platform.csv \
      --track platform=right --table table.csv --page gauging.html
Example: poses of a wagon whose pivots are 19 m apart, for pcl_bsh_collide
  pcl_bsh_gauge --axis line.axis --pivots 19 --step 0.5 --poses-out poses.txt)";

/// Axes as they are given, each FILE or NAME=FILE. A name has no slash, so ./a=b is a file.
std::vector<GaugeAxis> axesOf(const std::vector<std::string>& given)
{
  std::vector<GaugeAxis> axes;
  for (const std::string& axis : given) {
    const std::size_t equals = axis.find('=');
    const bool has_name = equals != std::string::npos && axis.find('/') > equals;
    axes.push_back({has_name ? axis.substr(0, equals) : "", has_name ? axis.substr(equals + 1) : axis});
    const GaugeAxis& last = axes.back();
    if ((has_name && last.name.empty()) || last.file.empty())
      throw UsageError("--axis: " + axis + ": lacks one of both: give NAME=FILE");
    if (given.size() > 1 && !has_name)
      throw UsageError("--axis: " + axis + ": several tracks need names: give NAME=FILE");
    for (std::size_t i = 0; i + 1 < axes.size(); ++i)
      if (axes[i].name == last.name)
        throw UsageError("--axis: " + axis + ": another track is called '" + last.name + "', too: give another name");
  }
  return axes;
}

/// Sets the alignment of one axis, given as TRACK=NAME, or of all axes, given as NAME.
void setAlignment(std::vector<GaugeAxis>& axes, const std::string& given)
{
  const std::size_t equals = given.find('=');
  const auto named = std::find_if(axes.begin(), axes.end(), [&](const GaugeAxis& axis) {
    return !axis.name.empty() && axis.name == given.substr(0, equals);
  });
  if (equals != std::string::npos && named != axes.end())
    named->settings.alignment = given.substr(equals + 1);
  else
    for (GaugeAxis& axis : axes) axis.settings.alignment = given;
}

void requireTrack(const std::vector<GaugeAxis>& axes, const std::string& name)
{
  std::string names;
  for (const GaugeAxis& axis : axes) {
    if (axis.name == name) return;
    names += (names.empty() ? "" : ", ") + axis.name;
  }
  throw UsageError("--track: no track is called '" + name + "': give " +
                   (names.empty() ? "--axis " + name + "=FILE" : "one of " + names));
}

/// Calls use(profile, VALUE) for one profile, given as NAME=VALUE, or for all profiles, given as VALUE.
void forProfiles(std::vector<io::EnvelopeFiles>& profiles, const std::string& option, const std::string& given,
                 const std::function<void(io::EnvelopeFiles&, const std::string&)>& use)
{
  const std::size_t equals = given.find('=');
  const std::string name = equals == std::string::npos ? "" : given.substr(0, equals);
  const std::string value = equals == std::string::npos ? given : given.substr(equals + 1);
  bool used = false;
  std::string names;
  for (io::EnvelopeFiles& profile : profiles) {
    names += (names.empty() ? "" : ", ") + profile.name;
    if (!name.empty() && profile.name != name) continue;
    use(profile, value);
    used = true;
  }
  if (!used) throw UsageError(option + ": " + given + ": no profile is called '" + name + "': give one of " + names);
}

/// The numbers on either side of the first character `between` of a text.
std::pair<double, double> twoNumbers(const std::string& option, const std::string& text, char between,
                                     const std::string& form)
{
  const std::size_t at = text.find(between);
  try {
    if (at == std::string::npos) throw io::FormatError("'" + text + "' is no pair");
    return {io::parseNumber<double>(text.substr(0, at)), io::parseNumber<double>(text.substr(at + 1))};
  }
  catch (const io::FormatError& error) {
    throw UsageError(option + ": " + error.what() + ": give " + form);
  }
}

void requireTogether(const GaugeOptions& options)
{
  const auto refuse = [](const std::string& option, const std::string& wrong) {
    throw UsageError(option + ": " + wrong);
  };
  const bool poses = !options.poses.empty();
  if (poses != (options.pivots > 0.0))
    refuse(poses ? "--poses-out" : "--pivots",
           poses ? "needs the vehicle: give --pivots L" : "makes poses: give --poses-out FILE");
  if (poses && options.axes.size() > 1) refuse("--poses-out", "follows one axis: give --axis once");
  if (options.input.empty()) {
    if (!poses) refuse("command line", std::string("INPUT is required: see ") + gauge_program + " --help");
    if (!options.profiles.empty()) refuse("--profile", "is compared with a scan: give INPUT");
    for (const auto& [option, file] : {std::pair{"--table", &options.written.table},
                                       {"--infringements", &options.written.infringements},
                                       {"--report", &options.written.report},
                                       {"--previous", &options.previous},
                                       {"--origin-path", &options.origin_path},
                                       {"--page", &options.written.page},
                                       {"--sections", &options.sections}})
      if (!file->empty()) refuse(option, "is about a scan: give INPUT");
    return;
  }
  if (options.isSite()) {
    if (!options.output.empty()) refuse("OUTPUT", "is written of a file, not of a site: leave it out");
    for (const auto& [option, crs] :
         {std::pair{"--to-crs", &options.reading.to_crs}, {"--input-crs", &options.reading.input_crs}})
      if (!crs->empty()) refuse(option, "is for files: make the site with it");
  }
  if (options.profiles.empty())
    refuse("command line", std::string("--profile is required: see ") + gauge_program + " --help");
  for (std::size_t i = 0; i < options.profiles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (options.profiles[i].name == options.profiles[j].name)
        refuse("--profile", options.profiles[i].profile.string() + ": another is called '" + options.profiles[i].name +
                                "', too: rename a file");
  for (const GaugeAxis& axis : options.axes)
    if (std::none_of(options.profiles.begin(), options.profiles.end(),
                     [&](const io::EnvelopeFiles& profile) { return io::countsOn(profile, axis.name); }))
      refuse("--track", "no profile counts on the track '" + axis.name + "': name it, too");
  if (!options.time_field.empty() && options.origin_path.empty())
    refuse("--time-field", "tells when beams were: give --origin-path FILE.csv");
  if (options.pictures && options.sections.empty()) refuse("--png", "draws sections: give --sections FOLDER");
  if (options.pictures && !io::drawsPictures())
    throw UsageError("--png: this program was built without librsvg: build it where librsvg2-dev is installed, or "
                     "leave it out: browsers show the .svg files");
  if (!options.at.empty() && !options.draws())
    refuse("--at", "draws sections: give --sections FOLDER or --page FILE.html");
}

} // namespace

std::optional<GaugeOptions> parseGaugeOptions(int argc, char** argv)
{
  GaugeOptions options;
  std::vector<std::filesystem::path> profiles;
  std::vector<std::string> axes, alignments, tracks, ranges, widenings, vehicles;
  io::AxisSettings settings;
  bool in_place = false;
  const auto finite = [] { return number<double>("give a finite number", [](double d) { return std::isfinite(d); }); };
  CLI::App app("Tables by chainage how far a scan is from profiles along an axis, and where it infringes them.",
               gauge_program);
  app.footer(gauge_footer);
  const auto named = [&](const char* name, const char* form, auto& value, const char* help) {
    return app.add_option(name, value, help)->type_name(form);
  };
  const auto listed = [&](const char* name, const char* form, auto& values, const char* help) {
    return named(name, form, values, help)->allow_extra_args(false);
  };
  const auto length = [&](const char* name, auto& value, const char* help) {
    named(name, "L", value, help)->transform(number<double>("give a finite length > 0", [](double d) {
      return d > 0 && std::isfinite(d);
    }));
  };
  named("INPUT", "", options.input, "the scan: a file, or a site of pcl_bsh_site, dealt to the ranks of mpirun");
  named("OUTPUT", "", options.output,
        "INPUT's points with all their fields, and chainage, offset, height,\n"
        "clearance, envelope (its number, -1: none) and place (0 at one place of\n"
        "the axis, 1 at two, 2 before it, 3 behind it, 4 too far, 5 not finite);\n"
        "of tracks with names also track (its number, -1: none)");
  listed("--axis", "[TRACK=]FILE", axes,
         "points as .csv, an alignment of LandXML as .xml, or elements as text; may\n"
         "be given again, with a name for each track")
      ->required();
  listed("--alignment", "[TRACK=]NAME", alignments, "name of the alignment, where a LandXML holds several");
  length("--fit", settings.fit,
         "of an axis of measured points: as few arcs as come so near to them\n"
         "(default: arcs through each point)");
  length("--cant-unit", settings.cant_unit,
         "cant is in so many of the clouds' units (default: 0.001 in LandXML, else 1)");
  length("--gauge", settings.gauge, "between the rails' heads, whose heights cant tells (default: the file's, or 1.5)");
  named("--pivot", "WHICH", settings.pivot,
        "what cant turns about: low_rail, whose height is the axis', or centre\n(default: the file's, or low_rail)")
      ->transform(choice(io::cant_pivots));
  listed("--profile", "FILE", profiles,
         "outline that must be free, as .csv (offset, height) or .dxf; its name is\n"
         "the file's, without extension; may be given more than once");
  length("--profile-unit", options.profile_unit,
         "profiles are in so many of the clouds' units (default: as a .dxf says, or 1)");
  listed("--track", "[NAME=]TRACK", tracks,
         "a profile counts on this track alone (default: on all); may be given more\nthan once");
  listed("--range", "[NAME=]FROM:TO", ranges, "chainages where a profile counts; may be given more than once");
  listed("--widening", "[NAME=]FILE.csv", widenings, "how a profile widens: a table of chainage, left, right");
  listed("--vehicle", "[NAME=]P,O", vehicles,
         "a profile widens by the overthrow of a vehicle with pivots P apart, and\n"
         "an overhang O beyond them, by the axis' radius");
  named("--limit", "D", options.limit, "clearances up to this infringe (default: 0)")->transform(finite());
  length("--step", options.step, "length of a part of the table, and between poses (default: 1)");
  length("--reach", options.reach.offset, "how far beside the axis points belong to it (default: 10)");
  length("--below", options.reach.below, "how far below it (default: 5)");
  length("--above", options.reach.above, "how far above it (default: 15)");
  length("--cluster-distance", options.cluster_distance,
         "infringing points no farther apart are one infringement (default: 0.5)");
  named("--table", "FILE.csv", options.written.table, "smallest clearances of each part of the axis");
  named("--infringements", "FILE.csv", options.written.infringements, "the infringements, the worst first");
  named("--report", "FILE", options.written.report, "both, and the counts, as JSON; - is standard output");
  named("--previous", "FILE", options.previous,
        "--report of an earlier run: infringements are new, persisting, resolved, or\n"
        "not visited by the axis or not scanned any more; --report may replace it");
  named("--origin-path", "FILE.csv", options.origin_path,
        "where the scanner was, in columns time, x, y, z: tells how much of the\n"
        "profiles' outlines its beams crossed, and where none did");
  named("--time-field", "NAME", options.time_field,
        "field of the points' times (default: gps_time, time, timestamp, timeStamp or t)");
  length("--seen-spacing", options.seen_spacing,
         "an outline is seen in cells with such edges, where a beam crosses them\n(default: 0.1)");
  named("--page", "FILE.html", options.written.page, "page for browsers: infringements, charts, maps, sections");
  named("--sections", "FOLDER", options.sections,
        "folder for drawings of sections: those of --at, and the worst places");
  app.add_flag("--png", options.pictures,
               "a .png beside each drawing of --sections, where this was built with librsvg");
  listed("--at", "C", options.at, "chainage of a section to draw; may be given more than once")->transform(finite());
  length("--thickness", options.thickness, "of sections, along the axis (default: 0.1)");
  length("--pivots", options.pivots, "distance of a vehicle's two pivots, which both stand on the axis");
  named("--poses-out", "FILE", options.poses,
        "the vehicle's poses along the axis, for pcl_bsh_collide --trajectory; its\n"
        "own frame is midway between the pivots, x ahead, y to the left, z up");
  named("--unit", "NAME", options.unit, "name of the clouds' unit, for reports");
  addThreads(app, options.threads, "threads, 0: all of the machine's (default)");
  ReadOptions reading;
  reading.addTo(app);
  reading.addSystemsTo(app, false);
  app.add_flag("--in-place", in_place, "OUTPUT may be INPUT, which it then replaces");
  if (!understood(app, gauge_program, argc, argv)) return std::nullopt;

  options.axes = axesOf(axes);
  for (GaugeAxis& axis : options.axes) axis.settings = settings;
  for (const std::string& alignment : alignments) setAlignment(options.axes, alignment);
  for (const std::filesystem::path& file : profiles) options.profiles.push_back({file.stem().string(), file});
  for (const std::string& track : tracks)
    forProfiles(options.profiles, "--track", track, [&](io::EnvelopeFiles& profile, const std::string& value) {
      requireTrack(options.axes, value);
      profile.tracks.push_back(value);
    });
  for (const std::string& range : ranges)
    forProfiles(options.profiles, "--range", range, [](io::EnvelopeFiles& profile, const std::string& value) {
      const auto [from, to] = twoNumbers("--range", value, ':', "FROM:TO, such as 1200:1350");
      profile.ranges.push_back({from, to});
    });
  for (const std::string& widening : widenings)
    forProfiles(options.profiles, "--widening", widening,
                [](io::EnvelopeFiles& profile, const std::string& value) { profile.widening = value; });
  for (const std::string& vehicle : vehicles)
    forProfiles(options.profiles, "--vehicle", vehicle, [](io::EnvelopeFiles& profile, const std::string& value) {
      const auto [pivots, overhang] = twoNumbers("--vehicle", value, ',', "P,O, such as 19,3.7");
      profile.vehicle = Vehicle{pivots, overhang};
    });
  if (!options.input.empty()) options.reading = reading.read({options.input});
  requireTogether(options);

  CommandFiles& files = options.files;
  files.reads("INPUT", options.input);
  for (const GaugeAxis& axis : options.axes) files.reads("--axis", axis.file);
  for (const io::EnvelopeFiles& profile : options.profiles)
    files.reads("--profile", profile.profile).reads("--widening", profile.widening);
  files.writes("OUTPUT", options.output, in_place ? "INPUT" : "")
      .writes("--report", options.written.report, "--previous");
  files.reads("--previous", options.previous).reads("--origin-path", options.origin_path);
  files.writes("--table", options.written.table).writes("--infringements", options.written.infringements);
  files.writes("--page", options.written.page).writes("--poses-out", options.poses);
  return options;
}

} // namespace pcl_bsh::cli
