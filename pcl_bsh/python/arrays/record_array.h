// SPDX-License-Identifier: BSD-3-Clause
// PCL's clouds of any fields as NumPy's structured arrays, and back.
#pragma once

#include <pcl_bsh/python/typed.h>

#include <pcl/PCLPointCloud2.h>

#include <pybind11/numpy.h>

#include <string>

namespace pcl_bsh::python {

/// A structured array that owns the cloud's records: (n,), of an organised cloud (height, width). Nothing is copied.
Records recordsFrom(pcl::PCLPointCloud2&& cloud);

/// Copies a structured array, or (n, 3) of float32 or float64, to a cloud.
/// @param name how errors call it
/// @throws std::invalid_argument for fields that PCL has no type for
pcl::PCLPointCloud2 cloudFrom(const std::string& name, const pybind11::object& records);

} // namespace pcl_bsh::python
