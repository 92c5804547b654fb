// SPDX-License-Identifier: BSD-3-Clause
// URDF by urdfdom. Refuses robots that urdfdom accepts and forward kinematics does not.
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/robots/ros_packages.h>
#include <pcl_bsh/io/robots/surface.h>
#include <pcl_bsh/io/text/file_bytes.h>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <set>

namespace pcl_bsh::io {

namespace {

namespace fs = std::filesystem;
using Packages = std::map<std::string, fs::path>;

/// While it lives, takes the errors that urdfdom would print, and keeps the first. A process has one handler of errors:
/// other threads wait for their turn.
class FirstComplaint : public console_bridge::OutputHandler {
public:
  FirstComplaint() : turn_(turns()) { console_bridge::useOutputHandler(this); }
  ~FirstComplaint() override { console_bridge::restorePreviousOutputHandler(); }
  FirstComplaint(const FirstComplaint&) = delete;
  FirstComplaint& operator=(const FirstComplaint&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override
  {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text_.empty()) text_ = text;
  }

  const std::string& text() const { return text_; }

private:
  static std::mutex& turns()
  {
    static std::mutex one;
    return one;
  }

  const std::lock_guard<std::mutex> turn_;
  std::string text_;
};

Eigen::Vector3d vectorOf(const urdf::Vector3& v)
{
  return {v.x, v.y, v.z};
}

Eigen::Isometry3d poseOf(const urdf::Pose& pose)
{
  const urdf::Rotation& q = pose.rotation;
  return Eigen::Translation3d(vectorOf(pose.position)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

class Reader {
  using Joint = robots::Joint;
  using Link = robots::Link;
  using Robot = robots::Robot;

public:
  Reader(const fs::path& path, const Packages& packages, const std::string& package_path)
  : path_(path),
    packages_(packages),
    package_path_(package_path)
  {
  }

  Robot read()
  {
    const FileBytes bytes(path_);
    FirstComplaint complaint;
    model_ = urdf::parseURDF(std::string(bytes.view()));
    // urdfdom leaves out a body that it cannot read, and goes on: the robot would lack this body
    if (!complaint.text().empty()) fail("is refused by urdfdom: " + complaint.text(), "mend the URDF");
    if (!model_) fail("is no URDF", "mend the URDF");
    requireTree();
    robot_.name = model_->getName();
    add(*model_->getRoot(), 0);
    if (robot_.links.size() != model_->links_.size()) fail(unreached(), "let one joint lead to each link but the root");
    requireMimics();
    return std::move(robot_);
  }

private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const
  {
    throw files::FileError(path_, wrong, remedy);
  }

  void requireTree() const
  {
    std::map<std::string, std::string> parents;
    for (const auto& [name, joint] : model_->joints_) {
      const auto [first, alone] = parents.emplace(joint->child_link_name, name);
      if (!alone)
        fail("link '" + first->first + "' hangs on two joints, '" + first->second + "' and '" + name + "'",
             "let one joint lead to each link but the root");
    }
  }

  /// Adds a link, and the links below it.
  void add(const urdf::Link& from, std::size_t parent)
  {
    Link link;
    link.name = from.name;
    if (from.parent_joint) link.joint = jointOf(*from.parent_joint, parent);
    for (const auto& body : from.collision_array) addShape(link, body->geometry.get(), body->origin);
    if (link.shapes.empty())
      for (const auto& body : from.visual_array) addShape(link, body->geometry.get(), body->origin);
    const std::size_t here = robot_.links.size();
    robot_.links.push_back(std::move(link));
    for (const auto& child : from.child_links) add(*child, here);
  }

  Joint jointOf(const urdf::Joint& from, std::size_t parent) const
  {
    Joint joint;
    joint.name = from.name;
    joint.parent = parent;
    joint.origin = poseOf(from.parent_to_joint_origin_transform);
    switch (from.type) {
    case urdf::Joint::FIXED:
      return joint;
    case urdf::Joint::REVOLUTE:
      joint.kind = Joint::Kind::revolute;
      break;
    case urdf::Joint::CONTINUOUS:
      joint.kind = Joint::Kind::continuous;
      break;
    case urdf::Joint::PRISMATIC:
      joint.kind = Joint::Kind::prismatic;
      break;
    default:
      fail("joint '" + from.name + "' is neither fixed, revolute, continuous nor prismatic",
           "write it as several of these");
    }
    joint.axis = vectorOf(from.axis);
    if (!(joint.axis.norm() > 0.0)) fail("joint '" + from.name + "' has the axis 0 0 0", "give it a direction");
    joint.axis.normalize();
    if (from.limits && joint.kind != Joint::Kind::continuous) {
      joint.lower = from.limits->lower;
      joint.upper = from.limits->upper;
    }
    if (from.mimic) joint.mimic = robots::Mimic{from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
    return joint;
  }

  void addShape(Link& link, const urdf::Geometry* geometry, const urdf::Pose& origin) const
  {
    if (!geometry) fail("link '" + link.name + "' has a body without a geometry", "mend the URDF");
    robots::Shape shape;
    shape.pose = poseOf(origin);
    if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) shape.form = robots::Box{vectorOf(box->dim)};
    if (const auto* tube = dynamic_cast<const urdf::Cylinder*>(geometry))
      shape.form = robots::Cylinder{tube->radius, tube->length};
    if (const auto* ball = dynamic_cast<const urdf::Sphere*>(geometry)) shape.form = robots::Sphere{ball->radius};
    if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(geometry)) {
      const fs::path file = fileOf(mesh->filename, link.name);
      if (!fs::exists(file))
        fail("link '" + link.name + "' has the mesh " + file.string() + ", which is not there", "check the name");
      shape.form = robots::Mesh{file.string(), vectorOf(mesh->scale)};
    }
    link.shapes.push_back(std::move(shape));
  }

  /// `package://NAME/...`, `file://...`, or a path that begins where the URDF is.
  fs::path fileOf(const std::string& name, const std::string& link) const
  {
    constexpr std::string_view package = "package://", file = "file://";
    if (name.starts_with(package)) {
      const std::string rest = name.substr(package.size());
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      const fs::path inside = rest.substr(std::min(slash + 1, rest.size()));
      const auto found = packages_.find(rest.substr(0, slash));
      if (found != packages_.end()) return found->second / inside;
      if (const auto folder = packageIn(package_path_, rest.substr(0, slash))) return *folder / inside;
      fail("link '" + link + "' has a mesh " + name, "say where that package is: --package " + rest.substr(0, slash) +
                                                         "=FOLDER, in Python `packages`, or ROS_PACKAGE_PATH");
    }
    if (name.starts_with(file)) return name.substr(file.size());
    return path_.parent_path() / name;
  }

  void requireMimics() const
  {
    std::map<std::string, const Joint*> joints;
    for (const Link& link : robot_.links)
      if (link.joint) joints[link.joint->name] = &*link.joint;
    for (const auto& [name, joint] : joints) {
      std::set<std::string> seen = {name};
      for (const Joint* at = joint; at->mimic;) {
        const auto next = joints.find(at->mimic->joint);
        if (next == joints.end())
          fail("joint '" + at->name + "' mimics '" + at->mimic->joint + "', which is not there", "mend the name");
        if (!seen.insert(next->first).second)
          fail("joint '" + name + "' mimics itself, by way of '" + at->name + "'",
               "let one of them have its own value");
        at = next->second;
      }
    }
  }

  std::string unreached() const
  {
    std::set<std::string> reached;
    for (const Link& link : robot_.links) reached.insert(link.name);
    for (const auto& [name, link] : model_->links_)
      if (!reached.contains(name)) return "link '" + name + "' hangs on itself: its joints are a cycle";
    return {};
  }

  fs::path path_;
  const Packages& packages_;
  const std::string& package_path_;
  urdf::ModelInterfaceSharedPtr model_;
  Robot robot_;
};

} // namespace

robots::Robot readRobot(const fs::path& urdf, const Packages& packages, const std::string& package_path)
{
  return Reader(urdf, packages, package_path).read();
}

void readMeshes(robots::Robot& robot)
{
  for (robots::Link& link : robot.links)
    for (robots::Shape& shape : link.shapes) {
      auto* const mesh = std::get_if<robots::Mesh>(&shape.form);
      if (!mesh) continue;
      const auto surface = std::make_shared<const Surface>(surfaceOf({*mesh}, 1.0));
      PointsView vertices = viewOf(surface->vertices.front().data(), surface->vertices.size());
      vertices.owner = surface;
      const TrianglesView triangles{vertices, surface->triangles.front().data(), surface->triangles.size()};
      mesh->surface = std::make_shared<const SphereHierarchy>(viewOf(triangles));
    }
}

} // namespace pcl_bsh::io
