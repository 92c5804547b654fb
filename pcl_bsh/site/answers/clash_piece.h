// SPDX-License-Identifier: BSD-3-Clause
// The pieces of clashes, one for each tile and clash. Pieces of several tiles are joined to clashes of the site.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/site/site_clashes.h>

#include <vector>

namespace pcl_bsh::site {

/// A colliding point of a piece. The smallest point of a piece is the piece's name.
struct Member {
  Point3 place;
  SitePoint point, piece;
  float distance = 0.0F;
  std::int32_t closest_pose = 0;
};

struct Piece {
  Clash clash;    ///< without records
  Member nearest; ///< its point of the closest pair
  MetPoint met;   ///< the model's point of the closest pair
};

/// The pieces of some tiles.
struct Pieces {
  bool of_site = false; ///< whether the model is a site: met points are then points of it
  std::vector<Piece> pieces;
  std::vector<Member> border; ///< points within the cluster distance of the box of another tile
  std::vector<Member> some;   ///< some points of each piece
};

/// Returns them as numbers. add() reads one such sequence after another.
std::vector<double> numbersOf(const Pieces& pieces);
void add(Pieces& pieces, const double* begin, const double* end);

/// Returns the pieces of all ranks of an MPI job, on all of them.
Pieces gathered(const Pieces& own);

/// Joins another piece of one clash. Where their closest pairs have equal distances, the pair of the smaller point of
/// the site counts, as in memory.
void join(Piece& piece, const Piece& other);

/// Leaves `most` members at most, those with the smallest hashes of their names. So the points of a clash that are left
/// do not depend on how the clash was cut into pieces.
void drawSome(std::vector<Member>& members, std::size_t most);

} // namespace pcl_bsh::site
