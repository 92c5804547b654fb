// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/file_bytes.h>

#include <boost/interprocess/file_mapping.hpp>

namespace pcl_bsh::io {

namespace {

namespace bip = boost::interprocess;

void requireFile(const std::filesystem::path& path)
{
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw CloudFileError(path, "no such file", "check the name");
  }
  if (std::filesystem::is_directory(status)) throw CloudFileError(path, "is a folder", "name a file in it");
  if (error) throw CloudFileError(path, "cannot be opened (" + error.message() + ")", "check its permissions");
  if (!std::filesystem::is_regular_file(status)) {
    throw CloudFileError(path, "is not an ordinary file", "save the cloud to a file first");
  }
  if (std::filesystem::file_size(path, error) == 0) {
    throw CloudFileError(path, "is empty", "export or copy the file again");
  }
}

} // namespace

FileBytes::FileBytes(const std::filesystem::path& path)
{
  requireFile(path);
  try {
    region_ = bip::mapped_region(bip::file_mapping(path.c_str(), bip::read_only), bip::read_only);
  }
  catch (const bip::interprocess_exception& error) {
    throw CloudFileError(path, std::string("cannot be read (") + error.what() + ")", "check its permissions");
  }
}

} // namespace pcl_bsh::io
