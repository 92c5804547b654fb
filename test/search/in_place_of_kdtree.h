// SPDX-License-Identifier: BSD-3-Clause
// Put in front of a source of PCL's tests: from here on KdTree means our class.
#pragma once

#include <pcl_bsh/search/bounding_sphere_search.h>

#include <pcl/common/common.h>
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/brute_force.h>
#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>
#include <pcl/search/organized.h>
#include <pcl/search/pcl_search.h>

namespace pcl::search {
using pcl_bsh::search::BoundingSphereSearch;
}

#define KdTree BoundingSphereSearch // all headers that say it were read above
