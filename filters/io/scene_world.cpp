// SPDX-License-Identifier: BSD-3-Clause
// From a scene file to the scene: clouds are read, hierarchies made, objects placed.
#include <pcl_bsh/filters/io/cloud_file.h>
#include <pcl_bsh/filters/io/json_reader.h>
#include <pcl_bsh/filters/io/records.h>
#include <pcl_bsh/filters/io/scene_file.h>
#include <pcl_bsh/filters/io/shape_points.h>

#include <pcl_bsh/search/cloud_view.h>

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

template <class T>
void placeField(pcl::PCLPointCloud2& cloud, std::size_t offset, double scale, double shift)
{
  for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i) {
    unsigned char* at = cloud.data.data() + i * cloud.point_step + offset;
    T value;
    std::memcpy(&value, at, sizeof value);
    value = static_cast<T>(scale * static_cast<double>(value) + shift);
    std::memcpy(at, &value, sizeof value);
  }
}

void scaleAndShift(pcl::PCLPointCloud2& cloud, const CloudSource& source)
{
  if (source.scale == 1.0 && source.shift.isZero(0.0)) return;
  const PointsView view = viewOf(cloud);
  for (std::size_t k = 0; k < 3; ++k) {
    const double shift = source.shift[static_cast<Eigen::Index>(k)];
    if (view.scalar == Scalar::float32)
      placeField<float>(cloud, view.offset[k], source.scale, shift);
    else
      placeField<double>(cloud, view.offset[k], source.scale, shift);
  }
}

std::vector<double> coordinatesOf(const PointsView& view)
{
  std::vector<double> xyz;
  xyz.reserve(3 * view.count);
  for (std::uint32_t i = 0; i < view.count; ++i)
    for (const double x : view.point(i)) xyz.push_back(x);
  return xyz;
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
  for (const CloudSource& source : file.clouds) {
    if (used.count(source.name) == 0) continue;
    if (reading) reading(source);
    Loaded& loaded = clouds_[source.name];
    loaded.points =
        source.shape.empty() ? readCloud(source.file) : cloudOf(shapePoints(source.shape, source.size, source.spacing));
    scaleAndShift(loaded.points, source);
    HierarchyOptions options;
    options.threads = file.options.threads;
    loaded.hierarchy = std::make_shared<SphereHierarchy>(viewOf(loaded.points), options);
  }

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
      if (entry.wave) {
        auto waving = std::make_unique<Waving>();
        waving->object = id;
        waving->part = static_cast<std::uint32_t>(object.parts.size());
        waving->wave = *entry.wave;
        waving->rest = waving->now = coordinatesOf(hierarchy->view());
        hierarchy = std::make_shared<SphereHierarchy>(viewOf(waving->now.data(), waving->now.size() / 3));
        waving_.push_back(std::move(waving));
      }
      object.parts.push_back({part.name, std::move(hierarchy), part.pose});
    }
    scene_->add(std::move(object));
  }
  setRules(*scene_, file.rules);
  deform(0.0);
}

std::size_t SceneWorld::points() const
{
  std::size_t count = 0;
  for (const auto& entry : clouds_) count += entry.second.hierarchy->size();
  return count;
}

void SceneWorld::deform(double time)
{
  constexpr double two_pi = 6.28318530717958647692;
  for (const auto& waving : waving_) {
    const Wave& wave = waving->wave;
    for (std::size_t i = 0; i < waving->rest.size(); i += 3) {
      const double height = std::sin(two_pi * (waving->rest[i] / wave.length - time / wave.period));
      for (std::size_t k = 0; k < 3; ++k)
        waving->now[i + k] = waving->rest[i + k] + height * wave.amplitude[static_cast<Eigen::Index>(k)];
    }
    scene_->deform(waving->object, waving->part, viewOf(waving->now.data(), waving->now.size() / 3));
  }
}

} // namespace pcl_bsh::io
