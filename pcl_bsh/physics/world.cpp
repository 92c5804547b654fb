// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/physics/world.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/physics/island_world.h>
#include <pcl_bsh/physics/joint.h>
#include <pcl_bsh/query/request_check.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double kErrorReduction = 0.2; ///< Bullet's share of a depth that a step takes away
constexpr double kBouncing = 0.2;       ///< slower approaches do not bounce
constexpr int kIterations = 400;        ///< with 60 a stone at rest rocks on: the residual of each contact moves it
constexpr int kMostLooks = 1000;        ///< distances of two bodies computed in a step
constexpr btScalar kAsleep = 0.02f;     ///< metres, or radians, in a second

void checkNumber(const std::string& name, double value, double least, double most, bool open)
{
  if (std::isfinite(value) && (open ? value > least : value >= least) && value <= most) return;
  const std::string limits = open          ? "give a finite number above 0"
                             : most == 1.0 ? "give a number from 0 to 1"
                                           : "give a finite number of at least 0";
  throw InvalidInput(Input::scene, name, std::to_string(value), limits).withValue(value);
}

void check(const Material& material)
{
  checkNumber("friction", material.friction, 0.0, 1e30, false);
  checkNumber("restitution", material.restitution, 0.0, 1.0, false);
}

} // namespace

struct World::State {
  explicit State(const WorldOptions& of)
  : options(of),
    dispatcher(&configuration),
    world(&dispatcher, &broad_phase, &solver, &configuration)
  {
    world.setGravity(bullet(options.gravity));
    btContactSolverInfo& info = world.getSolverInfo();
    info.m_numIterations = kIterations;
    // In a fixed order, the residuals of contacts would push a stack to the same side in every step.
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_RANDMIZE_ORDER; // the solver's own seed
    info.m_splitImpulse = 0; // poses are computed here from velocities, in double
    info.m_erp2 = static_cast<btScalar>(kErrorReduction);
    info.m_restitutionVelocityThreshold = static_cast<btScalar>(kBouncing);
  }
  ~State()
  {
    for (const auto& [bodies_of_it, joint] : joints) world.removeConstraint(joint.get());
    for (WorldBody& body : bodies) world.removeRigidBody(body.solved.get());
  }

  BodyId add(const Collider& collider, const Eigen::Isometry3d& pose, const MassProperties* mass,
             const Material& material)
  {
    checkPose("pose of a body", pose);
    check(material);
    WorldBody body;
    body.collider = &collider;
    body.material = material;
    body.pose = body.target = pose;
    body.own_axes = Eigen::Isometry3d::Identity();
    btVector3 inertia(0, 0, 0);
    if (mass) {
      checkNumber("mass", mass->mass, 0.0, 1e30, true);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(mass->inertia);
      for (const double about : axes.eigenvalues()) checkNumber("inertia", about, 0.0, 1e30, true);
      Eigen::Matrix3d turn = axes.eigenvectors();
      if (turn.determinant() < 0.0) turn.col(0) = -turn.col(0);
      body.own_axes.translate(mass->center);
      body.own_axes.rotate(turn);
      body.is_free = true;
      inertia = bullet(axes.eigenvalues());
    }
    body.reach = reachOf(collider.thing().view(), body.own_axes.translation());
    btRigidBody::btRigidBodyConstructionInfo info(mass ? static_cast<btScalar>(mass->mass) : btScalar(0), nullptr,
                                                  &shape, inertia);
    info.m_linearDamping = info.m_angularDamping = static_cast<btScalar>(options.damping);
    info.m_linearSleepingThreshold = info.m_angularSleepingThreshold = kAsleep;
    body.solved = std::make_unique<btRigidBody>(info);
    if (!mass)
      body.solved->setCollisionFlags(body.solved->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    if (mass && !options.sleeping) body.solved->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(body.solved.get());
    bodies.push_back(std::move(body));
    return static_cast<BodyId>(bodies.size() - 1);
  }

  void join(const std::pair<BodyId, BodyId>& key, const Joint& joint)
  {
    const WorldBody &a = bodies.at(key.first), &b = bodies.at(key.second);
    std::unique_ptr<btTypedConstraint> made = constraintOf(a, b, joint);
    std::unique_ptr<btTypedConstraint>& held = joints[key];
    if (held) world.removeConstraint(held.get());
    held = std::move(made);
    world.addConstraint(held.get());
    manifolds.erase(key);
    for (const WorldBody* body : {&a, &b}) body->solved->activate();
  }

  bool areNear(const WorldBody& a, const WorldBody& b, double within) const
  {
    return (a.center() - b.center()).norm() <= a.reach + b.reach + within;
  }

  /// Computes the manifolds of all pairs that may touch, and gives them to the solver.
  void touch(double dt, WorldStep& report)
  {
    for (BodyId i = 0; i < bodies.size(); ++i)
      for (BodyId j = i + 1; j < bodies.size(); ++j) {
        const WorldBody &a = bodies[i], &b = bodies[j];
        if (!a.is_free && !b.is_free) continue;
        const std::pair<BodyId, BodyId> key(i, j);
        if (!a.is_free && a.moves()) b.solved->activate();
        if (!b.is_free && b.moves()) a.solved->activate();
        if (joints.count(key) != 0) continue;
        const auto before = manifolds.find(key);
        const bool rest = (a.isAsleep() || (!a.is_free && !a.moves())) && (b.isAsleep() || (!b.is_free && !b.moves()));
        if (!rest) {
          const double spacing = 0.5 * std::max(a.collider->spacing(), b.collider->spacing());
          if (!areNear(a, b, options.margin + std::max(options.thickness, spacing))) {
            if (before != manifolds.end()) manifolds.erase(before);
            continue;
          }
          ++report.pairs;
          ManifoldRequest request;
          request.margin = options.margin;
          request.most = options.contacts;
          if (a.collider->spacing() == 0.0 || b.collider->spacing() == 0.0) request.thickness = options.thickness;
          Manifold& now = manifolds[key];
          if (before != manifolds.end()) request.previous = &now;
          contactManifold({*a.collider, a.pose}, {*b.collider, b.pose}, request, now);
          report.work += now.work;
        }
        if (manifolds.count(key) != 0) give(a, b, key, dt, report);
      }
  }

  /// Gives the contacts of a pair to the solver, in as many of Bullet's manifolds, of up to four contacts, as they
  /// need.
  void give(const WorldBody& a, const WorldBody& b, const std::pair<BodyId, BodyId>& key, double dt, WorldStep& report)
  {
    btPersistentManifold* into = nullptr;
    const double restitution = a.material.restitution * b.material.restitution;
    for (const Contact& contact : manifolds[key].contacts) {
      const auto at = [&](const WorldBody& body, const Eigen::Vector3d& place) {
        return (body.velocity + body.spin.cross(place - body.center())).eval();
      };
      const double approach = contact.normal.dot(at(b, contact.place_b) - at(a, contact.place_a));
      const bool bounces = restitution > 0.0 && approach > kBouncing;
      if (bounces && contact.distance > options.margin / 16) continue; // it is cut at the surface, and bounces then
      if (contact.normal.isZero(0.0)) continue;
      if (!into || into->getNumContacts() == MANIFOLD_CACHE_SIZE)
        into = dispatcher.getNewManifold(a.solved.get(), b.solved.get());
      const double least = -options.most_push * dt / kErrorReduction;
      const double gap = std::max(bounces ? std::min(contact.distance, 0.0) : contact.distance, least);
      btManifoldPoint point(a.inOwnAxes(contact.place_a), b.inOwnAxes(contact.place_b), bullet(contact.normal),
                            static_cast<btScalar>(gap));
      point.m_positionWorldOnA = bullet(contact.place_a - origin);
      point.m_positionWorldOnB = bullet(contact.place_b - origin);
      point.m_combinedFriction = static_cast<btScalar>(a.material.friction * b.material.friction);
      point.m_combinedRestitution = static_cast<btScalar>(restitution);
      const auto known = impulses.find({key.first, key.second, contact.id});
      if (known != impulses.end()) point.m_appliedImpulse = known->second;
      into->addManifoldPoint(point, true);
      given.push_back({key.first, key.second, contact.id});
      ++report.contacts;
    }
  }

  void findOrigin()
  {
    std::size_t free = 0;
    origin.setZero();
    for (const WorldBody& body : bodies)
      if (body.is_free) origin += body.center(), ++free;
    if (free > 0) origin /= static_cast<double>(free);
  }

  /// Keeps the impulses of the contacts for the next step, and removes the contacts.
  void takeImpulses()
  {
    impulses.clear();
    std::size_t next = 0;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold& touching = *dispatcher.getManifoldByIndexInternal(i);
      for (int k = 0; k < touching.getNumContacts(); ++k)
        impulses[given[next++]] = touching.getContactPoint(k).m_appliedImpulse;
    }
    given.clear();
    while (dispatcher.getNumManifolds() > 0) dispatcher.releaseManifold(dispatcher.getManifoldByIndexInternal(0));
  }

  /// Whether the distance of two bodies shrinks while none of their places moves by more than a quarter of it.
  static bool approach(const WorldBody& a, const WorldBody& b, double distance, double speed, Work& work)
  {
    const double seconds = 0.25 * distance / speed;
    const DistanceResult found =
        closestPair({a.collider->thing(), a.after(seconds)}, {b.collider->thing(), b.after(seconds)});
    work += found.work;
    return found.interval.upper < 0.999 * distance;
  }

  /// Returns for how many seconds of a step two bodies may move until they come to half of their distance. None where
  /// they do not come so near, even if one of them halts.
  std::optional<double> secondsBefore(const WorldBody& a, const WorldBody& b, double dt, Work& work) const
  {
    const double speed = a.mostSpeed() + b.mostSpeed();
    if (!(speed > 0.0) || !areNear(a, b, speed * dt)) return std::nullopt;
    double seconds = 0.0, halt = 0.0;
    for (int looks = 0; looks < kMostLooks && seconds < dt; ++looks) {
      DistanceRequest request;
      if (looks == 0) request.max_distance = 2.0 * speed * dt;
      const DistanceResult found =
          closestPair({a.collider->thing(), a.after(seconds)}, {b.collider->thing(), b.after(seconds)}, request);
      work += found.work;
      if (!found.pair) return std::nullopt;
      const double distance = found.interval.lower;
      if (looks == 0 && distance > 0.0 && distance <= options.thickness / 16 && approach(a, b, distance, speed, work))
        return 0.0; // else, pressing a blocked body would halve the distance in each step, down to 0
      if (looks == 0) halt = distance > 0.0 ? 0.5 * distance : distance - 0.5 * options.thickness;
      if (looks > 0 && distance - halt <= 1e-3 * std::abs(halt)) return seconds;
      seconds += (distance - halt) / speed;
    }
    return std::min(seconds, dt);
  }

  /// Returns for how many seconds each body may move. Two bodies that come near each other or are joined move for
  /// equally long.
  std::vector<double> secondsOfBodies(double dt, Work& work) const
  {
    std::vector<double> seconds(bodies.size(), dt);
    std::vector<std::pair<std::size_t, std::size_t>> near;
    for (BodyId i = 0; i < bodies.size(); ++i)
      for (BodyId j = i + 1; j < bodies.size(); ++j) {
        if (!bodies[i].is_free && !bodies[j].is_free) continue;
        if (joints.count({i, j}) != 0) {
          near.emplace_back(i, j);
          continue;
        }
        if (const auto known = manifolds.find({i, j}); known != manifolds.end() && areInEachOther(known->second))
          continue;
        const auto before = secondsBefore(bodies[i], bodies[j], dt, work);
        if (!before) continue;
        near.emplace_back(i, j);
        for (const std::size_t k : {i, j}) seconds[k] = std::min(seconds[k], *before);
      }
    for (bool changed = true; std::exchange(changed, false);)
      for (const auto& [i, j] : near) {
        const double least = std::min(bodies[i].moves() ? seconds[i] : dt, bodies[j].moves() ? seconds[j] : dt);
        for (const std::size_t k : {i, j}) {
          if (!bodies[k].moves() || seconds[k] == least) continue;
          seconds[k] = least;
          changed = true;
        }
      }
    return seconds;
  }

  WorldOptions options;
  btEmptyShape shape;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  IslandWorld world;
  std::vector<WorldBody> bodies;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); ///< of the solver's floats: the middle of the free bodies
  std::map<std::pair<BodyId, BodyId>, Manifold> manifolds;
  std::map<std::pair<BodyId, BodyId>, std::unique_ptr<btTypedConstraint>> joints;
  std::map<std::tuple<BodyId, BodyId, std::uint32_t>, btScalar> impulses; ///< of the last step, by contact
  std::vector<std::tuple<BodyId, BodyId, std::uint32_t>> given;           ///< contacts in the order of the solver's
};

World::World(const WorldOptions& options)
{
  if (!options.gravity.allFinite()) throw InvalidInput(Input::scene, "gravity", "not finite", "give a finite one");
  checkNumber("margin", options.margin, 0.0, 1e30, true);
  checkNumber("thickness", options.thickness, 0.0, 1e30, true);
  checkNumber("speed of pushing apart", options.most_push, 0.0, 1e30, true);
  checkNumber("damping", options.damping, 0.0, 1.0, false);
  if (options.contacts == 0) throw InvalidInput(Input::scene, "contacts", "0", "give at least 1");
  state_ = std::make_unique<State>(options);
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

BodyId World::addFixed(const Collider& collider, const Eigen::Isometry3d& T_world_collider, const Material& material)
{
  return state_->add(collider, T_world_collider, nullptr, material);
}

BodyId World::add(const Collider& collider, const Eigen::Isometry3d& T_world_collider, const MassProperties& mass,
                  const Material& material)
{
  return state_->add(collider, T_world_collider, &mass, material);
}

void World::join(BodyId a, BodyId b, const Joint& joint)
{
  check(joint, state_->bodies.at(a), state_->bodies.at(b));
  state_->join(std::minmax(a, b), joint);
}

std::size_t World::size() const noexcept
{
  return state_->bodies.size();
}
const Eigen::Isometry3d& World::pose(BodyId body) const
{
  return state_->bodies.at(body).pose;
}
Eigen::Vector3d World::velocity(BodyId body) const
{
  return state_->bodies.at(body).velocity;
}
Eigen::Vector3d World::spin(BodyId body) const
{
  return state_->bodies.at(body).spin;
}
bool World::isAsleep(BodyId body) const
{
  return state_->bodies.at(body).isAsleep();
}

void World::setVelocity(BodyId body, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin)
{
  WorldBody& of = state_->bodies.at(body);
  of.velocity = velocity;
  of.spin = spin;
  of.solved->activate(true);
}

void World::moveTo(BodyId body, const Eigen::Isometry3d& T_world_collider)
{
  checkPose("pose of a body", T_world_collider);
  WorldBody& of = state_->bodies.at(body);
  of.target = T_world_collider;
  of.is_led = of.is_free;
}

void World::release(BodyId body)
{
  state_->bodies.at(body).is_led = false;
}

bool World::isThere(BodyId body) const
{
  const WorldBody& of = state_->bodies.at(body);
  return of.pose.matrix() == of.target.matrix();
}

const std::map<std::pair<BodyId, BodyId>, Manifold>& World::contacts() const
{
  return state_->manifolds;
}

WorldStep World::step(double dt)
{
  checkNumber("step", dt, 0.0, 1e30, true);
  State& state = *state_;
  WorldStep report;
  for (WorldBody& body : state.bodies) body.headForTarget(dt);
  state.findOrigin();
  for (WorldBody& body : state.bodies) body.place(state.origin, dt);
  state.touch(dt, report);
  state.world.stepSimulation(static_cast<btScalar>(dt), 0);
  state.takeImpulses();
  for (WorldBody& body : state.bodies) {
    if (!body.is_free) continue;
    body.velocity = body.isAsleep() ? Eigen::Vector3d::Zero() : eigen(body.solved->getLinearVelocity());
    body.spin = body.isAsleep() ? Eigen::Vector3d::Zero() : eigen(body.solved->getAngularVelocity());
  }
  const std::vector<double> seconds = state.secondsOfBodies(dt, report.work);
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    WorldBody& body = state.bodies[i];
    if (!body.moves()) continue;
    body.pose = !body.is_free && seconds[i] == dt ? body.target : body.after(seconds[i]);
    if (seconds[i] < dt) ++report.cut;
  }
  return report;
}

} // namespace pcl_bsh
