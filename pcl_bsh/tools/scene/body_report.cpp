// SPDX-License-Identifier: BSD-3-Clause
#include "body_report.h"

#include <pcl_bsh/tools/cli/json_output.h>

#include <pcl_bsh/io/text/number_text.h>

#include <algorithm>
#include <ostream>

namespace pcl_bsh::cli {
namespace {

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

} // namespace pcl_bsh::cli
