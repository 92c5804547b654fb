// SPDX-License-Identifier: BSD-3-Clause
// The constants that the code uses, as Gappa reads numbers: "name value" in each line.
#include <pcl_bsh/distances/bound_margin.h>
#include <pcl_bsh/geometry/exact/compensated_sum.h>
#include <pcl_bsh/geometry/exact/rounded_length.h>
#include <pcl_bsh/geometry/local_frame.h>
#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/simd/roundings.h>
#include <pcl_bsh/simd/supports.h>
#include <pcl_bsh/trajectory/pose_path.h>

#include <cstdio>

int main()
{
#define PCL_BSH_PRINT(name) std::printf(#name " %a\n", static_cast<double>(pcl_bsh::name))
  PCL_BSH_PRINT(kCarriedProductError);
  PCL_BSH_PRINT(kCarriedShiftError);
  PCL_BSH_PRINT(kSquaredDistanceError);
  PCL_BSH_PRINT(kLengthError);
  PCL_BSH_PRINT(kSphereMargin);
  PCL_BSH_PRINT(kReachMargin);
  PCL_BSH_PRINT(kRadiusMargin);
  PCL_BSH_PRINT(kSegmentRounding);
  PCL_BSH_PRINT(kStepRounding);
  PCL_BSH_PRINT(kStoringError);
  PCL_BSH_PRINT(kFewDoubleRoundings);
  PCL_BSH_PRINT(kTermsError);
  PCL_BSH_PRINT(kMostLowOrder);
  PCL_BSH_PRINT(kLengthDoubt);
  PCL_BSH_PRINT(kBoundMargin);
  PCL_BSH_PRINT(kNeighborShare);
  PCL_BSH_PRINT(kNeighborMargin);
  PCL_BSH_PRINT(kSlabMargin);
  PCL_BSH_PRINT(kSupportShare);
  PCL_BSH_PRINT(kDistanceShare);
  PCL_BSH_PRINT(kSeparationError);
  PCL_BSH_PRINT(kFlatMargin);
  PCL_BSH_PRINT(kFlatShare);
  PCL_BSH_PRINT(kSineError);
  PCL_BSH_PRINT(kMotionRounding);
  std::printf("kCompensatedError %a\n", pcl_bsh::CompensatedSum::kError);
  std::printf("kFlatTriangleError %a\n", pcl_bsh::kFlatTriangleUnits * pcl_bsh::kFloatUnit);
  std::printf("kTrianglePairError %a\n", pcl_bsh::kTrianglePairUnits * pcl_bsh::kFloatUnit);
  PCL_BSH_PRINT(kTrianglePairMargin);
  std::printf("kFlatSkewOfFloats %a\n", pcl_bsh::kFlatSkew<float>);
}
