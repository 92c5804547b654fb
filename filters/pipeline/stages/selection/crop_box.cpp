// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/search/cloud_view.h>

#include <Eigen/Geometry>

#include <cmath>

namespace pcl_bsh::pipeline {
namespace {

/// As pcl::CropBox, but in double, so that it holds for georeferenced clouds.
struct CropBox : SelectingStage {
  Numbers<3> min = {-1, -1, -1};
  Numbers<3> max = {1, 1, 1};
  Numbers<3> translation = {0, 0, 0};
  Numbers<3> rotation = {0, 0, 0};
  Pose transform;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::size_t k = 0; k < 3; ++k) {
      if (min[k] > max[k]) throw OptionError("min", "lies above `max`: exchange them");
    }
    return inputs[0];
  }

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    const PointsView points = viewOf(cloud->cloud);
    const bool is_float = points.scalar == Scalar::float32;
    const Eigen::Array3d least = limitOf(min, is_float);
    const Eigen::Array3d most = limitOf(max, is_float);
    const Eigen::Affine3d box = boxFromCloud();
    const bool aligned = box.matrix().isIdentity(0);
    std::vector<std::uint8_t> passes(points.count);
    for (std::uint32_t i = 0; i < points.count; ++i) {
      const Point3 point = points.point(i);
      Eigen::Vector3d p(point[0], point[1], point[2]);
      if (!aligned) p = box * p;
      passes[i] = (p.array() >= least).all() && (p.array() <= most).all();
    }
    return passes;
  }

private:
  /// T_box_cloud, all of PCL's steps in one matrix: the large numbers of a georeferenced cloud cancel in it.
  Eigen::Affine3d boxFromCloud() const
  {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    const Eigen::Matrix3d turned =
        (AngleAxisd(rotation[2], Vector3d::UnitZ()) * AngleAxisd(rotation[1], Vector3d::UnitY()) *
         AngleAxisd(rotation[0], Vector3d::UnitX()))
            .toRotationMatrix();
    Eigen::Affine3d into_box = Eigen::Affine3d::Identity();
    into_box.linear() = turned.transpose();
    return into_box * Eigen::Translation3d(-translation[0], -translation[1], -translation[2]) *
           Eigen::Affine3d(transform.matrix);
  }

  /// Next to float coordinates, 0.3 must mean the float 0.3, as it does in PCL.
  static Eigen::Array3d limitOf(const Numbers<3>& given, bool is_float)
  {
    Eigen::Array3d limit(given[0], given[1], given[2]);
    if (is_float) limit = limit.unaryExpr([](double value) { return static_cast<double>(roundToFloat(value)); });
    return limit;
  }
};

} // namespace

StageType cropBox()
{
  auto description =
      describe<CropBox>("filters.crop_box", "Keeps points inside a box, its faces included. Computed in double.")
          .alias("pcl::CropBox")
          .option(&CropBox::min, "min", "the corner with the least coordinates, in the box's frame")
          .unit("m")
          .required()
          .option(&CropBox::max, "max", "the corner with the greatest coordinates, in the box's frame")
          .unit("m")
          .required()
          .option(&CropBox::translation, "translation", "position of the box's origin")
          .unit("m")
          .option(&CropBox::rotation, "rotation", "of the box: [roll, pitch, yaw], R = Rz(yaw) Ry(pitch) Rx(roll)")
          .unit("rad")
          .option(&CropBox::transform, "transform", "applied to the points before they are compared");
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
