// SPDX-License-Identifier: BSD-3-Clause
// What a clash has in one tile: pieces of several tiles are joined to clashes of the site.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/site/site_clashes.h>

#include <vector>

namespace pcl_bsh::site {

/// A colliding point of a piece, which is known by its smallest point.
struct Member {
  Point3 place;
  SitePoint point, piece;
  float distance = 0.0F;
  std::int32_t closest_pose = 0;
};

struct Piece {
  Clash clash;    ///< without records
  Member nearest; ///< its point of the closest pair
  MetPoint met;   ///< the model's
};

/// What tiles have of clashes.
struct Pieces {
  bool of_site = false; ///< whether the model is a site: the met points tell theirs
  std::vector<Piece> pieces;
  std::vector<Member> border; ///< points that a step of the cluster distance may lead to another tile
  std::vector<Member> some;   ///< of each piece
};

/// As numbers, one sequence after another of which add() understands.
std::vector<double> numbersOf(const Pieces& pieces);
void add(Pieces& pieces, const double* begin, const double* end);

/// Those of all ranks of an MPI job, on all of them.
Pieces gathered(const Pieces& own);

/// Two pieces of one clash. Of pairs of one distance that of the smaller point of the site counts, as in memory.
void join(Piece& piece, const Piece& other);

/// Leaves so many at most, drawn by lots: of all points of a clash the same, in whatever parts they are drawn.
void drawSome(std::vector<Member>& members, std::size_t most);

} // namespace pcl_bsh::site
