// SPDX-License-Identifier: BSD-3-Clause
#include "clouds_content.h"

#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/question_options.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/geometry/triangle/nearest_point.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/question/warnings/warnings.h>
#include <pcl_bsh/search/uncertainty.h>
#include <pcl_bsh/seen/seen_space.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::viewer {
namespace {

/// Makes a viewed cloud of a loaded one. A cloud with faces is a surface.
ViewedCloud viewedOf(const io::Obstacle& read, const std::filesystem::path& file, ViewedCloud::Role role,
                     unsigned threads)
{
  ViewedCloud viewed;
  viewed.name = viewed.legend = file.filename().string();
  viewed.role = role;
  viewed.file = file;
  HierarchyOptions how;
  how.threads = threads;
  viewed.hierarchy = std::make_shared<SphereHierarchy>(read.view(), how);
  viewed.cloud = read.cloud();
  if (read.isSurface()) viewed.surface = read;
  return viewed;
}

ViewedCloud load(const std::filesystem::path& file, ViewedCloud::Role role, const Options& options,
                 const io::ReadSettings& reading, io::CloudFacts& facts)
{
  cli::Step step("Loading " + file.string());
  const io::SurfaceSettings settings = {options.question.vertices_only};
  io::Mesh mesh = io::readMesh(file, settings, &facts, reading, options.question.threads);
  std::vector<io::FaceValues> face_values = std::move(mesh.face_values);
  ViewedCloud viewed = viewedOf(io::obstacleOf(file, std::move(mesh), settings), file, role, options.question.threads);
  viewed.face_values = std::move(face_values);
  step.done(counted(viewed.parts(), viewed.partName()));
  cli::warnOfFile(program, file, facts.remarks);
  return viewed;
}

/// A line for each obstacle. If there are more than most_named, those that collide come first, and the rest is counted.
std::string linesOf(std::vector<NamedCollisions> all, const std::string& unit)
{
  const std::size_t told = std::min(all.size(), most_named);
  if (told < all.size())
    std::stable_partition(all.begin(), all.end(), [](const NamedCollisions& one) { return one.colliding > 0; });
  std::string text;
  for (std::size_t i = 0; i < told; ++i) {
    text += '\n' + all[i].name + ": " +
            (all[i].colliding > 0 ? groupedCount(all[i].colliding, "collides", "collide") : "free");
    if (all[i].closest) text += ", smallest distance " + lengthOf(all[i].closest->distance, unit);
  }
  if (told < all.size()) text += "\nand " + std::to_string(all.size() - told) + " more obstacles";
  return text;
}

} // namespace

CloudsContent::CloudsContent(const Options& options) : FieldContent(options), poses_{options.question.pose}
{
  if (options.trajectory) {
    std::vector<std::string> warnings;
    poses_ = io::readPoses(*options.trajectory, &warnings);
    cli::warn(program, warnings);
  }
  if (options.step >= poses_.size())
    throw cli::UsageError("--step: " + std::to_string(options.step) + ": the trajectory has " +
                          counted(poses_.size(), "pose") + ", counted from 0");
  io::CloudFacts of_scan, facts;
  viewed_clouds_.push_back(
      load(options.clouds[0], ViewedCloud::Role::scan, options, options.reading.ofInput(options.clouds[0]), of_scan));
  origins_ = options.question.origin.empty() ? io::originsOf(*scan().cloud, of_scan) : options.question.origin;
  const auto add = [&](const std::filesystem::path& file) {
    viewed_clouds_.push_back(load(file, ViewedCloud::Role::obstacle, options,
                                  options.reading.ofObstacle(file, of_scan.unit, {}), facts = {}));
  };
  std::for_each(options.clouds.begin() + 1, options.clouds.end(), add);
  if (options.question.seen)
    seen_from_ = Shape(scan().file.string(), scan().points(), recordFields(scan().cloud->fields));
  if (options.model) {
    model_ = viewed_clouds_.size();
    add(*options.model);
  }
  if (scan().hierarchy->empty()) throw std::invalid_argument(scan().file.string() + ": has no finite point to show");
  for (const ViewedCloud& viewed : viewed_clouds_) shapes_.emplace_back(viewed.file.string(), viewed.hierarchy);
  if (!options.obstacles.empty()) loadNamed(of_scan);
  warnOfQuestions();
}

void CloudsContent::loadNamed(const io::CloudFacts& of_scan)
{
  double seconds = 0.0;
  const std::vector<cli::LoadedObstacle> loaded =
      cli::loadObstacles(options_.obstacles, options_.question, {options_.reading, of_scan.unit}, seconds);
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    const cli::ObstacleChoice& choice = options_.obstacles[i];
    const io::Obstacle& read = loaded[i].obstacle;
    ViewedCloud viewed = viewedOf(read, choice.file, ViewedCloud::Role::obstacle, options_.question.threads);
    viewed.name = viewed.legend = choice.name;
    viewed.number = i;
    const Uncertainty uncertainty = choice.uncertainty.value_or(Uncertainty());
    shapes_.push_back(uncertainty.isZero() ? Shape(choice.file.string(), viewed.hierarchy)
                                           : read.shape(choice.file.string()));
    cli::named([&] { shapes_.back().hierarchy(uncertainty, options_.question.threads); });
    viewed_clouds_.push_back(std::move(viewed));
    cli::warn(program, cli::warningsOf(read, choice.file));
  }
}

void CloudsContent::warnOfQuestions() const
{
  std::vector<std::string> told;
  Question question;
  for (std::size_t other = 1; other < viewed_clouds_.size(); ++other) {
    question.clearance = clearanceOf(other);
    question.path = pathOf(other);
    addTexts(warningsOf(question, shapes_[0].facts(true), shapes_[other].facts(true)), told);
  }
  cli::warn(program, told);
}

Eigen::Isometry3d CloudsContent::poseOf(std::size_t cloud, std::size_t step) const
{
  if (cloud == model_) return poses_[step];
  const cli::ObstacleChoice* const choice = choiceOf(cloud);
  if (!choice) return Eigen::Isometry3d::Identity();
  Question question;
  question.pose = poses_[step];
  return questionOf(question, choice->placed(Shape())).pose;
}

std::optional<double> CloudsContent::clearanceOf(std::size_t other) const
{
  const cli::ObstacleChoice* const choice = choiceOf(other);
  return choice && choice->clearance ? choice->clearance : options_.question.clearance;
}

std::vector<Eigen::Isometry3d> CloudsContent::pathOf(std::size_t cloud) const
{
  std::vector<Eigen::Isometry3d> path;
  for (std::size_t step = 0; step < (moves(cloud) ? steps() : 1); ++step) path.push_back(poseOf(cloud, step));
  return path;
}

Answer CloudsContent::asked(std::size_t other, std::size_t step, Question question, Shape* input) const
{
  question.clearance = clearanceOf(other);
  question.threads = options_.question.threads;
  question.solid = options_.question.solid;
  question.input_solid = options_.question.input_solid;
  question.pose = poseOf(other, step);
  if (const cli::ObstacleChoice* const choice = choiceOf(other)) {
    if (choice->solid) question.solid = *choice->solid;
    if (choice->uncertainty) question.obstacle_uncertainty = *choice->uncertainty;
  }
  Shape& scan = question.seen ? seen_from_ : input ? *input : shapes_[0];
  Answer answer = cli::named([&] { return ask(question, scan, shapes_[other]); }, question);
  for (const Warning& warning : answer.warnings)
    if (warning.kind == WarningKind::hollow && hollow_.insert(warning.text).second) cli::warn(program, {warning.text});
  return answer;
}

StepCollisions CloudsContent::collisions(std::size_t step) const
{
  StepCollisions found = options_.question.clearance ? StepCollisions() : FieldContent::collisions(step);
  if (options_.question.clearance) {
    found.known = true;
    found.flags.resize(viewed_clouds_.size());
    found.flags[0].assign(scan().parts(), Verdict::free);
    Question question;
    question.wanted.flags = question.wanted.obstacle_flags = true;
    question.seen = options_.question.seen;
    if (question.seen) {
      question.origin = origins_;
      question.seen_angle = options_.question.seen_angle;
    }
    for (std::size_t other = 1; other < viewed_clouds_.size(); ++other) {
      Answer answer = asked(other, step, question);
      const std::vector<Verdict>& of_scan = answer.collisions.flags;
      for (std::size_t i = 0; i < of_scan.size(); ++i) found.flags[0][i] = graver(found.flags[0][i], of_scan[i]);
      found.flags[other] = std::move(answer.obstacle_flags);
      if (const cli::ObstacleChoice* const choice = choiceOf(other))
        found.named.push_back({choice->name, answer.collisions.colliding, closest(other, step)});
    }
    countVerdicts(found);
    for (std::size_t other = 1; other < found.flags.size(); ++other)
      found.unseen += countOf(found.flags[other], Verdict::unseen);
  }
  if (options_.closest) found.closest = closest(step);
  return found;
}

std::optional<ClosestPair> CloudsContent::closest(std::size_t other, std::size_t step) const
{
  Question question;
  question.wanted.closest = true;
  const DistanceResult found = asked(other, step, question).closest;
  if (!found.pair) return std::nullopt;
  const auto [a, b] = nearestPoints(scan().cornersOf(found.pair->a, poseOf(0, step)),
                                    viewed_clouds_[other].cornersOf(found.pair->b, poseOf(other, step)));
  return ClosestPair{Eigen::Vector3d(a.data()), Eigen::Vector3d(b.data()), found.distance};
}

std::optional<ClosestPair> CloudsContent::closest(std::size_t step) const
{
  std::optional<ClosestPair> nearest;
  for (std::size_t other = 1; other < viewed_clouds_.size(); ++other) {
    const std::optional<ClosestPair> found = closest(other, step);
    if (found && !(nearest && nearest->distance <= found->distance)) nearest = found;
  }
  return nearest;
}

std::string CloudsContent::heading(const StepCollisions& collisions, std::size_t step) const
{
  std::ostringstream text;
  text << scan().name << ": " << groupedCount(scan().hierarchy->size(), scan().partName());
  if (collisions.known) {
    text << ", " << groupedCount(collisions.colliding, "collides", "collide");
    if (collisions.undecided > 0) text << ", " << groupedCount(collisions.undecided, "is undecided", "are undecided");
    if (options_.question.seen) text << ", of the obstacles " << grouped(collisions.unseen) << " unseen";
    if (collisions.sparse > 0) text << ", " << grouped(collisions.sparse) << " not scanned densely enough";
    if (options_.question.clearance)
      text << "  (clearance " << lengthOf(*options_.question.clearance, options_.unit) << ')';
  }
  text << linesOf(collisions.named, options_.unit);
  if (steps() > 1) text << "\npose " << step << " of 0.." << steps() - 1;
  return text.str();
}

MotionPaths CloudsContent::paths(std::size_t /*step*/) const
{
  if (steps() == 1) return {};
  return {model_ ? "path of the model" : "path of the obstacles", {poses_}};
}

std::vector<std::array<Eigen::Vector3d, 2>> CloudsContent::beams() const
{
  std::vector<std::array<Eigen::Vector3d, 2>> lines;
  if (options_.beams == 0) return lines;
  const PointsView& view = scan().points();
  const ScanBeams beams =
      scansOf(view, recordFields(scan().cloud->fields), scan().file.string(), origins_).front(); // of the first scan
  const std::size_t step = std::max<std::size_t>(beams.returns.size() / options_.beams, 1);
  for (std::size_t i = 0; i < beams.returns.size(); i += step) {
    const Point3 end = view.point(beams.returns.record(i));
    if (isFinite(end)) lines.push_back({Eigen::Vector3d(beams.origin.data()), Eigen::Vector3d(end.data())});
  }
  return lines;
}

std::optional<double> CloudsContent::distanceOf(std::uint32_t part, std::size_t step) const
{
  if (viewed_clouds_.size() == 1) return std::nullopt;
  const auto record = static_cast<std::int32_t>(part);
  PointsView view = scan().points();
  view.restrictTo(&record, 1);
  Shape alone(viewed_clouds_[0].file.string(), view);
  Question question;
  question.wanted.closest = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t other = 1; other < viewed_clouds_.size(); ++other)
    nearest = std::min(nearest, asked(other, step, question, &alone).closest.distance);
  return nearest;
}

std::vector<float> CloudsContent::distances(std::size_t step) const
{
  if (!options_.question.clearance) return FieldContent::distances(step);
  std::vector<float> distances(scan().parts(), std::numeric_limits<float>::quiet_NaN());
  Question question; // along a path of one pose: its distances are floats
  question.wanted.distances = true;
  for (std::size_t other = 1; other < viewed_clouds_.size(); ++other) {
    question.max_distance = options_.range.value_or(*clearanceOf(other));
    question.path = {poseOf(other, step)};
    const std::vector<float> found = asked(other, step, question).collisions.distance;
    for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = std::fmin(distances[i], found[i]);
  }
  return distances;
}

std::vector<double> CloudsContent::allDistances(std::size_t step) const
{
  if (options_.question.clearance) return {};
  if (viewed_clouds_.size() == 1) return FieldContent::allDistances(step);
  Question question;
  question.wanted.distances = true;
  std::vector<double> nearest;
  for (std::size_t other = 1; other < viewed_clouds_.size(); ++other) {
    const std::vector<double> found = asked(other, step, question).distances.a.distance;
    if (nearest.empty()) nearest.assign(found.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < found.size(); ++i) nearest[i] = std::fmin(nearest[i], found[i]);
  }
  return nearest;
}

std::vector<std::int32_t> CloudsContent::firstPoses() const
{
  if (first_poses_) return *first_poses_;
  std::vector<std::int32_t> first =
      options_.question.clearance ? std::vector<std::int32_t>(scan().parts(), -1) : FieldContent::firstPoses();
  if (options_.question.clearance) {
    cli::Step step("Following " + counted(steps(), "pose"));
    Question question;
    question.wanted.first_poses = true;
    for (std::size_t other = 1; other < viewed_clouds_.size(); ++other) {
      question.path = pathOf(other);
      const std::vector<std::int32_t> found = asked(other, 0, question).collisions.first_pose;
      for (std::size_t i = 0; i < first.size(); ++i)
        if (found[i] >= 0 && (first[i] < 0 || found[i] < first[i])) first[i] = found[i];
    }
    step.done(counted(steps(), "pose"));
  }
  return *(first_poses_ = std::move(first));
}

std::string CloudsContent::details(std::size_t cloud, std::uint32_t part, std::size_t step) const
{
  if (cloud > 0) return {};
  std::string text;
  if (const auto distance = distanceOf(part, step)) text += "; distance " + lengthOf(*distance, options_.unit);
  if (first_poses_ || steps() > 1) {
    const std::vector<std::int32_t> first = firstPoses();
    text += "; first pose " + (first[part] < 0 ? "none" : std::to_string(first[part]));
  }
  return text;
}

std::vector<Trace> CloudsContent::traces(std::size_t step) const
{
  std::vector<Trace> traces;
  for (std::size_t other = 1; other < viewed_clouds_.size(); ++other)
    traces.push_back(
        {0, other, traceCollision(placed(0, step), placed(other, step), {clearanceOf(other).value_or(0.0), {}})});
  return traces;
}

} // namespace pcl_bsh::viewer
