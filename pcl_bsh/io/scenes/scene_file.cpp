// SPDX-License-Identifier: BSD-3-Clause
// From a scene's JSON to what it means. Its structure is checked by scene.schema.json.
#include <pcl_bsh/io/scenes/scene_file.h>

#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/json/json_schema.h>
#include <pcl_bsh/io/json/nearest_name.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/scenes/robot_entry.h>
#include <pcl_bsh/io/scenes/scattered_motion.h>
#include <pcl_bsh/io/scenes/scene_clouds.h>
#include <pcl_bsh/io/text/file_bytes.h>

#include "scene.schema.json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace pcl_bsh::io {
namespace {

class SceneParser {
public:
  SceneParser(const Json& json, const std::filesystem::path& path)
  : path_(path),
    name_(path.string()),
    root_(json, name_)
  {
    file_.path = path;
  }

  SceneFile parse()
  {
    static const JsonSchema schema(scene_schema_json);
    schema.check(root_);
    parseOptions();
    if (root_.has("effects")) parseEffects(root_.at("effects"));
    for (const auto& [name, cloud] : root_.at("clouds").members()) {
      file_.clouds.push_back(cloudFrom(cloud, name, path_.parent_path()));
      cloud_names_.push_back(name);
    }
    for (const JsonReader& object : root_.at("objects").elements()) parseObject(object);
    for (const JsonReader& scatter : elementsOf(root_, "scatter")) parseScatter(scatter);
    if (file_.objects.empty()) root_.at("objects").fail("the scene has no objects", "give at least one");
    if (file_.bodies && std::none_of(file_.objects.begin(), file_.objects.end(),
                                     [](const ObjectEntry& object) { return object.body.falls(); }))
      root_.at("effects").at("bodies").fail("no object is a body", "give one a 'body' with its mass or density");
    if (root_.has("effects") && root_.at("effects").has("clashes")) parseClashes(root_.at("effects").at("clashes"));
    if (root_.has("pairs")) parsePairs(root_.at("pairs"));
    if (root_.has("outputs")) parseOutputs(root_.at("outputs"));
    return std::move(file_);
  }

private:
  void parseOptions()
  {
    SceneOptions& options = file_.options;
    options.threads = 0;
    read(root_, "clearance", options.clearance);
    read(root_, "tolerance", options.tolerance);
    read(root_, "voxel_edge", options.voxel_edge);
    readCount(root_, "threads", options.threads);
    if (root_.has("accuracy")) options.accuracy = parseAccuracy(root_.at("accuracy"));
    readCount(root_, "steps", file_.steps);
    read(root_, "dt", file_.dt);
  }

  static Accuracy parseAccuracy(const JsonReader& reader)
  {
    const std::string text = reader.text();
    try {
      return Accuracy::parse(text);
    }
    catch (const std::invalid_argument&) {
      reader.fail("'" + text + "' is no accuracy", "give exact, tolerance=LENGTH, level=N, pairs=N or time=SECONDS");
    }
  }

  void parseEffects(const JsonReader& reader)
  {
    Effects& effects = file_.options.effects;
    read(reader, "any", effects.any);
    read(reader, "flags", effects.flags);
    read(reader, "first_contact", effects.first_contact);
    read(reader, "swept", effects.swept);
    read(reader, "self", effects.self);
    if (reader.has("distance")) {
      const JsonReader distance = reader.at("distance");
      effects.distance = distance.json().is_string() ? std::numeric_limits<double>::infinity() : distance.number();
    }
    if (reader.has("contacts")) readCount(reader, "contacts", effects.contacts.emplace());
    std::string response = "none";
    read(reader, "response", response);
    effects.response = response == "stop" ? Response::stop : response == "slide" ? Response::slide : Response::none;
    if (reader.has("gravity")) {
      const JsonReader gravity = reader.at("gravity");
      effects.gravity = Gravity{};
      read(gravity, "step_height", effects.gravity->step_height);
      if (gravity.has("down")) effects.gravity->down = direction(gravity.at("down"));
    }
    read(reader, "deform", effects.deform);
    if (reader.has("bodies")) parseBodies(reader.at("bodies"));
  }

  void parseBodies(const JsonReader& reader)
  {
    if (const char* const other = effectAgainstBodies(file_.options.effects))
      reader.fail(std::string("does not go with the effect '") + other + "'", "leave one out");
    BodiesOptions& bodies = file_.bodies.emplace();
    read(reader, "gravity", bodies.gravity);
    read(reader, "step", bodies.step);
    read(reader, "thickness", bodies.thickness);
    read(reader, "margin", bodies.margin);
    read(reader, "push", bodies.most_push);
    read(reader, "damping", bodies.damping);
  }

  void parseClashes(const JsonReader& reader)
  {
    SceneClashes& clashes = file_.clashes.emplace();
    const JsonReader of = reader.at("of");
    std::vector<std::string> names;
    for (const ObjectEntry& object : file_.objects) names.push_back(object.name);
    const std::string name = of.oneOf(names);
    clashes.of = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    const ObjectEntry& scan = file_.objects[clashes.of];
    const auto stands = [](const Eigen::Isometry3d& pose) { return pose.matrix().isIdentity(0.0); };
    if (!scan.fixed) of.fail("'" + name + "' is not fixed", "give it \"fixed\": true, or name another object");
    if (scan.parts.size() > 1 || !stands(scan.pose) || !stands(scan.parts[0].pose))
      of.fail("'" + name + "' has parts or a pose, and places are told in its cloud's coordinates",
              "make it one cloud without a pose; its 'shift' may place it");
    if (names.size() < 2) of.fail("there is no other object", "add one");
    if (file_.options.effects.deform) reader.fail("does not go with the effect 'deform'", "leave one out");
    read(reader, "between", clashes.between);
    Question& question = clashes.question;
    read(reader, "seen", question.seen);
    for (const char* const option : {"origin", "seen_angle"})
      if (reader.has(option) && !question.seen) reader.at(option).fail("needs 'seen'", "give \"seen\": true, too");
    read(reader, "seen_angle", question.seen_angle);
    if (!reader.has("origin")) return;
    try {
      question.origin = ScanOrigins::parse(reader.at("origin").text());
    }
    catch (const InvalidInput& error) {
      reader.at("origin").fail(error.wrong(), error.remedy());
    }
  }

  /// The identity where none is given.
  Eigen::Isometry3d poseIn(const JsonReader& reader, const char* key)
  {
    return reader.has(key) ? reader.at(key).pose(file_.warnings) : Eigen::Isometry3d::Identity();
  }

  static Eigen::Vector3d direction(const JsonReader& reader)
  {
    const Eigen::Vector3d v = reader.vector();
    if (!(v.norm() > 0.0)) reader.fail("has length 0", "give a direction");
    return v;
  }

  std::string cloudName(const JsonReader& reader) const
  {
    const std::string name = reader.text();
    if (std::find(cloud_names_.begin(), cloud_names_.end(), name) == cloud_names_.end())
      reader.fail("no cloud is called '" + name + "'",
                  cloud_names_.empty() ? "add it to 'clouds'" : suggestion(name, cloud_names_));
    return name;
  }

  std::string newName(const JsonReader& reader)
  {
    const std::string name = reader.text();
    if (!object_names_.insert(name).second)
      reader.fail("'" + name + "' is taken", "give every object a name of its own");
    return name;
  }

  void parseObject(const JsonReader& reader)
  {
    ObjectEntry object;
    object.name = newName(reader.at("name"));
    if (reader.has("cloud")) object.parts.push_back({object.name, cloudName(reader.at("cloud"))});
    for (const JsonReader& part : elementsOf(reader, "parts")) parsePart(part, object);
    if (reader.has("robot")) object.robot = robotFrom(reader, file_);
    if (reader.has("adjacent")) parseAdjacent(reader.at("adjacent"), object);
    read(reader, "group", object.group);
    object.pose = poseIn(reader, "pose");
    object.place = reader.place();
    read(reader, "fixed", object.fixed);
    read(reader, "solid", object.solid);
    for (PartEntry& part : object.parts) part.solid = object.solid;
    if (reader.has("motion")) object.motion = parseMotion(reader.at("motion"));
    if (object.fixed && !std::holds_alternative<NoMotion>(object.motion))
      reader.fail("is fixed and moves", "leave 'fixed' or 'motion' out");
    parseBody(reader, object);
    if (reader.has("wave")) parseWave(reader.at("wave"), object);
    file_.objects.push_back(std::move(object));
  }

  void parseBody(const JsonReader& reader, ObjectEntry& object) const
  {
    for (const char* key : {"body", "friction", "restitution"})
      if (!file_.bodies && reader.has(key))
        reader.at(key).fail("needs the effect 'bodies'", "add \"bodies\": {} to 'effects'");
    if (!file_.bodies) return;
    SceneBody& body = object.body;
    read(reader, "friction", body.material.friction);
    read(reader, "restitution", body.material.restitution);
    if (reader.has("body")) {
      const JsonReader given = reader.at("body");
      read(given, "mass", body.mass);
      read(given, "density", body.density);
      if (given.has("inertia")) body.inertia = given.at("inertia").vector();
    }
    const bool moves = !std::holds_alternative<NoMotion>(object.motion);
    if (const char* const wrong = wrongWith(body, object.fixed, moves, object.parts.size()))
      reader.fail(wrong, "leave one out");
  }

  void parseWave(const JsonReader& reader, ObjectEntry& object)
  {
    if (!file_.options.effects.deform) reader.fail("needs the effect 'deform'", "add \"deform\": 1.5 to 'effects'");
    object.wave = Wave{reader.at("amplitude").vector(), reader.at("length").number(), reader.at("period").number()};
  }

  void parsePart(const JsonReader& reader, ObjectEntry& object)
  {
    PartEntry part{reader.at("name").text(), cloudName(reader.at("cloud")), poseIn(reader, "pose")};
    for (const PartEntry& other : object.parts)
      if (other.name == part.name) reader.at("name").fail("'" + part.name + "' is taken", "give another name");
    object.parts.push_back(std::move(part));
  }

  void parseAdjacent(const JsonReader& reader, ObjectEntry& object) const
  {
    std::vector<std::string> names;
    for (const PartEntry& part : object.parts) names.push_back(part.name);
    const auto index = [&](const JsonReader& name) {
      name.oneOf(names);
      return static_cast<std::uint32_t>(std::find(names.begin(), names.end(), name.text()) - names.begin());
    };
    for (const JsonReader& pair : reader.elements()) {
      const auto two = pair.elements();
      object.adjacent.emplace_back(index(two[0]), index(two[1]));
    }
  }

  Motion parseMotion(const JsonReader& reader)
  {
    if (reader.has("velocity")) {
      const JsonReader velocity = reader.at("velocity");
      VelocityMotion motion;
      if (velocity.json().is_array()) {
        motion.linear = velocity.vector();
        return motion;
      }
      read(velocity, "linear", motion.linear);
      read(velocity, "angular", motion.angular);
      return motion;
    }
    if (reader.has("circular")) {
      const JsonReader circular = reader.at("circular");
      CircularMotion motion;
      motion.center = circular.at("center").vector();
      if (circular.has("axis")) motion.axis = direction(circular.at("axis"));
      motion.speed = circular.at("speed").number();
      read(circular, "turning", motion.turning);
      return motion;
    }
    if (reader.has("waypoints")) {
      WaypointMotion motion;
      for (const JsonReader& point : reader.at("waypoints").elements()) {
        const double time = point.at("time").number();
        if (!motion.times.empty() && time <= motion.times.back())
          point.at("time").fail("is not later than the one before", "let times ascend");
        motion.times.push_back(time);
        motion.poses.push_back(point.at("pose").pose(file_.warnings));
      }
      return motion;
    }
    return parseTrajectory(reader.at("trajectory"));
  }

  Motion parseTrajectory(const JsonReader& reader)
  {
    const std::filesystem::path file = existingFile(reader.at("file"), path_.parent_path());
    file_.trajectories.push_back(file);
    double interval = file_.dt;
    read(reader, "interval", interval);
    const Eigen::Isometry3d base = poseIn(reader, "base");
    WaypointMotion motion;
    for (const Eigen::Isometry3d& pose : readPoses(file, &file_.warnings)) {
      motion.times.push_back(interval * static_cast<double>(motion.times.size()));
      motion.poses.push_back(nearestRigid(base * pose).pose); // two that are barely rigid may make one that is not
    }
    return motion;
  }

  void parseScatter(const JsonReader& reader)
  {
    const std::string name = newName(reader.at("name")), cloud = cloudName(reader.at("cloud"));
    ScatterBox box{reader.at("low").vector(), reader.at("high").vector()};
    if (!(box.low.array() <= box.high.array()).all())
      reader.at("high").fail("is below 'low'", "give the larger corner");
    std::size_t count = 0;
    std::uint64_t seed = 1;
    readCount(reader, "count", count);
    readCount(reader, "seed", seed);
    read(reader, "speed", box.speed);
    box.duration = file_.dt * static_cast<double>(file_.steps);
    std::string group;
    read(reader, "group", group);
    ScatteredMotions motions(box, seed);
    for (std::size_t i = 0; i < count; ++i) {
      ObjectEntry object;
      object.name = name + " " + std::to_string(i);
      if (!object_names_.insert(object.name).second)
        reader.at("name").fail("'" + object.name + "' is taken", "give another name");
      object.group = group;
      object.parts.push_back({object.name, cloud});
      const auto drift = motions.next(bounces_left_);
      if (!drift)
        reader.fail("bounces more than a million times until the scene ends",
                    "give a smaller 'speed' or 'count', fewer 'steps', a smaller 'dt' or a larger box");
      object.pose = drift->poses.front();
      if (box.speed > 0.0) object.motion = *drift;
      file_.objects.push_back(std::move(object));
    }
  }

  void parsePairs(const JsonReader& reader)
  {
    if (file_.bodies) file_.warnings.push_back("pairs: do not hold for bodies, which touch every object");
    if (reader.has("default")) file_.options.test_pairs = reader.at("default").text() == "tested";
    std::set<std::string> group_set;
    for (const ObjectEntry& object : file_.objects)
      if (!object.group.empty()) group_set.insert(object.group);
    const std::vector<std::string> names(object_names_.begin(), object_names_.end()),
        groups(group_set.begin(), group_set.end());
    for (const JsonReader& element : elementsOf(reader, "rules")) {
      RuleEntry entry;
      entry.of_groups = element.has("groups");
      if (entry.of_groups == element.has("objects"))
        element.fail("has both or none of 'objects' and 'groups'", "give one");
      const JsonReader pair = element.at(entry.of_groups ? "groups" : "objects");
      const auto two = pair.elements();
      const std::vector<std::string>& valid = entry.of_groups ? groups : names;
      if (valid.empty()) pair.fail("no object has a group", "give objects a 'group'");
      entry.a = two[0].oneOf(valid);
      entry.b = two[1].oneOf(valid);
      if (!entry.of_groups && entry.a == entry.b) pair.fail("names one object twice", "give two");
      if (element.has("tested")) entry.rule.tested = element.at("tested").boolean();
      read(element, "clearance", entry.rule.clearance);
      if (!entry.rule.tested && !entry.rule.clearance) element.fail("says nothing", "give 'tested' or 'clearance'");
      file_.rules.push_back(entry);
    }
  }

  void parseOutputs(const JsonReader& reader)
  {
    std::string when = "none";
    read(reader, "clouds", when);
    file_.cloud_output = when == "last" ? CloudOutput::last : when == "every" ? CloudOutput::every : CloudOutput::none;
    if (file_.cloud_output != CloudOutput::none && !file_.options.effects.flags && !file_.options.effects.swept)
      reader.at("clouds").fail("needs the effect 'flags' or 'swept'", "add one of them to 'effects'");
  }

  std::filesystem::path path_;
  std::string name_;
  JsonReader root_;
  SceneFile file_;
  std::vector<std::string> cloud_names_;
  std::set<std::string> object_names_;
  std::size_t bounces_left_ = 1000000; ///< of all scattered objects: each is a pose in memory
};

} // namespace

SceneFile parseScene(const std::string& text, const std::filesystem::path& path)
{
  const Json json = parseJson(text, path.string());
  return SceneParser(json, path).parse();
}

SceneFile readSceneFile(const std::filesystem::path& path)
{
  return parseScene(std::string(FileBytes(path).view()), path);
}

} // namespace pcl_bsh::io
