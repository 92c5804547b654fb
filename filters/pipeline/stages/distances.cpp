// SPDX-License-Identifier: BSD-3-Clause
// How far two clouds are from each other, in numbers and as a page.
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/distance_question.h>
#include <pcl_bsh/filters/surface_distances.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/distance_report.h>
#include <pcl_bsh/question/warnings.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::pipeline {
namespace {

struct DistanceWriter : Stage, DistanceQuestion {
  OutputFile filename;
  std::optional<OutputFile> also;
  std::optional<double> places_beyond;
  std::string unit;
  std::string input_name = "input";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::string& warning : check()) warn(std::move(warning));
    requireWritable("filename", filename);
    if (also) requireWritable("also", *also);
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    requirePoints(*inputs[0]);
    HierarchyOptions options;
    options.threads = number_of_threads;
    std::vector<std::string> told;
    const io::Obstacle compared = comparedObstacle(*this, told);
    for (std::string& line : told) warn(std::move(line));
    const SphereHierarchy a(viewOf(inputs[0]->cloud), options), b(compared.view(), options);
    const Placed input(a), other(b, obstaclePose());
    const io::DistanceQuestion question = {input_name,     obstacle.name, unit,
                                           request(*this), places_beyond, compared.isSurface() ? &compared : nullptr};
    SymmetricDistances found = symmetricDistances(input, other, question.request);
    const Question warned{namedCloud("the input", a),
                          namedCloud("the obstacle", b, compared.cover().get()),
                          {obstaclePose()},
                          std::nullopt};
    for (const Warning& warning : warningsOf(warned)) warn(warning.text);
    if (compared.isSurface()) tellOfSurface(compared.tolerance(), found);
    const io::DistanceReport report = io::reportOf(question, input, other, found);
    io::writeDistances(filename.path, report);
    if (also) io::writeDistances(also->path, report);
    return inputs[0];
  }

private:
  static void requireWritable(const std::string& option, const OutputFile& file)
  {
    try {
      io::requireDistanceFormat(file.path);
      files::requireWritable(file.path);
    }
    catch (const files::FileError& error) {
      throw OptionError(option, error.what());
    }
  }
};

} // namespace

StageType distanceWriter()
{
  auto description = describe<DistanceWriter>(
      "writers.distances",
      "Tells how far the input and another cloud are from each other, in both directions: mean, root of the mean "
      "square, percentiles, the Hausdorff distance, and the farthest places; as JSON for programs, or as a page for "
      "browsers. The cloud passes unchanged.");
  return withDistanceOptions(description
                                 .option(&DistanceWriter::filename, "filename",
                                         "the .json or .html file to write; it appears complete or not at all")
                                 .required()
                                 .option(&DistanceWriter::also, "also", "another such file, of the same distances"))
      .option(&DistanceWriter::places_beyond, "places_beyond",
              "places are groups of points farther than this; null: than 95 of 100 points")
      .unit("m")
      .atLeast(0)
      .option(&DistanceWriter::unit, "unit", "name of the clouds' unit, for titles and tables")
      .option(&DistanceWriter::input_name, "input_name", "name of the input in the report");
}

} // namespace pcl_bsh::pipeline
