// SPDX-License-Identifier: BSD-3-Clause
// VTK's data as files that ParaView opens; each appears complete or not at all.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::vtk {

/// Writes a .vtp file. @throws std::runtime_error naming the file
void writeVtp(vtkPolyData& data, const std::filesystem::path& path);

using NamedData = std::pair<std::string, vtkSmartPointer<vtkPolyData>>;

/// Writes a .vtm file, which lists named blocks, and beside it a folder of the same name without the extension, which
/// holds them as .vtp files. @throws std::runtime_error naming the file
void writeVtm(const std::vector<NamedData>& blocks, const std::filesystem::path& path);

} // namespace pcl_bsh::vtk
