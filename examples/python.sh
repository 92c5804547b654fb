#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The Python package, from a fresh clone: installs what it needs, builds it, fetches two clouds, lets a man walk through
# a scanned building, and draws where and when he collides.
#   bash examples/python.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/setup.sh release python
bash examples/demo/fetch_scans.sh build/demo
PYTHONPATH="$PWD/build/release/python" /usr/bin/python3 examples/python/walk_through_building.py \
  build/demo/building.ply build/demo/man.off build/python
