// SPDX-License-Identifier: BSD-3-Clause
// From a scene file to the scene: clouds are read, hierarchies made, objects placed.
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/scenes/scene_clouds.h>
#include <pcl_bsh/io/scenes/scene_file.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/question/warnings/scene_warnings.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace pcl_bsh::io {
namespace {

pcl::PCLPointCloud2 cloudOf(const std::vector<float>& xyz)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) addField(cloud, name, pcl::PCLPointField::FLOAT32);
  allocate(cloud, static_cast<std::uint32_t>(xyz.size() / 3));
  std::memcpy(cloud.data.data(), xyz.data(), xyz.size() * sizeof(float));
  cloud.is_dense = true;
  return cloud;
}

Point3 placed(const Point3& p, const CloudSource& source)
{
  Point3 at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = source.scale * p[k] + source.shift[static_cast<Eigen::Index>(k)];
  return at;
}

/// @param p finite
bool fitsFloat(const Point3& p)
{
  const auto fits = [](double x) { return static_cast<double>(roundToFloat(x)) == x; };
  return fits(p[0]) && fits(p[1]) && fits(p[2]);
}

void write(pcl::PCLPointCloud2& cloud, const PointsView& view, std::size_t i, const Point3& p)
{
  for (std::size_t k = 0; k < 3; ++k) {
    std::uint8_t* const at = cloud.data.data() + i * view.stride + view.offset[k];
    const float narrow = roundToFloat(p[k]);
    if (view.scalar == Scalar::float32)
      std::memcpy(at, &narrow, sizeof narrow);
    else
      std::memcpy(at, &p[k], sizeof(double));
  }
}

/// Nothing is rounded to float32: the cloud gets float64 coordinates where they are needed.
void scaleAndShift(pcl::PCLPointCloud2& cloud, const CloudSource& source, const std::string& file)
{
  if (source.isAsRead()) return;
  PointsView view = viewOf(cloud);
  bool fits = true;
  for (std::uint32_t i = 0; i < view.count; ++i) {
    const Point3 p = view.point(i);
    if (!isFinite(p)) continue;
    const Point3 at = placed(p, source);
    if (!isFinite(at))
      throw JsonError(file, source.place, "scale and shift take point " + std::to_string(i) + " beyond all numbers",
                      "give smaller ones");
    fits = fits && fitsFloat(at);
  }
  if (view.scalar == Scalar::float32 && !fits) {
    makeCoordinatesDouble(cloud);
    view = viewOf(cloud);
  }
  for (std::uint32_t i = 0; i < view.count; ++i) write(cloud, view, i, placed(view.point(i), source));
}

PointsView uncertainView(const PointsView& view, const std::vector<pcl::PCLPointField>& fields,
                         const CloudSource& source, const std::string& file)
{
  try {
    return withUncertainty(view, fields, "cloud '" + source.name + "'", source.uncertainty);
  }
  catch (const InvalidInput& error) {
    throw JsonError(file, source.place + ".uncertainty", error.wrong(), error.remedy());
  }
}

/// A view of a cloud's moved points, with the uncertainties of the measured ones. The cloud's own hierarchy keeps these
/// alive.
PointsView movedView(const std::vector<double>& now, const PointsView& measured)
{
  PointsView view = viewOf(now.data(), now.size() / 3);
  view.uncertainty = measured.uncertainty;
  view.uncertainties = measured.uncertainties;
  return view;
}

std::vector<double> coordinatesOf(const PointsView& view)
{
  std::vector<double> xyz;
  xyz.reserve(3 * view.count);
  for (std::uint32_t i = 0; i < view.count; ++i)
    for (const double x : view.point(i)) xyz.push_back(x);
  return xyz;
}

Obstacle shapeOf(Mesh mesh, const CloudSource& source, const SceneFile& file)
{
  const auto vertices = std::make_shared<const pcl::PCLPointCloud2>(std::move(mesh.vertices));
  const auto triangles = std::make_shared<const std::vector<Triangle>>(std::move(mesh.triangles));
  try {
    return Obstacle(vertices, triangles, source.surface);
  }
  catch (const InvalidInput& error) {
    throw JsonError(file.path.string(), source.place, error.wrong(), error.remedy());
  }
}

/// A shape with a hierarchy of its own, because the hierarchy of the scene is built only where effects need it.
Shape namedShape(const CloudSource& source, const PointsView& view)
{
  return Shape(source.text(), std::make_shared<const SphereHierarchy>(view));
}

const std::string& placeOf(const std::string& cloud, const SceneFile& file)
{
  return std::find_if(file.clouds.begin(), file.clouds.end(), [&](const auto& source) { return source.name == cloud; })
      ->place;
}

/// Whether the pose of a cloud's objects is uncertain by an angle.
bool turns(const std::string& cloud, const SceneFile& file)
{
  return std::any_of(file.clouds.begin(), file.clouds.end(), [&](const CloudSource& source) {
    return source.name == cloud && source.uncertainty.pose.angle > 0.0;
  });
}

} // namespace

void setRules(Scene& scene, const std::vector<RuleEntry>& rules)
{
  for (const RuleEntry& rule : rules) {
    if (rule.of_groups)
      scene.setGroupRule(rule.a, rule.b, rule.rule);
    else
      scene.setRule(*scene.find(rule.a), *scene.find(rule.b), rule.rule);
  }
}

SceneWorld::SceneWorld(const SceneFile& file, const std::function<void(const CloudSource&)>& reading)
{
  std::set<std::string> used;
  for (const ObjectEntry& object : file.objects)
    for (const PartEntry& part : object.parts) used.insert(part.cloud);
  std::map<std::string, Shape> named;
  for (const CloudSource& source : file.clouds) {
    if (used.count(source.name) == 0) continue;
    if (reading) reading(source);
    load(source, file, clouds_[source.name]);
    named.emplace(source.name, namedShape(source, clouds_[source.name].hierarchy->view()));
  }
  std::vector<NamedObject> objects;
  for (const ObjectEntry& object : file.objects) {
    objects.push_back({object.name, object.fixed, {}, object.pose, object.motion});
    for (const PartEntry& part : object.parts) objects.back().parts.push_back({part.cloud, part.pose, part.solid});
  }
  const double duration = static_cast<double>(file.steps) * file.dt;
  for (std::string& line : warningsOf(objects, named, file.options.clearance, duration))
    warnings_.push_back(std::move(line));

  scene_ = std::make_unique<Scene>(file.options);
  for (const ObjectEntry& entry : file.objects) {
    SceneObject object;
    object.name = entry.name;
    object.group = entry.group;
    object.pose = entry.pose;
    object.fixed = entry.fixed;
    object.motion = entry.motion;
    object.adjacent = entry.adjacent;
    const auto id = static_cast<ObjectId>(scene_->size());
    for (const PartEntry& part : entry.parts) {
      std::shared_ptr<SphereHierarchy> hierarchy = clouds_.at(part.cloud).hierarchy;
      if (entry.wave && surface(part.cloud)) {
        throw JsonError(file.path.string(), placeOf(part.cloud, file),
                        "is a surface, and the wave of '" + entry.name + "' moves points",
                        "give 'vertices_only': true");
      }
      if (entry.wave && turns(part.cloud, file)) {
        throw JsonError(file.path.string(), placeOf(part.cloud, file) + ".pose_uncertainty",
                        "has an angle, and the wave of '" + entry.name + "' moves points away from where it counts",
                        "give its length alone, no shorter than what the angle moves any point by");
      }
      if (entry.wave) {
        auto waving = std::make_unique<Waving>();
        waving->object = id;
        waving->part = static_cast<std::uint32_t>(object.parts.size());
        waving->wave = *entry.wave;
        waving->rest = waving->now = coordinatesOf(hierarchy->view());
        hierarchy = std::make_shared<SphereHierarchy>(movedView(waving->now, hierarchy->view()));
        waving_.push_back(std::move(waving));
      }
      if (part.solid && !surface(part.cloud))
        throw JsonError(file.path.string(), entry.place + ".solid", "cloud '" + part.cloud + "' has no faces",
                        "give a mesh that closes, or leave it out");
      object.parts.push_back({part.name, std::move(hierarchy), part.pose, part.solid});
    }
    if (entry.part_poses) jointed_.push_back({id, entry.part_poses});
    try {
      scene_->add(std::move(object));
    }
    catch (const InvalidInput& error) {
      if (error.input() != Input::surface) throw;
      throw JsonError(file.path.string(), entry.place + ".solid", error.wrong(), error.remedy());
    }
  }
  setRules(*scene_, file.rules);
  if (auto untested = warningOfNoPairs(*scene_)) warnings_.push_back(std::move(*untested));
  setTime(0.0);
}

void SceneWorld::load(const CloudSource& source, const SceneFile& file, Loaded& loaded)
{
  Mesh mesh;
  CloudFacts& facts = loaded.facts;
  if (source.mesh)
    mesh = *source.mesh;
  else if (!source.shape.empty())
    mesh.vertices = cloudOf(shapePoints(source.shape, source.size, source.spacing));
  else
    mesh = readMesh(source.file, source.surface, &facts, {source.columns, source.allow_scale}, file.options.threads);
  for (const std::string& remark : facts.remarks) warnings_.push_back(source.file.string() + ": " + remark);
  scaleAndShift(mesh.vertices, source, file.path.string());
  HierarchyOptions options;
  options.threads = file.options.threads;
  loaded.shape = shapeOf(std::move(mesh), source, file);
  const bool has_fields = !loaded.shape.isSurface();
  const PointsView view =
      uncertainView(loaded.shape.view(), has_fields ? loaded.shape.points().fields : std::vector<pcl::PCLPointField>(),
                    source, file.path.string());
  loaded.hierarchy = std::make_shared<SphereHierarchy>(view, options);
}

ScanOrigins SceneWorld::origins(const CloudSource& source) const
{
  ScanOrigins origins = originsOf(cloud(source.name), facts(source.name));
  for (ScanOrigins::Entry& entry : origins.entries) entry.origin = placed(entry.origin, source);
  return origins;
}

std::size_t SceneWorld::points() const
{
  std::size_t count = 0;
  for (const auto& entry : clouds_) count += entry.second.hierarchy->size();
  return count;
}

void SceneWorld::setTime(double time)
{
  for (const Jointed& jointed : jointed_) {
    const std::vector<Eigen::Isometry3d> poses = jointed.part_poses(time);
    for (std::uint32_t part = 0; part < poses.size(); ++part) scene_->setPartPose(jointed.object, part, poses[part]);
  }
  constexpr double two_pi = 6.28318530717958647692;
  for (const auto& waving : waving_) {
    const Wave& wave = waving->wave;
    for (std::size_t i = 0; i < waving->rest.size(); i += 3) {
      const double height = std::sin(two_pi * (waving->rest[i] / wave.length - time / wave.period));
      for (std::size_t k = 0; k < 3; ++k)
        waving->now[i + k] = waving->rest[i + k] + height * wave.amplitude[static_cast<Eigen::Index>(k)];
    }
    const PointsView& before = (*scene_)[waving->object].parts[waving->part].hierarchy->view();
    scene_->deform(waving->object, waving->part, movedView(waving->now, before));
  }
}

} // namespace pcl_bsh::io
