// SPDX-License-Identifier: BSD-3-Clause
// How far two clouds are from each other, in numbers and as a page.
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/naming_option.h>
#include <pcl_bsh/filters/pipeline/stages/question_stage.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/distance_report.h>

namespace pcl_bsh::pipeline {
namespace {

struct DistanceWriter : Stage, QuestionStage {
  OutputFile filename;
  std::optional<OutputFile> also;
  std::optional<double> places_beyond;
  std::string unit;
  std::string input_name = "input";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    Wanted wanted;
    wanted.distances = wanted.both_ways = true;
    QuestionStage::plan(inputs[0], wanted, *this);
    requireWritable("filename", filename);
    if (also) requireWritable("also", *also);
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    AnsweredQuestion asked = ask(inputs[0], *this);
    const Placed input(asked.inputHierarchy(question)), other(asked.obstacleHierarchy(0), question.pose);
    PointDistancesRequest request;
    request.max_distance = question.max_distance.value_or(request.max_distance);
    request.accuracy = question.accuracy;
    const io::Obstacle& compared = asked.obstacles[0].loaded;
    const io::DistanceQuestion told = {input_name,     obstacle->name,
                                       unit,           request,
                                       places_beyond,  compared.isSurface() ? &compared : nullptr,
                                       question.solid, inputs[0]->coordinate_system};
    const io::DistanceReport report = io::reportOf(told, input, other, asked.answer.distances);
    io::writeDistances(filename.path, report);
    if (also) io::writeDistances(also->path, report);
    return inputs[0];
  }

private:
  static void requireWritable(const std::string& option, const OutputFile& file)
  {
    namingOption(option, [&] {
      io::requireDistanceFormat(file.path);
      files::requireWritable(file.path);
    });
  }
};

} // namespace

StageType distanceWriter()
{
  auto description = describe<DistanceWriter>(
      "writers.distances", "Tells how far the input and another cloud are from each other, in both directions, as JSON "
                           "for programs, or as a page for browsers. It has the mean, the root of the mean square, "
                           "percentiles, the Hausdorff distance, and the farthest places. The cloud passes unchanged.");
  return withQuestionOptions(description
                                 .option(&DistanceWriter::filename, "filename",
                                         "the .json or .html file to write; it appears complete or not at all")
                                 .required()
                                 .option(&DistanceWriter::also, "also", "another such file, of the same distances"),
                             QuestionKind::both_ways)
      .option(&DistanceWriter::places_beyond, "places_beyond",
              "places are groups of points farther than this; null: than 95 of 100 points")
      .unit("m")
      .atLeast(0)
      .option(&DistanceWriter::unit, "unit", "name of the clouds' unit, for titles and tables")
      .option(&DistanceWriter::input_name, "input_name", "name of the input in the report");
}

} // namespace pcl_bsh::pipeline
