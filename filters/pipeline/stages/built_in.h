// SPDX-License-Identifier: BSD-3-Clause
// The stages that the library brings, each a row of the table. A static library would drop what nothing names, so each
// is named here.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <deque>

namespace pcl_bsh::pipeline {

StageType pcdReader();
StageType plyReader();
StageType objReader();
StageType offReader();
StageType meshReader();
StageType lasReader();
StageType ptsReader();
StageType ptxReader();
StageType textReader();
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
StageType pcdWriter();
StageType plyWriter();
StageType lasWriter();
StageType objWriter();
StageType ptsWriter();
StageType ptxWriter();
StageType textWriter();
StageType clashWriter();
StageType distanceWriter();

/// All of them, in the order of the documentation.
std::deque<StageType> builtInStages();

} // namespace pcl_bsh::pipeline
