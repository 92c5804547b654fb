// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/search/cloud_view.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

namespace pcl_bsh::pipeline {
namespace {

/// Three fields of one type as a vector in double.
class Triple {
public:
  Triple(const PointsView& layout) : layout_(layout) {}

  Eigen::Vector3d read(std::uint32_t record) const
  {
    const Point3 p = layout_.point(record);
    return {p[0], p[1], p[2]};
  }

  /// @return the vector as it could be stored
  Eigen::Vector3d write(std::uint8_t* record, const Eigen::Vector3d& vector) const
  {
    Eigen::Vector3d stored = vector;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      if (layout_.scalar == Scalar::float32) {
        const float narrow = roundToFloat(vector[axis]);
        std::memcpy(record + layout_.offset[k], &narrow, sizeof narrow);
        stored[axis] = narrow;
      }
      else {
        std::memcpy(record + layout_.offset[k], &vector[axis], sizeof(double));
      }
    }
    return stored;
  }

private:
  PointsView layout_;
};

/// normal_x, normal_y and normal_z, where the cloud has them all as numbers of one floating-point type.
std::optional<Triple> normalsOf(const pcl::PCLPointCloud2& cloud)
{
  PointsView layout = viewOf(cloud);
  std::size_t found = 0;
  std::uint8_t datatype = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (const pcl::PCLPointField& field : cloud.fields) {
      if (field.name != std::string("normal_") + "xyz"[k]) continue;
      if (k == 0) datatype = field.datatype;
      const bool real = field.datatype == pcl::PCLPointField::FLOAT32 || field.datatype == pcl::PCLPointField::FLOAT64;
      if (real && field.datatype == datatype && field.count <= 1) ++found;
      layout.offset[k] = field.offset;
    }
  }
  layout.scalar = datatype == pcl::PCLPointField::FLOAT32 ? Scalar::float32 : Scalar::float64;
  return found == 3 ? std::optional<Triple>(layout) : std::nullopt;
}

struct Transform : Stage {
  Pose transform;
  bool allow_scale = false;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    const io::RigidPart part = rigid();
    if (part.deviation > 0) warn("transform: " + io::nearestRotationWarning(part.deviation));
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    const auto output = ownCloud(std::move(inputs[0]));
    output->system_definition.clear();
    Eigen::Affine3d map(transform.matrix);
    map.linear() = rigid().linear;
    movePoints(output->cloud, map);
    turnNormals(output->cloud, map);
    moveViewpoint(output->viewpoint, map);
    for (std::array<double, 7>& scanner : output->scanners) moveViewpoint(scanner, map);
    return output;
  }

private:
  io::RigidPart rigid() const
  {
    const Eigen::Affine3d map(transform.matrix);
    if (transform.matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
      throw OptionError("transform", "has another last row than 0 0 0 1: give a rotation and a shift");
    if (!map.translation().allFinite()) throw OptionError("transform", "is not finite: give finite numbers");
    io::RigidPart part = io::rigidPart(map.linear(), allow_scale);
    if (!part.wrong.empty()) {
      throw OptionError("transform", part.wrong + ": " +
                                         (part.scales ? "give \"allow_scale\": true if that is meant"
                                                      : "give a rotation and a shift"));
    }
    return part;
  }

  void movePoints(pcl::PCLPointCloud2& cloud, const Eigen::Affine3d& map)
  {
    const PointsView view = viewOf(cloud);
    const Triple coordinates(view);
    double lost = 0;    // by rounding the result
    double spacing = 0; // of the input: how far its own coordinates may be off
    for (std::uint32_t i = 0; i < view.count; ++i) {
      const Eigen::Vector3d before = coordinates.read(i);
      const Eigen::Vector3d exact = map * before;
      const Eigen::Vector3d stored = coordinates.write(&cloud.data[std::size_t{i} * cloud.point_step], exact);
      if (!before.allFinite()) continue;
      if (!stored.allFinite()) throw OptionError("transform", "moves a point beyond all numbers: give a smaller one");
      lost = std::max(lost, (stored - exact).cwiseAbs().maxCoeff());
      spacing = std::max(spacing, before.cwiseAbs().maxCoeff() * std::numeric_limits<float>::epsilon());
    }
    if (view.scalar == Scalar::float64 || lost <= 4 * spacing * map.linear().norm()) return;
    warn(plainText("float32 coordinates are coarse where the cloud now lies: rounding moved points by up to ", lost));
  }

  /// Normals stay perpendicular to their surface, and as long as they were.
  static void turnNormals(pcl::PCLPointCloud2& cloud, const Eigen::Affine3d& map)
  {
    const std::optional<Triple> normals = normalsOf(cloud);
    if (!normals) return;
    const Eigen::Matrix3d turn = map.linear().inverse().transpose();
    const auto count = static_cast<std::uint32_t>(std::size_t{cloud.width} * cloud.height);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Eigen::Vector3d before = normals->read(i);
      const Eigen::Vector3d after = turn * before;
      const double length = after.norm();
      if (!(length > 0)) continue;
      normals->write(&cloud.data[std::size_t{i} * cloud.point_step], after * (before.norm() / length));
    }
  }

  static void moveViewpoint(std::array<double, 7>& viewpoint, const Eigen::Affine3d& map)
  {
    const Eigen::Vector3d position = map * Eigen::Vector3d(viewpoint[0], viewpoint[1], viewpoint[2]);
    const Eigen::Quaterniond before(viewpoint[3], viewpoint[4], viewpoint[5], viewpoint[6]);
    const Eigen::Quaterniond after = Eigen::Quaterniond(map.rotation()) * before;
    viewpoint = {position.x(), position.y(), position.z(), after.w(), after.x(), after.y(), after.z()};
  }
};

} // namespace

StageType transform()
{
  return describe<Transform>("filters.transform",
                             "Moves points, normals and viewpoints. Computed in double; a warning tells when float32 "
                             "coordinates become too coarse.")
      .alias("pcl::transformPointCloud")
      .option(
          &Transform::transform, "transform",
          "the motion that is applied to each point; a matrix of few printed digits stands for its nearest rotation")
      .required()
      .option(
          &Transform::allow_scale, "allow_scale",
          "the matrix may scale uniformly, as from millimetres to metres; it is refused otherwise, and whatever else "
          "is no rigid motion always");
}

} // namespace pcl_bsh::pipeline
