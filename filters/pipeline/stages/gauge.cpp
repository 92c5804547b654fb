// SPDX-License-Identifier: BSD-3-Clause
// Where points are along a track, and how far outside of what must stay free.
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/filters/gauge_fields.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/naming_option.h>
#include <pcl_bsh/filters/pipeline/stages/row_options.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/gauge_run.h>
#include <pcl_bsh/io/tracks/axis_file.h>
#include <pcl_bsh/io/tracks/origin_file.h>
#include <pcl_bsh/io/tracks/profile_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::pipeline {
namespace {

struct NamedAxis {
  std::string name;
  InputFile file;
  std::string alignment;
};

struct Profile {
  InputFile file;
  std::string name;
  std::vector<std::string> tracks;
  std::optional<double> from, to;
  std::optional<InputFile> widening;
  std::optional<double> vehicle_pivots;
  double vehicle_overhang = 0.0;
};

struct Gauge : Stage {
  std::optional<InputFile> axis;
  std::vector<NamedAxis> axes;
  std::string alignment;
  std::optional<double> fit, cant_unit, rail_gauge, profile_unit;
  std::optional<std::string> pivot;
  std::vector<Profile> profiles;
  std::optional<InputFile> previous, origin_path;
  std::string time_field;
  double seen_spacing = SeenCells().spacing;
  double limit = 0.0, step = 1.0, cluster_distance = 0.5;
  double reach = AxisReach().offset, below = AxisReach().below, above = AxisReach().above;
  std::optional<OutputFile> table, infringements, report, page;
  std::string unit;
  std::string input_name = "input";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    if (axis.has_value() != axes.empty())
      throw OptionError("axis", axis ? "is given beside `axes`: give one of both"
                                     : "is missing: give it, or `axes` with a name for each track");
    if (axis) readTrack("axis", {"", *axis, alignment});
    for (std::size_t i = 0; i < axes.size(); ++i) readTrack("axes/" + std::to_string(i), axes[i]);
    readEnvelopes();
    for (const Track& track : tracks_)
      namingOption("reach", [&] { io::namingTrack(track, [&] { track.axis.requireReach({reach, below, above}); }); });
    namingOption("step", [&] { io::tablesOf(tracks_, step); });
    for (const auto& [option, file, path] : {std::tuple{"table", &table, &files_.table},
                                             {"infringements", &infringements, &files_.infringements},
                                             {"report", &report, &files_.report},
                                             {"page", &page, &files_.page}})
      if (*file) {
        *path = (*file)->path;
        namingOption(option, [&written = *path] { files::requireWritable(written); });
      }
    if (origin_path) {
      namingOption("origin_path", [&] { origins_ = io::BeamOrigins{io::readOriginPath(origin_path->path), {}}; });
      namingOption("time_field", [&] { origins_->times = timeFieldOf(inputs[0], time_field); });
      namingOption("seen_spacing", [&] { io::seenOf(tracks_, {step, seen_spacing}); });
    }
    if (previous) namingOption("previous", [&] { earlier_ = io::readGaugeList(previous->path, limit); });
    return withFields(inputs[0], GaugeFields(tracks_).fields());
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    io::GaugeReport told{input_name,
                         unit,
                         inputs[0]->coordinate_system,
                         tracks_,
                         axis_files_,
                         io::tablesOf(tracks_, step),
                         {reach, below, above},
                         limit};
    told.cluster_distance = cluster_distance;
    if (origins_) {
      told.origin_path = origin_path->path;
      told.seen_spacing = seen_spacing;
      told.seen = io::seenOf(tracks_, {step, seen_spacing});
    }
    io::GaugeRun gauging(told, 1, origins_ ? &*origins_ : nullptr);
    GaugeFields fields(tracks_);
    io::forEachGaugeBatch(viewOf(inputs[0]->cloud), [&](const PointsView& batch, std::size_t first) {
      if (isCancelled()) throw Cancelled();
      fields.add(tracks_, gauging.add(batch, first));
    });
    const std::string earlier = previous ? previous->path : "";
    warnOf(earlier, gauging.finish(earlier, earlier_));
    if (told.outside.points > 0) warn(input_name + ": " + io::outsideRemark(told.outside, origins_->path));
    files_.write(told);
    const auto output = ownCloud(std::move(inputs[0]));
    output->cloud = withFields(output->cloud, fields.fields());
    return output;
  }

private:
  void warnOf(const std::string& file, const std::vector<std::string>& remarks)
  {
    for (const std::string& remark : remarks) warn(file + ": " + remark);
  }

  void readTrack(const std::string& option, const NamedAxis& from)
  {
    std::vector<std::string> remarks;
    namingOption(option, [&] {
      io::AxisSettings settings;
      settings.alignment = from.alignment.empty() ? alignment : from.alignment;
      settings.fit = fit;
      settings.cant_unit = cant_unit;
      settings.gauge = rail_gauge;
      if (pivot) settings.pivot = io::cantPivotOf(*pivot);
      tracks_.push_back({from.name, io::readAxis(from.file.path, settings, &remarks), {}});
    });
    warnOf(from.file.path, remarks);
    axis_files_.push_back(from.file.path);
    if (!axis && from.name.empty()) throw OptionError(option, "has an empty `name`: give the track's");
    for (std::size_t i = 0; i + 1 < tracks_.size(); ++i)
      if (tracks_[i].name == from.name)
        throw OptionError(option, "another track is called '" + from.name + "', too: give another `name`");
  }

  void readEnvelopes()
  {
    if (profiles.empty()) throw OptionError("profiles", "is an empty list: give one profile at least");
    std::set<std::string> names;
    for (std::size_t i = 0; i < profiles.size(); ++i) {
      const Profile& profile = profiles[i];
      const std::string place = "profiles/" + std::to_string(i);
      io::EnvelopeFiles files = {profile.name, profile.file.path, profile.tracks};
      if (profile.from.has_value() != profile.to.has_value())
        throw OptionError(place, "has one end of a range: give both, `from` and `to`");
      if (profile.from) files.ranges = {{*profile.from, *profile.to}};
      if (profile.widening) files.widening = profile.widening->path;
      if (profile.vehicle_pivots) files.vehicle = Vehicle{*profile.vehicle_pivots, profile.vehicle_overhang};
      for (const std::string& track : profile.tracks)
        if (std::none_of(tracks_.begin(), tracks_.end(), [&](const Track& given) { return given.name == track; }))
          throw OptionError(place, "no track is called '" + track + "': give names of `axes`");
      std::vector<std::string> remarks;
      const std::string name =
          namingOption(place, [&] { return io::addEnvelope(files, tracks_, profile_unit, remarks); });
      warnOf(profile.file.path, remarks);
      if (!names.insert(name).second)
        throw OptionError(place, "another is called '" + name + "', too: give it a `name`");
    }
    for (const Track& track : tracks_)
      if (track.envelopes.empty())
        throw OptionError("profiles", "no profile counts on the track '" + track.name + "': name it in `tracks`, too");
  }

  std::vector<Track> tracks_;
  std::vector<std::string> axis_files_;
  std::optional<io::GaugeList> earlier_;
  std::optional<io::BeamOrigins> origins_;
  io::GaugeFiles files_;
};

Option optionOfAxes()
{
  return rowsOption<NamedAxis>(
      "axes", "instead of `axis`: several tracks, gauged in one pass",
      {rowOption(&NamedAxis::name, "name", "the track's, for reports").required(),
       rowOption(&NamedAxis::file, "file", "the axis, as `axis` has it").required(),
       rowOption(&NamedAxis::alignment, "alignment", "name of the alignment; null: as for all")},
      [](Stage& stage) -> std::vector<NamedAxis>& { return static_cast<Gauge&>(stage).axes; });
}

Option optionOfProfiles()
{
  RowOption<Profile> pivots = rowOption(&Profile::vehicle_pivots, "vehicle_pivots",
                                        "it widens by the overthrow of a vehicle whose pivots are so far apart")
                                  .length(true);
  Option option = rowsOption<Profile>(
      "profiles", "the outlines that must stay free",
      {rowOption(&Profile::file, "file", "the outline, as .csv (offset, height) or .dxf").required(),
       rowOption(&Profile::name, "name", "null: the file's, without its extension"),
       rowOption(&Profile::tracks, "tracks", "names of `axes` where it counts; null: all"),
       rowOption(&Profile::from, "from", "the chainage where it begins to count; null: everywhere"),
       rowOption(&Profile::to, "to", "the chainage where it ends to count, inclusive"),
       rowOption(&Profile::widening, "widening", "how it widens: a .csv of chainage, left, right"), std::move(pivots),
       rowOption(&Profile::vehicle_overhang, "vehicle_overhang", "how far that vehicle goes on beyond its pivots")
           .length()},
      [](Stage& stage) -> std::vector<Profile>& { return static_cast<Gauge&>(stage).profiles; });
  option.required = true;
  return option;
}

} // namespace

StageType gaugeStage()
{
  return describe<Gauge>(
             "filters.gauge",
             "Adds where each point is along a track, and how far outside of profiles that must stay free. Fields: "
             "`chainage` (float64), `offset`, `height`, `clearance` (float32; below 0 inside, NaN without one). "
             "`envelope` (int32) is the profile's number, or -1 where no profile counts. `place` (uint8) is 0 at one "
             "place of the axis, 1 at two, 2 before it, 3 behind it, 4 too far, 5 not finite. With `axes` also `track` "
             "(int32), the number of the one that it is told with, or -1. All points stay. The "
             "query is that of pcl_bsh_gauge; TRACKS.md has the forms of the files.")
      .option(&Gauge::axis, "axis", "the axis: points as .csv, an alignment of LandXML as .xml, or elements as text")
      .option(optionOfAxes())
      .option(optionOfProfiles())
      .option(&Gauge::alignment, "alignment", "name of the alignment, where a LandXML holds several")
      .option(&Gauge::fit, "fit",
              "of an axis of measured points: as few arcs as come so near to them; null: arcs through each point")
      .positiveLength()
      .option(&Gauge::cant_unit, "cant_unit", "cant is in so many of the clouds' units; null: 0.001 in LandXML, else 1")
      .above(0)
      .option(&Gauge::rail_gauge, "gauge",
              "between the rails' heads, whose heights cant tells; null: the file's, or 1.5")
      .positiveLength()
      .option(&Gauge::pivot, "pivot", "what cant turns about; null: as the file says, or low_rail")
      .choices({"low_rail", "centre"})
      .option(&Gauge::profile_unit, "profile_unit",
              "profiles are in so many of the clouds' units; null: as a .dxf says, or 1")
      .above(0)
      .option(&Gauge::limit, "limit", "clearances up to this infringe")
      .unit("m")
      .option(&Gauge::step, "step", "length of a part of the table")
      .positiveLength()
      .option(&Gauge::reach, "reach", "how far beside the axis points belong to it")
      .positiveLength()
      .option(&Gauge::below, "below", "how far below it")
      .positiveLength()
      .option(&Gauge::above, "above", "how far above it")
      .positiveLength()
      .option(&Gauge::cluster_distance, "cluster_distance", "infringing points no farther apart are one infringement")
      .positiveLength()
      .option(&Gauge::origin_path, "origin_path",
              "where the scanner was, as .csv of time, x, y, z: tells how much of the outlines its beams crossed, and "
              "where none did")
      .option(&Gauge::time_field, "time_field",
              "the field of the points' times; empty: gps_time, time, timestamp, timeStamp or t")
      .option(&Gauge::seen_spacing, "seen_spacing", "edge of the outlines' cells that a beam must cross to be seen")
      .positiveLength()
      .option(&Gauge::table, "table", "the .csv file to write: smallest clearances of each part of the axis")
      .option(&Gauge::infringements, "infringements", "the .csv file to write: infringements, the worst first")
      .option(&Gauge::previous, "previous",
              "the `report` of an earlier run: tells infringements that are new, persisting, resolved, not visited or "
              "not scanned any more; may be `report`")
      .replaceable()
      .option(&Gauge::report, "report", "the .json file to write: both, and the counts")
      .option(&Gauge::page, "page", "the .html file to write: infringements, charts and maps")
      .option(&Gauge::unit, "unit", "name of the clouds' unit, for the page")
      .option(&Gauge::input_name, "input_name", "name of the input in the report");
}

} // namespace pcl_bsh::pipeline
