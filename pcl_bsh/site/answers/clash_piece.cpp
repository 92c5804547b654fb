// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/answers/clash_piece.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh::site {

namespace {

constexpr std::size_t member_numbers = 9, piece_numbers = member_numbers + 17;

/// Numbers of 32 bits, floats and numbers of points are exact as doubles.
void write(std::vector<double>& out, const Member& member)
{
  out.insert(out.end(), member.place.begin(), member.place.end());
  for (const SitePoint& point : {member.point, member.piece}) {
    out.push_back(static_cast<double>(point.source));
    out.push_back(static_cast<double>(point.record));
  }
  out.push_back(double{member.distance});
  out.push_back(static_cast<double>(member.closest_pose));
}

Member readMember(const double* in)
{
  const auto point = [](const double* at) {
    return SitePoint{static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1])};
  };
  return {
      {in[0], in[1], in[2]}, point(in + 3), point(in + 5), static_cast<float>(in[7]), static_cast<std::int32_t>(in[8])};
}

void write(std::vector<double>& out, const Piece& piece)
{
  write(out, piece.nearest);
  const Clash& clash = piece.clash;
  out.push_back(static_cast<double>(clash.points));
  out.insert(out.end(), clash.low.begin(), clash.low.end());
  out.insert(out.end(), clash.high.begin(), clash.high.end());
  out.push_back(clash.distance);
  out.insert(out.end(), {static_cast<double>(piece.met.point.source), static_cast<double>(piece.met.point.record)});
  out.insert(out.end(), piece.met.place.begin(), piece.met.place.end());
  out.push_back(static_cast<double>(clash.first_pose));
  out.push_back(static_cast<double>(clash.certain_points));
  out.insert(out.end(), {clash.interval.lower, clash.interval.upper});
}

Piece readPiece(const double* in)
{
  Piece piece;
  piece.nearest = readMember(in);
  in += member_numbers;
  Clash& clash = piece.clash;
  clash.points = static_cast<std::size_t>(in[0]);
  clash.low = {in[1], in[2], in[3]};
  clash.high = {in[4], in[5], in[6]};
  clash.distance = in[7];
  piece.met = {{static_cast<std::uint32_t>(in[8]), static_cast<std::uint32_t>(in[9])}, {in[10], in[11], in[12]}};
  clash.first_pose = static_cast<std::int32_t>(in[13]);
  clash.certain_points = static_cast<std::size_t>(in[14]);
  clash.interval = {in[15], in[16]};
  clash.closest_pose = piece.nearest.closest_pose;
  return piece;
}

template <typename Item>
void writeAll(std::vector<double>& out, const std::vector<Item>& items)
{
  out.push_back(static_cast<double>(items.size()));
  for (const Item& item : items) write(out, item);
}

/// @return where the next list begins
template <typename Item, typename Read>
const double* readAll(std::vector<Item>& items, const double* in, std::size_t numbers, const Read& read)
{
  for (auto left = static_cast<std::size_t>(*in++); left > 0; --left) {
    items.push_back(read(in));
    in += numbers;
  }
  return in;
}

/// Mixes all bits of a point's name (the finalizer of MurmurHash3).
std::uint64_t lotOf(const SitePoint& point)
{
  std::uint64_t bits = (std::uint64_t{point.source} << 32 | point.record) + 1;
  bits = (bits ^ bits >> 33) * 0xff51afd7ed558ccdULL;
  bits = (bits ^ bits >> 33) * 0xc4ceb9fe1a85ec53ULL;
  return bits ^ bits >> 33;
}

} // namespace

std::vector<double> numbersOf(const Pieces& pieces)
{
  std::vector<double> numbers = {pieces.of_site ? 1.0 : 0.0};
  writeAll(numbers, pieces.pieces);
  writeAll(numbers, pieces.border);
  writeAll(numbers, pieces.some);
  return numbers;
}

void add(Pieces& pieces, const double* begin, const double* end)
{
  while (begin != end) {
    pieces.of_site = *begin++ != 0.0 || pieces.of_site;
    begin = readAll(pieces.pieces, begin, piece_numbers, readPiece);
    begin = readAll(pieces.border, begin, member_numbers, readMember);
    begin = readAll(pieces.some, begin, member_numbers, readMember);
  }
}

Pieces gathered(const Pieces& own)
{
  const std::vector<double> numbers = gatheredFromAllRanks(numbersOf(own));
  Pieces all;
  add(all, numbers.data(), numbers.data() + numbers.size());
  return all;
}

void join(Piece& piece, const Piece& other)
{
  Clash& clash = piece.clash;
  clash.points += other.clash.points;
  clash.certain_points += other.clash.certain_points;
  for (std::size_t k = 0; k < 3; ++k) {
    clash.low[k] = std::min(clash.low[k], other.clash.low[k]);
    clash.high[k] = std::max(clash.high[k], other.clash.high[k]);
  }
  clash.first_pose = std::min(clash.first_pose, other.clash.first_pose);
  clash.interval.lower = std::fmin(clash.interval.lower, other.clash.interval.lower); // the one that is a number
  clash.interval.upper = std::fmin(clash.interval.upper, other.clash.interval.upper);
  if (std::pair(clash.distance, piece.nearest.point) <= std::pair(other.clash.distance, other.nearest.point)) return;
  clash.distance = other.clash.distance;
  clash.closest_pose = other.clash.closest_pose;
  piece.nearest = other.nearest;
  piece.met = other.met;
}

void drawSome(std::vector<Member>& members, std::size_t most)
{
  if (members.size() <= most) return;
  std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(most), members.end(),
                   [](const Member& a, const Member& b) {
                     return std::pair(lotOf(a.point), a.point) < std::pair(lotOf(b.point), b.point);
                   });
  members.resize(most);
}

} // namespace pcl_bsh::site
