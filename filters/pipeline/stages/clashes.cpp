// SPDX-License-Identifier: BSD-3-Clause
// What collides, place by place, as a list.
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_report.h>

namespace pcl_bsh::pipeline {
namespace {

struct ClashWriter : Stage, CollisionQuestion {
  OutputFile filename;
  std::optional<OutputFile> also;
  std::optional<double> cluster_distance;
  std::optional<InputFile> previous;
  std::string unit;
  std::string input_name = "input";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::string& warning : check(inputs[0], true)) warn(std::move(warning));
    requireWritable("filename", filename);
    if (also) requireWritable("also", *also);
    if (previous) readEarlier();
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    requirePoints(*inputs[0]);
    Filter filter;
    setUp(filter, *this);
    filter.setInputCloud(pointsOf(inputs[0]));
    TrajectoryResult found;
    filter.computeTrajectory(found);
    write(viewOf(inputs[0]->cloud), found);
    return inputs[0];
  }

private:
  static void requireWritable(const std::string& option, const OutputFile& file)
  {
    try {
      io::requireClashFormat(file.path);
      files::requireWritable(file.path);
    }
    catch (const files::FileError& error) {
      throw OptionError(option, error.what());
    }
  }

  void readEarlier()
  {
    try {
      earlier_ = io::readClashes(previous->path);
      for (const std::string& warning : io::requireComparable(previous->path, earlier_, question())) warn(warning);
    }
    catch (const std::runtime_error& error) {
      throw OptionError("previous", error.what());
    }
  }

  double clusterDistance(const PointsView& scan) const
  {
    if (cluster_distance) return *cluster_distance;
    HierarchyOptions options;
    options.threads = number_of_threads;
    return io::clusterDistanceFor(clearance, spacingOf(SphereHierarchy(scan, options)));
  }

  io::ClashQuestion question() const
  {
    const std::optional<double> motion = swept > 0 ? std::optional(swept) : std::nullopt;
    return {input_name,
            obstacle.name,
            clearance,
            motion,
            Accuracy::parse(accuracy),
            given(uncertainty),
            given(obstacle_uncertainty)};
  }

  void write(const PointsView& scan, const TrajectoryResult& found)
  {
    const double distance = clusterDistance(scan);
    const PointsView model = comparedObstacle().view();
    io::ClashReport report{.question = question(),
                           .cluster_distance = distance,
                           .clashes = findClashes(scan, found, distance),
                           .scan = scan,
                           .model = model,
                           .poses = poses(),
                           .found = found,
                           .survey = {poses(), extentOf(scan)},
                           .unit = unit,
                           .surface = comparedObstacle().isSurface() ? &comparedObstacle() : nullptr};
    if (previous) {
      TrajectoryRequest motion;
      motion.swept = report.question.swept;
      motion.threads = number_of_threads;
      for (const std::string& warning :
           io::compareWithList(report, previous->path, earlier_, [&](FormerPlaces& former) {
             former.visit(SphereHierarchy(model), poses(), motion);
             former.scan(scan);
           }))
        warn(warning);
    }
    io::writeClashes(filename.path, report);
    if (also) io::writeClashes(also->path, report);
  }

  io::ClashList earlier_;
};

} // namespace

StageType clashWriter()
{
  auto description = describe<ClashWriter>(
      "writers.clashes",
      "Lists where the input's points collide with an obstacle, place by place, the nearest first: as JSON or CSV for "
      "programs, or as a page for browsers. The query is that of `filters.bsh_flag` with these options; the cloud "
      "passes unchanged.");
  return withCollisionOptions(description
                                  .option(&ClashWriter::filename, "filename",
                                          "the .json, .csv or .html file to write; it appears complete or not at all")
                                  .required()
                                  .option(&ClashWriter::also, "also", "another such file, of the same clashes"))
      .option(&ClashWriter::cluster_distance, "cluster_distance",
              "colliding points farther apart are two clashes; null: computed from clearance and spacing")
      .unit("m")
      .above(0)
      .option(&ClashWriter::previous, "previous",
              "the .json of an earlier run with the same clearance, uncertainties and accuracy: tells clashes that are "
              "new, persisting, resolved, or not visited by the path or not scanned any more; may be `filename`")
      .replaceable()
      .option(&ClashWriter::unit, "unit", "name of the clouds' unit, for the list and the page")
      .option(&ClashWriter::input_name, "input_name", "name of the input in the list");
}

} // namespace pcl_bsh::pipeline
