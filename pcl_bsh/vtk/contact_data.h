// SPDX-License-Identifier: BSD-3-Clause
// Contacts as VTK's data: where they are, which way the surface pushes, and how much room is left.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/contacts.h>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// The places of b, a point each. Point arrays: `normal` (from b to a; the active vectors), `gap` (below 0 where they
/// are in each other), `place_a` (opposite), `id`, `patch`.
vtkSmartPointer<vtkPolyData> contactData(const std::vector<Contact>& contacts);

/// An arrow for each contact of contactData(), along its normal, with its arrays at every corner. It begins at the
/// place. A contact without a direction has no arrow.
/// @param length of each, in the clouds' unit
vtkSmartPointer<vtkPolyData> contactArrows(vtkPolyData& contacts, double length);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
