// SPDX-License-Identifier: BSD-3-Clause
// The list that nanoflann's radiusSearch() fills: of pairs up to version 1.4, of ResultItem from 1.5 on.
#pragma once

#include <nanoflann.hpp>

#include <type_traits>

namespace pcl_bsh::test {

/// Each element has `first`, the number of a point, and `second`, its squared distance.
template <typename Index, typename Distance>
using RadiusHits = std::remove_reference_t<decltype(nanoflann::RadiusResultSet<Distance, Index>::m_indices_dists)>;

} // namespace pcl_bsh::test
