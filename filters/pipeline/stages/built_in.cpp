// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>

namespace pcl_bsh::pipeline {

std::deque<StageType> builtInStages()
{
  return {pcdReader(),
          plyReader(),
          objReader(),
          offReader(),
          meshReader(),
          lasReader(),
          ptsReader(),
          ptxReader(),
          textReader(),
          voxelGrid(),
          approximateVoxelGrid(),
          uniformSampling(),
          passThrough(),
          cropBox(),
          statisticalOutlierRemoval(),
          radiusOutlierRemoval(),
          transform(),
          normalEstimation(),
          euclideanCluster(),
          merge(),
          bshCollision(),
          bshFlag(),
          bshDistance(),
          pcdWriter(),
          plyWriter(),
          lasWriter(),
          ptsWriter(),
          ptxWriter(),
          objWriter(),
          textWriter(),
          clashWriter(),
          distanceWriter()};
}

} // namespace pcl_bsh::pipeline
