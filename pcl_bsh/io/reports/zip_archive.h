// SPDX-License-Identifier: BSD-3-Clause
// Small files in one zip archive, in memory.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// Contents by names, which have / between folders.
using ZipFiles = std::map<std::string, std::string>;

/// The archive of these files, the same bytes for the same files and date.
/// @param date as reportDate() has it
std::string zipped(const ZipFiles& files, const std::string& date);

/// The files of an archive that are wanted. No more than 256 MiB are unpacked, whatever the archive says.
/// @param wanted is given each name
/// @throws FormatError where it is no archive, is cut off or damaged, unpacks to more, or has a name that is there
///   twice or leads out of it
ZipFiles unzipped(std::string_view archive, const std::function<bool(const std::string& name)>& wanted);

} // namespace pcl_bsh::io
