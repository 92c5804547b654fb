// SPDX-License-Identifier: BSD-3-Clause
// Drawings of a gauging run, each an SVG of its own.
#pragma once

#include <pcl_bsh/io/reports/gauge_report.h>

#include <string>

namespace pcl_bsh::io {

/// The scan near a section, as seen along the axis, with all envelopes of its track that count there, and the worst
/// point's clearance.
std::string sectionDrawing(const GaugeReport& report, const GaugeSection& section);

/// A map of smallest clearances. Chainage runs across; the way round the envelope runs up: left, above, right, below.
std::string clearanceMap(const GaugeReport& report, std::size_t track, std::size_t envelope);

/// The share of each sector's outline that beams crossed, by chainage. @pre the report has `seen`
std::string seenMap(const GaugeReport& report, std::size_t track, std::size_t envelope);

/// Smallest clearances of the four sectors by chainage.
std::string clearanceChart(const GaugeReport& report, std::size_t track, std::size_t envelope);

} // namespace pcl_bsh::io
