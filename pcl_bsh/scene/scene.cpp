// SPDX-License-Identifier: BSD-3-Clause
// Objects, poses and rules of a scene. Effects are computed in scene_query.cpp, responses in the folder responses.
#include <pcl_bsh/scene/scene.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/scene/check_scene.h>
#include <pcl_bsh/scene/state.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace pcl_bsh {
namespace {

bool isWhole(const Eigen::Isometry3d& pose)
{
  return pose.matrix() == Eigen::Matrix4d::Identity();
}

void addSolid(SceneSolids& solids, const std::string& object, const ScenePart& part)
{
  try {
    if (part.solid) solids.addSolid(part.hierarchy);
  }
  catch (const InvalidInput& error) {
    throw InvalidInput(Input::surface, "object '" + object + "'", error.wrong(), error.remedy());
  }
}

void checkRule(const PairRule& rule)
{
  if (rule.clearance && !isLength(*rule.clearance))
    refuse("clearance " + plainText(*rule.clearance) + " of a rule is not finite and >= 0");
}

} // namespace

/// A product with the identity may turn -0 into 0; beyond that, poses are passed on bit by bit.
Eigen::Isometry3d worldPoseOf(const Eigen::Isometry3d& pose, const Eigen::Isometry3d& part)
{
  return isWhole(part) ? pose : pose * part;
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
  if (object >= bodies.size()) refuse("there is no object " + plainText(object) + " among " + plainText(bodies.size()));
  return bodies[object];
}

void Scene::State::updateWorld(Body& body)
{
  for (std::size_t i = 0; i < body.world.size(); ++i)
    body.world[i] = worldPoseOf(body.object.pose, body.object.parts[i].pose);
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

/// Hierarchies are shared with other scenes and with callers that update them. Memory of points that have changed since
/// is dropped, also where another scene changed them.
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

void Scene::State::followSolids()
{
  if (solids.none()) return;
  for (const Body& body : bodies)
    for (const ScenePart& part : body.object.parts) solids.follow(part.hierarchy, part.solid);
}

void Scene::State::shapeChanged(ObjectId object)
{
  Body& changed = bodies[object];
  changed.box = boxOf(changed.object);
  updateWorld(changed);
  if (!grid_stale) grid.forget(object);
}

void Scene::State::pointsChanged(ObjectId object)
{
  shapeChanged(object);
  bodies[object].reshaped = true;
}

void Scene::State::recover() noexcept
{
  result = SceneResult();
  grid_stale = true;
}

/// A step that throws has not been made.
SceneResult Scene::State::step(double dt)
{
  const double before = time;
  for (Body& body : bodies) {
    body.step_pose = body.object.pose;
    body.step_follows_motion = body.follows_motion;
    body.step_turned = body.turned;
  }
  try {
    followPoints();
    followSolids();
    move(dt);
    stepping = true;
    SceneResult found = query();
    stepping = false;
    return found;
  }
  catch (...) {
    time = before;
    stepping = false;
    for (Body& body : bodies) {
      body.detoured = false;
      body.follows_motion = body.step_follows_motion;
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
  for (const ScenePart& part : object.parts) addSolid(s.solids, object.name, part);
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
  body.follows_motion = false;
  state_->setPose(object, pose);
  if (body.last_version == 0)
    body.last_pose = pose;                           // no query has seen it anywhere else
  else if (usesSweptMotion(state_->options.effects)) // one leg there, in the shorter direction
    body.turned = shorterTurn(body.last_pose.linear(), pose.linear());
}

void Scene::setPartPose(ObjectId object, std::uint32_t part, const Eigen::Isometry3d& pose)
{
  Body& body = state_->body(object);
  checkPose("pose of a part of object '" + body.object.name + "'", pose);
  checkPose("pose of a part of object '" + body.object.name + "' in the world", body.object.pose * pose);
  ScenePart& set = body.object.parts.at(part);
  if (usesSweptMotion(state_->options.effects) && body.last_version > 0 && body.last_parts.empty()) {
    std::vector<Eigen::Isometry3d> poses;
    poses.reserve(body.object.parts.size());
    for (const ScenePart& each : body.object.parts) poses.push_back(each.pose);
    body.last_parts = std::move(poses);
  }
  set.pose = pose;
  state_->shapeChanged(object);
}

void Scene::setMotion(ObjectId object, const Motion& motion)
{
  pcl_bsh::check(motion);
  Body& body = state_->body(object);
  body.object.motion = Motion(motion); // copied as a whole, or not at all
  body.start = body.object.pose;
  body.start_time = state_->time;
  body.follows_motion = true;
}

void Scene::setRule(ObjectId a, ObjectId b, const PairRule& rule)
{
  state_->body(a);
  state_->body(b);
  if (a == b) refuse("a rule needs two objects, not object " + plainText(a) + " twice");
  checkRule(rule);
  state_->rules.set(a, b, rule);
  state_->grid_stale = true;
}

void Scene::setGroupRule(const std::string& group_a, const std::string& group_b, const PairRule& rule)
{
  checkRule(rule);
  state_->rules.setGroups(group_a, group_b, rule);
  state_->grid_stale = true;
}

void Scene::pointsChanged(ObjectId object)
{
  state_->body(object);
  state_->pointsChanged(object);
}

std::optional<double> Scene::clearanceOf(ObjectId a, ObjectId b) const
{
  return state_->rules.clearanceOf(state_->body(a).id, state_->body(b).id);
}

bool Scene::testsPairs() const
{
  return state_->rules.testsAny();
}

RefitReport Scene::deform(ObjectId object, std::uint32_t part, const PointsView& now)
{
  const Body& body = state_->body(object);
  if (!state_->options.effects.deform)
    throw InvalidInput(Input::scene, "Scene", "object '" + body.object.name + "' cannot deform",
                       "deform is not listed");
  if (part >= body.object.parts.size()) refuse("object '" + body.object.name + "' has no part " + std::to_string(part));
  EffectCost& cost = state_->cost(Effect::deform);
  const Timed timed(cost.seconds);
  const RefitReport report = body.object.parts[part].hierarchy->refit(now, *state_->options.effects.deform);
  state_->followPoints();
  ++cost.pairs;
  cost.work.volumes_built += report.volumes_refitted;
  return report;
}

SceneResult Scene::query()
{
  const DefaultFloatEnvironment environment;
  const State::InProgress in_progress(*state_);
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
  if (!isLength(dt)) refuse("a step of " + plainText(dt) + " seconds is not finite and >= 0");
  const DefaultFloatEnvironment environment;
  const State::InProgress in_progress(*state_);
  return state_->step(dt);
}

} // namespace pcl_bsh
