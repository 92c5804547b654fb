// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/impl/bounding_sphere_search.hpp>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

PCL_INSTANTIATE(BoundingSphereSearch, PCL_XYZ_POINT_TYPES)
