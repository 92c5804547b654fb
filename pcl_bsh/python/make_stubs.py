# SPDX-License-Identifier: BSD-3-Clause
"""Writes a module's stub from the signatures that its docstrings begin with.

python3 make_stubs.py __init__.pyi|vtk.pyi   of the package beside which the module _core, or vtk, was built
"""
import enum
import importlib
import inspect
import pathlib
import re
import sys

CORE = """\
import enum
import os
from typing import Any, Callable, Dict, Iterator, List, Literal, Mapping, Optional, Sequence, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

__version__: str
__all__: List[str]
"""
# Debian's vtkmodules have no stubs: where VTK's own are missing, what these classes inherit is not checked.
VTK = "from typing import Optional\n"
WORDS = [  # pybind11's to those of Python's typing
    (r"\b_core\.", ""),
    (r"numpy\.ndarray\[numpy\.(\w+)\]", r"npt.NDArray[np.\1]"),
    (r"numpy\.ndarray\[[\w:]+\]", "npt.NDArray[np.void]"),  # records
    (r"numpy\.ndarray\b", "npt.NDArray[Any]"),
    (r"\*\*kwargs", "**options: Any"),
    (r"\[\d+\]", ""),  # of an array of fixed length
    (r"\bdict\b", "Dict[str, Any]"),
    (r"\bIterator\b", "Iterator[Any]"),
]


def typed(text):
    for pybind, typing in WORDS:
        text = re.sub(pybind, typing, text)
    return text


def functions(name, doc, indent=""):
    """The lines for a function: of each overload."""
    found = re.findall(rf"^(?:\d+\. )?{name}\((.*)\) -> (.*)$", doc, re.MULTILINE)
    for arguments, result in found:
        arguments = re.sub(r"^self: [\w.]+", "self", typed(arguments).replace("List[", "Sequence["))
        arguments = re.sub(r": (\w+) = None", r": Optional[\1] = None", arguments)  # of a pointer
        if len(found) > 1:
            yield f"{indent}@overload"
        elif indent and not arguments.startswith("self"):
            yield f"{indent}@staticmethod"
        yield f"{indent}def {name}({arguments}) -> {typed(result)}: ..."


def members(cls):
    for name, member in vars(cls).items():
        if isinstance(member, property):
            result = member.fget.__doc__.splitlines()[0].split(" -> ")[1]
            yield from ["    @property", f"    def {name}(self) -> {typed(result)}: ..."]
        else:
            yield from functions(name, getattr(getattr(cls, name), "__doc__", None) or "", "    ")


def core(module):
    for name, value in vars(module).items():
        if name.startswith("_"):
            continue
        if not inspect.isclass(value):
            yield from functions(name, value.__doc__) if callable(value) else [f"{name}: {type(value).__name__}"]
        elif issubclass(value, enum.Enum):
            yield from [f"class {name}(enum.IntEnum):", *(f"    {member.name} = {member.value}" for member in value)]
        elif issubclass(value, Exception):
            yield f"class {name}({', '.join(base.__name__ for base in value.__bases__)}): ..."
        else:
            yield from [f"class {name}:", *members(value)]


def vtk(module):
    """VTK's wrappers, too, write each method's signature into its docstring; None stands for a null object."""
    lines, used = [], set()
    classes = sorted((c for n, c in vars(module).items() if n.startswith("vtk")), key=lambda c: len(c.__mro__))
    for cls in classes:
        base = cls.__bases__[0]
        used.add(base.__name__)
        lines.append(f"class {cls.__name__}({base.__name__}):" + ("" if base in classes else "  # type: ignore"))
        if cls not in [c.__bases__[0] for c in classes]:  # what others derive from is abstract
            lines.append("    def __init__(self) -> None: ...")
        for name, member in vars(cls).items():
            if not name.startswith(("__", "IsTypeOf", "IsA", "GetNumberOfGenerations")):
                doc = re.sub(r"\s+", " ", member.__doc__.split("C++:")[0]).strip().replace(":", ": ")
                used.update(re.findall(r"\bvtk\w+", doc))
                doc = doc if name == "NewInstance" else re.sub(r"\b(vtk\w+)", r"Optional[\1]", doc)
                lines.extend(functions(name, doc, "    "))
    for part in ("Core", "DataModel", "ExecutionModel", "Transforms"):
        common = importlib.import_module(f"vtkmodules.vtkCommon{part}")
        names = ", ".join(name for name in sorted(used) if hasattr(common, name))
        yield f"from {common.__name__} import {names}  # type: ignore"
    yield from lines


stub = pathlib.Path(sys.argv[1])
if stub.name == "vtk.pyi":
    sys.path.insert(0, str(stub.parent.parent))
    text = VTK + "\n".join(vtk(importlib.import_module("pcl_bsh.vtk")))
else:
    sys.path.insert(0, str(stub.parent))  # without the package, which hides the types
    text = CORE + "\n".join(core(importlib.import_module("_core")))
stub.write_text("# SPDX-License-Identifier: BSD-3-Clause\n" + text + "\n")
