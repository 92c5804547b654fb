// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/pipeline/stages/naming_option.h>
#include <pcl_bsh/filters/pipeline/stages/one_system.h>
#include <pcl_bsh/filters/pipeline/stages/question_stage.h>
#include <pcl_bsh/filters/pipeline/stages/row_options.h>
#include <pcl_bsh/io/clouds/point_masks.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/uncertainty.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace pcl_bsh::pipeline {
namespace {

std::vector<Eigen::Isometry3d> readTrajectory(const InputFile& file, std::vector<std::string>& warnings)
{
  return namingOption("trajectory", [&] { return io::readPoses(file.path, &warnings); });
}

/// A matrix of few printed digits stands for its nearest rotation, with a warning. A pose farther from rigid stays as
/// it is, and the query refuses it.
Eigen::Isometry3d rigidPoseOf(const Pose& pose, const std::string& option, std::vector<std::string>& warnings)
{
  Eigen::Isometry3d only;
  only.matrix() = pose.matrix;
  const io::RigidPose rigid = io::nearestRigid(only);
  if (rigid.deviation > 0) warnings.push_back(option + ": " + io::nearestRotationWarning(rigid.deviation));
  return rigid.pose;
}

/// Checks an uncertainty by the fields of a cloud. Its points are checked when the stage runs.
void checkField(const std::string& option, const Uncertainty& uncertainty, const CloudHeader& cloud)
{
  namingOption(option, [&] { withUncertainty(PointsView(), cloud.fields, "cloud", uncertainty); });
}

/// Warns of points, or of other parts, that are not decided.
void warnOfUndecided(const Answer& answer, const Question& question, const char* parts, Stage& stage)
{
  const std::size_t undecided = answer.collisions.undecided + answer.sparse;
  if (undecided == 0) return;
  const std::string why = answer.sparse > 0 ? ", of which " + std::to_string(answer.sparse) +
                                                  " where the obstacle is not scanned densely enough"
                          : question.isUncertain() ? " where places are as uncertain"
                                                   : " with this accuracy";
  stage.warn(std::to_string(undecided) + ' ' + parts + " stay undecided" + why + ": they are not taken for free");
}

/// Warns of what a scanner did not see. @param obstacle its name, or "the obstacle"
void warnOfUnseen(const Answer::Unseen& unseen, const std::string& part, const std::string& obstacle, Stage& stage)
{
  if (unseen.count == 0) return;
  stage.warn(counted(unseen.count, part + " of " + obstacle + " is", part + "s of " + obstacle + " are") +
             " unseen: free of collisions, but no scanner saw that nothing is there (" +
             std::to_string(unseen.in_shadow) + " in shadow, " + std::to_string(unseen.inSkin()) + " in the skin)");
}

/// Returns the shape as which a cloud is compared. @param option the option that gives the cloud, for errors
io::Obstacle shapeOf(const StageCloudPtr& cloud, const Question& question, const std::string& option)
{
  if (!cloud->corners_alone.empty() && !question.vertices_only)
    throw OptionError(option,
                      "is of " + cloud->corners_alone + ": give `vertices_only`: true to compare its corners alone");
  return namingOption(option, [&] {
    return io::Obstacle({cloud, &cloud->cloud}, cloud->triangles, {question.vertices_only});
  });
}

/// The parts of a row's cloud. @pre it has some
std::vector<io::Obstacle> partsOf(const NamedObstacle& row, bool vertices_only)
{
  const StageCloud& cloud = *row.file.cloud;
  const std::vector<Triangle> none;
  return io::obstaclesOf(*row.parts, cloud.cloud, cloud.triangles ? *cloud.triangles : none, {vertices_only});
}

Value valueOf(const Uncertainty& uncertainty)
{
  return OptionType<LengthOrField>::to({uncertainty.length, uncertainty.field});
}
template <typename T>
Value valueOf(const T& value)
{
  if constexpr (is_text_option<T>)
    return value.text();
  else
    return OptionType<T>::to(value);
}

void assign(Uncertainty& uncertainty, const Value& value)
{
  const auto [length, field] = OptionType<LengthOrField>::from(value);
  uncertainty = field.empty() ? Uncertainty(length) : Uncertainty(field, 1.0);
}
template <typename T>
void assign(T& member, const Value& value)
{
  if constexpr (is_text_option<T>)
    member = T::parse(std::get<std::string>(value));
  else
    member = OptionType<T>::from(value);
}

template <typename T>
constexpr Kind kindOf()
{
  if constexpr (is_text_option<T>)
    return Kind::text;
  else if constexpr (std::is_same_v<T, Uncertainty>)
    return Kind::length_or_field;
  else
    return OptionType<T>::kind;
}

std::vector<RowOption<NamedObstacle>> optionsOfObstacles()
{
  std::vector<RowOption<NamedObstacle>> rows = {
      rowOption(&NamedObstacle::file, "file", "the cloud or mesh").required(),
      rowOption(&NamedObstacle::name, "name", "that lists and pages tell; null: the file's, or the tag"),
      rowOption(&NamedObstacle::pose, "pose", "in the frame of all obstacles; null: that frame's"),
      rowOption(&NamedObstacle::clearance, "clearance", "in place of the stage's").length(),
      rowOption(&NamedObstacle::solid, "solid", "in place of the stage's"),
      rowOption(&NamedObstacle::uncertainty, "uncertainty", "of its points, in place of `obstacle_uncertainty`")
          .length(),
      rowOption(&NamedObstacle::in_parts, "parts",
                "an obstacle of each object or group of an .obj, or solid of an .stl, named PART or NAME/PART")};
  for (const auto& [name, doc] : {std::pair{"unit", "the unit of the file's lengths"},
                                  {"to_unit", "the unit that they are read in, as `to_unit` of readers"},
                                  {"crs", "the coordinate system of the file, as `crs` of readers"},
                                  {"to_crs", "the system that it is read in, as `to_crs` of readers"}}) {
    RowOption<NamedObstacle> row;
    row.option.name = name;
    row.option.doc = doc;
    row.option.kind = Kind::text;
    row.option.nullable = row.option.of_reader = true;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string nameOf(const NamedObstacle& obstacle)
{
  return obstacle.name.empty() ? std::filesystem::path(obstacle.file.name).stem().string() : obstacle.name;
}

std::string placeOf(std::size_t obstacle, const char* option)
{
  return "obstacles/" + std::to_string(obstacle) + '/' + option;
}

} // namespace

Option optionOfObstacles(const std::function<std::vector<NamedObstacle>&(Stage&)>& obstacles)
{
  Option option = rowsOption<NamedObstacle>(
      "obstacles", "in place of `obstacle`, several with names: one question about all of them", optionsOfObstacles(),
      obstacles);
  option.cloud = [obstacles](Stage& stage, std::size_t row) { return &obstacles(stage)[row].file; };
  return option;
}

Option optionOf(const QuestionOption& row, std::function<Question&(Stage&)> question)
{
  Option option;
  option.name = row.name_of_stages ? row.name_of_stages : row.name;
  option.doc = row.doc;
  option.unit = row.unit;
  option.required = row.required;
  std::visit(
      [&](const auto member) {
        using T = std::decay_t<decltype(std::declval<Question>().*member)>;
        option.kind = kindOf<T>();
        option.set = [question, member, name = option.name](Stage& stage, const Value& value) {
          namingOption(name, [&] { assign(question(stage).*member, value); });
        };
        option.get = [question, member](const Stage& stage) {
          return valueOf(question(const_cast<Stage&>(stage)).*member); // NOLINT: which is not changed
        };
      },
      row.member);
  if (option.kind == Kind::boolean || option.kind == Kind::text) return option;
  option.least = 0;
  option.above_least = row.range == OptionRange::above_zero;
  if (row.most() < std::numeric_limits<double>::max()) option.most = row.most();
  return option;
}

void refuse(const InvalidInput& error, const Question& question)
{
  std::string name = pcl_bsh::optionOf(error, question);
  if (name.empty()) throw; // within a catch
  const QuestionOption* const row = questionOption(name);
  if (row && row->name_of_stages) name = row->name_of_stages;
  throw OptionError(name == "path" ? "trajectory" : name, error.advice());
}

void QuestionStage::plan(const CloudHeader& input, const Wanted& wanted, Stage& stage)
{
  if (!obstacle && obstacles.empty())
    throw OptionError("obstacle", "is missing: give the tag of an earlier stage, or the name of a cloud file");
  if (obstacle && !obstacles.empty()) throw OptionError("obstacles", "and `obstacle` are both given: give one of them");
  if (trajectory && pose) throw OptionError("trajectory", "and `pose` are both given: give one of them");
  std::vector<std::string> warnings;
  if (trajectory) question.path = readTrajectory(*trajectory, warnings);
  if (pose) question.pose = rigidPoseOf(*pose, "pose", warnings);
  question.wanted = wanted;
  checkField("uncertainty", question.uncertainty, input);
  namingOption("ignore_points", [&] { io::readMasks(question.ignore_points); });
  namingOption("obstacle_ignore_points", [&] { io::readMasks(question.obstacle_ignore_points); });
  for (std::size_t row = 0; row < obstacles.size(); ++row) {
    NamedObstacle& named = obstacles[row];
    if (!named.in_parts.value_or(false)) continue;
    named.parts = namingOption(placeOf(row, "parts"), [&] {
      return std::make_shared<const io::MeshParts>(io::readMeshParts(named.file.name));
    });
    for (const std::string& remark : named.parts->remarks) stage.warn(named.file.name + ": " + remark);
  }
  std::vector<std::string> names;
  for (const auto& [row, one, shape] : asked(warnings)) {
    try {
      check(one.question);
    }
    catch (const InvalidInput& error) {
      refuse(error, one.question);
    }
    if (one.name.empty()) {
      checkField("obstacle_uncertainty", question.obstacle_uncertainty, obstacle->header);
      continue;
    }
    const NamedObstacle& named = obstacles[row];
    checkField(named.uncertainty ? placeOf(row, "uncertainty") : "obstacle_uncertainty",
               one.question.obstacle_uncertainty, named.file.header);
    names.push_back(one.name);
  }
  namingOption("obstacles", [&] { checkObstacleNames(names); });
  for (std::string& warning : warnings) stage.warn(std::move(warning));
}

std::vector<QuestionStage::Asked> QuestionStage::asked(std::vector<std::string>& warnings) const
{
  std::vector<Asked> all;
  const auto add = [&](std::size_t row, const std::string& name, const OtherCloud& file, const PlacedShape& shape) {
    all.push_back({row, {name, file.name}, shape});
    all.back().one.question = questionOf(question, shape);
  };
  if (obstacle) add(0, "", *obstacle, {});
  for (std::size_t row = 0; row < obstacles.size(); ++row) {
    const NamedObstacle& one = obstacles[row];
    PlacedShape shape = {Shape(), Eigen::Isometry3d::Identity(), one.clearance, one.solid};
    if (one.pose) shape.pose = rigidPoseOf(*one.pose, placeOf(row, "pose"), warnings);
    if (one.uncertainty) assign(shape.uncertainty.emplace(), OptionType<LengthOrField>::to(*one.uncertainty));
    if (!one.parts) add(row, nameOf(one), one.file, shape);
    for (std::size_t part = 0; one.parts && part < one.parts->names.size(); ++part)
      add(row, one.parts->nameOf(part, one.name), one.file, shape);
  }
  return all;
}

QuestionStage::AnsweredQuestion QuestionStage::ask(const StageCloudPtr& input, Stage& stage,
                                                   const std::function<bool(const std::string&)>& ignores_input) const
{
  Question asked = question;
  asked.wanted.spacings = asked.wanted.collisions();
  asked.progress = [&stage](double) { return !stage.isCancelled(); };
  if (asked.seen && asked.origin.empty()) {
    io::CloudFacts facts;
    facts.viewpoint = input->viewpoint;
    facts.scanners = input->scanners;
    asked.origin = io::originsOf(input->cloud, facts);
  }
  AnsweredQuestion found;
  found.input = shapeOf(input, question, "input").shape("the input");
  std::vector<std::string> told;    // plan() has told these
  std::vector<io::Obstacle> shapes; // of a row, not asked about yet; the next one last
  for (auto& [row, one, shape] : this->asked(told)) {
    if (shapes.empty()) {
      const std::string option = obstacle ? "obstacle" : placeOf(row, "file");
      const StageCloudPtr& cloud = obstacle ? obstacle->cloud : obstacles[row].file.cloud;
      requireOneSystem(*input, *cloud, option, stage);
      const io::Obstacle whole = shapeOf(cloud, question, option);
      if (whole.isSurface())
        stage.warn((obstacle ? "" : nameOf(obstacles[row]) + ": ") + io::promiseOf(whole, one.question.solid));
      shapes = {whole};
      if (!obstacle && obstacles[row].parts)
        shapes = namingOption(option, [&, at = row] { return partsOf(obstacles[at], question.vertices_only); });
      std::reverse(shapes.begin(), shapes.end());
    }
    one.loaded = std::move(shapes.back());
    shapes.pop_back();
    shape.shape = one.loaded.shape(one.name.empty() ? "the obstacle" : one.name);
    shape.ignores_input = ignores_input && !one.name.empty() && ignores_input(one.name);
    found.obstacles.push_back(std::move(one));
    found.shapes.push_back(std::move(shape));
  }
  try {
    found.answer = io::askAbout(asked, found.input, found.shapes, found.obstacles).all;
  }
  catch (const InvalidInput& error) {
    refuse(error, question);
  }
  for (const Warning& warning : found.answer.warnings) stage.warn(warning.text);
  for (const io::ComparedObstacle& one : found.obstacles)
    warnOfUnseen(one.name.empty() ? found.answer.unseen : one.answer.unseen, one.loaded.partName(),
                 one.name.empty() ? "the obstacle" : one.name, stage);
  warnOfUndecided(found.answer, question, found.input.isSurface() ? "triangles" : "points", stage);
  return found;
}

void QuestionStage::requirePoints(const StageCloud& input) const
{
  if (asksAboutFaces(input))
    throw OptionError("vertices_only", "is false, and the input has faces: the stage knows points alone: give true to "
                                       "ask about its vertices, or read it without faces");
}

} // namespace pcl_bsh::pipeline
