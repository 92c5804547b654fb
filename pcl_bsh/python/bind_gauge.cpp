// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/track/gauge_table.h>
#include <pcl_bsh/track/tracks.h>

#include <pybind11/stl.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

constexpr auto kEnvelope =
    R"(Room about an axis that must stay free: a polygon in section, which may widen along the axis.

Parameters
----------
name : str
corners : array_like, (n, 2)
    Offset to the right and height of each corner; closed, and may not cross itself.
ranges : sequence of (float, float), optional
    Chainages where it counts, both inclusive; default everywhere.
vehicle : (float, float), optional
    Distance of a vehicle's pivots and its overhang: it widens by their overthrow, by the axis' radius at each place.
widening : array_like, (n, 3), optional
    Distance along the axis, and how much it widens to the left and to the right there; straight between rows.

Raises
------
ValueError
    Naming the envelope, and the edges that cross.

Examples
--------
>>> import pcl_bsh
>>> pcl_bsh.Envelope("box", [[-1.5, 0], [1.5, 0], [1.5, 4], [-1.5, 4]], ranges=[(100, 200)])
Envelope('box', 4 corners)
)";

constexpr auto kGauge =
    R"(The place of every point beside an axis, and its clearance from envelopes.

Parameters
----------
points : array_like, (n, 3), or structured with x, y, z
axis : Axis
envelopes : sequence of Envelope
reach : float, default 10
    How far beside the axis points belong to it; at most 0.8 of its smallest radius.
below, above : float, default 5 and 15
    How far below and above the axis' height points belong to it.
threads : int, default 1
    0: all of the machine's; the result is the same for any number.

Returns
-------
Gauged
    A point that is near two places of the axis counts at both: its clearance is the smaller one.

Raises
------
ValueError
    Without envelopes, or for a reach that this axis does not have.

Examples
--------
>>> import pcl_bsh
>>> axis = pcl_bsh.Axis([[0, 0, 0], [100, 0, 0]], [1000, 1100])
>>> box = pcl_bsh.Envelope("box", [[-1.5, 0], [1.5, 0], [1.5, 4], [-1.5, 4]])
>>> found = pcl_bsh.gauge([[20.0, -1.25, 2.0], [30, 2, 2], [30, 50, 2]], axis, [box])
>>> found.chainage, found.offset, found.clearance
(array([1020., 1030.,   nan]), array([ 1.25, -2.  ,   nan]), array([-0.25,  0.5 ,   nan]))
>>> found.envelope
array([ 0,  0, -1], dtype=int32)
)";

constexpr auto kGaugeTracks =
    R"(Gauges several tracks beside one another in one pass.

Parameters
----------
points : array_like, (n, 3), or structured with x, y, z
tracks : sequence of (str, Axis, sequence of Envelope)
    Name, axis and envelopes of each track.
reach, below, above, threads
    As `gauge` has them.

Returns
-------
GaugedTracks
    A point that is near several tracks counts at each. It is told with that of its smallest clearance, of equal ones
    with the nearer one; a track where no envelope counts comes last.

Raises
------
ValueError
    Without tracks, and as `gauge` does.

Examples
--------
>>> import pcl_bsh
>>> left = pcl_bsh.Axis([[0, 4, 0], [100, 4, 0]], [1000, 1100])
>>> right = pcl_bsh.Axis([[0, 0, 0], [100, 0, 0]], [0, 100])
>>> box = pcl_bsh.Envelope("box", [[-1.5, 0], [1.5, 0], [1.5, 4], [-1.5, 4]])
>>> found = pcl_bsh.gauge_tracks([[20.0, 3, 2], [30, 1.5, 2]], [("left", left, [box]), ("right", right, [box])])
>>> found.track, found.told.clearance, found.told.chainage
(array([0, 1], dtype=int32), array([-0.5,  0. ]), array([1020.,   30.]))
>>> found.each[1].clearance
array([1.5, 0. ])
)";

constexpr auto kTable =
    R"(The smallest clearance of each part of the axis.

Parameters
----------
step : float, default 1
    Length of a part; the last one may be shorter.

Returns
-------
structured ndarray
    A row for each part and envelope: distance_from, distance_to, chainage_from, chainage_to, envelope, points, and the
    clearances smallest, left, above, right and below, by side of the envelope. NaN: no data, which is not clear.

Examples
--------
>>> import pcl_bsh
>>> axis = pcl_bsh.Axis([[0, 0, 0], [100, 0, 0]], [1000, 1100])
>>> box = pcl_bsh.Envelope("box", [[-1.5, 0], [1.5, 0], [1.5, 4], [-1.5, 4]])
>>> table = pcl_bsh.gauge([[20.0, -1.25, 2.0], [30, 2, 2]], axis, [box]).table(step=50)
>>> table["chainage_from"], table["smallest"], table["left"]
(array([1000., 1050.]), array([-0.25,   nan]), array([0.5, nan]))
)";

Envelope envelopeOf(std::string name, const ArrayLike& corners, const std::vector<std::pair<double, double>>& ranges,
                    const std::optional<std::pair<double, double>>& vehicle, const OptionalArray& widening)
{
  EnvelopeDescription description;
  description.name = std::move(name);
  const std::vector<double> numbers = rowsOf("corners", corners, 2);
  for (std::size_t i = 0; i < numbers.size(); i += 2) description.corners.push_back({numbers[i], numbers[i + 1]});
  for (const auto& [from, to] : ranges) description.ranges.push_back({from, to});
  if (vehicle) description.vehicle = Vehicle{vehicle->first, vehicle->second};
  if (!widening.is_none()) {
    const std::vector<double> rows = rowsOf("widening", widening, 3);
    std::vector<Knot> left, right;
    for (std::size_t i = 0; i < rows.size(); i += 3) {
      if (i > 0 && !(rows[i] >= rows[i - 3]))
        throw InvalidInput(Input::trajectory, "widening", "has distances that fall", "give rows along the axis");
      left.push_back({rows[i], rows[i + 1]});
      right.push_back({rows[i], rows[i + 2]});
    }
    description.left = Piecewise::through(left, Piecewise::Ends::held);
    description.right = Piecewise::through(right, Piecewise::Ends::held);
  }
  return Envelope(std::move(description));
}

/// The answer of gauge(), with its axis and envelopes, and the chainage of each point.
struct GaugedRun {
  Axis axis;
  std::vector<Envelope> envelopes;
  GaugedPoints found;
  std::vector<double> chainage;
};

/// @param axis_at the axis of the track that a point with a place is told with
template <class AxisAt>
GaugedRun runOf(Axis axis, std::vector<Envelope> envelopes, GaugedPoints found, const AxisAt& axis_at)
{
  GaugedRun run{std::move(axis), std::move(envelopes), std::move(found), {}};
  run.chainage.reserve(run.found.state.size());
  for (std::size_t i = 0; i < run.found.state.size(); ++i) {
    const bool placed = hasPlace(run.found.state[i]);
    if (!placed) run.found.place[i] = {no_number, no_number, no_number};
    run.chainage.push_back(placed ? axis_at(i).chainage(run.found.place[i].distance) : no_number);
  }
  return run;
}

GaugedRun gaugeOf(const ArrayLike& points, const Axis& axis, const std::vector<Envelope>& envelopes, double reach,
                  double below, double above, unsigned threads)
{
  py::array kept;
  const PointsView view = viewForCall("points", points, kept);
  return unlocked([&] {
    return runOf(axis, envelopes, gauge(view, axis, envelopes, {{reach, below, above}, threads}),
                 [&](std::size_t) -> const Axis& { return axis; });
  });
}

/// Answers for several tracks.
struct GaugedLines {
  std::vector<std::string> names;
  std::vector<GaugedRun> each;
  GaugedRun told;
  std::vector<std::int32_t> track;
};

GaugedLines gaugeTracks(const ArrayLike& points,
                        const std::vector<std::tuple<std::string, Axis, std::vector<Envelope>>>& given, double reach,
                        double below, double above, unsigned threads)
{
  py::array kept;
  const PointsView view = viewForCall("points", points, kept);
  return unlocked([&] {
    std::vector<Track> tracks;
    for (const auto& [name, axis, envelopes] : given) tracks.push_back({name, axis, envelopes});
    GaugedTracks found = gauge(view, tracks, {{reach, below, above}, threads});
    const auto axis_at = [&](std::size_t i) -> const Axis& {
      return tracks[static_cast<std::size_t>(found.track[i])].axis;
    };
    GaugedLines lines{{}, {}, runOf(tracks.front().axis, {}, std::move(found.told), axis_at), std::move(found.track)};
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      lines.names.push_back(tracks[t].name);
      lines.each.push_back(runOf(tracks[t].axis, tracks[t].envelopes, std::move(found.each[t]),
                                 [&](std::size_t) -> const Axis& { return tracks[t].axis; }));
    }
    return lines;
  });
}

/// A property for one of the numbers of each place.
auto placeColumn(double AxisPlace::*number)
{
  return [number](const py::object& self) {
    const std::vector<AxisPlace>& places = self.cast<const GaugedRun&>().found.place;
    return arrayIn(self, places.empty() ? nullptr : &(places.front().*number),
                   {static_cast<py::ssize_t>(places.size())}, {sizeof(AxisPlace)});
  };
}

/// A row of the table, NaN where there is no data.
struct GaugeRow {
  double distance_from, distance_to, chainage_from, chainage_to;
  std::int32_t envelope;
  std::uint64_t points;
  double smallest, left, above, right, below;
};

Records tableOf(const GaugedRun& run, double step)
{
  std::vector<GaugeRow> rows = unlocked([&] {
    GaugeTable table(run.axis, run.envelopes.size(), step);
    table.add(run.found, run.envelopes);
    const auto told = [](double clearance) { return std::isfinite(clearance) ? clearance : no_number; };
    std::vector<GaugeRow> made;
    for (std::size_t part = 0; part < table.parts(); ++part) {
      const double from = table.from(part), to = table.to(part);
      for (std::size_t e = 0; e < run.envelopes.size(); ++e)
        made.push_back({from, to, run.axis.chainage(from), run.axis.chainage(std::nextafter(to, from)),
                        static_cast<std::int32_t>(e), table.points(part), told(table.smallest(part, e)),
                        told(table.smallest(part, e, Sector::left)), told(table.smallest(part, e, Sector::above)),
                        told(table.smallest(part, e, Sector::right)), told(table.smallest(part, e, Sector::below))});
    }
    return made;
  });
  return Records(arrayFrom(std::move(rows)));
}

py::dict countsOf(const GaugedRun& run)
{
  const auto& counts = run.found.counts;
  return py::dict("at_one_place"_a = counts[0], "at_two_places"_a = counts[1], "before_the_beginning"_a = counts[2],
                  "behind_the_end"_a = counts[3], "too_far"_a = counts[4], "not_finite"_a = counts[5]);
}

} // namespace

void bindGauge(py::module_& module)
{
  PYBIND11_NUMPY_DTYPE(GaugeRow, distance_from, distance_to, chainage_from, chainage_to, envelope, points, smallest,
                       left, above, right, below);

  py::class_<Envelope>(module, "Envelope", kEnvelope)
      .def(py::init(&envelopeOf), "name"_a, "corners"_a, py::kw_only(),
           "ranges"_a = std::vector<std::pair<double, double>>(), "vehicle"_a = py::none(), "widening"_a = py::none())
      .def_property_readonly("name", &Envelope::name)
      .def("__repr__", [](const Envelope& envelope) {
        return "Envelope('" + envelope.name() + "', " + counted(envelope.corners().size(), "corner") + ")";
      });
  py::class_<GaugedRun>(module, "Gauged",
                        "The answer of `gauge`: arrays have an entry for each point, NaN where it has no place at the "
                        "axis.")
      .def_property_readonly(
          "place",
          [](const py::object& self) {
            const auto& state = self.cast<const GaugedRun&>().found.state;
            return arrayIn(self, reinterpret_cast<const std::uint8_t*>(state.data()),
                           {static_cast<py::ssize_t>(state.size())});
          },
          "uint8: 0 at one place of the axis, 1 at two, 2 before its beginning, 3 behind its end, 4 "
          "too far from it, 5 not finite.")
      .def_property_readonly("chainage", column(&GaugedRun::chainage), "float64.")
      .def_property_readonly("distance", placeColumn(&AxisPlace::distance), "float64: along the axis.")
      .def_property_readonly("offset", placeColumn(&AxisPlace::offset), "float64: to the right, in the cant's plane.")
      .def_property_readonly("height", placeColumn(&AxisPlace::height), "float64: above the axis, in the same plane.")
      .def_property_readonly(
          "clearance",
          [](const py::object& self) { return arrayIn(self, self.cast<const GaugedRun&>().found.clearance); },
          "float64: the smallest of all envelopes, less than 0 inside; NaN where none counts.")
      .def_property_readonly(
          "envelope",
          [](const py::object& self) { return arrayIn(self, self.cast<const GaugedRun&>().found.envelope); },
          "int32: the number of the envelope that has it, of equal ones the first; -1: none counts.")
      .def_property_readonly(
          "each",
          [](const py::object& self) {
            const auto& run = self.cast<const GaugedRun&>();
            return arrayIn(
                self, run.found.each.data(),
                {static_cast<py::ssize_t>(run.found.state.size()), static_cast<py::ssize_t>(run.envelopes.size())});
          },
          "(points, envelopes) float64: the clearance of each envelope; NaN where it does not count.")
      .def_property_readonly("counts", &countsOf, "How many points have each state of `place`.")
      .def("table", &tableOf, kTable, "step"_a = 1.0)
      .def("__repr__", [](const GaugedRun& run) {
        return "Gauged(" + counted(run.found.counts[0] + run.found.counts[1], "point") + " at the axis, of " +
               std::to_string(run.found.state.size()) + ")";
      });
  module.def("gauge", &gaugeOf, kGauge, "points"_a, "axis"_a, "envelopes"_a, py::kw_only(), "reach"_a = 10.0,
             "below"_a = 5.0, "above"_a = 15.0, "threads"_a = 1);
  py::class_<GaugedLines>(module, "GaugedTracks", "The answer of `gauge_tracks`.")
      .def_readonly("names", &GaugedLines::names, "list of str: the tracks' names.")
      .def_readonly("each", &GaugedLines::each, "list of Gauged: the answer of each track, as if it were alone.")
      .def_readonly("told", &GaugedLines::told,
                    "Gauged: the answer of the track that each point is told with; it has no envelopes of its own.")
      .def_property_readonly("track", column(&GaugedLines::track),
                             "int32: the number of that track; -1: the point has a place at none.")
      .def("__repr__", [](const GaugedLines& lines) {
        return "GaugedTracks(" + counted(lines.names.size(), "track") + ", " + counted(lines.track.size(), "point") +
               ")";
      });
  module.def("gauge_tracks", &gaugeTracks, kGaugeTracks, "points"_a, "tracks"_a, py::kw_only(), "reach"_a = 10.0,
             "below"_a = 5.0, "above"_a = 15.0, "threads"_a = 1);
}

} // namespace pcl_bsh::python
