// SPDX-License-Identifier: BSD-3-Clause
// One stage on a cloud in memory.
#pragma once

#include <pcl_bsh/filters/pipeline/pipeline.h>

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace pcl_bsh::pipeline {

template <typename PointT>
StageCloudPtr stageCloud(const pcl::PointCloud<PointT>& points)
{
  auto cloud = std::make_shared<StageCloud>();
  pcl::toPCLPointCloud2(points, cloud->cloud);
  return cloud;
}

template <typename PointT>
pcl::PointCloud<PointT> typedOf(const StageCloudPtr& cloud)
{
  pcl::PointCloud<PointT> points;
  pcl::fromPCLPointCloud2(cloud->cloud, points);
  return points;
}

/// The result of a stage that reads `in`. @param stage its JSON object
/// @param obstacle given for the tag `other`, unless null
inline PipelineResult runStage(const StageCloudPtr& in, const std::string& stage, const StageCloudPtr& other = nullptr)
{
  const std::string others = other ? R"({"type": "readers.pcd", "tag": "other", "filename": "o.pcd"},)" : "";
  Pipeline pipeline = Pipeline::parse(R"({"pipeline": [)" + others +
                                      R"({"type": "readers.pcd", "tag": "in", "filename": "i.pcd"},)" + stage + "]}");
  pipeline.setCloud("in", in);
  if (other) pipeline.setCloud("other", other);
  return pipeline.run();
}

/// The one cloud that nobody reads.
inline StageCloudPtr outputOf(const StageCloudPtr& in, const std::string& stage, const StageCloudPtr& other = nullptr)
{
  const PipelineResult result = runStage(in, stage, other);
  EXPECT_EQ(result.clouds.size(), 1U);
  return result.clouds.begin()->second;
}

/// The error's text, without the document and the stage.
template <typename Run>
std::string errorOf(Run&& run)
{
  try {
    run();
  }
  catch (const PipelineError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was found wrong";
  return {};
}

} // namespace pcl_bsh::pipeline
