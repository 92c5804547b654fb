// SPDX-License-Identifier: BSD-3-Clause
// VTK's data as files that ParaView opens; each appears complete or not at all.
#pragma once

#include <pcl_bsh/export.h>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// Writes a .vtp file. @throws std::runtime_error naming the file
void writeVtp(vtkPolyData& data, const std::filesystem::path& path);

/// The name of a block, and its data.
using NamedData = std::pair<std::string, vtkSmartPointer<vtkPolyData>>;

/// Writes a .vtm file, NAME.vtm, which lists named blocks, and beside it a folder NAME, which holds them as files
/// NAME_0_0.vtp, NAME_0_1.vtp ... An earlier NAME.vtm is replaced when all blocks are there; then its blocks with such
/// names are removed. Nothing else is touched.
/// @throws std::runtime_error naming the file; when NAME is not a folder, or holds other files
void writeVtm(const std::vector<NamedData>& blocks, const std::filesystem::path& path);

/// Fails early where writeVtp() or writeVtm() would fail because of the path. The extension .vtm selects writeVtm().
/// @throws std::runtime_error naming the file
void requireWritableData(const std::filesystem::path& path);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
