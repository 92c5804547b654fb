// SPDX-License-Identifier: BSD-3-Clause
// Writes the collisions, place by place, as a list.
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/question_stage.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_report.h>

namespace pcl_bsh::pipeline {
namespace {

struct ClashWriter : Stage, QuestionStage {
  OutputFile filename;
  std::optional<OutputFile> also;
  std::optional<double> cluster_distance;
  std::optional<InputFile> previous;
  std::string unit;
  std::string input_name = "input";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    Wanted wanted;
    wanted.flags = wanted.contacts = wanted.poses = wanted.unseen_places = true;
    QuestionStage::plan(inputs[0], wanted, *this);
    requireWritable("filename", filename);
    if (also) requireWritable("also", *also);
    if (previous) readEarlier();
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    requirePoints(*inputs[0]);
    write(ask(inputs[0], *this), inputs[0]->coordinate_system);
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
      for (const std::string& warning : io::requireComparable(previous->path, earlier_, asked())) warn(warning);
    }
    catch (const std::runtime_error& error) {
      throw OptionError("previous", error.what());
    }
  }

  io::ClashQuestion asked() const { return {question, input_name, obstacle.name}; }

  void write(AnsweredQuestion&& found, const std::string& coordinate_system)
  {
    const SphereHierarchy &input = found.inputHierarchy(question), &other = found.obstacleHierarchy(question);
    const double distance =
        cluster_distance ? *cluster_distance : io::clusterDistanceFor(*question.clearance, spacingOf(input));
    const std::vector<Eigen::Isometry3d> poses = question.poses();
    io::ClashReport report = io::clashesOf(asked(), input, other, poses, found.answer, distance,
                                           found.compared.isSurface() ? &found.compared : nullptr);
    report.unit = unit;
    report.coordinate_system = coordinate_system;
    if (previous)
      for (const std::string& warning : io::compareWithList(report, previous->path, earlier_, input, other))
        warn(warning);
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
      "programs, as a page for browsers, or as topics of BCF (.bcf: 3.0, .bcfzip: 2.1). The query is that of "
      "`filters.bsh_flag` with these options; the cloud "
      "passes unchanged.");
  return withQuestionOptions(
             description
                 .option(&ClashWriter::filename, "filename",
                         "the .json, .csv, .html, .bcf or .bcfzip file to write; it appears complete or not at all")
                 .required()
                 .option(&ClashWriter::also, "also", "another such file, of the same clashes"),
             QuestionKind::collisions)
      .option(&ClashWriter::cluster_distance, "cluster_distance",
              "colliding points farther apart are two clashes; null: computed from clearance and spacing")
      .unit("m")
      .above(0)
      .option(&ClashWriter::previous, "previous",
              "the .json or BCF of an earlier run with the same options but `swept` and `seen`: tells clashes that are "
              "new, persisting, resolved, not visited, unseen or not scanned any more; may be `filename`")
      .replaceable()
      .option(&ClashWriter::unit, "unit", "name of the clouds' unit, for the list and the page")
      .option(&ClashWriter::input_name, "input_name", "name of the input in the list");
}

} // namespace pcl_bsh::pipeline
