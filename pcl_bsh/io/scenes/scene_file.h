// SPDX-License-Identifier: BSD-3-Clause
// Scenes as JSON files: clouds, objects, motions, pairs, effects. examples/scenes/scene.schema.json describes them.
//
//   SceneFile file = readSceneFile("walk.json");
//   SceneWorld world(file);                        // reads the clouds
//   for (std::size_t i = 0; i < file.steps; ++i) report(world.scene().step(file.dt));
#pragma once

#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/physics/scene_bodies.h>
#include <pcl_bsh/question/question.h>
#include <pcl_bsh/scene/scene.h>
#include <pcl_bsh/search/uncertainty.h>

#include <pcl/PCLPointCloud2.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// A cloud of the scene: a file, or points made on the surface of a shape.
struct CloudSource {
  std::string name;
  std::filesystem::path file;        ///< empty for a shape
  std::string shape;                 ///< "sphere", "box" or "cylinder"
  Eigen::Vector3d size = {1, 1, 1};  ///< as shapePoints() takes it
  double spacing = 0.1;              ///< of a shape's points, about
  double scale = 1.0;                ///< of a file's coordinates, about the origin
  Eigen::Vector3d shift = {0, 0, 0}; ///< afterwards
  Uncertainty uncertainty;           ///< of its points; sigmas of a field are scaled with the cloud
  SurfaceSettings surface;           ///< of a file with faces
  ColumnNames columns;               ///< of a file of columns; empty: as it says
  std::shared_ptr<const Mesh> mesh;  ///< of a robot's link, which is neither a file nor a shape
  bool allow_scale = false;          ///< of a .ptx, whose transforms may scale uniformly then
  std::string place;                 ///< in the document

  /// Whether its coordinates are those of the file.
  bool isAsRead() const { return scale == 1.0 && shift.isZero(0.0); }

  /// Returns the name that users know it by.
  std::string text() const { return file.empty() ? "cloud '" + name + "'" : file.string(); }
};

/// A wave that runs through an object's points along x: amplitude * sin(2 pi (x / length - time / period)).
struct Wave {
  Eigen::Vector3d amplitude = {0, 0, 0};
  double length = 1.0;
  double period = 1.0;
};

struct PartEntry {
  std::string name;
  std::string cloud;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool solid = false;
};

/// A robot as the document has it; addRobots() (io/robots/scene_robots.h) reads it.
struct RobotEntry {
  std::filesystem::path urdf, srdf, states; ///< the last two may be empty
  double interval = 0.1;                    ///< seconds from state to state
  std::map<std::string, std::filesystem::path> packages;
  std::string place; ///< in the document
};

struct ObjectEntry {
  std::string name, group;
  std::vector<PartEntry> parts;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool fixed = false;
  bool solid = false; ///< all of its parts are, a robot's meshes included
  Motion motion;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> adjacent;
  SceneBody body;                  ///< with the effect bodies
  std::optional<Wave> wave;        ///< with the effect deform
  std::optional<RobotEntry> robot; ///< whose links are its parts, once it is read
  /// T_object_part of each part at a time; null where parts rest.
  std::function<std::vector<Eigen::Isometry3d>(double time)> part_poses;
  std::string place; ///< in the document
};

struct RuleEntry {
  bool of_groups = false;
  std::string a, b;
  PairRule rule;
};

/// The effect clashes: a list of the places where other objects come too near to one, the scan.
struct SceneClashes {
  std::size_t of = 0;   ///< the scan, among the objects: fixed, one cloud, its points in the scene's frame
  bool between = false; ///< the other objects are compared with each other, too
  Question question;    ///< its options `seen`, `origin` and `seen_angle`
};

/// Which clouds are written, with a field 'collision' of the effect `flags` (or `swept` where that is not listed).
enum class CloudOutput { none, last, every };

struct SceneFile {
  std::filesystem::path path;
  SceneOptions options;
  std::optional<BodiesOptions> bodies; ///< where the effect bodies is listed
  std::optional<SceneClashes> clashes; ///< where the effect clashes is listed
  std::size_t steps = 1;
  double dt = 0.1; ///< seconds
  std::vector<CloudSource> clouds;
  std::vector<std::filesystem::path> trajectories; ///< the files of poses that motions were read from
  std::vector<ObjectEntry> objects;
  std::vector<RuleEntry> rules;
  CloudOutput cloud_output = CloudOutput::none;
  std::vector<std::string> warnings; ///< what its reader should tell the user, a line each

  /// The files that it is made of, and what each is.
  std::vector<std::pair<std::string, std::filesystem::path>> files() const
  {
    std::vector<std::pair<std::string, std::filesystem::path>> all;
    for (const CloudSource& cloud : clouds)
      if (!cloud.file.empty()) all.emplace_back("cloud '" + cloud.name + "'", cloud.file);
    for (const std::filesystem::path& trajectory : trajectories) all.emplace_back("trajectory", trajectory);
    for (const ObjectEntry& object : objects) {
      if (!object.robot) continue;
      for (const std::filesystem::path& file : {object.robot->urdf, object.robot->srdf, object.robot->states})
        if (!file.empty()) all.emplace_back("robot '" + object.name + "'", file);
    }
    return all;
  }
};

/// Reads and checks a scene, but none of its clouds and robots: their files must only exist.
/// @throws JsonError for what the document has wrong, files::FileError for a file that cannot be read
SceneFile readSceneFile(const std::filesystem::path& path);

/// Reads a scene from a text; relative file names are looked for beside `path`.
SceneFile parseScene(const std::string& text, const std::filesystem::path& path);

/// Gives a scene the file's rules about pairs; the objects are there already.
void setRules(Scene& scene, const std::vector<RuleEntry>& rules);

/// The scene itself, and the clouds that its objects consist of.
class SceneWorld {
public:
  /// @param file its robots are read already
  /// @param reading called with the name of each cloud before it is read, if not null
  /// @throws files::FileError, JsonError naming the place in the document
  explicit SceneWorld(const SceneFile& file, const std::function<void(const CloudSource&)>& reading = nullptr);

  Scene& scene() { return *scene_; }

  /// A cloud's points as they were read, scaled and shifted; of a shape, x y z. float32 coordinates have become float64
  /// where float32 cannot hold what scale and shift make of them. A surface gives its vertices.
  const pcl::PCLPointCloud2& cloud(const std::string& name) const { return clouds_.at(name).shape.points(); }
  /// The surface of a cloud with faces; null where it is points.
  const Obstacle* surface(const std::string& name) const
  {
    const Obstacle& found = clouds_.at(name).shape;
    return found.isSurface() ? &found : nullptr;
  }
  /// A cloud as queries ask about it.
  const Obstacle& obstacle(const std::string& name) const { return clouds_.at(name).shape; }
  const CloudFacts& facts(const std::string& name) const { return clouds_.at(name).facts; } ///< of its file
  /// Where the scanners of a cloud stood, scaled and shifted as its points are.
  ScanOrigins origins(const CloudSource& source) const;
  std::size_t points() const;                                            ///< of all clouds; of surfaces, triangles
  const std::vector<std::string>& warnings() const { return warnings_; } ///< of clouds, a line each

  /// Moves robots' links and the points of waving objects to where they are at this time. The constructor moves them to
  /// where they are at 0.
  void setTime(double time);

private:
  struct Loaded {
    Obstacle shape;
    CloudFacts facts;
    std::shared_ptr<SphereHierarchy> hierarchy;
  };
  struct Waving {
    ObjectId object;
    std::uint32_t part;
    Wave wave;
    std::vector<double> rest, now;
  };
  /// A robot.
  struct Jointed {
    ObjectId object;
    std::function<std::vector<Eigen::Isometry3d>(double time)> part_poses;
  };

  void load(const CloudSource& source, const SceneFile& file, Loaded& loaded);

  std::map<std::string, Loaded> clouds_;
  std::vector<std::string> warnings_;
  std::vector<std::unique_ptr<Waving>> waving_;
  std::vector<Jointed> jointed_;
  std::unique_ptr<Scene> scene_;
};

} // namespace pcl_bsh::io
