// SPDX-License-Identifier: BSD-3-Clause
// Objects, poses, rules: what a scene is. What it computes is in effects.cpp and response.cpp.
#include <pcl_bsh/scene/scene.h>

#include <pcl_bsh/geometry/float_environment.h>
#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/scene/state.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace pcl_bsh {
namespace {

[[noreturn]] void refuse(const std::string& what)
{
  throw InvalidInput(Input::scene, "Scene", what);
}

bool isLength(double value)
{
  return std::isfinite(value) && value >= 0.0;
}

void check(const SceneOptions& options)
{
  const Effects& effects = options.effects;
  if (!isLength(options.clearance))
    refuse("clearance " + std::to_string(options.clearance) + " is not finite and >= 0");
  if (!(std::isfinite(options.tolerance) && options.tolerance > 0.0))
    refuse("tolerance " + std::to_string(options.tolerance) + " is not finite and > 0");
  if (!isLength(options.accuracy.value))
    refuse("accuracy " + options.accuracy.text() + " has a number that is not finite and >= 0");
  if (!isLength(options.voxel_edge))
    refuse("voxel edge " + std::to_string(options.voxel_edge) + " is not finite and >= 0");
  if (effects.distance && !(*effects.distance >= 0.0))
    refuse("distances within " + std::to_string(*effects.distance) + " were asked for, which is not >= 0");
  if (effects.gravity) {
    if (!(std::isfinite(effects.gravity->step_height) && effects.gravity->step_height > 0.0))
      refuse("step height " + std::to_string(effects.gravity->step_height) + " is not finite and > 0");
    if (!(effects.gravity->down.allFinite() && effects.gravity->down.norm() > 0.0))
      refuse("gravity's direction is not finite or of length 0");
  }
  if (effects.deform && !(std::isfinite(*effects.deform) && *effects.deform >= 1.0))
    refuse("deform's threshold " + std::to_string(*effects.deform) + " is not finite and >= 1");
}

void check(const SceneObject& object, const std::unordered_map<std::string, ObjectId>& names)
{
  if (object.name.empty()) refuse("an object has no name");
  if (names.count(object.name) > 0) refuse("object '" + object.name + "': the name is taken");
  if (object.parts.empty()) refuse("object '" + object.name + "' has no parts");
  checkPose("pose of object '" + object.name + "'", object.pose);
  for (const ScenePart& part : object.parts) {
    if (!part.hierarchy) refuse("object '" + object.name + "', part '" + part.name + "' has no hierarchy");
    checkPose("pose of part '" + part.name + "' of object '" + object.name + "'", part.pose);
  }
  for (const auto& [a, b] : object.adjacent)
    if (a >= object.parts.size() || b >= object.parts.size())
      refuse("object '" + object.name + "': part " + std::to_string(std::max(a, b)) + " is adjacent, but there are " +
             std::to_string(object.parts.size()) + " parts");
  check(object.motion);
}

bool isWhole(const Eigen::Isometry3d& pose)
{
  return pose.matrix() == Eigen::Matrix4d::Identity();
}

} // namespace

const char* nameOf(Effect effect) noexcept
{
  static constexpr const char* names[kEffects] = {"any",  "flags", "distance", "contacts", "first_contact", "swept",
                                                  "self", "stop",  "slide",    "gravity",  "deform"};
  return names[static_cast<std::size_t>(effect)];
}

bool Effects::has(Effect effect) const noexcept
{
  switch (effect) {
  case Effect::any:
    return any;
  case Effect::flags:
    return flags;
  case Effect::distance:
    return distance.has_value();
  case Effect::contacts:
    return contacts.has_value();
  case Effect::first_contact:
    return first_contact;
  case Effect::swept:
    return swept;
  case Effect::self:
    return self;
  case Effect::stop:
    return response == Response::stop;
  case Effect::slide:
    return response == Response::slide;
  case Effect::gravity:
    return gravity.has_value();
  case Effect::deform:
    return deform.has_value();
  }
  return false;
}

bool Effects::none() const noexcept
{
  for (std::size_t i = 0; i < kEffects; ++i)
    if (has(static_cast<Effect>(i))) return false;
  return true;
}

Scene::State::State(SceneOptions scene_options)
: options(std::move(scene_options)),
  rules(options.clearance, options.test_pairs)
{
}

/// Two poses that are just rigid enough may have a product that is not: found here, not by a query of a later step.
void Scene::State::checkWorld(const SceneObject& object, const Eigen::Isometry3d& pose)
{
  for (const ScenePart& part : object.parts)
    if (!isWhole(part.pose))
      checkPose("pose of part '" + part.name + "' of object '" + object.name + "' in the world", pose * part.pose);
}

Body& Scene::State::body(ObjectId object)
{
  if (object >= bodies.size())
    refuse("there is no object " + std::to_string(object) + " among " + std::to_string(bodies.size()));
  return bodies[object];
}

void Scene::State::updateWorld(Body& body)
{
  for (std::size_t i = 0; i < body.world.size(); ++i) {
    const Eigen::Isometry3d& part = body.object.parts[i].pose;
    // A product with the identity may turn -0 into 0; beyond that, poses are passed on bit by bit.
    body.world[i] = isWhole(part) ? body.object.pose : body.object.pose * part;
  }
  body.world_box = pcl_bsh::moved(body.box, body.object.pose);
  ++body.version;
  if (body.listed) return;
  body.listed = true;
  moved.push_back(body.id);
}

void Scene::State::setPose(ObjectId object, const Eigen::Isometry3d& pose)
{
  bodies[object].object.pose = pose;
  updateWorld(bodies[object]);
}

/// Hierarchies are shared with other scenes and with callers that update them. What was remembered of points that have
/// changed since is not believed, whoever changed them.
void Scene::State::followPoints()
{
  if (options.effects.none()) return;
  for (auto& [hierarchy, revision] : watched) {
    const std::uint64_t now = hierarchy->storage().revision;
    if (now == revision) continue;
    for (const Body& body : bodies)
      for (const ScenePart& part : body.object.parts)
        if (part.hierarchy.get() == hierarchy) {
          pointsChanged(body.id);
          break;
        }
    revision = now;
  }
}

void Scene::State::pointsChanged(ObjectId object)
{
  Body& changed = bodies[object];
  changed.box = boxOf(changed.object);
  updateWorld(changed);
  changed.last_version = 0; // there is no way from the points that were
  if (!grid_stale) grid.forget(object);
}

void Scene::State::recover() noexcept
{
  result = SceneResult();
  grid_stale = near_stale = true;
  near.clear();
}

/// A step that throws has not been made.
SceneResult Scene::State::step(double dt)
{
  const double before = time;
  for (Body& body : bodies) {
    body.step_pose = body.object.pose;
    body.step_on_course = body.on_course;
    body.step_turned = body.turned;
  }
  try {
    followPoints();
    move(dt);
    return query();
  }
  catch (...) {
    time = before;
    for (Body& body : bodies) {
      body.on_course = body.step_on_course;
      body.turned = body.step_turned;
      if (body.object.pose.matrix() != body.step_pose.matrix()) setPose(body.id, body.step_pose);
    }
    recover();
    throw;
  }
}

Scene::Scene(SceneOptions options)
{
  check(options);
  state_ = std::make_unique<State>(std::move(options));
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

ObjectId Scene::add(SceneObject object)
{
  check(object, state_->names);
  State::checkWorld(object, object.pose);
  State& s = *state_;
  const auto id = static_cast<ObjectId>(s.bodies.size());
  for (auto& [a, b] : object.adjacent)
    if (a > b) std::swap(a, b);
  Body body;
  body.id = id;
  body.start = object.pose;
  body.start_time = s.time;
  body.world.resize(object.parts.size());
  body.box = boxOf(object);
  body.object = std::move(object);
  body.last_pose = body.object.pose;
  // Memory for everything first: an object is added altogether or not at all.
  if (s.bodies.size() == s.bodies.capacity()) s.bodies.reserve(2 * s.bodies.size() + 4);
  s.moved.reserve(s.bodies.capacity()); // so that steps need not
  s.moved_before.reserve(s.bodies.capacity());
  const auto name = s.names.emplace(body.object.name, id).first;
  std::vector<const SphereHierarchy*> watched; // from now on
  try {
    watched.reserve(body.object.parts.size());
    for (const ScenePart& part : body.object.parts)
      if (s.watched.emplace(part.hierarchy.get(), part.hierarchy->storage().revision).second)
        watched.push_back(part.hierarchy.get());
    s.rules.addObject(body.object.group, body.object.fixed);
  }
  catch (...) {
    for (const SphereHierarchy* hierarchy : watched) s.watched.erase(hierarchy);
    s.names.erase(name);
    throw;
  }
  static_assert(std::is_nothrow_move_constructible_v<Body>);
  s.updateWorld(body);
  s.bodies.push_back(std::move(body));
  s.grid_stale = true;
  return id;
}

std::size_t Scene::size() const noexcept
{
  return state_->bodies.size();
}
const SceneObject& Scene::operator[](ObjectId object) const
{
  return state_->body(object).object;
}
std::optional<ObjectId> Scene::find(const std::string& name) const
{
  const auto found = state_->names.find(name);
  if (found == state_->names.end()) return std::nullopt;
  return found->second;
}
const SceneOptions& Scene::options() const noexcept
{
  return state_->options;
}
double Scene::time() const noexcept
{
  return state_->time;
}

const Eigen::Isometry3d& Scene::worldPose(ObjectId object, std::uint32_t part) const
{
  return state_->body(object).world.at(part);
}

void Scene::setPose(ObjectId object, const Eigen::Isometry3d& pose)
{
  Body& body = state_->body(object);
  checkPose("pose of object '" + body.object.name + "'", pose);
  State::checkWorld(body.object, pose);
  body.on_course = false;
  state_->setPose(object, pose);
  if (looksBack(state_->options.effects)) // straight there, the shorter way round
    body.turned = shorterTurn(body.last_pose.linear(), pose.linear());
}

void Scene::setPartPose(ObjectId object, std::uint32_t part, const Eigen::Isometry3d& pose)
{
  Body& body = state_->body(object);
  checkPose("pose of a part of object '" + body.object.name + "'", pose);
  checkPose("pose of a part of object '" + body.object.name + "' in the world", body.object.pose * pose);
  body.object.parts.at(part).pose = pose;
  state_->pointsChanged(object);
}

void Scene::setMotion(ObjectId object, const Motion& motion)
{
  pcl_bsh::check(motion);
  Body& body = state_->body(object);
  body.object.motion = Motion(motion); // copied as a whole, or not at all
  body.start = body.object.pose;
  body.start_time = state_->time;
  body.on_course = true;
}

void Scene::setRule(ObjectId a, ObjectId b, const PairRule& rule)
{
  state_->body(a);
  state_->body(b);
  if (a == b) refuse("a rule needs two objects, not object " + std::to_string(a) + " twice");
  if (rule.clearance && !isLength(*rule.clearance))
    refuse("clearance " + std::to_string(*rule.clearance) + " of a rule is not finite and >= 0");
  state_->rules.set(a, b, rule);
  state_->grid_stale = true;
}

void Scene::setGroupRule(const std::string& group_a, const std::string& group_b, const PairRule& rule)
{
  if (rule.clearance && !isLength(*rule.clearance))
    refuse("clearance " + std::to_string(*rule.clearance) + " of a rule is not finite and >= 0");
  state_->rules.setGroups(group_a, group_b, rule);
  state_->grid_stale = true;
}

void Scene::pointsChanged(ObjectId object)
{
  state_->body(object);
  state_->pointsChanged(object);
}

SceneResult Scene::query()
{
  const DefaultFloatEnvironment environment;
  try {
    return state_->query();
  }
  catch (...) {
    state_->recover();
    throw;
  }
}

SceneResult Scene::step(double dt)
{
  if (!isLength(dt)) refuse("a step of " + std::to_string(dt) + " seconds is not finite and >= 0");
  const DefaultFloatEnvironment environment;
  return state_->step(dt);
}

} // namespace pcl_bsh
