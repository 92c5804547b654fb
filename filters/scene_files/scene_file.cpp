// SPDX-License-Identifier: BSD-3-Clause
// From a scene's JSON to what it means, key by key.
#include <pcl_bsh/filters/scene_files/scene_file.h>

#include <pcl_bsh/filters/cloud_files/cloud_file_error.h>
#include <pcl_bsh/filters/cloud_files/file_bytes.h>
#include <pcl_bsh/filters/json/json_reader.h>
#include <pcl_bsh/filters/json/nearest_name.h>
#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/filters/pose_files/rigid_pose.h>
#include <pcl_bsh/filters/scene_files/shape_points.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace pcl_bsh::io {
namespace {

constexpr double kMostPoints = 1e8;           // of a shape
constexpr double kMostObjects = 1e6;          // of a scene
constexpr double kSmallest = 1e-300;          // stands for "more than 0"
constexpr std::size_t kMostBounces = 1000000; // of all that is scattered: each is a pose in memory

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
    root_.requireKeys({"$schema", "comment", "clouds", "objects", "scatter", "pairs", "effects", "clearance",
                       "tolerance", "accuracy", "voxel_edge", "threads", "steps", "dt", "outputs"});
    parseOptions();
    if (root_.has("effects")) parseEffects(root_.at("effects"));
    for (const auto& [name, cloud] : root_.at("clouds").members()) parseCloud(name, cloud);
    for (const JsonReader& object : root_.at("objects").elements()) parseObject(object);
    if (root_.has("scatter"))
      for (const JsonReader& scatter : root_.at("scatter").elements()) parseScatter(scatter);
    if (file_.objects.empty()) root_.at("objects").fail("the scene has no objects", "give at least one");
    if (root_.has("pairs")) parsePairs(root_.at("pairs"));
    if (root_.has("outputs")) parseOutputs(root_.at("outputs"));
    return std::move(file_);
  }

private:
  void parseOptions()
  {
    SceneOptions& options = file_.options;
    options.threads = 0;
    if (root_.has("clearance")) options.clearance = root_.at("clearance").number(0);
    if (root_.has("tolerance")) options.tolerance = root_.at("tolerance").number(kSmallest);
    if (root_.has("voxel_edge")) options.voxel_edge = root_.at("voxel_edge").number(0);
    if (root_.has("threads")) options.threads = static_cast<unsigned>(root_.at("threads").whole(0, 1024));
    if (root_.has("accuracy")) options.accuracy = parseAccuracy(root_.at("accuracy"));
    if (root_.has("steps")) file_.steps = root_.at("steps").whole(0, 1000000000);
    if (root_.has("dt")) file_.dt = root_.at("dt").number(kSmallest);
  }

  static Accuracy parseAccuracy(const JsonReader& reader)
  {
    const std::string text = reader.text();
    try {
      return Accuracy::parse(text);
    }
    catch (const std::invalid_argument&) {
      reader.fail("'" + text + "' is no accuracy",
                  "give exact, float, tolerance=LENGTH, level=N, pairs=N or time=SECONDS");
    }
  }

  void parseEffects(const JsonReader& reader)
  {
    reader.requireKeys(
        {"any", "flags", "distance", "contacts", "first_contact", "swept", "self", "response", "gravity", "deform"});
    Effects& effects = file_.options.effects;
    const auto flag = [&](const char* key, bool& target) {
      if (reader.has(key)) target = reader.at(key).boolean();
    };
    flag("any", effects.any);
    flag("flags", effects.flags);
    flag("first_contact", effects.first_contact);
    flag("swept", effects.swept);
    flag("self", effects.self);
    if (reader.has("distance")) {
      const JsonReader distance = reader.at("distance");
      if (distance.json().is_string())
        distance.oneOf({"all"}), effects.distance = std::numeric_limits<double>::infinity();
      else
        effects.distance = distance.number(0);
    }
    if (reader.has("contacts")) effects.contacts = reader.at("contacts").whole(1, 1000000000);
    if (reader.has("response")) {
      const std::string response = reader.at("response").oneOf({"none", "stop", "slide"});
      effects.response = response == "stop" ? Response::stop : response == "slide" ? Response::slide : Response::none;
    }
    if (reader.has("gravity")) {
      const JsonReader gravity = reader.at("gravity");
      gravity.requireKeys({"step_height", "down"});
      effects.gravity = Gravity{};
      if (gravity.has("step_height")) effects.gravity->step_height = gravity.at("step_height").number(kSmallest);
      if (gravity.has("down")) effects.gravity->down = direction(gravity.at("down"));
    }
    if (reader.has("deform")) effects.deform = reader.at("deform").number(1);
  }

  static Eigen::Vector3d direction(const JsonReader& reader)
  {
    const Eigen::Vector3d v = reader.vector();
    if (!(v.norm() > 0.0)) reader.fail("has length 0", "give a direction");
    return v;
  }

  void parseCloud(const std::string& name, const JsonReader& reader)
  {
    CloudSource cloud;
    cloud.name = name;
    cloud.place = reader.place();
    if (reader.json().is_string()) {
      cloud.file = existing(reader);
    }
    else {
      reader.requireKeys({"file", "scale", "shift", "sphere", "box", "cylinder", "spacing"});
      for (const char* shape : {"sphere", "box", "cylinder"})
        if (reader.has(shape)) {
          if (!cloud.shape.empty()) reader.fail("is both a " + cloud.shape + " and a " + shape, "give one of them");
          cloud.shape = shape;
        }
      if (cloud.shape.empty() == !reader.has("file"))
        reader.fail("is neither or both of a file and a shape", "give 'file', 'sphere', 'box' or 'cylinder'");
      if (reader.has("file")) cloud.file = existing(reader.at("file"));
      if (reader.has("scale")) cloud.scale = reader.at("scale").number(kSmallest);
      if (reader.has("shift")) cloud.shift = reader.at("shift").vector();
      if (!cloud.shape.empty()) parseShape(reader, cloud);
    }
    file_.clouds.push_back(cloud);
    cloud_names_.push_back(name);
  }

  static void parseShape(const JsonReader& reader, CloudSource& cloud)
  {
    const JsonReader shape = reader.at(cloud.shape.c_str());
    if (cloud.shape == "sphere") {
      shape.requireKeys({"radius"});
      cloud.size.setConstant(shape.at("radius").number(kSmallest));
    }
    else if (cloud.shape == "box") {
      shape.requireKeys({"size"});
      cloud.size = shape.at("size").vector();
      if (!(cloud.size.array() > 0).all()) shape.at("size").fail("has an edge that is not > 0", "give three lengths");
    }
    else {
      shape.requireKeys({"radius", "height", "open"});
      cloud.size = {shape.at("radius").number(kSmallest), shape.at("height").number(kSmallest), 0};
      if (shape.has("open") && shape.at("open").boolean()) cloud.size[2] = 1;
    }
    if (reader.has("spacing")) cloud.spacing = reader.at("spacing").number(kSmallest);
    if (!(shapePointCount(cloud.shape, cloud.size, cloud.spacing) <= kMostPoints))
      reader.fail("would have more than 1e8 points", "give a larger 'spacing'");
  }

  std::filesystem::path existing(const JsonReader& reader) const
  {
    const std::filesystem::path given = reader.text();
    const std::filesystem::path file = given.is_absolute() ? given : path_.parent_path() / given;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) reader.fail("no such file: " + file.string(), "check the name");
    if (std::filesystem::is_directory(file, error)) reader.fail(file.string() + " is a folder", "name a file");
    return file;
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
    reader.requireKeys({"name", "cloud", "parts", "adjacent", "group", "pose", "fixed", "motion", "wave"});
    ObjectEntry object;
    object.name = newName(reader.at("name"));
    if (reader.has("cloud") == reader.has("parts")) reader.fail("has both or none of 'cloud' and 'parts'", "give one");
    if (reader.has("cloud")) object.parts.push_back({object.name, cloudName(reader.at("cloud")), {}});
    if (reader.has("cloud")) object.parts.back().pose.setIdentity();
    if (reader.has("parts")) parseParts(reader.at("parts"), object);
    if (reader.has("adjacent")) parseAdjacent(reader.at("adjacent"), object);
    if (reader.has("group")) object.group = reader.at("group").text();
    if (reader.has("pose")) object.pose = reader.at("pose").pose(file_.warnings);
    if (reader.has("fixed")) object.fixed = reader.at("fixed").boolean();
    if (reader.has("motion")) object.motion = parseMotion(reader.at("motion"));
    if (object.fixed && !std::holds_alternative<NoMotion>(object.motion))
      reader.fail("is fixed and moves", "leave 'fixed' or 'motion' out");
    if (reader.has("wave")) parseWave(reader.at("wave"), object);
    file_.objects.push_back(std::move(object));
  }

  void parseWave(const JsonReader& reader, ObjectEntry& object)
  {
    reader.requireKeys({"amplitude", "length", "period"});
    if (!file_.options.effects.deform) reader.fail("needs the effect 'deform'", "add \"deform\": 1.5 to 'effects'");
    object.wave = Wave{};
    object.wave->amplitude = reader.at("amplitude").vector();
    object.wave->length = reader.at("length").number(kSmallest);
    object.wave->period = reader.at("period").number(kSmallest);
  }

  void parseParts(const JsonReader& reader, ObjectEntry& object)
  {
    for (const JsonReader& element : reader.elements()) {
      element.requireKeys({"name", "cloud", "pose"});
      PartEntry part{element.at("name").text(), cloudName(element.at("cloud")), Eigen::Isometry3d::Identity()};
      if (element.has("pose")) part.pose = element.at("pose").pose(file_.warnings);
      for (const PartEntry& other : object.parts)
        if (other.name == part.name) element.at("name").fail("'" + part.name + "' is taken", "give another name");
      object.parts.push_back(std::move(part));
    }
    if (object.parts.empty()) reader.fail("is empty", "give at least one part");
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
      if (two.size() != 2) pair.fail("is no pair", "give the names of two parts");
      object.adjacent.emplace_back(index(two[0]), index(two[1]));
    }
  }

  Motion parseMotion(const JsonReader& reader)
  {
    if (!reader.json().is_object() || reader.json().size() != 1)
      reader.fail("is not one motion", "give { \"velocity\" | \"circular\" | \"waypoints\" | \"trajectory\": ... }");
    reader.requireKeys({"velocity", "circular", "waypoints", "trajectory"});
    if (reader.has("velocity")) {
      const JsonReader velocity = reader.at("velocity");
      VelocityMotion motion;
      if (velocity.json().is_array()) {
        motion.linear = velocity.vector();
        return motion;
      }
      velocity.requireKeys({"linear", "angular"});
      if (velocity.has("linear")) motion.linear = velocity.at("linear").vector();
      if (velocity.has("angular")) motion.angular = velocity.at("angular").vector();
      return motion;
    }
    if (reader.has("circular")) {
      const JsonReader circular = reader.at("circular");
      circular.requireKeys({"center", "axis", "speed", "turning"});
      CircularMotion motion;
      motion.center = circular.at("center").vector();
      if (circular.has("axis")) motion.axis = direction(circular.at("axis"));
      motion.speed = circular.at("speed").number();
      if (circular.has("turning")) motion.turning = circular.at("turning").boolean();
      return motion;
    }
    if (reader.has("waypoints")) {
      WaypointMotion motion;
      for (const JsonReader& point : reader.at("waypoints").elements()) {
        point.requireKeys({"time", "pose"});
        const double time = point.at("time").number();
        if (!motion.times.empty() && time <= motion.times.back())
          point.at("time").fail("is not later than the one before", "let times ascend");
        motion.times.push_back(time);
        motion.poses.push_back(point.at("pose").pose(file_.warnings));
      }
      if (motion.poses.empty()) reader.at("waypoints").fail("is empty", "give at least one { \"time\", \"pose\" }");
      return motion;
    }
    return parseTrajectory(reader.at("trajectory"));
  }

  Motion parseTrajectory(const JsonReader& reader)
  {
    reader.requireKeys({"file", "interval", "base"});
    const std::filesystem::path file = existing(reader.at("file"));
    const double interval = reader.has("interval") ? reader.at("interval").number(kSmallest) : file_.dt;
    const Eigen::Isometry3d base =
        reader.has("base") ? reader.at("base").pose(file_.warnings) : Eigen::Isometry3d::Identity();
    WaypointMotion motion;
    for (const Eigen::Isometry3d& pose : readPoses(file, &file_.warnings)) {
      motion.times.push_back(interval * static_cast<double>(motion.times.size()));
      motion.poses.push_back(nearestRigid(base * pose).pose); // two that are barely rigid may make one that is not
    }
    return motion;
  }

  /// Many copies of a cloud at random places in a box, drifting and thrown back by its sides.
  void parseScatter(const JsonReader& reader)
  {
    reader.requireKeys({"name", "cloud", "count", "low", "high", "speed", "seed", "group"});
    const std::string name = newName(reader.at("name")), cloud = cloudName(reader.at("cloud"));
    const std::size_t count = reader.at("count").whole(1, static_cast<std::uint64_t>(kMostObjects));
    const Eigen::Vector3d low = reader.at("low").vector(), high = reader.at("high").vector();
    if (!(low.array() <= high.array()).all()) reader.at("high").fail("is below 'low'", "give the larger corner");
    const double speed = reader.has("speed") ? reader.at("speed").number(0) : 0.0;
    std::mt19937_64 engine(reader.has("seed") ? reader.at("seed").whole(0, 1ull << 53) : 1);
    const auto uniform = [&] { return std::ldexp(static_cast<double>(engine() >> 11), -53); };
    for (std::size_t i = 0; i < count; ++i) {
      ObjectEntry object;
      object.name = name + " " + std::to_string(i);
      if (!object_names_.insert(object.name).second)
        reader.at("name").fail("'" + object.name + "' is taken", "give another name");
      if (reader.has("group")) object.group = reader.at("group").text();
      object.parts.push_back({object.name, cloud, Eigen::Isometry3d::Identity()});
      Eigen::Vector3d place, velocity;
      for (int k = 0; k < 3; ++k) {
        place[k] = low[k] + uniform() * (high[k] - low[k]);
        velocity[k] = speed * (2.0 * uniform() - 1.0);
      }
      object.pose.translation() = place;
      if (speed > 0.0) object.motion = drift(place, velocity, low, high, reader);
      file_.objects.push_back(std::move(object));
    }
  }

  /// As long as the scene lasts.
  WaypointMotion drift(Eigen::Vector3d place, Eigen::Vector3d velocity, const Eigen::Vector3d& low,
                       const Eigen::Vector3d& high, const JsonReader& reader)
  {
    WaypointMotion motion;
    const double end = file_.dt * static_cast<double>(file_.steps);
    double time = 0.0;
    for (;;) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = place;
      motion.times.push_back(time);
      motion.poses.push_back(pose);
      if (time >= end) return motion;
      double free = end - time; // until the first side, or the end
      int side = -1;
      for (int k = 0; k < 3; ++k) {
        if (velocity[k] == 0.0) continue;
        const double until = ((velocity[k] > 0.0 ? high[k] : low[k]) - place[k]) / velocity[k];
        if (until >= free) continue;
        free = until;
        side = k;
      }
      place = (place + free * velocity).cwiseMax(low).cwiseMin(high);
      if (side >= 0) velocity[side] = -velocity[side];
      if (side >= 0 && ++bounces_ > kMostBounces)
        reader.fail("bounces more than a million times until the scene ends",
                    "give a smaller 'speed' or 'count', fewer 'steps', a smaller 'dt' or a larger box");
      if (!(free > 1e-9)) { // caught in a corner or between sides that touch
        velocity.setZero();
        free = end - time;
      }
      time += free;
    }
  }

  void parsePairs(const JsonReader& reader)
  {
    reader.requireKeys({"default", "rules"});
    if (reader.has("default")) file_.options.test_pairs = reader.at("default").oneOf({"tested", "ignored"}) == "tested";
    if (!reader.has("rules")) return;
    std::set<std::string> group_set;
    for (const ObjectEntry& object : file_.objects)
      if (!object.group.empty()) group_set.insert(object.group);
    const std::vector<std::string> names(object_names_.begin(), object_names_.end()),
        groups(group_set.begin(), group_set.end());
    for (const JsonReader& element : reader.at("rules").elements()) {
      element.requireKeys({"objects", "groups", "tested", "clearance"});
      RuleEntry entry;
      entry.of_groups = element.has("groups");
      if (entry.of_groups == element.has("objects"))
        element.fail("has both or none of 'objects' and 'groups'", "give one");
      const JsonReader pair = element.at(entry.of_groups ? "groups" : "objects");
      const auto two = pair.elements();
      if (two.size() != 2) pair.fail("is no pair", "give two names");
      const std::vector<std::string>& valid = entry.of_groups ? groups : names;
      if (valid.empty()) pair.fail("no object has a group", "give objects a 'group'");
      entry.a = two[0].oneOf(valid);
      entry.b = two[1].oneOf(valid);
      if (!entry.of_groups && entry.a == entry.b) pair.fail("names one object twice", "give two");
      if (element.has("tested")) entry.rule.tested = element.at("tested").boolean();
      if (element.has("clearance")) entry.rule.clearance = element.at("clearance").number(0);
      if (!entry.rule.tested && !entry.rule.clearance) element.fail("says nothing", "give 'tested' or 'clearance'");
      file_.rules.push_back(entry);
    }
  }

  void parseOutputs(const JsonReader& reader)
  {
    reader.requireKeys({"clouds"});
    if (!reader.has("clouds")) return;
    const std::string when = reader.at("clouds").oneOf({"none", "last", "every"});
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
  std::size_t bounces_ = 0; ///< of all scattered objects so far
};

} // namespace

SceneFile parseScene(const std::string& text, const std::filesystem::path& path)
{
  const Json json = parseJson(text, path.string());
  return SceneParser(json, path).parse();
}

SceneFile readSceneFile(const std::filesystem::path& path)
{
  const FileBytes bytes(path);
  return parseScene(std::string(bytes.view()), path);
}

} // namespace pcl_bsh::io
