// SPDX-License-Identifier: BSD-3-Clause
// The makers behind makeSearchRacer(), one per library.
#pragma once

#include "../search_racers.h"

namespace pcl_bsh::bench {

std::unique_ptr<SearchRacer> makeSphereSearch();
std::unique_ptr<SearchRacer> makeSphereBatch(unsigned threads);
std::unique_ptr<SearchRacer> makePclKdTreeSearch();
std::unique_ptr<SearchRacer> makePclOctreeSearch();
std::unique_ptr<SearchRacer> makeNanoflannSearch();
std::unique_ptr<SearchRacer> makeGridSearch();

} // namespace pcl_bsh::bench
