// SPDX-License-Identifier: BSD-3-Clause
// Writes the collisions, place by place, as a list.
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/naming_option.h>
#include <pcl_bsh/filters/pipeline/stages/question_stage.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <set>

namespace pcl_bsh::pipeline {
namespace {

struct ClashWriter : Stage, QuestionStage {
  OutputFile filename;
  std::optional<OutputFile> also;
  std::optional<double> cluster_distance;
  std::optional<InputFile> previous;
  std::string unit;
  std::string input_name = "input";
  bool between = false;
  bool overlap = false;
  std::vector<std::string> ignore;
  std::vector<std::string> only;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    Wanted wanted;
    wanted.flags = wanted.contacts = wanted.poses = wanted.unseen_places = true;
    wanted.closest = !obstacles.empty();
    wanted.overlap = overlap;
    if (overlap && !between) throw OptionError("overlap", "is of obstacles that are compared: give `between`: true");
    QuestionStage::plan(inputs[0], wanted, *this);
    requireWritable("filename", filename);
    if (also) requireWritable("also", *also);
    readListing();
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    requirePoints(*inputs[0]);
    const auto ignores_input = [&](const std::string& name) {
      return unasked_.count(name) > 0 || ignored_.holds(kInputName, name);
    };
    write(ask(inputs[0], *this, ignores_input), inputs[0]->coordinate_system);
    return inputs[0];
  }

private:
  static void requireWritable(const std::string& option, const OutputFile& file)
  {
    namingOption(option, [&] {
      io::requireClashFormat(file.path);
      files::requireWritable(file.path);
    });
  }

  /// Reads the facts about the list that are known before clouds are read.
  void readListing()
  {
    std::vector<std::string> names, warnings; // plan() has told those of poses
    std::vector<io::ComparedObstacle> compared;
    for (auto& [row, one, shape] : asked(warnings)) {
      if (!one.name.empty()) names.push_back(one.name);
      compared.push_back(std::move(one));
    }
    if (names.empty() && (between || !ignore.empty()))
      throw OptionError(between ? "between" : "ignore", "is given, and there is one obstacle: give `obstacles`");
    ignored_ = namingOption("ignore", [&] { return IgnoredPairs(ignore, names); });
    if (!only.empty()) {
      if (names.empty()) throw OptionError("only", "is given, and there is one obstacle: give `obstacles`");
      if (!previous) throw OptionError("only", "is given, and nothing tells of the other obstacles: give `previous`");
      const std::vector<bool> fitting = namingOption("only", [&] { return fittingNames("only", only, names); });
      for (std::size_t i = 0; i < names.size(); ++i) {
        compared[i].asked = fitting[i];
        if (!fitting[i]) unasked_.insert(names[i]);
      }
    }
    listing_ = {input_name, unit};
    listing_.cluster_distance = cluster_distance;
    if (!previous) return;
    listing_.previous = previous->path;
    warnings.clear();
    namingOption("previous", [&] { listing_.readEarlier(compared, warnings); });
    for (std::string& warning : warnings) warn(std::move(warning));
  }

  void write(AnsweredQuestion&& found, const std::string& coordinate_system)
  {
    std::vector<const SphereHierarchy*> hierarchies;
    for (std::size_t i = 0; i < found.shapes.size(); ++i) hierarchies.push_back(&found.obstacleHierarchy(i));
    listing_.coordinate_system = coordinate_system;
    std::vector<std::string> warnings;
    for (io::ComparedObstacle& one : found.obstacles) one.asked = unasked_.count(one.name) == 0;
    if (listing_.kept) {
      const std::optional<Extent> box = extentOf(found.inputHierarchy(question).view());
      namingOption("previous", [&] { listing_.keep(found.obstacles, ignored_, box, warnings); });
    }
    if (between) listing_.between = io::askBetween(question, found.shapes, found.obstacles, ignored_);
    const io::ClashLists lists =
        io::listOf(listing_, found.inputHierarchy(question), hierarchies, found.obstacles, found.answer, warnings);
    for (std::string& warning : warnings) warn(std::move(warning));
    for (std::string& remark : io::writeClashes(filename.path, lists)) warn(std::move(remark));
    if (!also) return;
    for (std::string& remark : io::writeClashes(also->path, lists)) warn(std::move(remark));
  }

  IgnoredPairs ignored_;
  std::set<std::string> unasked_; ///< names of obstacles whose clashes are those of `previous`
  io::ClashListing listing_;
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
      .positiveLength()
      .option(&ClashWriter::previous, "previous",
              "the .json or BCF of an earlier run with the same options but `swept` and `seen`: tells clashes that are "
              "new, persisting, resolved, not visited, unseen or not scanned any more; may be `filename`")
      .replaceable()
      .option(&ClashWriter::between, "between",
              "the `obstacles` are compared with each other, too, as they stand; where they are more than 32, pairs "
              "that are clear are not told")
      .option(&ClashWriter::overlap, "overlap",
              "with `between`: the area of each surface inside another obstacle that is a solid, as an interval")
      .option(
          &ClashWriter::ignore, "ignore",
          "pairs of names that are not compared, of `obstacles` or `input`: \"FIRST:SECOND\", where * is any letters, "
          "and a backslash stands before a colon within a name")
      .option(
          &ClashWriter::only, "only",
          "names of the `obstacles` that are asked about, * is any letters; what `previous` lists of the others, for "
          "the same cloud and question, is listed again")
      .option(&ClashWriter::unit, "unit", "name of the clouds' unit, for the list and the page")
      .option(&ClashWriter::input_name, "input_name", "name of the input in the list");
}

} // namespace pcl_bsh::pipeline
