# SPDX-License-Identifier: BSD-3-Clause
"""Gauging runs along an axis: against the formulas of straights and circles."""

import numpy as np
import pytest

import pcl_bsh
from stubs import mypy_errors

BOX = [[-1.5, 0], [1.5, 0], [1.5, 4], [-1.5, 4]]
BEND = "chainage 1000\nstart 500000 4000000 0\narc 300 200\nheight 1000 30\nequation 1100 2100"


def box_distance(u, v, widen=0.0):
    dx, dy = np.abs(u) - 1.5 - widen, np.maximum(v - 4, -v)
    return np.where((dx > 0) & (dy > 0), np.hypot(dx, dy), np.maximum(dx, dy))


def about_the_bend(n=2000):
    """Points about a circle of radius 200 that turns to the right from north."""
    random = np.random.default_rng(1)
    s, u, v = random.uniform(0, 300, n), random.uniform(-4, 4, n), random.uniform(-1, 6, n)
    radius, angle = 200 - u, s / 200
    return np.stack([500200 - radius * np.cos(angle), 4000000 + radius * np.sin(angle), 30 + v], 1), s, u, v


def test_a_circle_is_its_formula():
    points, s, u, v = about_the_bend()
    axis = pcl_bsh.Axis.elements(BEND)
    assert axis.length == 300 and axis.smallest_radius == 200 and axis.deviation == 0
    envelopes = [pcl_bsh.Envelope("late", BOX, ranges=[(2100, 2400)]),
                 pcl_bsh.Envelope("wide", BOX, widening=[[0, 0.5, 0.5], [300, 0.5, 0.5]])]
    found = pcl_bsh.gauge(points, axis, envelopes, threads=2)
    assert (found.place == 0).all() and found.counts["at_one_place"] == len(points)
    np.testing.assert_allclose(found.distance, s, atol=1e-8)
    np.testing.assert_allclose(found.chainage, s + np.where(s < 100, 1000, 2000), atol=1e-8)
    np.testing.assert_allclose(found.offset, u, atol=2e-9)
    np.testing.assert_allclose(found.height, v, atol=2e-9)
    late, wide = np.where(s < 100, np.nan, box_distance(u, v)), box_distance(u, v, 0.5)
    np.testing.assert_allclose(found.each, np.stack([late, wide], 1), atol=4e-9)
    np.testing.assert_array_equal(found.clearance, np.nanmin(found.each, axis=1))
    np.testing.assert_array_equal(found.each[np.arange(len(s)), found.envelope], found.clearance)
    assert not found.offset.flags.writeable
    narrow = pcl_bsh.gauge(points.astype(np.float32), axis, envelopes)
    assert np.abs(narrow.offset - u).max() < 0.5

    table = found.table(step=50)
    assert len(table) == 12 and table["points"][::2].sum() == len(points)
    np.testing.assert_array_equal(table["distance_from"][::2], np.arange(0, 300, 50))
    np.testing.assert_array_equal(table["chainage_from"][::2], [1000, 1050, 2100, 2150, 2200, 2250])
    for row in table:
        inside = (s >= row["distance_from"]) & (s < row["distance_to"])
        least = found.each[inside, row["envelope"]].min()
        np.testing.assert_array_equal(row["smallest"], least)
        np.testing.assert_array_equal(np.nanmin([row[k] for k in ("left", "above", "right", "below")] + [np.inf]),
                                      np.inf if np.isnan(least) else least)


def test_a_vehicle_widens_by_its_overthrow():
    axis = pcl_bsh.Axis.elements(BEND)
    p, o = 19.0, 3.7
    found = pcl_bsh.gauge(about_the_bend()[0], axis, [pcl_bsh.Envelope("wagon", BOX, vehicle=(p, o))])
    inner = 200 - np.sqrt(200**2 - p**2 / 4)
    outer = np.sqrt(200**2 - p**2 / 4 + (p / 2 + o) ** 2) - 200
    right = (np.abs(found.offset - inner / 2 + outer / 2) > 1) & (found.height > 1) & (found.height < 3)
    expected = np.where(found.offset > 0, found.offset - 1.5 - inner, -found.offset - 1.5 - outer)
    np.testing.assert_allclose(found.clearance[right], expected[right], atol=4e-9)


def test_an_axis_through_points_and_its_frame(tmp_path):
    at = np.array([[0, 0, 10.0], [50, 0, 10], [100, 0, 10]])
    axis = pcl_bsh.Axis(at, [0, 50, 100], [0.1, 0.1, 0.1], gauge=1.5, pivot="centre")
    frame = axis.frame(20.0)
    np.testing.assert_allclose(frame[:3, :3].T @ frame[:3, :3], np.eye(3), atol=1e-15)
    np.testing.assert_allclose(frame[:3, 0], [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(frame[2, 1], 0.1 / 1.5, atol=1e-15)  # the left rail is higher
    np.testing.assert_allclose(frame[:3, 3], [20, 0, 10], atol=1e-12)
    angle = np.linspace(0, 1, 101)
    circle = np.stack([100 * np.sin(angle), 100 * np.cos(angle), 0 * angle], axis=1)
    circle[:, :2] += np.random.default_rng(1).uniform(-0.005, 0.005, (101, 2))
    fitted = pcl_bsh.Axis(circle, 100 * angle, fit=0.02)
    assert 0.002 < fitted.deviation <= 0.02 and 90 < fitted.smallest_radius < 105
    assert pcl_bsh.Axis(circle, 100 * angle).smallest_radius < 80
    (tmp_path / "line.axis").write_text(BEND)
    read = pcl_bsh.Axis.read(tmp_path / "line.axis")
    assert read.distances_at(2150.0) == [150.0] and read.distances_at(1500.0) == []
    assert repr(read) == "Axis(chainage 1000.0 to 2300.0)"
    with pytest.raises(pcl_bsh.FileError, match="none.csv"):
        pcl_bsh.Axis.read(tmp_path / "none.csv")


def test_points_without_a_place():
    axis = pcl_bsh.Axis([[0, 0, 0], [100, 0, 0]], [0, 100])
    points = [[50, 0, 1], [-1, 0, 1], [101, 0, 1], [50, 50, 1], [np.nan, 0, 1]]
    found = pcl_bsh.gauge(points, axis, [pcl_bsh.Envelope("box", BOX)])
    assert found.place.tolist() == [0, 2, 3, 4, 5] and found.envelope.tolist() == [0, -1, -1, -1, -1]
    for column in (found.chainage, found.distance, found.offset, found.height, found.clearance):
        assert np.isnan(column).tolist() == [False, True, True, True, True]
    assert repr(found) == "Gauged(1 point at the axis, of 5)"
    nothing = pcl_bsh.gauge(np.empty((0, 3)), axis, [pcl_bsh.Envelope("box", BOX)])
    assert nothing.offset.shape == (0,) and nothing.each.shape == (0, 1)
    assert np.isnan(nothing.table(step=100)["smallest"]).all()


def test_several_tracks_are_each_its_own_run():
    points, _, _, _ = about_the_bend()
    points[5] = [0, 0, 0]
    left, right = pcl_bsh.Axis.elements(BEND), pcl_bsh.Axis.elements(BEND.replace("500000", "500003").replace("200", "197", 1))
    box, wide = pcl_bsh.Envelope("box", BOX), pcl_bsh.Envelope("wide", BOX, widening=[[0, 0.5, 0.5]])
    found = pcl_bsh.gauge_tracks(points, [("left", left, [box, wide]), ("right", right, [box])], threads=2)
    assert found.names == ["left", "right"] and repr(found) == "GaugedTracks(2 tracks, 2000 points)"
    for of, alone in zip(found.each, (pcl_bsh.gauge(points, left, [box, wide]), pcl_bsh.gauge(points, right, [box]))):
        for column in ("chainage", "offset", "height", "clearance", "envelope", "place", "each"):
            np.testing.assert_array_equal(getattr(of, column), getattr(alone, column))
        table, table_alone = of.table(step=50), alone.table(step=50)
        for column in table.dtype.names:
            np.testing.assert_array_equal(table[column], table_alone[column])
    both = np.stack([of.clearance for of in found.each])
    np.testing.assert_array_equal(found.told.clearance, np.fmin(*both))
    assert found.track[5] == -1 and set(found.track) == {-1, 0, 1} and np.isnan(found.told.chainage[5])
    for number, of in enumerate(found.each):
        mine = found.track == number
        for column in ("chainage", "offset", "height", "envelope", "place"):
            np.testing.assert_array_equal(getattr(found.told, column)[mine], getattr(of, column)[mine])
    assert found.told.each.shape == (2000, 0) and len(found.told.table()) == 0


def test_beams_cross_cells_of_an_outline():
    axis, box = pcl_bsh.Axis([[0, 0, 0], [10, 0, 0]], [100, 110]), pcl_bsh.Envelope("box", BOX)
    tall = pcl_bsh.Envelope("tall", BOX, ranges=[(106, 110)])
    points = np.array([[2.1, -3, 2.1], [2.2, -3, 2.2], [2.7, -3, 2.1], [2.1, 3, 2.1], [7.1, 0, 9]])
    origins = points.copy()
    origins[:, 1:] = 0, 2.1
    rows = pcl_bsh.seen_outline(points, origins, axis, [box, tall], step=5, spacing=0.5, threads=2)
    assert rows["envelope"].tolist() == [0, 0, 1] and rows["chainage_from"].tolist() == [100, 105, 105], "where it counts"
    high = BOX[2][1] - BOX[1][1]
    side = (5 / 0.5) * np.ceil(high / 0.5)
    assert rows["right"][0] == 2 / side and rows["left"][0] == 1 / side and rows["above"][0] == 0
    assert rows["above"][1] > 0 and rows["right"][1] == 0 and rows["unseen"].tolist() == [True, True, True]
    origins[4] = np.nan
    assert pcl_bsh.seen_outline(points, origins, axis, [box], step=5, spacing=0.5)["above"][1] == 0, "without an origin"


@pytest.mark.parametrize("call, message", [
    (lambda axis, box: pcl_bsh.seen_outline(np.zeros((2, 3)), np.zeros((1, 3)), axis, [box]),
     "origins: has 1 place for 2 points: give one for each point"),
    (lambda axis, box: pcl_bsh.seen_outline(np.zeros((1, 3)), np.zeros((1, 3)), axis, [box], spacing=0), "spacing"),
    (lambda axis, box: pcl_bsh.gauge_tracks(np.zeros((1, 3)), []), "tracks: there are none: give one at least"),
    (lambda axis, box: pcl_bsh.gauge_tracks(np.zeros((1, 3)), [("a", axis, [])]), "envelopes: there are none"),
    (lambda axis, box: pcl_bsh.gauge(np.zeros((1, 3)), axis, []), "envelopes: there are none: give one at least"),
    (lambda axis, box: pcl_bsh.gauge(np.zeros((1, 3)), axis, [box], reach=-1), "reach"),
    (lambda axis, box: pcl_bsh.gauge(np.zeros((1, 2)), axis, [box]), "points"),
    (lambda axis, box: pcl_bsh.Axis([[0, 0, 0], [1, 0, 0]], [0]), "chainages: are 1: give one for each of the 2 points"),
    (lambda axis, box: pcl_bsh.Axis([[0, 0]], [0]), r"points: have shape \(1, 2\): give \(n, 3\)"),
    (lambda axis, box: pcl_bsh.Axis([[0, 0, 0], [1, 0, 0]], [0, 1], pivot="left"), "pivot: `left` is unknown"),
    (lambda axis, box: pcl_bsh.Axis.elements("bend 5"), "elements: line 1"),
    (lambda axis, box: axis.chainage(101), "distance: 101.0 is not on the axis: give one from 0 to 100.0"),
    (lambda axis, box: axis.frame(np.nan), "distance: nan"),
    (lambda axis, box: pcl_bsh.Envelope("x", [[0, 0], [1, 1], [1, 0], [0, 1]]), "envelope x: its edges"),
    (lambda axis, box: pcl_bsh.Envelope("x", BOX, widening=[[5, 0, 0], [4, 0, 0]]), "widening: has distances that fall"),
    (lambda axis, box: pcl_bsh.gauge(np.zeros((1, 3)), axis, [box]).table(step=0), "step"),
])
def test_wrong_input_is_named(call, message):
    axis = pcl_bsh.Axis([[0, 0, 0], [100, 0, 0]], [0, 100])
    with pytest.raises(ValueError, match=message):
        call(axis, pcl_bsh.Envelope("box", BOX))


def test_types(tmp_path):
    assert mypy_errors(
        tmp_path,
        "import numpy as np\n"
        "import pcl_bsh\n"
        "axis = pcl_bsh.Axis(np.zeros((2, 3)), [0, 1], pivot='centre')\n"
        "box = pcl_bsh.Envelope('box', [[0, 0], [1, 0], [1, 1]], ranges=[(0, 1)], vehicle=(19, 3))\n"
        "found = pcl_bsh.gauge(np.zeros((1, 3)), pcl_bsh.Axis.elements('straight 5'), [box], reach=5)\n"
        "least: float = float(found.clearance.min() + found.each[0, 0])\n"
        "found.table(step=2)['smallest'].dtype\n"
        "pcl_bsh.gauge(np.zeros((1, 3)), axis, box)  # error: not a list\n"
        "pcl_bsh.Axis(np.zeros((2, 3)), [0, 1], pivot='left')  # error\n"
        "axis.length = 3.0  # error\n"
        "both = pcl_bsh.gauge_tracks(np.zeros((1, 3)), [('left', axis, [box]), ('right', axis, [box])])\n"
        "both.each[0].clearance.min() + both.told.clearance[both.track >= 0].min()\n"
        "pcl_bsh.gauge_tracks(np.zeros((1, 3)), [axis])  # error\n") == [8, 9, 10, 13]
