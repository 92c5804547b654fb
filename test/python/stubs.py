# SPDX-License-Identifier: BSD-3-Clause
"""The verdict of mypy on the package's stubs."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import pytest

import pcl_bsh

PACKAGE = pathlib.Path(pcl_bsh.__file__).parent


def mypy_errors(folder, program):
    """The lines of a program in which mypy finds an error."""
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("mypy is not found: install mypy")
    (folder / "use.py").write_text(program)
    env = dict(os.environ, MYPYPATH=str(PACKAGE.parent))
    result = subprocess.run([sys.executable, "-m", "mypy", f"--cache-dir={folder.parent}/mypy", "use.py"],
                            env=env, cwd=folder, capture_output=True, text=True)
    errors = [line for line in result.stdout.splitlines() if "error:" in line]
    assert all(line.startswith("use.py:") for line in errors), result.stdout  # none is in the stubs
    assert result.returncode == (1 if errors else 0), result.stdout + result.stderr
    return sorted({int(line.split(":")[1]) for line in errors})
