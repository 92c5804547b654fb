// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/added_fields.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/search/bounding_sphere_search.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/features/normal_3d_omp.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

namespace pcl_bsh::pipeline {
namespace {

using Search = search::BoundingSphereSearch<pcl::PointXYZ>;

const std::vector<std::string> normal_fields = {"normal_x", "normal_y", "normal_z", "curvature"};

struct NormalEstimation : Stage {
  std::optional<unsigned> k_search;
  std::optional<double> radius_search;
  std::optional<Numbers<3>> view_point;
  unsigned number_of_threads = 1;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    if (k_search.has_value() == radius_search.has_value()) {
      throw OptionError("k_search", "and `radius_search` are " + std::string(k_search ? "both" : "neither") +
                                        " given: give one of them");
    }
    CloudHeader header = inputs[0];
    addFields(header, normal_fields, pcl::PCLPointField::FLOAT32);
    return header;
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    const auto output = ownCloud(std::move(inputs[0]));
    const auto offsets = addFields(output->cloud, normal_fields, pcl::PCLPointField::FLOAT32);
    const PointsView view = viewOf(output->cloud);
    const FloatCloud points = floatCloud(view);
    const double length = radius_search ? *radius_search : neighbourSpacing(view, points);
    if (const std::string warning = roundingWarning(points, length); !warning.empty()) warn(warning);
    const pcl::PointCloud<pcl::Normal> normals = normalsOf(points, output->viewpoint);

    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    std::size_t next = 0; // of the finite points
    const std::size_t count = std::size_t{output->cloud.width} * output->cloud.height;
    for (std::size_t i = 0; i < count; ++i) {
      const bool finite = next < points.records.size() && points.records[next] == i;
      float values[4] = {none, none, none, none};
      if (finite) {
        const pcl::Normal& normal = normals[next++];
        std::copy_n(normal.normal, 3, values);
        values[3] = normal.curvature;
      }
      std::uint8_t* const record = &output->cloud.data[i * output->cloud.point_step];
      for (std::size_t k = 0; k < 4; ++k) std::memcpy(record + offsets[k], &values[k], sizeof(float));
    }
    if (!normals.is_dense) output->cloud.is_dense = 0;
    return output;
  }

private:
  pcl::PointCloud<pcl::Normal> normalsOf(const FloatCloud& points, const std::array<double, 7>& sensor)
  {
    pcl::PointCloud<pcl::Normal> normals;
    if (points.points->empty()) return normals;
    const Numbers<3> view = view_point.value_or(Numbers<3>{sensor[0], sensor[1], sensor[2]});
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(number_of_threads);
    setInput(estimation, points);
    estimation.setSearchMethod(std::make_shared<Search>());
    estimation.setViewPoint(static_cast<float>(view[0] - points.origin[0]),
                            static_cast<float>(view[1] - points.origin[1]),
                            static_cast<float>(view[2] - points.origin[2]));
    if (k_search) {
      estimation.setKSearch(static_cast<int>(std::min<std::size_t>(*k_search, points.points->size())));
    }
    else {
      estimation.setRadiusSearch(*radius_search);
    }
    estimation.compute(normals);
    return normals;
  }
};

} // namespace

StageType normalEstimation()
{
  return describe<NormalEstimation>(
             "filters.normal_estimation",
             "Adds normal_x, normal_y, normal_z and curvature, float32, of the plane through a point's neighbours; NaN "
             "where they span no plane. Computed in float32 about the cloud's middle; coordinates stay as they are.")
      .alias("pcl::NormalEstimation")
      .alias("pcl::NormalEstimationOMP")
      .option(&NormalEstimation::k_search, "k_search", "number of neighbours, the point itself among them")
      .atLeast(3)
      .atMost(1e6)
      .option(&NormalEstimation::radius_search, "radius_search",
              "instead of `k_search`: all neighbours within this distance")
      .positiveLength()
      .option(&NormalEstimation::view_point, "view_point",
              "[x, y, z] that normals point to; null: the sensor's position in the file")
      .unit("m")
      .option(&NormalEstimation::number_of_threads, "number_of_threads", "0: all of the machine's")
      .atMost(1024);
}

} // namespace pcl_bsh::pipeline
