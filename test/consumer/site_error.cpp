// SPDX-License-Identifier: BSD-3-Clause
// Exceptions in the declarations of sites' headers are declared in installed headers.
#include <pcl_bsh/site/site.h>

#include <cstdio>

int main()
{
  try {
    pcl_bsh::site::Site site;
    site.folder = "nowhere";
    pcl_bsh::site::readTile(site, {});
  }
  catch (const pcl_bsh::files::FileError& error) {
    std::printf("refused: %s\n", error.what());
    return 0;
  }
  return 1;
}
