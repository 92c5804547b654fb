// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/solid.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/solid/columns.h>
#include <pcl_bsh/solid/open_edges.h>

#include <string>

namespace pcl_bsh {
namespace {

void checkClosed(const TrianglesView& view)
{
  const OpenEdges open = openEdgesOf(view);
  if (open.closed()) return;
  const auto text = [](const Point3& p) {
    return '(' + plainText(p[0]) + ", " + plainText(p[1]) + ", " + plainText(p[2]) + ')';
  };
  throw InvalidInput(Input::surface, "solid",
                     counted(open.count, "edge is", "edges are") + " open, the first from " + text(open.from) + " to " +
                         text(open.to) + " in triangle " + std::to_string(open.triangle),
                     "close the mesh, or let it count as a surface")
      .withIndex(open.triangle);
}

std::unique_ptr<const Columns> columnsOf(const TrianglesView& view)
{
  checkTriangles(view);
  const DefaultFloatEnvironment environment;
  checkClosed(view);
  return std::make_unique<const Columns>(view);
}

} // namespace

Solid::Solid(const TrianglesView& triangles) : triangles_(triangles), columns_(columnsOf(triangles))
{
}
Solid::~Solid() = default;
Solid::Solid(Solid&&) noexcept = default;
Solid& Solid::operator=(Solid&&) noexcept = default;

std::size_t Solid::bytes() const noexcept
{
  return sizeof *this + sizeof(Columns) + columns_->bytes();
}

} // namespace pcl_bsh
