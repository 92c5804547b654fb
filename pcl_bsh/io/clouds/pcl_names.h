// SPDX-License-Identifier: BSD-3-Clause
// Files call normals nx ny nz and give colours a number per channel; PCL says normal_x normal_y normal_z and packs
// colours into one field. Both ways, without loss.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_bsh::io {

using Fields = std::vector<pcl::PCLPointField>;

/// Names of a colour's channels in a file: red, green, blue, opacity.
using ChannelNames = std::array<const char*, 4>;
inline constexpr ChannelNames ply_channels = {"red", "green", "blue", "alpha"};
inline constexpr ChannelNames text_channels = {"r", "g", "b", "a"};

/// Whether the field is PCL's packed colour: rgb or rgba, four bytes.
bool isPackedColour(const pcl::PCLPointField& field);

/// Appends a file's values (name, type, count; one of count 0 gets no field) to the cloud's records, with the names and
/// meaning that PCL has for them:
///
/// nx ny nz                floating-point, of one type: normal_x normal_y normal_z
/// red green blue [alpha]  a byte each: rgb (float32, its fourth byte 0) or rgba (uint32), as PCL's PLY reader has it;
///                         also r g b [a] and diffuse_red diffuse_green diffuse_blue [diffuse_alpha]
///
/// Letters may be of any case, in these names and in x y z intensity curvature. Values of other types (float red), sets
/// that are not complete, and what would get the name of another value stay as they are.
/// @return for each value, where in a record it goes
/// @throws FormatError when a record would grow beyond 4 GiB
std::vector<std::uint32_t> layOutForPcl(const Fields& values, pcl::PCLPointCloud2& cloud);

/// The other way: fields with a file's names; a packed colour is three or four fields of a byte, which lie in it. A
/// field whose new name another field has keeps its own.
Fields namedForFiles(Fields fields, const ChannelNames& channels);

/// Says which colours of the cloud are not packed, where PCL's tools will not see them; empty when there are none, or a
/// packed one beside them.
std::string remarkOnColours(const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
