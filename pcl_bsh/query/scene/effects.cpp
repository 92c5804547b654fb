// SPDX-License-Identifier: BSD-3-Clause
// What a query computes: the pairs worth asking about, then each listed effect by itself, with its own cost.
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/hierarchy/parallel.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/scene/state.h>
#include <pcl_bsh/query/scene/sweep.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_map>

namespace pcl_bsh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 0x1p-40; // relative; far above that of a few operations in double
constexpr unsigned kPatience = 8;     // queries after which a wider one that failed is tried again
constexpr double kAhead = 4.0;        // steps of the present speed that a wider query looks ahead
constexpr double kCoarse = 64;        // voxels of an object's box beyond which its own voxels are looked at

/// Adds the time until its end to a cost.
class Timed {
public:
  explicit Timed(double& seconds) : seconds_(seconds) {}
  ~Timed() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

CollisionRequest requestFor(double clearance, const Accuracy& accuracy = {})
{
  CollisionRequest request;
  request.clearance = clearance;
  request.accuracy = accuracy;
  return request;
}

/// Whether a pair of points found earlier still collides.
bool collides(const Placed& a, const Placed& b, PointPair pair, double clearance, Work& work)
{
  ++work.exact_decisions;
  const PointsView &p = a.hierarchy.view(), &q = b.hierarchy.view();
  return ExactDistance(a.pose, b.pose)
             .compare(p.point(pair.a), q.point(pair.b), clearance, p.radius(pair.a), q.radius(pair.b)) <= 0;
}

bool looksBack(const Effects& effects)
{
  return effects.first_contact || effects.swept;
}

/// A voxel edge that suits most of what moves.
double edgeFor(const std::vector<Body>& bodies, double reach)
{
  std::vector<double> sizes;
  for (const bool fixed : {false, true}) {
    for (const Body& body : bodies)
      if (body.object.fixed == fixed && !body.box.empty()) sizes.push_back(2.0 * body.box.half().maxCoeff());
    if (!sizes.empty()) break;
  }
  if (sizes.empty()) return 1.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double edge = 1.5 * *middle + reach;
  return std::isfinite(edge) && edge > 0x1p-500 ? edge : 1.0;
}

} // namespace

Path Scene::State::pathOf(ObjectId object) const
{
  const Body& body = bodies[object];
  return {body.last_version > 0 ? body.last_pose : body.object.pose, body.object.pose, body.box};
}

void Scene::State::prepareGrid()
{
  const Timed timed(result.broad_phase.seconds);
  if (grid_stale) {
    reach = std::max(rules.largestClearance(), options.effects.distance.value_or(0.0)) * (1.0 + kRounding);
    grid.reset(!std::isfinite(reach)      ? kInfinity
               : options.voxel_edge > 0.0 ? options.voxel_edge
                                          : edgeFor(bodies, reach),
               rules);
    for (Body& body : bodies) body.placed_version = 0;
    grid_stale = false;
    near_stale = true;
    near.clear();
    for (ObjectId i = 0; i < bodies.size(); ++i) place(i);
    return;
  }
  for (const ObjectId i : moved) place(i);
  for (const ObjectId i : moved_before) place(i); // whose boxes held their ways
}

void Scene::State::place(ObjectId object)
{
  Body& body = bodies[object];
  const bool way = looksBack(options.effects) && body.last_version > 0 && body.version != body.last_version;
  if (body.placed_version == body.version && !body.placed_swept && !way) return;
  body.placed_version = body.version;
  body.placed_swept = way;
  ++result.broad_phase.moved;
  boxes_.assign(1, way ? pathOf(object).swept() : body.world_box);
  boxes_.front().grow(0.5 * reach);
  if (!way && grid.voxelsOf(boxes_.front()) > kCoarse) {
    boxes_.clear();
    for (std::size_t p = 0; p < body.world.size(); ++p) {
      const SphereHierarchy::Storage& storage = body.object.parts[p].hierarchy->storage();
      for (std::size_t v = 0; v < storage.voxel_count; ++v) {
        const LocalFrame& frame = storage.voxels[v].frame;
        Box3 box;
        for (int k = 0; k < 3; ++k) {
          const auto axis = static_cast<std::size_t>(k);
          const double half = (frame.reach[axis] + frame.slack(k)) * frame.unit * (1.0 + kRounding);
          box.low[k] = frame.origin[axis] - half;
          box.high[k] = frame.origin[axis] + half;
        }
        box = pcl_bsh::moved(box, body.world[p]);
        box.grow(storage.largest_radius + 0.5 * reach);
        boxes_.push_back(box);
      }
    }
  }
  grid.place(object, boxes_, result.broad_phase);
}

void Scene::State::compareBoxes(BroadPair& pair)
{
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  PairMemory& memory = pair.memory;
  if (memory.version_a == a.version && memory.version_b == b.version) return;
  ++result.broad_phase.box_tests;
  memory.version_a = a.version;
  memory.version_b = b.version;
  Box3 box = a.world_box;
  box.grow(pair.clearance * (1.0 + kRounding));
  const bool was_near = memory.near;
  memory.near = box.meets(b.world_box);
  if (memory.near && !was_near) newly_near_.push_back(&pair);
}

void Scene::State::findNear()
{
  const Timed timed(result.broad_phase.seconds);
  const auto before = [](const BroadPair* l, const BroadPair* r) { return pairKey(l->a, l->b) < pairKey(r->a, r->b); };
  newly_near_.clear();
  if (near_stale)
    for (BroadPair* pair : grid.pairs()) compareBoxes(*pair);
  else
    for (const ObjectId object : moved)
      for (BroadPair* pair : grid.pairsOf(object)) compareBoxes(*pair);
  near_stale = false;
  near.erase(std::remove_if(near.begin(), near.end(),
                            [](const BroadPair* pair) { return pair->shared == 0 || !pair->memory.near; }),
             near.end());
  const auto middle = static_cast<std::ptrdiff_t>(near.size());
  std::sort(newly_near_.begin(), newly_near_.end(), before);
  near.insert(near.end(), newly_near_.begin(), newly_near_.end());
  std::inplace_merge(near.begin(), near.begin() + middle, near.end(), before);
  grid.dropParted();
  result.broad_phase.pairs_sharing = grid.pairCount();
  result.broad_phase.candidates = near.size();
}

template <class Decide>
void Scene::State::eachPair(const std::vector<BroadPair*>& pairs, EffectCost& cost, const Decide& decide)
{
  parallelFor(pairs.size(), threadCount(options.threads), [&](std::size_t i) {
    pairs[i]->memory.work = Work();
    pairs[i]->memory.asked = 0;
    pairs[i]->memory.reused = false;
    decide(i);
  });
  for (const BroadPair* pair : pairs) {
    cost.pairs += pair->memory.asked;
    cost.reused += pair->memory.reused ? 1 : 0;
    cost.work += pair->memory.work;
  }
}

// ---- any ---------------------------------------------------------------------------------------------------------

void Scene::State::findAny()
{
  EffectCost& spent = cost(Effect::any);
  const Timed timed(spent.seconds);
  eachPair(near, spent, [this](std::size_t i) { decideAny(*near[i]); });
  for (const BroadPair* pair : near) {
    if (pair->memory.colliding) result.any.push_back(pair->memory.witness);
    if (pair->memory.undecided) result.undecided.push_back(*pair->memory.undecided);
  }
}

void Scene::State::decideAny(BroadPair& pair) const
{
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  PairMemory& memory = pair.memory;
  if (memory.any_a == a.version && memory.any_b == b.version) {
    memory.reused = true;
    return;
  }
  memory.any_a = a.version;
  memory.any_b = b.version;
  const bool remember = options.remember && options.accuracy.isExact(); // else memory would change answers
  if (remember && remembersAny(pair)) {
    memory.reused = true;
    return;
  }

  /// Whether any parts collide at the clearance; if so, notes the witness; if not, who may.
  const auto ask = [&](double clearance) {
    memory.undecided.reset();
    for (std::uint32_t i = 0; i < a.world.size(); ++i)
      for (std::uint32_t j = 0; j < b.world.size(); ++j) {
        const AnyResult found =
            anyCollision(placed(pair.a, i), placed(pair.b, j), requestFor(clearance, options.accuracy));
        memory.work += found.work;
        ++memory.asked;
        const PartPair parts{pair.a, pair.b, i, j};
        if (found.verdict == Verdict::undecided && !memory.undecided) memory.undecided = parts;
        if (!found.witness) continue;
        memory.undecided.reset();
        memory.witness = {{pair.a, pair.b, i, j}, *found.witness};
        return true;
      }
    return false;
  };
  memory.has_witness = false;
  memory.apart = 0.0;
  const double ahead = remember ? kAhead * (a.last_motion + b.last_motion) : 0.0;
  if (ahead > 0.0 && memory.patience == 0) {
    // What is free at a wider clearance need not be asked again until it has moved that far.
    memory.colliding = ask(pair.clearance + ahead);
    if (!memory.colliding) {
      memory.apart = pair.clearance + ahead;
      memory.apart_a = a.object.pose;
      memory.apart_b = b.object.pose;
      return;
    }
    memory.patience = kPatience;
    memory.has_witness = collides(placed(pair.a, memory.witness.part_a), placed(pair.b, memory.witness.part_b),
                                  memory.witness.witness, pair.clearance, memory.work);
    if (memory.has_witness) return;
  }
  else if (memory.patience > 0) {
    --memory.patience;
  }
  memory.colliding = memory.has_witness = ask(pair.clearance);
}

/// Whether what an earlier step found still answers.
bool Scene::State::remembersAny(BroadPair& pair) const
{
  PairMemory& memory = pair.memory;
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  if (memory.apart > pair.clearance) {
    const double way =
        motionBound(a.box, memory.apart_a, a.object.pose) + motionBound(b.box, memory.apart_b, b.object.pose);
    if (memory.apart * (1.0 - kRounding) - way > pair.clearance) {
      memory.colliding = false;
      return true;
    }
  }
  if (!memory.has_witness) return false;
  memory.colliding = collides(placed(pair.a, memory.witness.part_a), placed(pair.b, memory.witness.part_b),
                              memory.witness.witness, pair.clearance, memory.work);
  return memory.colliding;
}

/// As `any` has just found.
bool Scene::State::isKnownFree(const BroadPair& pair) const
{
  return options.effects.any && options.accuracy.isProven() && !pair.memory.colliding && !pair.memory.undecided;
}

// ---- flags -------------------------------------------------------------------------------------------------------

namespace {

/// Flags of parts, made when the first of their points is flagged.
class FlagTable {
public:
  explicit FlagTable(const std::vector<Body>& bodies) : bodies_(bodies) {}

  void merge(ObjectId object, std::uint32_t part, const std::vector<std::uint8_t>& flags)
  {
    if (std::all_of(flags.begin(), flags.end(), isFree)) return;
    FlaggedPart& target = parts_[std::uint64_t{object} << 32 | part];
    if (target.flags.empty()) {
      target.object = object;
      target.part = part;
      target.flags.assign(bodies_[object].object.parts[part].hierarchy->view().count, 0);
    }
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (!isFree(flags[i]) && target.flags[i] != flagOf(Verdict::colliding)) target.flags[i] = flags[i];
  }

  std::vector<FlaggedPart> take()
  {
    std::vector<FlaggedPart> list;
    for (auto& entry : parts_) {
      FlaggedPart& part = entry.second;
      const auto count = [&part](Verdict verdict) {
        return static_cast<std::size_t>(std::count(part.flags.begin(), part.flags.end(), flagOf(verdict)));
      };
      part.colliding = count(Verdict::colliding);
      part.undecided = count(Verdict::undecided);
      list.push_back(std::move(part));
    }
    return list;
  }

private:
  static bool isFree(std::uint8_t flag) { return flag == flagOf(Verdict::free); }

  const std::vector<Body>& bodies_;
  std::map<std::uint64_t, FlaggedPart> parts_;
};

/// The flags of one pair of parts.
struct PairFlags {
  PartPair parts;
  std::vector<std::uint8_t> a, b;
};

} // namespace

void Scene::State::findFlags()
{
  EffectCost& spent = cost(Effect::flags);
  const Timed timed(spent.seconds);
  std::vector<std::vector<PairFlags>> found(near.size());
  eachPair(near, spent, [&](std::size_t k) {
    const BroadPair& pair = *near[k];
    PairMemory& memory = near[k]->memory;
    if (isKnownFree(pair)) {
      memory.reused = true;
      return;
    }
    CollisionRequest request = requestFor(pair.clearance, options.accuracy);
    request.flagged = Side::both;
    for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
      for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
        FlagsResult flags = collisionFlags(placed(pair.a, i), placed(pair.b, j), request);
        memory.work += flags.work;
        ++memory.asked;
        const std::size_t not_free = flags.colliding_a + flags.colliding_b + flags.undecided_a + flags.undecided_b;
        if (not_free > 0) found[k].push_back({{pair.a, pair.b, i, j}, std::move(flags.a), std::move(flags.b)});
      }
  });
  FlagTable table(bodies);
  for (const auto& of_pair : found)
    for (const PairFlags& flags : of_pair) {
      table.merge(flags.parts.a, flags.parts.part_a, flags.a);
      table.merge(flags.parts.b, flags.parts.part_b, flags.b);
    }
  result.flags = table.take();
}

// ---- distance ----------------------------------------------------------------------------------------------------

void Scene::State::findDistances()
{
  EffectCost& spent = cost(Effect::distance);
  const Timed timed(spent.seconds);
  const std::vector<BroadPair*>& pairs = grid.pairs();
  const double within = *options.effects.distance;
  eachPair(pairs, spent, [&](std::size_t i) { decideDistance(*pairs[i], within); });
  for (const BroadPair* pair : pairs)
    if (pair->memory.within) result.distance.push_back(pair->memory.distance);
}

void Scene::State::decideDistance(BroadPair& pair, double within) const
{
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  PairMemory& memory = pair.memory;
  if (memory.distance_a == a.version && memory.distance_b == b.version) {
    memory.reused = true;
    return;
  }
  memory.distance_a = a.version;
  memory.distance_b = b.version;
  memory.within = false;
  Interval& interval = memory.distance.interval;
  interval = {kInfinity, kInfinity};
  Box3 box = a.world_box;
  box.grow(within * (1.0 + kRounding));
  if (a.box.empty() || b.box.empty() || !box.meets(b.world_box)) return;
  bool first = true;
  for (std::uint32_t i = 0; i < a.world.size(); ++i)
    for (std::uint32_t j = 0; j < b.world.size(); ++j) {
      const DistanceResult found =
          closestPair(placed(pair.a, i), placed(pair.b, j), requestFor(pair.clearance, options.accuracy));
      memory.work += found.work;
      ++memory.asked;
      interval.lower = std::min(interval.lower, found.interval.lower);
      interval.upper = std::min(interval.upper, found.interval.upper);
      if (!found.pair || (!first && !(found.distance < memory.distance.distance))) continue;
      memory.distance = {{pair.a, pair.b, i, j}, found.distance, interval, *found.pair};
      first = false;
    }
  const bool certain = options.accuracy.isExact() || !options.accuracy.isProven();
  memory.within = !first && (certain ? memory.distance.distance : interval.lower) <= within;
}

// ---- contacts ----------------------------------------------------------------------------------------------------

void Scene::State::findContacts()
{
  EffectCost& spent = cost(Effect::contacts);
  const Timed timed(spent.seconds);
  std::vector<std::vector<ContactPair>> found(near.size());
  eachPair(near, spent, [&](std::size_t k) {
    const BroadPair& pair = *near[k];
    PairMemory& memory = near[k]->memory;
    if (isKnownFree(pair)) {
      memory.reused = true;
      return;
    }
    for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
      for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
        ContactsResult contacts = nearestContacts(placed(pair.a, i), placed(pair.b, j), requestFor(pair.clearance),
                                                  *options.effects.contacts);
        memory.work += contacts.work;
        ++memory.asked;
        if (contacts.contacts.empty() && contacts.complete) continue;
        found[k].push_back({{pair.a, pair.b, i, j}, std::move(contacts.contacts), contacts.complete});
      }
  });
  for (auto& of_pair : found)
    for (ContactPair& contacts : of_pair) result.contacts.push_back(std::move(contacts));
}

// ---- first contact, swept ----------------------------------------------------------------------------------------

void Scene::State::findFirstContacts()
{
  EffectCost& spent = cost(Effect::first_contact);
  const Timed timed(spent.seconds);
  const std::vector<BroadPair*>& pairs = grid.pairs();
  std::vector<std::optional<PartFirstContact>> found(pairs.size());
  eachPair(pairs, spent, [&](std::size_t k) {
    const BroadPair& pair = *pairs[k];
    const Path path_a = pathOf(pair.a), path_b = pathOf(pair.b);
    Box3 box = path_a.swept();
    box.grow((pair.clearance + options.tolerance) * (1.0 + kRounding));
    if (!box.meets(path_b.swept())) return;
    for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
      for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
        const ScenePart &part_a = bodies[pair.a].object.parts[i], &part_b = bodies[pair.b].object.parts[j];
        const auto met =
            firstMeeting({*part_a.hierarchy, part_a.pose, path_a}, {*part_b.hierarchy, part_b.pose, path_b},
                         pair.clearance, options.tolerance, pairs[k]->memory.work);
        ++pairs[k]->memory.asked;
        if (met && (!found[k] || met->s < found[k]->fraction))
          found[k] = PartFirstContact{{pair.a, pair.b, i, j}, met->s, met->pair};
      }
  });
  for (const auto& contact : found)
    if (contact) result.first_contact.push_back(*contact);
}

void Scene::State::findSwept()
{
  EffectCost& spent = cost(Effect::swept);
  const Timed timed(spent.seconds);
  const std::vector<BroadPair*>& pairs = grid.pairs();
  std::vector<std::vector<PairFlags>> found(pairs.size());
  eachPair(pairs, spent, [&](std::size_t k) {
    const BroadPair& pair = *pairs[k];
    const Path path_a = pathOf(pair.a), path_b = pathOf(pair.b);
    Box3 box = path_a.swept();
    box.grow((pair.clearance + options.tolerance) * (1.0 + kRounding));
    if (!box.meets(path_b.swept())) return;
    for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
      for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
        const ScenePart &part_a = bodies[pair.a].object.parts[i], &part_b = bodies[pair.b].object.parts[j];
        PairFlags flags{{pair.a, pair.b, i, j},
                        std::vector<std::uint8_t>(part_a.hierarchy->view().count, 0),
                        std::vector<std::uint8_t>(part_b.hierarchy->view().count, 0)};
        flagMeetings({*part_a.hierarchy, part_a.pose, path_a}, {*part_b.hierarchy, part_b.pose, path_b}, pair.clearance,
                     options.tolerance, flags.a, flags.b, pairs[k]->memory.work);
        ++pairs[k]->memory.asked;
        if (std::find(flags.a.begin(), flags.a.end(), 1) != flags.a.end()) found[k].push_back(std::move(flags));
      }
  });
  FlagTable table(bodies);
  for (const auto& of_pair : found)
    for (const PairFlags& flags : of_pair) {
      table.merge(flags.parts.a, flags.parts.part_a, flags.a);
      table.merge(flags.parts.b, flags.parts.part_b, flags.b);
    }
  result.swept = table.take();
}

// ---- self --------------------------------------------------------------------------------------------------------

void Scene::State::findSelf()
{
  EffectCost& spent = cost(Effect::self);
  const Timed timed(spent.seconds);
  for (ObjectId object = 0; object < bodies.size(); ++object) {
    const SceneObject& whole = bodies[object].object;
    for (std::uint32_t i = 0; i < whole.parts.size(); ++i)
      for (std::uint32_t j = i + 1; j < whole.parts.size(); ++j) {
        if (std::find(whole.adjacent.begin(), whole.adjacent.end(), std::make_pair(i, j)) != whole.adjacent.end())
          continue;
        // In the object's own frame, where only the parts' poses count.
        const AnyResult found = anyCollision({*whole.parts[i].hierarchy, whole.parts[i].pose},
                                             {*whole.parts[j].hierarchy, whole.parts[j].pose},
                                             requestFor(options.clearance, options.accuracy));
        spent.work += found.work;
        ++spent.pairs;
        if (found.witness) result.self.push_back({object, i, j, *found.witness});
        if (found.verdict == Verdict::undecided) result.undecided.push_back({object, object, i, j});
      }
  }
}

// ---- all of it ---------------------------------------------------------------------------------------------------

SceneResult Scene::State::query()
{
  const Effects& effects = options.effects;
  result.time = time;
  const bool of_near = effects.any || effects.flags || effects.contacts;
  if (of_near || effects.distance || looksBack(effects)) prepareGrid();
  if (of_near) findNear();
  if (effects.any) findAny();
  if (effects.flags) findFlags();
  if (effects.distance) findDistances();
  if (effects.contacts) findContacts();
  if (effects.first_contact) findFirstContacts();
  if (effects.swept) findSwept();
  if (effects.self) findSelf();
  if (!of_near) grid.dropParted(); // nobody keeps them
  for (const ObjectId object : moved_before) bodies[object].last_motion = 0.0;
  for (const ObjectId object : moved) {
    Body& body = bodies[object];
    body.last_motion =
        options.remember && body.last_version > 0 ? motionBound(body.box, body.last_pose, body.object.pose) : 0.0;
    body.last_pose = body.object.pose;
    body.last_version = body.version;
    body.listed = false;
  }
  moved_before.swap(moved);
  moved.clear();
  SceneResult finished = std::move(result);
  result = SceneResult();
  return finished;
}

} // namespace pcl_bsh
