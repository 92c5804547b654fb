// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/certify/certify.h>

int main()
{
  const float xyz[] = {0, 0, 0, 1, 2, 3};
  const pcl_bsh::SphereHierarchy hierarchy(pcl_bsh::viewOf(xyz, 2));
  return pcl_bsh::certify(hierarchy).holds() ? 0 : 1;
}
