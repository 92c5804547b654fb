// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_actor.h"
#include "value_bar.h"
#include "value_histogram.h"
#include <pcl_bsh/tools/viewer/content/view_content.h>

namespace pcl_bsh::viewer {

/// The colour of a cloud's free parts.
Color plainColor(const ViewedCloud& viewed);

/// The colouring that the options ask for, else the one that fits best.
Coloring coloringOf(const ViewContent& content, const StepCollisions& collisions);

/// Gives all clouds their colours, and shows the bar where these stand for values.
/// @throws cli::UsageError when the clouds lack what the colours stand for
void paint(CloudActors clouds, ValueBar& bar, const ViewContent& content, Coloring coloring);

/// Colours the scan by the distances of all of its points at this step, where these are asked for and known; then the
/// bar and the histogram say which there are. @return whether it did
bool paintDistances(CloudActors clouds, ValueBar& bar, ValueHistogram& histogram, const ViewContent& content,
                    Coloring coloring, std::size_t step);

/// Marks what collides at this step; where the marks' colours stand for values, the bar says which.
/// @throws cli::UsageError when it is not known what collides
void mark(CloudActors clouds, ValueBar& bar, const ViewContent& content, const StepCollisions& collisions,
          Coloring coloring, std::size_t step);

} // namespace pcl_bsh::viewer
