// SPDX-License-Identifier: BSD-3-Clause
// What collides, place by place, as a list.
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/filters/reports/clash_report.h>

namespace pcl_bsh::pipeline {
namespace {

struct ClashWriter : Stage, CollisionQuestion {
  OutputFile filename;
  std::optional<OutputFile> also;
  std::optional<double> cluster_distance;
  std::optional<InputFile> previous;
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
      const io::ClashList list = io::readClashes(previous->path);
      const std::optional<double> motion = swept > 0 ? std::optional(swept) : std::nullopt;
      for (const std::string& warning :
           io::requireComparable(previous->path, list, {input_name, obstacle.name, clearance, motion, {}})) {
        warn(warning);
      }
      earlier_ = list.clashes;
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

  void write(const PointsView& scan, const TrajectoryResult& found) const
  {
    const double distance = clusterDistance(scan);
    const PointsView model = comparedObstacle().view();
    io::ClashReport report{input_name,
                           obstacle.name,
                           clearance,
                           distance,
                           {},
                           findClashes(scan, found, distance),
                           scan,
                           model,
                           poses(),
                           found,
                           swept > 0 ? std::optional(swept) : std::nullopt,
                           comparedObstacle().isSurface() ? &comparedObstacle() : nullptr};
    if (previous) {
      report.previous = previous->path;
      compareWithEarlier(report.clashes, earlier_, distance);
    }
    io::writeClashes(filename.path, report);
    if (also) io::writeClashes(also->path, report);
  }

  std::vector<Clash> earlier_;
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
              "the .json of an earlier run: tells new, persisting and resolved clashes; may be `filename`")
      .replaceable()
      .option(&ClashWriter::input_name, "input_name", "name of the input in the list");
}

} // namespace pcl_bsh::pipeline
