#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds comments, documents, messages and titles of commits to plain words.

Counts what the rules in words.csv find, and compares each count with its limit there. A limit only falls: a count
above its limit fails, and so does one below it, until the smaller count is written there.

    python3 test/project/words.py              checks; exit 1 where a count is not its limit
    python3 test/project/words.py list RULE    prints each finding of a rule, with its place
    python3 test/project/words.py lower        writes smaller counts into words.csv; refuses greater ones
"""

import csv
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RULES = Path(__file__).with_name("words.csv")
PRODUCT = ("pcl_bsh", "filters", "examples")
CODE = {".h": "//", ".hpp": "//", ".cpp": "//", ".cmake": "#", ".sh": "#", ".py": "#", ".txt": "#"}
SAMPLE = {"//": r"//[/!]* {3,}(\S.*;( *//.*)?$| {3,}\S)|//.*\S {3,}\S", "#": r"# {3,}\S"}  # code, tables, command lines
LONGEST_TITLE = 60


def git(*arguments):
    """What git prints in the project's folder; None where there is no git, or no repository."""
    try:
        done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return done.stdout if done.returncode == 0 else None


def files():
    listed = git("ls-files", "-z", "--cached", "--others", "--exclude-standard")
    if listed is None:  # an archive without a repository, or a system without git
        names = [str(p.relative_to(ROOT)) for p in ROOT.rglob("*") if p.is_file() and p.relative_to(ROOT).parts[0] not in ("build", ".git")]
    else:
        names = listed.split("\0")
    return sorted(Path(n) for n in names if n and (ROOT / n).is_file() and not n.startswith("test/project/words."))


def comments(lines, mark):
    """Paragraphs (line number, text) of comments that begin with the mark; samples are left out."""
    paragraph, first, column = [], 0, -1
    for number, line in enumerate(lines, 1):
        found = re.match(r"^(.*?)(?:(?<=\s)|^)" + mark + r"[/!]*<? ?(.*)$", line)
        text = found.group(2).strip() if found else ""
        sample = found and re.search(SAMPLE[mark], line)
        plain = found and text and not sample and not re.match(r"^(SPDX|clang-format|NOLINT|!/|-+$)", text)
        alone = plain and not found.group(1).strip()
        at = len(found.group(1)) if found else -1
        if plain and paragraph and at == column and not re.match(r"[@\\-]", text) and alone:
            paragraph.append(text)
            continue
        if paragraph:
            yield first, " ".join(paragraph)
        paragraph, first, column = ([text], number, at) if plain else ([], 0, -1)
    if paragraph:
        yield first, " ".join(paragraph)


def prose(lines):
    """Paragraphs of a document: no code, no tables' rulers, no headings; a cell of a table is one."""
    paragraph, first, fenced = [], 0, False
    for number, line in enumerate(lines, 1):
        text = line.strip()
        fence = text.startswith("```")
        fenced ^= fence
        cell = text.startswith("|")
        if fenced or fence or not text or text.startswith(("#", "|", "<", "![")) or (line.startswith("    ") and not paragraph) or re.match(r"^(- |\* |\d+\. )", text):
            if paragraph:
                yield first, " ".join(paragraph)
            paragraph = []
            if cell and not fenced:
                for part in text.strip("|").split(" | "):
                    yield number, part.strip()
            if not fenced and re.match(r"^(- |\* |\d+\. )", text):
                paragraph, first = [re.sub(r"^(- |\* |\d+\. )", "", text)], number
            continue
        if not paragraph:
            first = number
        paragraph.append(text)
    if paragraph:
        yield first, " ".join(paragraph)


def embedded(text, begin, end):
    """Paragraphs of documents within code: docstrings of Python, raw strings of C++. Indentation divides them."""
    for found in re.finditer(begin + r"(.*?)" + end, text, re.DOTALL):
        first = text.count("\n", 0, found.start(1)) + 1
        paragraph, start, column = [], first, 0
        for number, line in enumerate(found.group(1).split("\n") + [""], first):
            at = len(line) - len(line.lstrip())
            sample = re.match(r"\s*(>>>|\.\.\. |[-=]{3}|\S+ : )", line)
            if paragraph and (not line.strip() or sample or (at != column and number > start + 1)):
                yield start, " ".join(paragraph)
                paragraph = []
            if line.strip() and not sample:
                if not paragraph:
                    start = number
                column = at
                paragraph.append(line.strip())


def messages(text):
    """String literals of C++ with three words or more, neighbours joined."""
    for found in re.finditer(r'"((?:[^"\\\n]|\\.)*)"(?:\s*"((?:[^"\\\n]|\\.)*)")*', text):
        joined = "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', found.group(0)))
        if len(re.findall(r"[A-Za-z]{2,}", joined)) >= 3:
            yield text.count("\n", 0, found.start()) + 1, joined


def sentences(paragraph):
    paragraph = re.sub(r"`[^`]*`", "CODE", paragraph)
    paragraph = re.sub(r"\b(e\.g|i\.e|etc|cf|al|no)\.", r"\1", paragraph)
    paragraph = re.sub(r"^@(param \w+|returns?|throws \w+)\s*", "", paragraph)
    return [s for s in re.split(r"(?<=[.!?;])\s+(?=[A-Z`\"(*[])", paragraph.strip()) if s]


def texts():
    """(kind, file, line, sentence) of all that people read."""
    for path in files():
        mark = CODE.get(path.suffix) if path.suffix != ".txt" or path.name == "CMakeLists.txt" else None
        if not mark and path.suffix != ".md":
            continue
        text = (ROOT / path).read_text(encoding="utf-8", errors="replace")
        lines = text.split("\n")
        pieces = [("document", p) for p in prose(lines)] if not mark else [("comment", p) for p in comments(lines, mark)]
        if mark == "//" and path.parts[0] in PRODUCT:
            pieces += [("message", p) for p in messages("\n".join(re.sub(r"(^|\s)//.*", "", l) for l in lines))]
            pieces += [("embedded", p) for p in embedded(text, r'R"\(', r'\)"')]
        if path.suffix == ".py":
            pieces += [("embedded", p) for p in embedded(text, '"""', '"""')]
        for kind, (line, paragraph) in pieces:
            for sentence in sentences(paragraph):
                yield kind, path, line, sentence


def titles(base):
    """Titles of commits since the base; none where the history is not there."""
    log = git("log", "--no-merges", "--format=%h %s", f"{base}..HEAD")
    return [line.split(" ", 1) for line in (log or "").splitlines()]


def findings(rules):
    found = {rule["rule"]: [] for rule in rules}
    compiled = [(r["rule"], re.compile(r["pattern"]), r["where"].split()) for r in rules if r["where"] not in ("titles", "length")]
    longest = [(r["rule"], int(r["pattern"])) for r in rules if r["where"] == "length"]
    for kind, path, line, sentence in texts():
        for rule, pattern, where in compiled:
            if kind in where and pattern.search(sentence):
                found[rule].append(f"{path}:{line}: {sentence}")
        if kind not in ("message", "embedded"):
            for rule, words in longest:
                if len(sentence.split()) > words:
                    found[rule].append(f"{path}:{line}: {sentence}")
    for rule in rules:
        if rule["where"] == "titles":
            found[rule["rule"]] = [f"{h}: {title}" for h, title in titles(rule["pattern"]) if len(title) > LONGEST_TITLE]
    return found


def main():
    with RULES.open(newline="", encoding="utf-8") as file:
        rules = list(csv.DictReader(file))
    found = findings(rules)
    if sys.argv[1:2] == ["list"]:
        names = sys.argv[2:] or list(found)
        unknown = [n for n in names if n not in found]
        if unknown:
            sys.exit(f"words.py: {unknown[0]}: no such rule: one of {', '.join(found)}")
        for name in names:
            print("\n".join(found[name]))
        return
    if sys.argv[1:] not in ([], ["lower"]):
        sys.exit(f"words.py: {sys.argv[1]}: list [RULE] or lower")
    wrong = []
    for rule in rules:
        count, limit = len(found[rule["rule"]]), int(rule["limit"])
        print(f"{rule['rule']:24} {count:6} of {limit}")
        if count > limit:
            wrong.append(f"{rule['rule']}: {count} findings, at most {limit}: {rule['instead']}; the last ones:")
            wrong += found[rule["rule"]][-3:]
        elif count < limit and sys.argv[1:] != ["lower"]:
            wrong.append(f"{rule['rule']}: {count} findings, fewer than {limit}: run `python3 test/project/words.py lower`")
        rule["limit"] = min(count, limit)
    if sys.argv[1:] == ["lower"]:
        with RULES.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rules[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rules)
    if wrong:
        sys.exit("words.py: " + "\n  ".join(wrong))


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:  # of `list`, into head
        pass
