// SPDX-License-Identifier: BSD-3-Clause
// Topics of BCF, the BIM Collaboration Format: what people said of a clash. It is carried from list to list.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

struct BcfComment {
  std::string guid, date, author, text, modified_date, modified_author; ///< the last two may be empty
};

/// A clash's topic; what is not said is empty.
struct BcfTopic {
  std::string status, priority, creation_date, creation_author, due_date, assigned_to, stage;
  std::vector<BcfComment> comments;
};

using BcfTopics = std::map<std::string, BcfTopic>; ///< by GUID, in small letters

/// A BCF file that was made of a list of clashes.
struct BcfContents {
  std::string list; ///< clashJson() of the run
  BcfTopics topics;
};

/// The GUID that a name has in every file: by SHA-1 (RFC 4122, version 5).
std::string bcfGuid(const std::string& name);

/// The list's name in an archive: bcfListDocument() in version 3, bcf_list_file in version 2.1.
std::string bcfListDocument();
inline constexpr auto bcf_list_file = "clashes.json";

/// Whether files with this extension, in small letters, are BCF.
inline bool isBcfExtension(std::string_view extension)
{
  return extension == ".bcf" || extension == ".bcfzip";
}

/// Reads versions from 2.0 to 3.0. @throws FormatError; where the list is not there, too
BcfContents parseBcf(std::string_view archive);

} // namespace pcl_bsh::io
