// SPDX-License-Identifier: BSD-3-Clause
#include "random_clouds.h"

#include <pcl_bsh/query/trace.h>

#include <gtest/gtest.h>

