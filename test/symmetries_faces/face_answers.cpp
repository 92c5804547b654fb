// SPDX-License-Identifier: BSD-3-Clause
#include "face_answers.h"

#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/filters/mesh_collision_filter.h>
#include <pcl_bsh/filters/pipeline/pipeline.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/site/ask_site.h>
#include <pcl_bsh/site/make_site.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

namespace pcl_bsh::symmetries {
namespace {

using Cloud = pcl::PCLPointCloud2;

std::shared_ptr<Cloud> cloudOf(const Body& body)
{
  auto cloud = std::make_shared<Cloud>();
  const bool wide = body.scalar == Scalar::float64;
  for (const char* axis : {"x", "y", "z"})
    io::addField(*cloud, axis, wide ? pcl::PCLPointField::FLOAT64 : pcl::PCLPointField::FLOAT32);
  io::allocate(*cloud, static_cast<std::uint32_t>(body.points.size()));
  std::uint8_t* to = cloud->data.data();
  for (const Point3& p : body.points)
    for (const double x : p) {
      const auto narrow = static_cast<float>(x);
      if (wide)
        std::memcpy(to, &x, sizeof x);
      else
        std::memcpy(to, &narrow, sizeof narrow);
      to += wide ? sizeof x : sizeof narrow;
    }
  return cloud;
}

/// @throws std::runtime_error where there is no such field
template <class Value>
std::vector<Value> fieldOf(const Cloud& cloud, const std::string& name)
{
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == name) {
      std::vector<Value> values(cloud.width * cloud.height);
      for (std::size_t i = 0; i < values.size(); ++i)
        std::memcpy(&values[i], &cloud.data[i * cloud.point_step + field.offset], sizeof(Value));
      return values;
    }
  throw std::runtime_error("there is no field " + name);
}

std::shared_ptr<pcl::PolygonMesh> meshOf(const Body& body, const std::vector<Triangle>& faces)
{
  auto mesh = std::make_shared<pcl::PolygonMesh>();
  mesh->cloud = *cloudOf(body);
  for (const Triangle& face : faces) {
    mesh->polygons.emplace_back();
    for (const std::uint32_t corner : face) mesh->polygons.back().vertices.push_back(static_cast<pcl::index_t>(corner));
  }
  return mesh;
}

/// The 16 numbers of a pose, which read back as they are.
std::string numbersOf(const Eigen::Isometry3d& pose, const char* between)
{
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  for (Eigen::Index k = 0; k < 16; ++k) text << (k == 0 ? "" : between) << pose.matrix()(k / 4, k % 4);
  return text.str();
}

std::string textOf(double number)
{
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << number;
  return text.str();
}

void quiet(QuestionFilter& filter)
{
  filter.setWarn([](const std::string&) {});
}

} // namespace

Answers askFilters(const Instance& instance)
{
  const auto a = cloudOf(instance.a), b = cloudOf(instance.b);
  Answers told;
  CollisionFilter<Cloud> collides;
  quiet(collides);
  collides.setInputCloud(a);
  collides.setObstacleCloud(b);
  collides.setClearance(instance.clearance);
  collides.setNumberOfThreads(instance.threads);
  collides.setPose(instance.relative.front());
  std::vector<Verdict> flags;
  collides.computeFlags(flags);
  told.asked_flags = pcl_bsh::numbersOf(flags);
  collides.setNegative(true); // those that collide
  pcl::Indices kept;
  collides.filter(kept);
  std::vector<std::uint8_t> colliding(flags.size(), 0);
  for (const pcl::index_t record : kept) colliding[static_cast<std::size_t>(record)] = 1;
  if (colliding != told.asked_flags) throw std::runtime_error("what filter() keeps is not what computeFlags() tells");
  collides.setTrajectory(instance.relative);
  TrajectoryResult along;
  collides.computeTrajectory(along);
  told.asked_path_flags = pcl_bsh::numbersOf(along.flags);
  told.first_poses = along.first_pose;

  DistanceFilter<Cloud> measures;
  quiet(measures);
  measures.setInputCloud(a);
  measures.setObstacleCloud(b);
  measures.setPose(instance.relative.front());
  measures.setFilterLimits(instance.clearance / 2, 2 * instance.clearance);
  PointDistances distances;
  measures.computeDistances(distances);
  told.asked_distances.assign(distances.distance.begin(), distances.distance.end());
  measures.filter(kept);
  told.asked_within.assign(instance.a.points.size(), 0);
  for (const pcl::index_t record : kept) told.asked_within[static_cast<std::size_t>(record)] = 1;

  for (const bool solid : {false, true}) {
    const std::vector<Triangle>& faces = solid ? instance.shell : instance.faces;
    if (faces.empty()) continue;
    Answers::Surface& surface = solid ? told.shell : told.surface;
    const auto mesh = meshOf(instance.b, faces);
    CollisionFilter<Cloud> near_faces;
    quiet(near_faces);
    near_faces.setInputCloud(a);
    near_faces.setObstacleSurface(mesh);
    near_faces.setObstacleSolid(solid);
    near_faces.setClearance(instance.clearance);
    near_faces.setPose(instance.relative.front());
    near_faces.computeFlags(flags);
    surface.flags = pcl_bsh::numbersOf(flags);
    MeshCollisionFilter colliding_faces; // in b's frame: only where the pose's inverse is as exact
    quiet(colliding_faces);
    colliding_faces.setInputMesh(mesh);
    colliding_faces.setObstacleCloud(b);
    colliding_faces.setClearance(instance.clearance);
    colliding_faces.computeFlags(flags);
    surface.face_flags = pcl_bsh::numbersOf(flags);
  }
  return told;
}

Answers askPipelines(const Instance& instance)
{
  const auto ask = [&](const std::string& stage) {
    Pipeline pipeline =
        Pipeline::parse(R"({"pipeline": [{"type": "readers.pcd", "tag": "b", "filename": "b.pcd"},)"
                        R"({"type": "readers.pcd", "tag": "a", "filename": "a.pcd"}, {"obstacle": "b", "pose": [)" +
                        numbersOf(instance.relative.front(), ", ") +
                        "], \"number_of_threads\": " + std::to_string(instance.threads) + ", " + stage + "}]}");
    for (const auto& [tag, body] : {std::pair("a", &instance.a), std::pair("b", &instance.b)}) {
      auto cloud = std::make_shared<pipeline::StageCloud>();
      cloud->cloud = *cloudOf(*body);
      pipeline.setCloud(tag, cloud);
    }
    return pipeline.run().clouds.begin()->second;
  };
  Answers told;
  told.asked_flags = fieldOf<std::uint8_t>(
      ask(R"("type": "filters.bsh_flag", "clearance": )" + textOf(instance.clearance))->cloud, "collision");
  told.asked_distances = fieldOf<float>(ask(R"("type": "filters.bsh_distance")")->cloud, "distance");
  return told;
}

Answers askSite(const Instance& instance, const std::filesystem::path& folder, std::uint64_t tile_points)
{
  static int made = 0;
  const std::filesystem::path place = folder / std::to_string(made++);
  std::filesystem::create_directories(place);
  io::writeCloud(place / "a.pcd", *cloudOf(instance.a));
  site::MakeOptions options;
  options.tile_points = tile_points;
  options.overview_points = 0;
  options.threads = 1;
  const site::Site whole = site::makeSite({place / "a.pcd"}, place / "site", options);
  const test::Cloud cloud_b = instance.b.cloud();
  Shape obstacle("b", cloud_b.view());
  Question question;
  question.pose = instance.relative.front();
  question.clearance = instance.clearance;
  Wanted& wanted = question.wanted;
  wanted.flags = wanted.obstacle_flags = wanted.any = wanted.distances = wanted.closest = true;

  Answers told;
  const std::size_t count = instance.a.points.size();
  told.asked_flags.assign(count, 0);
  told.asked_distances.assign(count, std::numeric_limits<float>::quiet_NaN());
  told.asked_path_flags.assign(count, 0);
  told.first_poses.assign(count, -1);
  site::SiteMeans means;
  means.receiver = [&](const site::Tile&, const Cloud& cloud, const Answer& found) {
    const auto of = fieldOf<std::uint32_t>(cloud, site::record_field_name);
    const std::vector<Verdict>& flags = found.collisions.flags;
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (question.path) {
        told.asked_path_flags[of[i]] = static_cast<std::uint8_t>(flags[i]);
        told.first_poses[of[i]] = found.collisions.first_pose[i];
      }
      else if (!flags.empty()) {
        told.asked_flags[of[i]] = static_cast<std::uint8_t>(flags[i]);
      }
      else {
        told.asked_distances[of[i]] = static_cast<float>(found.distances.a.distance[i]);
      }
    }
  };
  const site::SiteAnswer answer = site::ask(question, whole, obstacle, means);
  told.asked_obstacle_flags = pcl_bsh::numbersOf(answer.obstacle_flags);
  const bool any = answer.any.verdict == Verdict::colliding;
  if (any != (answer.collisions.colliding > 0))
    throw std::runtime_error("any collision of the site is not that of its flags");
  told.asked_closest = answer.closest.distance;
  question.path = instance.relative;
  wanted = {};
  wanted.contacts = true;
  site::ask(question, whole, obstacle, means);
  std::filesystem::remove_all(place);
  return told;
}

Answers askProgram(const Instance& instance, const std::filesystem::path& folder)
{
  io::writeCloud(folder / "a.pcd", *cloudOf(instance.a));
  io::writeCloud(folder / "b.pcd", *cloudOf(instance.b));
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text << '\n'; };
  write("pose.txt", numbersOf(instance.relative.front(), " "));
  const auto ask = [&](const std::string& obstacle, const std::string& options) {
    const std::string command = "'" PCL_BSH_PROGRAM_DIR "/pcl_bsh_collide' '" + folder.string() + "/a.pcd' '" +
                                folder.string() + "/" + obstacle + "' '" + folder.string() + "/out.pcd' --clearance " +
                                textOf(instance.clearance) + " --pose '" + folder.string() + "/pose.txt' " + options +
                                " >'" + folder.string() + "/said.txt' 2>&1";
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    return io::readCloud(folder / "out.pcd");
  };
  Answers told;
  const Cloud of_points = ask("b.pcd", "--distances");
  told.asked_flags = fieldOf<std::uint8_t>(of_points, "collision");
  told.asked_distances = fieldOf<float>(of_points, "distance");
  for (const bool solid : {false, true}) {
    const std::vector<Triangle>& faces = solid ? instance.shell : instance.faces;
    if (faces.empty()) continue;
    io::writeMesh(folder / "b.ply", *cloudOf(instance.b), faces);
    const Cloud found = ask("b.ply", solid ? "--distances --solid" : "--distances");
    Answers::Surface& surface = solid ? told.shell : told.surface;
    surface.flags = fieldOf<std::uint8_t>(found, "collision");
    surface.distances = fieldOf<float>(found, "distance");
  }
  return told;
}

} // namespace pcl_bsh::symmetries
