#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the pages that people read first to their lengths: the lines and tables in pages.csv, at most.

    python3 test/project/pages.py     exit 1 where a page is longer; a new topic belongs on a page of its own
"""

import csv
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


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
    if wrong:
        sys.exit("pages.py: " + "\n  ".join(wrong))


if __name__ == "__main__":
    main()
