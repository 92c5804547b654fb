// SPDX-License-Identifier: BSD-3-Clause
// Refuses builds whose Eigen alignment differs from the one PCL's libraries were compiled with. Such builds compile and
// link, then free memory they did not allocate or filter every point away.
#pragma once

#include <Eigen/Core>

// A PCL of your own, compiled with wider vectors, needs these flags everywhere: then, and only then, define
// PCL_BSH_NO_ALIGNMENT_CHECK. Other processors have other defaults, which no option commonly in use changes.
#if defined(__x86_64__) && !defined(PCL_BSH_NO_ALIGNMENT_CHECK)
static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && EIGEN_MALLOC_ALREADY_ALIGNED == 1,
              "pcl_bsh: this build would allocate point clouds otherwise than PCL's libraries do, and crash or lose "
              "points. Remove -march=native, -mavx and the like where PCL is included (pcl_bsh chooses its vector "
              "instructions at run time), or add -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1 (also for "
              "-fsanitize=address).");
#endif
