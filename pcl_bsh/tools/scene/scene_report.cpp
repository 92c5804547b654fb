// SPDX-License-Identifier: BSD-3-Clause
#include "scene_report.h"

#include <pcl_bsh/tools/cli/json_output.h>

#include <pcl_bsh/io/text/number_text.h>

#include <algorithm>
#include <ostream>

namespace pcl_bsh::cli {
namespace {

std::size_t sumOf(const std::vector<FlaggedPart>& parts, std::size_t FlaggedPart::*value)
{
  std::size_t sum = 0;
  for (const FlaggedPart& part : parts) sum += part.*value;
  return sum;
}

/// How many pairs are undecided. @param of_one pairs of parts of one object, not of two objects
std::size_t undecidedPairs(const SceneResult& result, bool of_one)
{
  return static_cast<std::size_t>(std::count_if(result.undecided.begin(), result.undecided.end(),
                                                [&](const PartPair& pair) { return (pair.a == pair.b) == of_one; }));
}

/// Writes the count of items, and the smallest value, empty without items.
template <class Item>
void writeSmallest(std::ostream& out, const std::vector<Item>& items, double Item::*value)
{
  out << ',' << items.size() << ',';
  if (items.empty()) return;
  double smallest = items.front().*value;
  for (const Item& item : items) smallest = std::min(smallest, item.*value);
  out << io::numberText(smallest);
}

nlohmann::ordered_json jsonOf(const Eigen::Vector3d& v)
{
  return {v.x(), v.y(), v.z()};
}

/// As scene files give poses: the first three rows, one after the other.
nlohmann::ordered_json jsonOf(const Eigen::Isometry3d& pose)
{
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 4; ++column) json.push_back(pose(row, column));
  return json;
}

/// Names of the columns, each after a comma.
void writeBodyHeader(std::ostream& out)
{
  out << ",awake_bodies,body_contacts,bodies_steps,bodies_queries,bodies_cut,bodies_node_pairs,bodies_seconds";
}

void writeBodyRow(std::ostream& out, const BodiesStep& step, const SceneBodies& bodies)
{
  const std::vector<BodyState> states = bodies.states();
  std::size_t contacts = 0;
  for (const BodyContacts& pair : bodies.contacts()) contacts += pair.contacts.size();
  out << ',' << std::count_if(states.begin(), states.end(), [](const BodyState& state) { return !state.asleep; }) << ','
      << contacts << ',' << step.steps << ',' << step.solved.pairs << ',' << step.solved.cut << ','
      << step.solved.work.node_pairs << ',' << io::numberText(step.seconds);
}

/// Adds `bodies`, where each is and how it moves, and `body_contacts`.
void addBodies(nlohmann::ordered_json& json, const SceneBodies& bodies, const Scene& scene)
{
  using Json = nlohmann::ordered_json;
  json["bodies"] = Json::array();
  for (const BodyState& state : bodies.states())
    json["bodies"].push_back({{"object", scene[state.object].name},
                              {"pose", jsonOf(state.pose)},
                              {"velocity", jsonOf(state.velocity)},
                              {"spin", jsonOf(state.spin)},
                              {"asleep", state.asleep}});
  json["body_contacts"] = Json::array();
  for (const BodyContacts& pair : bodies.contacts()) {
    Json entry = {{"a", scene[pair.a].name}, {"b", scene[pair.b].name}, {"points", Json::array()}};
    for (const Contact& contact : pair.contacts)
      entry["points"].push_back({{"place_a", jsonOf(contact.place_a)},
                                 {"place_b", jsonOf(contact.place_b)},
                                 {"normal", jsonOf(contact.normal)},
                                 {"gap", contact.distance}});
    json["body_contacts"].push_back(std::move(entry));
  }
}

} // namespace

void BodyCost::add(const BodiesStep& step)
{
  steps += step.steps;
  solved += step.solved;
  seconds += step.seconds;
}

nlohmann::ordered_json BodyCost::json() const
{
  return {{"steps", steps},    {"queries", solved.pairs},       {"contacts", solved.contacts},
          {"cut", solved.cut}, {"work", workJson(solved.work)}, {"seconds", seconds}};
}

bool mayBeUndecided(const Scene& scene)
{
  if (scene.options().accuracy.stopsEarly()) return true;
  for (ObjectId id = 0; id < scene.size(); ++id)
    for (const ScenePart& part : scene[id].parts)
      if (part.hierarchy->view().isUncertain()) return true;
  return false;
}

void SceneTotals::add(const BodiesStep& step, double seconds)
{
  const SceneResult& result = step.scene;
  step_seconds.push_back(seconds);
  bodies.add(step);
  for (std::size_t e = 0; e < kEffects; ++e) {
    costs[e].pairs += result.costs[e].pairs;
    costs[e].reused += result.costs[e].reused;
    costs[e].work += result.costs[e].work;
    costs[e].seconds += result.costs[e].seconds;
  }
  broad_phase.moved += result.broad_phase.moved;
  broad_phase.voxels_left += result.broad_phase.voxels_left;
  broad_phase.voxels_entered += result.broad_phase.voxels_entered;
  broad_phase.box_tests += result.broad_phase.box_tests;
  broad_phase.candidates += result.broad_phase.candidates;
  broad_phase.seconds += result.broad_phase.seconds;
  colliding_steps += result.any.empty() ? 0 : 1;
  undecided_steps += result.undecided.empty() ? 0 : 1;
  unswept_steps += result.unswept.empty() ? 0 : 1;
  for (const Outcome& outcome : result.outcomes) {
    touched_moves += outcome.touched ? 1 : 0;
    travelled += outcome.travelled;
    wanted += outcome.wanted;
  }
}

void SceneTable::writeHeader(std::ostream& out) const
{
  out << "step,time_s,moved_objects,candidate_pairs";
  for (std::size_t e = 0; e < kEffects; ++e) {
    const auto effect = static_cast<Effect>(e);
    if (!effects_.has(effect)) continue;
    const std::string name = nameOf(effect);
    if (effect == Effect::any) out << (undecided_ ? ",colliding_pairs,undecided_pairs" : ",colliding_pairs");
    if (effect == Effect::flags) out << (undecided_ ? ",flagged_points,undecided_points" : ",flagged_points");
    if (effect == Effect::distance) out << ",near_pairs,smallest_distance";
    if (effect == Effect::contacts) out << ",contacts";
    if (effect == Effect::first_contact) out << ",first_contacts,earliest_fraction";
    if (effect == Effect::swept) out << (undecided_ ? ",swept_points,undecided_swept_points" : ",swept_points");
    if (effect == Effect::self) out << (undecided_ ? ",self_collisions,undecided_self_collisions" : ",self_collisions");
    out << ',' << name << "_queries," << name << "_reused," << name << "_node_pairs," << name << "_updates," << name
        << "_seconds";
  }
  if (sweeps()) out << ",unswept_objects";
  if (moves()) out << ",touched,stuck,grounded,travelled,wanted";
  if (bodies_) writeBodyHeader(out);
  out << '\n';
}

void SceneTable::writeRow(std::ostream& out, std::size_t step, const BodiesStep& done) const
{
  const SceneResult& result = done.scene;
  out << step << ',' << io::numberText(result.time) << ',' << result.broad_phase.moved << ','
      << result.broad_phase.candidates;
  for (std::size_t e = 0; e < kEffects; ++e) {
    const auto effect = static_cast<Effect>(e);
    if (!effects_.has(effect)) continue;
    const auto counts = [&](std::size_t colliding, std::size_t undecided) {
      out << ',' << colliding;
      if (undecided_) out << ',' << undecided;
    };
    const auto points = [&](const std::vector<FlaggedPart>& parts) {
      counts(sumOf(parts, &FlaggedPart::colliding), sumOf(parts, &FlaggedPart::undecided));
    };
    if (effect == Effect::any) counts(result.any.size(), undecidedPairs(result, false));
    if (effect == Effect::flags) points(result.flags);
    if (effect == Effect::distance) writeSmallest(out, result.distance, &DistantPair::distance);
    if (effect == Effect::contacts) {
      std::size_t count = 0;
      for (const ContactPair& pair : result.contacts) count += pair.contacts.size();
      out << ',' << count;
    }
    if (effect == Effect::first_contact) writeSmallest(out, result.first_contact, &PartFirstContact::fraction);
    if (effect == Effect::swept) points(result.swept);
    if (effect == Effect::self) counts(result.self.size(), undecidedPairs(result, true));
    const EffectCost& cost = result.cost(effect);
    out << ',' << cost.pairs << ',' << cost.reused << ',' << cost.work.node_pairs << ',' << cost.work.updates() << ','
        << io::numberText(cost.seconds);
  }
  if (sweeps()) out << ',' << result.unswept.size();
  if (moves()) {
    std::size_t touched = 0, stuck = 0, grounded = 0;
    double travelled = 0.0, wanted = 0.0;
    for (const Outcome& outcome : result.outcomes) {
      touched += outcome.touched;
      stuck += outcome.stuck;
      grounded += outcome.grounded;
      travelled += outcome.travelled;
      wanted += outcome.wanted;
    }
    out << ',' << touched << ',' << stuck << ',' << grounded << ',' << io::numberText(travelled) << ','
        << io::numberText(wanted);
  }
  if (bodies_) writeBodyRow(out, done, *bodies_);
  out << '\n';
}

nlohmann::ordered_json toJson(const EffectCost& cost)
{
  return {{"queries", cost.pairs}, {"reused", cost.reused}, {"work", workJson(cost.work)}, {"seconds", cost.seconds}};
}

nlohmann::ordered_json toJson(std::size_t step, const BodiesStep& done, const Scene& scene, const SceneBodies* bodies)
{
  using Json = nlohmann::ordered_json;
  const SceneResult& result = done.scene;
  const Effects& effects = scene.options().effects;
  const Accuracy& accuracy = scene.options().accuracy;
  const bool open = mayBeUndecided(scene);
  const auto names = [&](const PartPair& pair) {
    Json json = {{"a", scene[pair.a].name}, {"b", scene[pair.b].name}};
    if (scene[pair.a].parts.size() > 1) json["part_a"] = scene[pair.a].parts[pair.part_a].name;
    if (scene[pair.b].parts.size() > 1) json["part_b"] = scene[pair.b].parts[pair.part_b].name;
    return json;
  };
  const auto points = [](PointPair pair) { return Json::array({pair.a, pair.b}); };
  const auto flagged = [&](const std::vector<FlaggedPart>& parts) {
    Json list = Json::array();
    for (const FlaggedPart& part : parts)
      list.push_back({{"object", scene[part.object].name},
                      {"part", scene[part.object].parts[part.part].name},
                      {"points", part.colliding}});
    for (std::size_t i = 0; open && i < parts.size(); ++i) list[i]["undecided"] = parts[i].undecided;
    return list;
  };
  Json json = {{"step", step}, {"time", result.time}};
  const auto list = [&](const char* key, const auto& items, const auto& more) {
    json[key] = Json::array();
    for (const auto& item : items) {
      Json entry = names(item);
      more(entry, item);
      json[key].push_back(std::move(entry));
    }
  };
  if (effects.any) list("any", result.any, [&](Json& e, const CollidingPair& pair) { e["pair"] = points(pair.pair); });
  if (open && (effects.any || effects.self)) list("undecided", result.undecided, [](Json&, const PartPair&) {});
  if (effects.flags) json["flags"] = flagged(result.flags);
  if (effects.distance)
    list("distance", result.distance, [&](Json& e, const DistantPair& pair) {
      e["distance"] = pair.distance;
      e["pair"] = points(pair.pair);
      if (!accuracy.isExact() || pair.distance < 0.0) e["interval"] = {pair.interval.lower, pair.interval.upper};
    });
  if (effects.contacts)
    list("contacts", result.contacts, [&](Json& e, const ContactPair& pair) {
      e["complete"] = pair.complete;
      e["points"] = Json::array();
      for (const Contact& contact : pair.contacts)
        e["points"].push_back({{"pair", points(contact.pair)},
                               {"distance", contact.distance},
                               {"normal", {contact.normal[0], contact.normal[1], contact.normal[2]}}});
    });
  if (effects.first_contact) {
    const auto contact_of = [&](Json& e, const PartFirstContact& contact) {
      e["fraction"] = contact.fraction;
      e["pair"] = points(contact.pair);
    };
    list("first_contact", result.first_contact, contact_of);
    if (open) list("certain_contact", result.certain_contact, contact_of);
  }
  if (effects.swept) json["swept"] = flagged(result.swept);
  if (effects.first_contact || effects.swept) {
    json["unswept"] = Json::array();
    for (const UnsweptObject& unswept : result.unswept)
      json["unswept"].push_back({{"object", scene[unswept.object].name},
                                 {"added", unswept.added},
                                 {"reshaped", unswept.reshaped},
                                 {"detoured", unswept.detoured}});
  }
  if (effects.self) {
    json["self"] = Json::array();
    for (const SelfCollision& hit : result.self)
      json["self"].push_back({{"object", scene[hit.object].name},
                              {"part_a", scene[hit.object].parts[hit.part_a].name},
                              {"part_b", scene[hit.object].parts[hit.part_b].name},
                              {"pair", points(hit.pair)}});
  }
  if (effects.response != Response::none || effects.gravity) {
    json["moves"] = Json::array();
    for (const Outcome& outcome : result.outcomes) {
      const Eigen::Vector3d at = scene[outcome.object].pose.translation();
      Json entry = {
          {"object", scene[outcome.object].name}, {"position", {at[0], at[1], at[2]}}, {"wanted", outcome.wanted},
          {"travelled", outcome.travelled},       {"touched", outcome.touched},        {"stuck", outcome.stuck}};
      if (outcome.touched || outcome.stuck) entry["against"] = scene[outcome.against].name;
      if (effects.gravity) entry["grounded"] = outcome.grounded;
      json["moves"].push_back(std::move(entry));
    }
  }
  Json costs = Json::object();
  for (std::size_t e = 0; e < kEffects; ++e)
    if (effects.has(static_cast<Effect>(e))) costs[nameOf(static_cast<Effect>(e))] = toJson(result.costs[e]);
  if (bodies) {
    addBodies(json, *bodies, scene);
    BodyCost cost;
    cost.add(done);
    costs["bodies"] = cost.json();
  }
  json["cost"] = std::move(costs);
  return json;
}

} // namespace pcl_bsh::cli
