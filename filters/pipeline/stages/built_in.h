// SPDX-License-Identifier: BSD-3-Clause
// The stages that the library brings, each a row of the table. A static library would drop what nothing names, so each
// is named here.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <deque>

namespace pcl_bsh::pipeline {

std::deque<StageType> fileReaders();
StageType voxelGrid();
StageType approximateVoxelGrid();
StageType uniformSampling();
StageType passThrough();
StageType cropBox();
StageType statisticalOutlierRemoval();
StageType radiusOutlierRemoval();
StageType transform();
StageType normalEstimation();
StageType euclideanCluster();
StageType merge();
StageType bshCollision();
StageType bshFlag();
StageType bshDistance();
StageType gaugeStage();
std::deque<StageType> fileWriters();
StageType clashWriter();
StageType distanceWriter();

} // namespace pcl_bsh::pipeline
