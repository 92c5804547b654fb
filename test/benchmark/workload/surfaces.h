// SPDX-License-Identifier: BSD-3-Clause
// Closed meshes, some 1 long: what bench_surface asks about.
#pragma once

#include "support/made_meshes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh::bench {

using test::TestMesh;

/// A milling tool of 66,000 triangles: flutes wind about its axis, and both ends are flat.
TestMesh machinedPart();

/// A closed surface with bumps of many sizes, of a million triangles.
TestMesh bumpySurface();

/// 50,000 triangles of straight tubes in all directions, 1 long and 4e-4 wide.
TestMesh thinTubes();

/// The statue of statue.h, of some 250,000 triangles.
TestMesh statueMesh();

/// A connecting rod with fillets about its flat sides, of 6,442 triangles: narrow strips, and long thin triangles.
TestMesh connectingRod();

/// A tube tied to a knot, of 48,000 triangles.
TestMesh knottedTube();

/// The longest side of the box about a mesh.
double sizeOf(const TestMesh& mesh);

/// Points about a mesh, x y z: every other one within `noise` of the surface, along each axis; the others anywhere in
/// its box.
std::vector<double> scanOf(const TestMesh& mesh, std::size_t count, double noise, std::uint64_t seed);

} // namespace pcl_bsh::bench
