// SPDX-License-Identifier: BSD-3-Clause
// Writes the points of a site as clouds again, in the order of their sources.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <filesystem>
#include <functional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// The memory and the progress of an export.
struct ExportOptions {
  std::uint64_t memory = std::uint64_t{2}
                         << 30; ///< bytes that may be held at once; the less, the oftener tiles are read
  /// Called now and then with the points done and all points. False: stop, the export throws Cancelled.
  std::function<bool(std::uint64_t done, std::uint64_t all)> progress;
};

/// Writes all points as one binary PCD file with all fields of the site, in the order of (source, record).
/// @throws files::FileError, also where the disk has no room; Cancelled
void exportCloud(const Site& site, const std::filesystem::path& file, const ExportOptions& options = {});

/// Writes one source as a binary PCD file: its points in their order, with its fields in its types. They also have the
/// fields that no source has, which hold the answers of queries.
/// @param source < site.sources.size()
void exportSource(const Site& site, std::size_t source, const std::filesystem::path& file,
                  const ExportOptions& options = {});

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
