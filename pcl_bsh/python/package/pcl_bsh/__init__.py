# SPDX-License-Identifier: BSD-3-Clause
"""Where point clouds collide: bounding-sphere hierarchies, exact answers.

>>> import numpy as np, pcl_bsh
>>> hall = pcl_bsh.SphereHierarchy(np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]))
>>> robot = pcl_bsh.SphereHierarchy(np.array([[0.0, 0.0, 0.04]]))
>>> pcl_bsh.collision_flags(hall, robot, clearance=0.05)
array([1, 0], dtype=uint8)

Two points collide if and only if their distance is at most the clearance (plus their radii), as exact arithmetic on the
given numbers decides it. Poses are rigid transforms from a cloud to the world; lengths are in the clouds' own unit.
Queries run without the interpreter's lock. Wrong input is a ValueError that says what to do.
"""

from . import _core
from ._core import *  # noqa: F401,F403
from ._core import __version__  # noqa: F401

_core._hide_types()  # of docstrings, for inspect: the stubs have them
__all__ = [name for name in dir(_core) if not name.startswith("_")]

for _name in __all__:
    _value = getattr(_core, _name)
    if isinstance(_value, type):
        _value.__module__ = __name__
del _name, _value
