#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the tests of the Python package; without pytest it says so and returns 77, which ctest knows as skipped.
#   bash test/python/run.sh PYTHON FOLDER_OF_THE_PACKAGE
set -euo pipefail
if ! "$1" -c "import pytest" 2>/dev/null; then
  printf 'python/pytest: Skipped\nthe Python package: pytest is not found: install python3-pytest\n'
  exit 77
fi
export PYTHONPATH="$2" PYTHONDONTWRITEBYTECODE=1
exec "$1" -m pytest -q --disable-warnings -p no:cacheprovider --rootdir "$(dirname "$0")" -ra "$(dirname "$0")"
