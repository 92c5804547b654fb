// SPDX-License-Identifier: BSD-3-Clause
#include "surface_peer.h"

namespace pcl_bsh::bench {

std::vector<SurfaceLibrary> surfaceLibraries()
{
  return {
#ifdef PCL_BSH_BENCH_EMBREE
      {"Embree", makeEmbree, false},
      {"Embree, parity", makeEmbree, true},
#endif
#ifdef PCL_BSH_BENCH_FCL_SURFACE
      {"FCL OBBRSS", makeFcl, false},
#endif
#ifdef PCL_BSH_BENCH_VTK
      {"VTK static locator", makeVtkLocator, false},
      {"VTK enclosed points", makeVtkEnclosed, true},
#endif
#ifdef PCL_BSH_BENCH_CGAL
      {"CGAL AABB", makeCgalTree, false},
      {"CGAL side of mesh", makeCgalSide, true},
#endif
  };
}

} // namespace pcl_bsh::bench
