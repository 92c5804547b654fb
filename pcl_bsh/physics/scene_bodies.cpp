// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/physics/scene_bodies.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/scene/part_colliders.h>
#include <pcl_bsh/solid/solid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

namespace pcl_bsh {
namespace {

constexpr double kMostSteps = 1e6;  ///< of the world in one of a scene
constexpr double kCatchingUp = 2.0; ///< times its own speed, of an object that was held up
constexpr double kLedSpeed = 4.0;   ///< of an object that is led by hand, metres or radians in a second

[[noreturn]] void refuse(const std::string& what, const std::string& remedy)
{
  throw InvalidInput(Input::scene, "bodies", what, remedy);
}

/// Returns the pose on the way from one to another, as far as a hand leads an object in so many seconds.
Eigen::Isometry3d onTheWay(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double seconds)
{
  const double angle = Eigen::AngleAxisd(to.linear() * from.linear().transpose()).angle();
  const double way = std::max((to.translation() - from.translation()).norm(), angle);
  return way <= kLedSpeed * seconds ? to : poseAt(WaypointMotion{{0.0, way}, {from, to}}, from, kLedSpeed * seconds);
}

bool moves(const SceneObject& object)
{
  return !std::holds_alternative<NoMotion>(object.motion);
}

/// As if each point were a ball that reaches halfway to the next.
MassProperties massOfPoints(const Collider& collider)
{
  PointsView view = collider.thing().view();
  const std::vector<float> radii(view.count, static_cast<float>(0.5 * collider.spacing()));
  view.radii = radii.data();
  return massOf(view);
}

MassProperties massOfBody(const Collider& collider, const Solid* solid, const SceneBody& body)
{
  const PointsView& view = collider.thing().view();
  const bool encloses = solid != nullptr || view.radii != nullptr;
  if (body.density && !encloses)
    throw InvalidInput(Input::density, "density", "is of points, which enclose nothing", "give the mass");
  const double density = body.density.value_or(1.0);
  MassProperties mass = solid ? massOf(*solid, density) : view.radii ? massOf(view, density) : massOfPoints(collider);
  if (body.mass) mass = mass.withMass(*body.mass);
  if (body.inertia) mass.inertia = body.inertia->asDiagonal();
  return mass;
}

class WorldOfScene final : public SceneBodies {
public:
  WorldOfScene(Scene& scene, const BodiesOptions& options, const std::vector<SceneBody>& how)
  : scene_(scene),
    options_(options),
    world_(options)
  {
    if (!(std::isfinite(options.step) && options.step > 0.0))
      refuse("step " + plainText(options.step) + " is not finite and > 0", "give the seconds between two solutions");
    if (const char* const other = effectAgainstBodies(scene.options().effects))
      refuse(plainText("the effect '", other, "' does not go with them"), "leave one out");
    if (how.size() != scene.size())
      refuse(plainText(how.size(), " for ", scene.size(), " objects"), "give one for each");
    if (std::none_of(how.begin(), how.end(), [](const SceneBody& body) { return body.falls(); }))
      refuse("no object is one", "give a mass or a density to what shall fall");
    for (ObjectId object = 0; object < scene.size(); ++object) {
      const SceneObject& of = scene[object];
      if (const char* const wrong = wrongWith(how[object], of.fixed, moves(of), of.parts.size()))
        refuse("object '" + of.name + "' " + wrong, "leave one out");
    }
    for (ObjectId object = 0; object < scene.size(); ++object) {
      try {
        add(object, how[object]);
      }
      catch (const InvalidInput& error) {
        throw InvalidInput(error.input(), "object '" + scene[object].name + "'", error.what());
      }
    }
    for (ObjectId object = 0; object < scene.size(); ++object) scene.setMotion(object, NoMotion());
    followWorld();
    warnOfOverlaps();
  }

  BodiesStep step(double dt) override
  {
    const double count = std::ceil(dt / options_.step * (1.0 - 1e-9)); // for a dt of n steps, n
    if (!(dt >= 0.0 && count <= kMostSteps))
      refuse(plainText("a step of ", dt, " seconds in ", options_.step, " each"),
             "give a finite one of at least 0, and at most a million of these");
    BodiesStep report;
    report.steps = static_cast<std::size_t>(count);
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 1; i <= report.steps; ++i) {
      const double passed = time_ + dt * (static_cast<double>(i) / count);
      for (Moved& each : moved_) {
        if (each.led) world_.moveTo(each.body, onTheWay(world_.pose(each.body), *each.led * each.part, dt / count));
        if (each.falls || each.led) continue;
        each.next = std::min(passed, each.reached + kCatchingUp * dt / count);
        world_.moveTo(each.body, poseAt(each.motion, each.start, each.next) * each.part);
      }
      report.solved += world_.step(dt / count);
      for (Moved& each : moved_)
        if (!each.falls && !each.led && world_.isThere(each.body)) each.reached = each.next;
    }
    time_ += dt;
    followWorld();
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.scene = scene_.step(dt);
    return report;
  }

  void lead(ObjectId object, const Eigen::Isometry3d& T_world_object) override
  {
    checkPose("pose of object '" + scene_[object].name + "'", T_world_object);
    if (scene_[object].parts.size() > 1)
      refuse("object '" + scene_[object].name + "' has several parts", "lead one that has one");
    movedOf(object).led = T_world_object;
  }

  void release(ObjectId object) override
  {
    Moved& of = movedOf(object);
    of.led.reset();
    of.motion = NoMotion();
    of.start = poseOf(of);
    if (of.falls) world_.release(of.body);
  }

  std::vector<BodyState> states() const override
  {
    std::vector<BodyState> all;
    for (const Moved& each : moved_)
      if (each.falls)
        all.push_back({each.object, poseOf(each), world_.velocity(each.body), world_.spin(each.body),
                       world_.isAsleep(each.body)});
    return all;
  }

  std::vector<BodyContacts> contacts() const override
  {
    std::map<std::pair<ObjectId, ObjectId>, std::vector<Contact>> found; // objects may have several parts
    for (const auto& [bodies, between] : world_.contacts()) {
      std::vector<Contact>& into = found[{objects_[bodies.first], objects_[bodies.second]}];
      into.insert(into.end(), between.contacts.begin(), between.contacts.end());
    }
    std::vector<BodyContacts> all;
    for (auto& [pair, contacts] : found)
      if (!contacts.empty()) all.push_back({pair.first, pair.second, std::move(contacts)});
    return all;
  }

  const std::vector<std::string>& warnings() const noexcept override { return warnings_; }

private:
  /// An object that moves.
  struct Moved {
    ObjectId object;
    BodyId body;
    bool falls;
    Motion motion; ///< of an object that does not fall
    Eigen::Isometry3d start, part;
    double reached = 0.0, next = 0.0; ///< of the motion, seconds: where it is, and where this step takes it
    std::optional<Eigen::Isometry3d> led = std::nullopt; ///< by hand, to this pose of the object
  };

  void add(ObjectId object, const SceneBody& how)
  {
    const SceneObject& of = scene_[object];
    const Eigen::Isometry3d begin = poseAt(of.motion, of.pose, 0.0); // waypoints may begin elsewhere
    for (const ScenePart& part : of.parts) {
      const PartCollider& shape = shapeOf(part, how.falls());
      const Eigen::Isometry3d pose = begin * part.pose;
      const BodyId body = how.falls() ? world_.add(*shape.collider, pose,
                                                   massOfBody(*shape.collider, shape.solid.get(), how), how.material)
                                      : world_.addFixed(*shape.collider, pose, how.material);
      objects_.push_back(object);
      if (how.falls() || moves(of)) moved_.push_back({object, body, how.falls(), of.motion, of.pose, part.pose});
    }
  }

  /// Returns the entry of an object. An object that stood still until now gets one.
  Moved& movedOf(ObjectId object)
  {
    const auto found =
        std::find_if(moved_.begin(), moved_.end(), [&](const Moved& each) { return each.object == object; });
    if (found != moved_.end()) return *found;
    const auto body = static_cast<BodyId>(std::find(objects_.begin(), objects_.end(), object) - objects_.begin());
    const SceneObject& of = scene_[object];
    return moved_.emplace_back(Moved{object, body, false, NoMotion(), of.pose, of.parts[0].pose});
  }

  /// Sets the poses of the scene's objects to those of the world's bodies.
  void followWorld()
  {
    for (const Moved& each : moved_) {
      const Eigen::Isometry3d pose = poseOf(each);
      if (pose.matrix() != scene_[each.object].pose.matrix()) scene_.setPose(each.object, pose);
    }
  }

  const PartCollider& shapeOf(const ScenePart& part, bool falls)
  {
    return shapes_.of(*part.hierarchy, part.hierarchy->view().triangles && (falls || part.solid));
  }

  Eigen::Isometry3d poseOf(const Moved& each) const
  {
    const Eigen::Isometry3d& pose = world_.pose(each.body);
    return each.part.matrix() == Eigen::Matrix4d::Identity() ? pose : pose * each.part.inverse();
  }

  /// Warns of bodies that overlap something at the beginning, by distances of a scene, which see enclosed objects, too.
  void warnOfOverlaps()
  {
    SceneOptions asked;
    double thickest = options_.thickness;
    for (const auto& [key, shape] : shapes_.all()) thickest = std::max(thickest, 0.5 * shape.collider->spacing());
    asked.effects.distance = 0.5 * thickest;
    Scene still(asked);
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      SceneObject copy = scene_[object];
      copy.fixed = std::none_of(moved_.begin(), moved_.end(),
                                [&](const Moved& each) { return each.object == object && each.falls; });
      for (ScenePart& part : copy.parts) part.solid = part.solid || (!copy.fixed && part.hierarchy->view().triangles);
      still.add(std::move(copy));
    }
    for (const DistantPair& pair : still.query().distance) {
      const double rest = restOf(pair);
      if (pair.distance > 0.5 * rest) continue;
      warnings_.push_back(plainText("objects '", scene_[pair.a].name, "' and '", scene_[pair.b].name,
                                    "' begin in each other, at a distance of ", pair.distance, " where they rest at ",
                                    rest, ": they are pushed apart by ", options_.most_push, " in a second at most"));
    }
  }

  double restOf(const DistantPair& pair) const
  {
    const auto spacing = [&](ObjectId object, std::uint32_t part) {
      for (const auto& [key, shape] : shapes_.all())
        if (key.first == scene_[object].parts[part].hierarchy.get()) return shape.collider->spacing();
      return 0.0;
    };
    const double a = spacing(pair.a, pair.part_a), b = spacing(pair.b, pair.part_b);
    return a > 0.0 && b > 0.0 ? 0.5 * std::max(a, b) : options_.thickness;
  }

  Scene& scene_;
  BodiesOptions options_;
  World world_;
  double time_ = 0.0; ///< since motions began
  PartColliders shapes_;
  std::vector<ObjectId> objects_; ///< of each body of the world
  std::vector<Moved> moved_;
  std::vector<std::string> warnings_;
};

} // namespace

std::unique_ptr<SceneBodies> makeSceneBodies(Scene& scene, const BodiesOptions& options,
                                             const std::vector<SceneBody>& how)
{
  return std::make_unique<WorldOfScene>(scene, options, how);
}

} // namespace pcl_bsh
