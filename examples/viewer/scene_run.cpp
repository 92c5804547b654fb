// SPDX-License-Identifier: BSD-3-Clause
#include "scene_run.h"

#include "cli/program.h"
#include "cli/step.h"
#include "text.h"

#include <pcl_bsh/filters/scene_files/scene_file.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::view {
namespace {

constexpr std::size_t most_ways = 50;
constexpr std::size_t most_meetings = 3;

/// What only reports, and moves nothing.
Effects movingOnly(const Effects& effects)
{
  Effects moving;
  moving.response = effects.response;
  moving.gravity = effects.gravity;
  moving.deform = effects.deform;
  return moving;
}

io::SceneFile readScene(const Options& options)
{
  io::SceneFile file = io::readSceneFile(*options.scene);
  if (options.step > file.steps)
    throw cli::UsageError("--step: " + std::to_string(options.step) + ": the scene has steps 0 to " +
                          std::to_string(file.steps));
  file.options.effects = movingOnly(file.options.effects);
  file.options.threads = options.threads;
  return file;
}

/// Step 0 is the start, step n what n steps of the scene's length make of it, responses included. Steps are run when
/// they are first asked for, and their poses kept; what collides is asked anew at every look.
class SceneRun final : public World {
public:
  explicit SceneRun(const Options& options);

  std::string name() const override { return file_.path.filename().string(); }
  std::size_t steps() const override { return file_.steps + 1; }
  const char* stepName() const override { return "step"; }
  Eigen::Isometry3d poseOf(std::size_t thing, std::size_t step) const override;
  bool moves(std::size_t thing) const override { return things_[thing].role == Thing::Role::obstacle; }
  bool deforms(std::size_t thing) const override { return file_.objects[places_[thing].object].wave.has_value(); }

  /// By the clearance of the options, else by the scene's. Of all things.
  Findings findings(std::size_t step) const override;
  std::string heading(const Findings& findings, std::size_t step) const override;

  /// Of moving objects until this step, where they are not too many.
  Ways ways(std::size_t step) const override;

private:
  /// Which part of the scene a thing is.
  struct Place {
    ObjectId object = 0;
    std::uint32_t part = 0;
  };

  struct Moment {
    std::vector<Eigen::Isometry3d> poses; ///< of each object
    std::vector<std::string> meetings;    ///< lines about objects that met something
  };

  void addThings();
  void makeWatcher();
  const Moment& at(std::size_t step) const;
  Moment now(const SceneResult& result) const;
  std::size_t thingOf(ObjectId object, std::uint32_t part) const { return first_thing_[object] + part; }
  double clearance() const { return options_.clearance.value_or(file_.options.clearance); }

  io::SceneFile file_;
  std::unique_ptr<io::SceneWorld> mover_; ///< goes from step to step, and finds nothing but its way
  std::unique_ptr<Scene> watcher_;        ///< the same objects, put where they are at the step that is looked at
  std::vector<Place> places_;             ///< of each thing
  std::vector<std::size_t> first_thing_;  ///< of each object
  std::size_t points_ = 0;                ///< finite, of all things
  mutable std::vector<Moment> moments_;   ///< as far as the mover went
};

SceneRun::SceneRun(const Options& options) : World(options), file_(readScene(options))
{
  cli::warn(program, file_.warnings);
  cli::Step step("Loading the clouds of " + name());
  mover_ = std::make_unique<io::SceneWorld>(file_);
  step.done(std::to_string(mover_->points()) + " points");
  addThings();
  if (points_ == 0) throw std::invalid_argument(file_.path.string() + ": has no finite point to show");
  makeWatcher();
  moments_.push_back(now({}));
}

void SceneRun::addThings()
{
  const Scene& scene = mover_->scene();
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const SceneObject& has = scene[object];
    first_thing_.push_back(things_.size());
    for (std::uint32_t part = 0; part < has.parts.size(); ++part) {
      Thing thing;
      thing.name = has.name + (has.parts.size() > 1 ? "/" + has.parts[part].name : "");
      thing.legend = has.fixed ? "fixed objects" : "moving objects";
      thing.role = has.fixed ? Thing::Role::scan : Thing::Role::obstacle;
      thing.hierarchy = has.parts[part].hierarchy;
      points_ += thing.hierarchy->size();
      things_.push_back(std::move(thing));
      places_.push_back({object, part});
    }
  }
}

void SceneRun::makeWatcher()
{
  SceneOptions asked = file_.options;
  asked.effects = {};
  asked.effects.flags = true;
  if (options_.closest) asked.effects.distance = std::numeric_limits<double>::infinity();
  asked.clearance = clearance();
  watcher_ = std::make_unique<Scene>(asked);
  for (ObjectId object = 0; object < mover_->scene().size(); ++object) {
    SceneObject still = mover_->scene()[object];
    still.motion = NoMotion();
    watcher_->add(std::move(still));
  }
  std::vector<io::RuleEntry> rules = file_.rules;
  if (options_.clearance)
    for (io::RuleEntry& entry : rules) entry.rule.clearance.reset();
  io::setRules(*watcher_, rules);
}

SceneRun::Moment SceneRun::now(const SceneResult& result) const
{
  const Scene& scene = mover_->scene();
  Moment moment;
  for (ObjectId object = 0; object < scene.size(); ++object) moment.poses.push_back(scene[object].pose);
  for (const Outcome& outcome : result.outcomes)
    if (outcome.touched || outcome.stuck)
      moment.meetings.push_back(scene[outcome.object].name + (outcome.stuck ? " is stuck in " : " meets ") +
                                scene[outcome.against].name);
  return moment;
}

const SceneRun::Moment& SceneRun::at(std::size_t step) const
{
  if (step < moments_.size()) return moments_[step];
  cli::Step running("Running the scene to step " + std::to_string(step));
  const std::size_t from = moments_.size();
  while (moments_.size() <= step) {
    running.share(static_cast<double>(moments_.size() - from) / static_cast<double>(step + 1 - from));
    mover_->deform(mover_->scene().time() + file_.dt);
    moments_.push_back(now(mover_->scene().step(file_.dt)));
  }
  running.done(std::to_string(step + 1 - from) + " steps");
  return moments_[step];
}

Eigen::Isometry3d SceneRun::poseOf(std::size_t thing, std::size_t step) const
{
  const Place& place = places_[thing];
  return at(step).poses[place.object] * mover_->scene()[place.object].parts[place.part].pose;
}

Findings SceneRun::findings(std::size_t step) const
{
  const Moment& moment = at(step);
  mover_->deform(static_cast<double>(step) * file_.dt);
  for (ObjectId object = 0; object < watcher_->size(); ++object) {
    const Eigen::Isometry3d& pose = moment.poses[object];
    if (pose.matrix() != (*watcher_)[object].pose.matrix()) watcher_->setPose(object, pose);
    if (deforms(first_thing_[object])) watcher_->pointsChanged(object);
  }
  const SceneResult result = watcher_->query();
  Findings found;
  found.known = true;
  found.flags.resize(things_.size());
  for (const FlaggedPart& part : result.flags) {
    found.flags[thingOf(part.object, part.part)] = part.flags;
    found.colliding += part.colliding;
  }
  for (const DistantPair& pair : result.distance) {
    if (found.closest && found.closest->distance <= pair.distance) continue;
    const auto point = [&](ObjectId object, std::uint32_t part, std::uint32_t record) {
      const std::size_t thing = thingOf(object, part);
      const Point3 p = things_[thing].points().point(record);
      return Eigen::Vector3d(poseOf(thing, step) * Eigen::Vector3d(p[0], p[1], p[2]));
    };
    found.closest = {point(pair.a, pair.part_a, pair.pair.a), point(pair.b, pair.part_b, pair.pair.b), pair.distance};
  }
  return found;
}

std::string SceneRun::heading(const Findings& findings, std::size_t step) const
{
  std::ostringstream text;
  text << name() << ": " << grouped(file_.objects.size()) << " objects, " << grouped(points_) << " points, "
       << grouped(findings.colliding) << " collide  (clearance " << lengthOf(clearance(), options_.unit) << ")\nstep "
       << step << " of 0.." << file_.steps << ", " << shortest(static_cast<double>(step) * file_.dt) << " s";
  const std::vector<std::string>& meetings = at(step).meetings;
  for (std::size_t i = 0; i < std::min(meetings.size(), most_meetings); ++i) text << '\n' << meetings[i];
  if (meetings.size() > most_meetings) text << "\n... " << meetings.size() - most_meetings << " more meet something";
  return text.str();
}

Ways SceneRun::ways(std::size_t step) const
{
  Ways ways;
  ways.name = "way so far";
  at(step);
  for (ObjectId object = 0; object < first_thing_.size(); ++object) {
    if (!moves(first_thing_[object])) continue;
    if (ways.poses.size() == most_ways) return {};
    ways.poses.emplace_back();
    for (std::size_t k = 0; k <= step; ++k) ways.poses.back().push_back(moments_[k].poses[object]);
  }
  return ways;
}

} // namespace

std::unique_ptr<World> makeSceneRun(const Options& options)
{
  return std::make_unique<SceneRun>(options);
}

} // namespace pcl_bsh::view
