#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Do three machines fit into the hall, and can the mill be carried in? Asked of the first week's scan, and of the second's
# with the first week's lists. The floor does not count. In the folder that make_hall.sh made; the programs are in PATH.
#   bash fit.sh FOLDER
set -euo pipefail

(($# == 1)) || { printf 'fit.sh: FOLDER: is missing: say where make_hall.sh put the hall\n' >&2; exit 1; }
cd "$1"

options=(--input-unit m --unit m --ignore-points classification=2 --solid)
stand() { # WEEK OPTIONS...
  pcl_bsh_collide "$1.las" "$1_fit.las" --clearance 0.1 "${options[@]}" --between \
    --obstacle 'press=press.stl;unit=mm;pose=500003,5400002,100,0,0,0.3' \
    --obstacle 'mill=mill.stl;unit=mm;pose=500007.5,5400006,100,0,0,1.5707963267948966' \
    --obstacle 'crate=crate.stl;unit=mm;clearance=0.3;pose=500005,5400005,100,0,0,0' \
    --clashes "$1_fit.json" --clashes "$1_fit.csv" --clashes "$1_fit.html" --report "$1_report.json" "${@:2}"
}
carry() { # WEEK OPTIONS...
  pcl_bsh_collide "$1.las" mill.stl "$1_way.las" --clearance 0.05 "${options[@]}" --obstacle-unit mm --trajectory way.txt \
    --clashes "$1_way.json" --clashes "$1_way.html" "${@:2}"
}
stand week_47
carry week_47 --poses-out poses.txt
stand week_48 --previous week_47_fit.json
carry week_48 --previous week_47_way.json
