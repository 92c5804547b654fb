// SPDX-License-Identifier: BSD-3-Clause
// Drawings as pictures: SVG drawn as PNG by librsvg, where that was there when this was built.
#pragma once

#include <string>

namespace pcl_bsh::io {

/// Whether this was built with librsvg.
bool drawsPictures();

/// The PNG of a drawing. @param pixels per unit of the drawing; texts are 11 units high
/// @pre drawsPictures(). @throws std::runtime_error where librsvg does not draw it
std::string pngOf(const std::string& svg, double pixels);

} // namespace pcl_bsh::io
