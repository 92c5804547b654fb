// SPDX-License-Identifier: BSD-3-Clause
// A cloud's spheres as a file for ParaView.
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/write_data.h>

#include <cstdio>

int main(int, char** argv)
{
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const pcl_bsh::SphereHierarchy hierarchy(pcl_bsh::viewOf(corners, 4));
  const auto spheres = pcl_bsh::vtk::sphereData(hierarchy, 0);
  pcl_bsh::vtk::writeVtp(*spheres, argv[1]);
  std::printf("%d sphere(s)\n", static_cast<int>(spheres->GetNumberOfPoints()));
  return spheres->GetNumberOfPoints() > 0 ? 0 : 1;
}
