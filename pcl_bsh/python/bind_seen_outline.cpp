// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/track/seen_outline.h>

#include <pybind11/stl.h>

#include <cmath>
#include <vector>

namespace pcl_bsh::python {
namespace {

constexpr auto kSeenOutline =
    R"(How much of envelopes' outlines the beams of a scanner crossed, part by part of the axis.

Parameters
----------
points : array_like, (n, 3), or structured with x, y, z
origins : array_like, (n, 3), or structured with x, y, z
    Where the beam of each point came from; NaN: it is not known, and the beam does not count.
axis : Axis
envelopes : sequence of Envelope
step : float, default 1
    Length of a part of the axis; the last one may be shorter.
spacing : float, default 0.1
    The longest edge of an outline's cells. A cell is seen where a beam crosses it.
reach, below, above, threads
    As `gauge` has them.

Returns
-------
structured ndarray
    A row for each part and each envelope that counts at its middle: distance_from, distance_to, chainage_from,
    chainage_to, envelope, the shares of cells that are seen: seen, left, above, right and below, NaN where there are
    none, and unseen: whether no beam crossed one of the sides.

Raises
------
ValueError
    For another number of origins than of points, a spacing that is no length, and as `gauge` does.

Examples
--------
>>> import pcl_bsh
>>> axis = pcl_bsh.Axis([[0, 0, 0], [100, 0, 0]], [1000, 1100])
>>> box = pcl_bsh.Envelope("box", [[-1.5, 0], [1.5, 0], [1.5, 4], [-1.5, 4]])
>>> rows = pcl_bsh.seen_outline([[20.0, -3, 2]], [[20.0, 0, 2]], axis, [box], step=50, spacing=0.5)
>>> rows["right"] > 0, rows["left"], rows["unseen"]
(array([ True, False]), array([0., 0.]), array([ True,  True]))
)";

/// A row of an outline, NaN where it has no cells.
struct SeenRow {
  double distance_from, distance_to, chainage_from, chainage_to;
  std::int32_t envelope;
  double seen, left, above, right, below;
  bool unseen;
};

Records seenRows(const ArrayLike& points, const ArrayLike& origins, const Axis& axis,
                 const std::vector<Envelope>& envelopes, double step, double spacing, double reach, double below,
                 double above, unsigned threads)
{
  py::array kept_points, kept_origins;
  const PointsView view = viewForCall("points", points, kept_points),
                   places = viewForCall("origins", origins, kept_origins);
  if (places.count != view.count)
    throw InvalidInput(Input::trajectory, "origins",
                       "has " + counted(places.count, "place") + " for " + counted(view.count, "point"),
                       "give one for each point");
  std::vector<SeenRow> rows = unlocked([&] {
    std::vector<Point3> each;
    for (std::uint32_t i = 0; i < places.count; ++i) each.push_back(places.point(i));
    const GaugeTable parts(axis, envelopes.size(), step);
    SeenOutline outline(axis, envelopes, {step, spacing});
    outline.add(view, each, {{reach, below, above}, threads});
    std::vector<SeenRow> made;
    for (std::size_t part = 0; part < parts.parts(); ++part) {
      const double from = parts.from(part), to = parts.to(part);
      for (std::size_t e = 0; e < envelopes.size(); ++e) {
        if (!envelopes[e].countsAt(axis.chainage(0.5 * from + 0.5 * to))) continue;
        made.push_back({from, to, axis.chainage(from), axis.chainage(std::nextafter(to, from)),
                        static_cast<std::int32_t>(e), outline.share(part, e), outline.share(part, e, Sector::left),
                        outline.share(part, e, Sector::above), outline.share(part, e, Sector::right),
                        outline.share(part, e, Sector::below), outline.isUnseen(part, e)});
      }
    }
    return made;
  });
  return Records(arrayFrom(std::move(rows)));
}

} // namespace

void bindSeenOutline(py::module_& module)
{
  PYBIND11_NUMPY_DTYPE(SeenRow, distance_from, distance_to, chainage_from, chainage_to, envelope, seen, left, above,
                       right, below, unseen);
  module.def("seen_outline", &seenRows, kSeenOutline, "points"_a, "origins"_a, "axis"_a, "envelopes"_a, py::kw_only(),
             "step"_a = 1.0, "spacing"_a = 0.1, "reach"_a = 10.0, "below"_a = 5.0, "above"_a = 15.0, "threads"_a = 1);
}

} // namespace pcl_bsh::python
