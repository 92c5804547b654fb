#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the pages that people read first to their lengths: the lines and tables in pages.csv, at most. A file of the
product's code has 400 lines at most.

    python3 test/project/pages.py     exit 1 where a page or file is longer: a new topic belongs in one of its own
"""

import csv
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PRODUCT = ("pcl_bsh", "filters", "examples")
CODE = (".h", ".hpp", ".cpp", ".py")
LONGEST_FILE = 400


def main():
    wrong = []
    with Path(__file__).with_name("pages.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            lines = (ROOT / row["page"]).read_text(encoding="utf-8").splitlines()
            counts = {"lines": len(lines), "tables": sum(line.startswith("|--") for line in lines)}
            for what, count in counts.items():
                print(f"{row['page']:20} {count:4} of {row[what]} {what}")
                if count > int(row[what]):
                    wrong.append(f"{row['page']}: {count} {what}, at most {row[what]}: move the rest to another page")
    for path in sorted(p for room in PRODUCT for p in (ROOT / room).rglob("*") if p.suffix in CODE):
        count = len(path.read_text(encoding="utf-8").splitlines())
        if count > LONGEST_FILE:
            wrong.append(f"{path.relative_to(ROOT)}: {count} lines, at most {LONGEST_FILE}: move a part to another file")
    if wrong:
        sys.exit("pages.py: " + "\n  ".join(wrong))


if __name__ == "__main__":
    main()
