// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/used_files.h>

namespace pcl_bsh::files {
namespace {

/// The message about two names of one file; empty where they are allowed together.
std::string wrongWith(const UsedFile& file, const UsedFile& other, bool is_stream)
{
  if (file.use == Use::read) {
    const bool gone = is_stream && other.use == Use::read;
    return gone ? "is the pipe of " + other.name + ", and can be read only once: save it to a file first" : "";
  }
  if (other.use == Use::written) return "is the file of " + other.name + ", too: choose another name";
  if (file.replaces == other.name) return {};
  return "is the file of " + other.name + ", which is read: choose another name";
}

} // namespace

std::optional<FileClash> findClash(const std::vector<UsedFile>& files)
{
  std::vector<FileIdentity> identities;
  for (const UsedFile& file : files) identities.emplace_back(file.path, file.use);
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t k = 0; k < files.size(); ++k) {
      const bool once = files[i].use != files[k].use || k < i; // of two names with one use, the later is told
      if (k == i || !once || !(identities[i] == identities[k]) || identities[i].isDevice()) continue;
      const std::string wrong = wrongWith(files[i], files[k], identities[i].isStream());
      if (!wrong.empty()) return FileClash{i, k, wrong};
    }
  }
  return std::nullopt;
}

} // namespace pcl_bsh::files
