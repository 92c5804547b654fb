// SPDX-License-Identifier: BSD-3-Clause
// SRDF by pugixml.
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/parse_number.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <pugixml.hpp>

namespace pcl_bsh::io {

namespace {

using robots::Robot;

std::optional<std::size_t> linkOf(const Robot& robot, const std::string& name)
{
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (robot.links[i].name == name) return i;
  return std::nullopt;
}

/// Whether a state has a value for the joint of a link.
bool isVariable(const Robot& robot, std::size_t link)
{
  const std::vector<std::size_t> variables = variablesOf(robot);
  return std::find(variables.begin(), variables.end(), link) != variables.end();
}

class Groups {
public:
  Groups(const pugi::xml_node& root, const Robot& robot) : root_(root), robot_(robot) {}

  /// The joints that a group moves: of its joints, links, chains and other groups.
  std::vector<std::string> jointsOf(const std::string& name, std::size_t depth = 0) const
  {
    std::vector<bool> taken(robot_.links.size(), false);
    const auto take = [&](const std::optional<std::size_t>& link) {
      if (link) taken[*link] = true;
    };
    const pugi::xml_node group = root_.find_child_by_attribute("group", "name", name.c_str());
    for (const pugi::xml_node& part : group.children()) {
      const std::string kind = part.name(), of = part.attribute("name").value();
      if (kind == "joint") take(robot_.linkOfJoint(of));
      if (kind == "link") take(linkOf(robot_, of));
      if (kind == "group" && depth < 16)
        for (const std::string& joint : jointsOf(of, depth + 1)) take(robot_.linkOfJoint(joint));
      if (kind != "chain") continue;
      const auto base = linkOf(robot_, part.attribute("base_link").value());
      for (auto at = linkOf(robot_, part.attribute("tip_link").value()); at && at != base;) {
        take(at);
        const std::optional<robots::Joint>& joint = robot_.links[*at].joint;
        at = joint ? std::optional(joint->parent) : std::nullopt;
      }
    }
    std::vector<std::string> joints;
    for (std::size_t i = 0; i < taken.size(); ++i)
      if (taken[i] && isVariable(robot_, i)) joints.push_back(robot_.links[i].joint->name);
    return joints;
  }

private:
  const pugi::xml_node& root_;
  const Robot& robot_;
};

} // namespace

RobotGroups readGroups(const std::filesystem::path& srdf, Robot& robot)
{
  const FileBytes bytes(srdf);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(bytes.view().data(), bytes.view().size());
  const pugi::xml_node root = document.child("robot");
  if (!parsed) throw files::FileError(srdf, std::string("is no XML: ") + parsed.description(), "mend the SRDF");
  if (!root) throw files::FileError(srdf, "has no element <robot>", "give an SRDF");
  for (const pugi::xml_node& pair : root.children("disable_collisions")) {
    const auto a = linkOf(robot, pair.attribute("link1").value()), b = linkOf(robot, pair.attribute("link2").value());
    if (a && b) robot.disabled_pairs.push_back({*a, *b});
  }
  RobotGroups groups;
  for (const pugi::xml_node& group : root.children("group")) {
    const std::string name = group.attribute("name").value();
    groups.joints[name] = Groups(root, robot).jointsOf(name);
  }
  for (const pugi::xml_node& state : root.children("group_state")) {
    robots::JointValues& values = groups.states[state.attribute("name").value()];
    for (const pugi::xml_node& joint : state.children("joint")) {
      const std::string name = joint.attribute("name").value(), text = joint.attribute("value").value();
      const auto link = robot.linkOfJoint(name);
      if (!link || !isVariable(robot, *link)) continue;
      try {
        values[name] = parseNumber<double>(text);
      }
      catch (const FormatError& error) {
        throw files::FileError(srdf, "joint '" + name + "' of a state: " + error.what(), error.remedy());
      }
    }
  }
  return groups;
}

} // namespace pcl_bsh::io
