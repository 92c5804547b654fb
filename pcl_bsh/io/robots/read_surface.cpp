// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/surface.h>

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/search/cloud_view.h>

#include <Eigen/Geometry>

#include <string>
#include <utility>

#ifdef PCL_BSH_ASSIMP
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace pcl_bsh::io {
namespace {

namespace fs = std::filesystem;

#ifdef PCL_BSH_ASSIMP

constexpr auto readable = ".stl, .obj, .ply, .off or .dae";

/// The faces of a node and of those below it.
void addNode(Surface& surface, const aiScene& scene, const aiNode& node, const Eigen::Affine3d& T_file_parent)
{
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> own;
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned k = 0; k < 4; ++k) own(i, k) = static_cast<double>(node.mTransformation[i][k]);
  const Eigen::Affine3d T_file_node = T_file_parent * Eigen::Affine3d(own);
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      const Eigen::Vector3d p = T_file_node * Eigen::Vector3d(v.x, v.y, v.z);
      surface.vertices.push_back({p.x(), p.y(), p.z()});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue; // lines and points
      surface.triangles.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(surface, scene, *node.mChildren[i], T_file_node);
}

Surface readCollada(const fs::path& path)
{
  const FileBytes bytes(path);
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1); // else all is turned until y is up
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);          // where there is no mesh
  const aiScene* const scene =
      importer.ReadFileFromMemory(bytes.view().data(), bytes.view().size(), aiProcess_Triangulate, "dae");
  if (!scene || !scene->mRootNode)
    throw files::FileError(path, std::string("is refused by assimp: ") + importer.GetErrorString(),
                           "mend the COLLADA, or give a .stl file in metres");
  Surface surface;
  addNode(surface, *scene, *scene->mRootNode, Eigen::Affine3d::Identity());
  return surface;
}

#else

constexpr auto readable = ".stl, .obj, .ply or .off";

Surface readCollada(const fs::path& path)
{
  throw files::FileError(
      path, "is COLLADA, and this program was built without assimp",
      "build it where libassimp-dev is installed, or save the mesh as .stl in metres, e.g. with Blender");
}

#endif

} // namespace

Surface readSurface(const fs::path& path)
{
  if (extensionOf(path) == ".dae") return readCollada(path);
  if (!mayHaveFaces(path))
    throw files::FileError(path, "is no file of a mesh that is read",
                           std::string("save it as ") + readable + ", in metres");
  Mesh read = readMesh(path);
  const PointsView view = viewOf(read.vertices);
  Surface surface;
  surface.triangles = std::move(read.triangles);
  for (std::uint32_t i = 0; i < view.count; ++i) surface.vertices.push_back(view.point(i));
  return surface;
}

} // namespace pcl_bsh::io
