// SPDX-License-Identifier: BSD-3-Clause
#include "scene_content.h"

#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/scene_bodies.h>
#include <pcl_bsh/tools/cli/scene_robots.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/scenes/scene_file.h>
#include <pcl_bsh/scene/dragged_object.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::viewer {
namespace {

constexpr std::size_t most_paths = 50;
constexpr std::size_t most_contacts = 3;

/// The effects without those that only report.
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
  io::SceneFile file = cli::readScene(*options.scene);
  if (options.step > file.steps)
    throw cli::UsageError("--step: " + std::to_string(options.step) + ": the scene has steps 0 to " +
                          std::to_string(file.steps));
  cli::requireBodies(file);
  file.options.effects = movingOnly(file.options.effects);
  file.options.threads = options.question.threads;
  return file;
}

/// The contacts of bodies. Normals point to what can move.
std::vector<Contact> contactsOf(const SceneBodies& bodies, const Scene& scene)
{
  std::vector<Contact> all;
  for (const BodyContacts& pair : bodies.contacts())
    for (Contact contact : pair.contacts) {
      if (scene[pair.a].fixed) {
        std::swap(contact.place_a, contact.place_b);
        contact.normal = -contact.normal;
      }
      all.push_back(contact);
    }
  return all;
}

/// The options of a scene, with its response alone: no other effect is computed while something is dragged.
SceneOptions respondingOnly(SceneOptions options)
{
  Effects effects;
  effects.response = options.effects.response;
  effects.gravity = options.effects.gravity;
  options.effects = effects;
  return options;
}

struct StepState {
  std::vector<Eigen::Isometry3d> poses;              ///< of each object
  std::vector<std::vector<Eigen::Isometry3d>> parts; ///< in each object, of its parts
  std::vector<std::string> contacts;                 ///< lines about objects that touched another
  std::vector<Contact> touching;                     ///< of bodies, or of the object that is led
};

/// Where objects and parts are.
StepState placesOf(const Scene& scene)
{
  StepState state;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    state.poses.push_back(scene[object].pose);
    state.parts.emplace_back();
    for (const ScenePart& part : scene[object].parts) state.parts.back().push_back(part.pose);
  }
  return state;
}

/// A copy of a scene, of which an object follows the mouse. Others are at rest; bodies fall, and are pushed.
class SceneDrag final : public DraggedCloud {
public:
  SceneDrag(const io::SceneFile& file, const Scene& of, const StepState& from, ObjectId object)
  : object_(object),
    scene_(respondingOnly(file.options))
  {
    for (ObjectId i = 0; i < of.size(); ++i) {
      SceneObject copy = of[i];
      copy.motion = NoMotion();
      copy.pose = from.poses[i];
      for (std::size_t part = 0; part < copy.parts.size(); ++part) copy.parts[part].pose = from.parts[i][part];
      copy.fixed = copy.fixed || (!file.bodies && i != object); // pairs of others are not tested
      scene_.add(std::move(copy));
    }
    io::setRules(scene_, file.rules);
    bodies_ = cli::bodiesOf(file, scene_);
    led_ = std::make_unique<DraggedObject>(scene_, object);
    state_ = placesOf(scene_);
  }

  ObjectId object() const { return object_; }
  const StepState& state() const { return state_; }

  const std::string& name() const override { return scene_[object_].name; }
  std::string nameOfNearest() const override { return now_.nearest ? scene_[now_.nearest->object].name : ""; }
  const Eigen::Isometry3d& pose() const override { return scene_[object_].pose; }

  const DragStep& moveTo(const Eigen::Isometry3d& T_world_object) override
  {
    if (bodies_) {
      bodies_->lead(object_, T_world_object);
      bodies_->step(seconds_of_event);
      now_ = led_->look();
      now_.held = !now_.pose.isApprox(T_world_object, 1e-9);
      now_.contacts = contactsOf(*bodies_, scene_);
    }
    else
      now_ = led_->moveTo(T_world_object);
    state_ = placesOf(scene_);
    state_.touching = now_.contacts;
    return now_;
  }

  void release() override
  {
    if (bodies_) bodies_->release(object_);
  }

private:
  static constexpr double seconds_of_event = 1.0 / 60; ///< that pass for bodies with each event

  ObjectId object_;
  Scene scene_;
  std::unique_ptr<SceneBodies> bodies_; ///< null where the scene has none
  std::unique_ptr<DraggedObject> led_;
  DragStep now_;
  StepState state_;
};

/// Step 0 is the start, step n the scene after n of its steps, responses included. Steps are run when they are first
/// shown, and their poses are kept; the query for collisions runs again each time a step is shown.
class SceneContent final : public ViewContent {
public:
  explicit SceneContent(const Options& options);

  std::string name() const override { return file_.path.filename().string(); }
  std::size_t steps() const override { return file_.steps + 1; }
  const char* stepName() const override { return "step"; }
  Eigen::Isometry3d poseOf(std::size_t cloud, std::size_t step) const override;
  bool moves(std::size_t cloud) const override { return viewed_clouds_[cloud].role == ViewedCloud::Role::obstacle; }
  bool deforms(std::size_t cloud) const override { return file_.objects[places_[cloud].object].wave.has_value(); }

  /// Collisions of all clouds, by the clearance of the options, else by the scene's.
  StepCollisions collisions(std::size_t step) const override;
  std::string heading(const StepCollisions& collisions, std::size_t step) const override;

  /// Paths of moving objects, and of robots' last links, until this step, where they are not too many.
  MotionPaths paths(std::size_t step) const override;
  std::vector<Contact> contacts(std::size_t step) const override { return at(step).touching; }
  DraggedCloud* drag(std::size_t cloud, std::size_t step) const override;

private:
  /// Which part of the scene a viewed cloud is.
  struct Place {
    ObjectId object = 0;
    std::uint32_t part = 0;
  };

  void addClouds();
  void makeQueryScene();
  const StepState& at(std::size_t step) const;
  const StepState& runTo(std::size_t step) const;
  StepState stateAfter(const SceneResult& result) const;
  std::size_t cloudOf(ObjectId object, std::uint32_t part) const { return first_cloud_[object] + part; }
  double clearance() const { return options_.question.clearance.value_or(file_.options.clearance); }

  io::SceneFile file_;
  std::unique_ptr<io::SceneWorld> running_scene_; ///< moves the objects from step to step, and reports nothing else
  std::unique_ptr<SceneBodies> bodies_;           ///< of the running scene; null where it has none
  std::unique_ptr<Scene> query_scene_;      ///< the objects without motions, at the step shown: asked what collides
  std::vector<Place> places_;               ///< of each viewed cloud
  std::vector<std::size_t> first_cloud_;    ///< of each object
  std::size_t points_ = 0;                  ///< finite, of all clouds
  mutable std::vector<StepState> states_;   ///< of the steps run so far
  mutable std::unique_ptr<SceneDrag> drag_; ///< of the step shown; null while nothing was led there
  mutable std::size_t drag_step_ = 0;
};

SceneContent::SceneContent(const Options& options) : ViewContent(options), file_(readScene(options))
{
  cli::warn(program, file_.warnings);
  cli::Step step("Loading the clouds of " + name());
  running_scene_ = std::make_unique<io::SceneWorld>(file_);
  step.done(counted(running_scene_->points(), "point"));
  cli::warn(program, running_scene_->warnings());
  addClouds();
  if (points_ == 0) throw std::invalid_argument(file_.path.string() + ": has no finite point to show");
  makeQueryScene();
  bodies_ = cli::bodiesOf(file_, running_scene_->scene());
  if (bodies_) cli::warn(program, bodies_->warnings());
  states_.push_back(stateAfter({}));
}

void SceneContent::addClouds()
{
  const Scene& scene = running_scene_->scene();
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const SceneObject& has = scene[object];
    first_cloud_.push_back(viewed_clouds_.size());
    for (std::uint32_t part = 0; part < has.parts.size(); ++part) {
      ViewedCloud viewed;
      viewed.name = has.name + (has.parts.size() > 1 ? "/" + has.parts[part].name : "");
      viewed.legend = has.fixed ? "fixed objects" : "moving objects";
      viewed.role = has.fixed ? ViewedCloud::Role::scan : ViewedCloud::Role::obstacle;
      viewed.hierarchy = has.parts[part].hierarchy;
      if (const io::Obstacle* const surface = running_scene_->surface(file_.objects[object].parts[part].cloud))
        viewed.surface = *surface;
      points_ += viewed.hierarchy->size();
      viewed_clouds_.push_back(std::move(viewed));
      places_.push_back({object, part});
    }
  }
}

void SceneContent::makeQueryScene()
{
  SceneOptions asked = file_.options;
  asked.effects = {};
  asked.effects.flags = true;
  if (options_.closest) asked.effects.distance = std::numeric_limits<double>::infinity();
  asked.clearance = clearance();
  query_scene_ = std::make_unique<Scene>(asked);
  for (ObjectId object = 0; object < running_scene_->scene().size(); ++object) {
    SceneObject still = running_scene_->scene()[object];
    still.motion = NoMotion();
    query_scene_->add(std::move(still));
  }
  std::vector<io::RuleEntry> rules = file_.rules;
  if (options_.question.clearance)
    for (io::RuleEntry& entry : rules) entry.rule.clearance.reset();
  io::setRules(*query_scene_, rules);
}

StepState SceneContent::stateAfter(const SceneResult& result) const
{
  const Scene& scene = running_scene_->scene();
  StepState state = placesOf(scene);
  for (const Outcome& outcome : result.outcomes)
    if (outcome.touched || outcome.stuck)
      state.contacts.push_back(scene[outcome.object].name + (outcome.stuck ? " is stuck in " : " meets ") +
                               scene[outcome.against].name);
  if (bodies_) state.touching = contactsOf(*bodies_, scene);
  return state;
}

const StepState& SceneContent::at(std::size_t step) const
{
  return drag_ && step == drag_step_ ? drag_->state() : runTo(step);
}

const StepState& SceneContent::runTo(std::size_t step) const
{
  if (step < states_.size()) return states_[step];
  cli::Step running("Running the scene to step " + std::to_string(step));
  const std::size_t from = states_.size();
  while (states_.size() <= step) {
    running.share(static_cast<double>(states_.size() - from) / static_cast<double>(step + 1 - from));
    running_scene_->setTime(running_scene_->scene().time() + file_.dt);
    states_.push_back(stateAfter(cli::stepOf(running_scene_->scene(), bodies_.get(), file_.dt).scene));
  }
  running.done(counted(step + 1 - from, "step"));
  return states_[step];
}

Eigen::Isometry3d SceneContent::poseOf(std::size_t cloud, std::size_t step) const
{
  const Place& place = places_[cloud];
  const StepState& state = at(step);
  return state.poses[place.object] * state.parts[place.object][place.part];
}

DraggedCloud* SceneContent::drag(std::size_t cloud, std::size_t step) const
{
  const ObjectId object = places_[cloud].object;
  if (running_scene_->scene()[object].fixed) return nullptr;
  const StepState from = at(step);
  if (drag_ && drag_step_ == step && drag_->object() == object) return drag_.get();
  cli::Step preparing("Getting ready to drag " + running_scene_->scene()[object].name);
  drag_ = std::make_unique<SceneDrag>(file_, running_scene_->scene(), from, object);
  drag_step_ = step;
  preparing.done(counted(from.poses.size(), "object"));
  return drag_.get();
}

StepCollisions SceneContent::collisions(std::size_t step) const
{
  if (step != drag_step_) drag_.reset();
  const StepState& state = at(step);
  running_scene_->setTime(static_cast<double>(step) * file_.dt);
  for (ObjectId object = 0; object < query_scene_->size(); ++object) {
    const Eigen::Isometry3d& pose = state.poses[object];
    if (pose.matrix() != (*query_scene_)[object].pose.matrix()) query_scene_->setPose(object, pose);
    for (std::uint32_t part = 0; part < state.parts[object].size(); ++part) {
      const Eigen::Isometry3d& in_object = state.parts[object][part];
      if (in_object.matrix() != (*query_scene_)[object].parts[part].pose.matrix())
        query_scene_->setPartPose(object, part, in_object);
    }
    if (deforms(first_cloud_[object])) query_scene_->pointsChanged(object);
  }
  const SceneResult result = query_scene_->query();
  StepCollisions found;
  found.known = true;
  found.flags.resize(viewed_clouds_.size());
  for (const FlaggedPart& part : result.flags) {
    found.flags[cloudOf(part.object, part.part)] = part.flags;
    found.colliding += part.colliding;
  }
  for (const DistantPair& pair : result.distance) {
    if (found.closest && found.closest->distance <= pair.distance) continue;
    const auto corners = [&](ObjectId object, std::uint32_t part, std::uint32_t record) {
      const std::size_t cloud = cloudOf(object, part);
      return viewed_clouds_[cloud].cornersOf(record, poseOf(cloud, step));
    };
    const auto [a, b] =
        nearestPoints(corners(pair.a, pair.part_a, pair.pair.a), corners(pair.b, pair.part_b, pair.pair.b));
    found.closest = {Eigen::Vector3d(a.data()), Eigen::Vector3d(b.data()), pair.distance};
  }
  return found;
}

std::string SceneContent::heading(const StepCollisions& collisions, std::size_t step) const
{
  std::ostringstream text;
  text << name() << ": " << groupedCount(file_.objects.size(), "object") << ", " << groupedCount(points_, "point");
  if (collisions.known) text << ", " << groupedCount(collisions.colliding, "collides", "collide");
  text << "  (clearance " << lengthOf(clearance(), options_.unit) << ")\nstep " << step << " of 0.." << file_.steps
       << ", " << shortest(static_cast<double>(step) * file_.dt) << " s";
  const std::vector<std::string>& contacts = at(step).contacts;
  for (std::size_t i = 0; i < std::min(contacts.size(), most_contacts); ++i) text << '\n' << contacts[i];
  if (contacts.size() > most_contacts)
    text << "\n... " << counted(contacts.size() - most_contacts, "more meets", "more meet") << " something";
  return text.str();
}

MotionPaths SceneContent::paths(std::size_t step) const
{
  MotionPaths paths;
  paths.name = "path so far";
  at(step);
  for (ObjectId object = 0; object < first_cloud_.size(); ++object) {
    if (!moves(first_cloud_[object])) continue;
    if (paths.poses.size() == most_paths) return {};
    paths.poses.emplace_back();
    for (std::size_t k = 0; k <= step; ++k) {
      const StepState& state = states_[k];
      paths.poses.back().push_back(file_.objects[object].robot ? state.poses[object] * state.parts[object].back()
                                                               : state.poses[object]);
    }
  }
  return paths;
}

} // namespace

std::unique_ptr<ViewContent> makeSceneContent(const Options& options)
{
  return std::make_unique<SceneContent>(options);
}

} // namespace pcl_bsh::viewer
