# SPDX-License-Identifier: BSD-3-Clause
"""Finds mutants in C++ sources, and writes them into a copy behind a switch.

A mutant changes one place of one statement, or of one condition. `pcl_bsh_mutant(K)` (mutant.h) says whether mutant K is
the chosen one; a statement S with a mutant S' becomes `{ if (pcl_bsh_mutant(K)) { S' } else { S } }`, a condition or an
initial value E becomes `pcl_bsh_mutant(K) ? (E') : (E)`. Lines keep their numbers, so that errors of the compiler name
the mutants which cannot be compiled.
"""
import collections
import hashlib
import re

# Name, what is found in code without comments and strings, what takes its place.
OPERATORS = [
    ("boundary", r"(?<=[\w)\]] )<(?= [\w(\-!*])", "<="),
    ("boundary", r"(?<=[\w)\]] )<=(?= )", "<"),
    ("boundary", r"(?<=[\w)\]] )>(?= [\w(\-!*])", ">="),
    ("boundary", r"(?<=[\w)\]] )>=(?= )", ">"),
    ("comparison", r"(?<= )==(?= )", "!="),
    ("comparison", r"(?<= )!=(?= )", "=="),
    ("sign", r"(?<=[\w)\]] )\+(?= [\w(])", "-"),
    ("sign", r"(?<=[\w)\]] )-(?= [\w(])", "+"),
    ("sign", r"(?<= )\+=(?= )", "-="),
    ("sign", r"(?<= )-=(?= )", "+="),
    ("term", r"(?<=[\w)\]]) [+-] \w[\w.]*(?=[;,)]|$)", ""),
    ("term", r"(?<=[\w)\]]) \| \w[\w.]*(?=[;,)]|$)", ""),
    ("factor", r"(?<=[\w)\]]) \* \w[\w.]*(?=[;,)]|$)", ""),
    ("logic", r"(?<= )&&(?= )", "||"),
    ("logic", r"(?<= )\|\|(?= )", "&&"),
    ("negation", r"(?<![\w)\]=])!(?=[\w(])", ""),
    ("mask", r"(?<= )&=(?= )", "|="),
    ("half", r"(?<![\w.])(?!0\.0+f?\b)(\d+\.\d+(?:e-?\d+)?f?)(?![\w.])", r"(0.5f * \1)"),
    ("extreme", r"\bmax\(", "min("),
    ("extreme", r"\bmin\(", "max("),
    ("extreme", r"\bMax\(", "Min("),
    ("extreme", r"\bMin\(", "Max("),
    ("lanes", r"\bhn::Le\(", "hn::Lt("),
    ("lanes", r"\bhn::Lt\(", "hn::Le("),
    ("lanes", r"\bhn::Add\(", "hn::Sub("),
    ("lanes", r"\bhn::Sub\(", "hn::Add("),
    ("side", r"(?<=\W)a(?=\.(?:pose|hierarchy|view|cloud)\b)", "b"),
    ("side", r"(?<=\W)b(?=\.(?:pose|hierarchy|view|cloud)\b)", "a"),
    ("side", r"\bFlagged::a\b", "Flagged::b"),
    ("index", r"(?<=\[)([a-z]\w*)(?=\])(?!\s*\()", r"\1 + 1"),
    ("rounding", r"\broundUp\(", "roundDown("),
    ("rounding", r"\broundDown\(", "roundUp("),
]
UNINTERESTING = re.compile(r"\b(assert|reserve|static_assert|shrink_to_fit|typedef|using|throw|goto|asm|friend|delete)\b|^PCL_|^HWY_")

# kind: condition, value (of a declaration), return, statement. begin, end: of what is changed, in the file.
Site = collections.namedtuple("Site", "kind begin end head tail")
# id: by what it changes, not by where; lines move.
Mutant = collections.namedtuple("Mutant", "id file line operator before after site")


def blanked(text, strings=True):
    """The text, of the same length, with comments, preprocessor lines and, where asked for, strings blanked."""
    def blank(match):
        found = match.group()
        if not strings and found[0] in "\"'":
            return found
        return re.sub(r"[^\n]", " ", found)
    pattern = r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])*\'|^[ \t]*#(?:\\\n|[^\n])*'
    return re.sub(pattern, blank, text, flags=re.DOTALL | re.MULTILINE)


def closing(code, at):
    """The place of the bracket that closes the one at `at`."""
    pairs, depth = {"(": ")", "{": "}", "[": "]"}, 0
    opening, close = code[at], pairs[code[at]]
    for i in range(at, len(code)):
        if code[i] == opening:
            depth += 1
        elif code[i] == close:
            depth -= 1
            if depth == 0:
                return i
    raise ValueError("a bracket is not closed")


DECLARES = re.compile(r"(?:^|\s)(?:namespace|struct|class|union|extern)\b")
FUNCTION_HEAD = re.compile(r"\)\s*(?:const|noexcept|override|final|mutable|&|->\s*[\w:<>,&*\s]+|:\s.*)*\s*$", re.DOTALL)
LAMBDA_HEAD = re.compile(r"\]\s*(?:\([^{}]*\))?\s*(?:mutable|noexcept|HWY_ATTR|->\s*[\w:<>,&*\s]+|\s)*$", re.DOTALL)


class Scanner:
    """Finds the statements and conditions of functions' bodies."""

    def __init__(self, text):
        self.code = blanked(text)
        self.sites = []

    def scan(self):
        self.declarations(0, len(self.code))
        return self.sites

    def declarations(self, i, end):
        start = i
        while i < end:
            c = self.code[i]
            if c in ";":
                start = i + 1
            elif c == "}":
                start = i + 1
            elif c == "(":
                i = closing(self.code, i)
            elif c == "{":
                head = self.code[start:i]
                close = closing(self.code, i)
                if re.search(r"\benum\b", head):
                    pass
                elif DECLARES.search(head) and not head.rstrip().endswith(")") and "(" not in head:
                    self.declarations(i + 1, close)
                    start = close + 1
                elif "(" in head and FUNCTION_HEAD.search(head) and not re.search(r"\bconsteval\b|\)\s*:\s[^{}]*\w$", head):
                    self.body(i + 1, close)
                    start = close + 1
                elif re.search(r"\)\s*:\s", head) and re.search(r"[\w>]$", head.rstrip()):
                    i = close  # a member's initial value in braces
                    continue
                elif LAMBDA_HEAD.search(head):
                    self.body(i + 1, close)
                i = close
            i += 1

    def body(self, i, end):
        """Statements between i and end."""
        while i < end:
            while i < end and self.code[i] in " \n\t;":
                i += 1
            if i >= end:
                return
            i = self.statement(i, end)

    def statement(self, i, end):
        """The statement that begins at i; returns where the next begins."""
        code = self.code
        if code[i] == "{":
            close = closing(code, i)
            self.body(i + 1, close)
            return close + 1
        word = re.compile(r"(?:\w+|\[\[\w+\]\])").match(code, i)
        word = word.group() if word else ""
        if word in ("else", "do", "try"):
            return i + len(word)
        if word in ("case", "default"):
            colon = re.compile(r"(?<!:):(?!:)").search(code, i)
            return colon.end()
        if word in ("if", "while", "for", "switch", "catch"):
            opening = code.index("(", i)
            constexpr = "constexpr" in code[i:opening]
            close = closing(code, opening)
            if word == "for":
                self.of_for(opening + 1, close)
            elif word in ("if", "while") and not constexpr:
                begin = opening + 1
                semicolon = code.rfind(";", begin, close)
                if semicolon > 0:
                    begin = semicolon + 1
                self.condition(begin, close)
            return close + 1
        return self.plain(i, end)

    def of_for(self, begin, close):
        parts, depth, last = [], 0, begin
        for i in range(begin, close):
            if code_depth := {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(self.code[i]):
                depth += code_depth
            elif self.code[i] == ";" and depth == 0:
                parts.append((last, i))
                last = i + 1
        if len(parts) == 2:
            self.condition(*parts[1])

    def condition(self, begin, end):
        text = self.code[begin:end]
        if not text.strip() or re.search(r"\w\s*[*&]*\s+[*&]*\w+\s*=[^=]", text) or "{" in text:
            return
        self.sites.append(Site("condition", begin, end, "", ""))

    def plain(self, i, end):
        code, depth, j, blocks = self.code, 0, i, False
        while j < end:
            c = code[j]
            if c in "([":
                depth += 1
            elif c in ")]":
                depth -= 1
            elif c == "{":
                close = closing(code, j)
                if LAMBDA_HEAD.search(code[i:j]):
                    blocks = True
                    self.body(j + 1, close)
                elif re.match(r"\s*(?:struct|class|enum|union)\b", code[i:j]):
                    blocks = True
                    if "enum" not in code[i:j]:
                        self.declarations(j + 1, close)
                j = close
            elif c == ";" and depth == 0:
                break
            j += 1
        text = code[i:j]
        if not blocks and j < end and not UNINTERESTING.search(text):
            self.simple(i, j, text)
        return j + 1

    def simple(self, i, j, text):
        if match := re.match(r"return\b\s*", text):
            if text[match.end():].strip():
                self.sites.append(Site("return", i, j, "return ", ""))
            return
        if re.match(r"(?:break|continue|return|co_\w+|else)\b", text):
            return
        declared = re.match(r"(?:(?:const|static|constexpr|thread_local|unsigned|long|alignas\([^)]*\))\s+)*[A-Za-z_][\w:]*(?:<[^;=]*>)?(?:::\w+)*"
                            r"(?:\s+const)?\s*(?:[*&]+\s*(?:const\s+)?|\s)\s*([A-Za-z_]\w*)\s*(=[^=]|\(|\{|;|$|\[|,)", text)
        if declared and not re.match(r"(?:\*|&)", text):
            if re.match(r".*\b(?:constexpr|static)\b", text[:declared.start(1)]) or not declared.group(2).startswith("="):
                return
            begin = i + declared.start(2) + 1
            value = self.code[begin:j]
            if value.lstrip().startswith("{") or self.has_comma(value):
                return
            self.sites.append(Site("value", begin, j, "", ""))
            return
        self.sites.append(Site("statement", i, j, "", ""))

    @staticmethod
    def has_comma(text):
        depth = 0
        for c in text:
            if c in "([{":
                depth += 1
            elif c in ")]}":
                depth -= 1
            elif c == "," and depth == 0:
                return True
        return False


ENDS_OPERAND = re.compile(r"[,;?]|(?<!:):(?!:)|(?<![=!<>])=(?!=)|\breturn\b|(?<= )\|\|(?= )|(?<= )&&(?= )")


def operands(code, begin, end):
    """Ranges that hold one operand of && or || and its operator: each operand of a chain once."""
    def level(i, last, step):
        """The places from i on that no bracket encloses, until the one that encloses i ends."""
        depth = 0
        while i != last:
            if code[i] in "([{":
                depth += step
            elif code[i] in ")]}":
                depth -= step
            if depth < 0:
                return
            if depth == 0:
                yield i
            i += step

    def bound(operator, places):
        """The last place of an operand, which ends at `operator` and at what binds less, and the match of what ends it."""
        last = None
        for i in places:
            found = ENDS_OPERAND.match(code, i)
            if found and (found.group() != "&&" or operator == "&&"):
                return last, found
            last = i
        return last, None

    for found in re.finditer(r"(?<= )(?:&&|\|\|)(?= )", code[begin:end]):
        operator, first, after = found.group(), begin + found.start(), begin + found.end()
        right, _ = bound(operator, level(after, end, 1))
        yield first, right + 1
        left, before = bound(operator, level(first - 1, begin - 1, -1))
        if not before or before.group() != operator:
            yield before.end() if before else left, after


def mutants_of(name, text):
    """All mutants of a file's text, in the order of lines."""
    code, plain = blanked(text), blanked(text, strings=False)
    found, seen = [], collections.Counter()

    def add(site, operator, begin, end, after):
        before = one_line(plain[site.begin:site.end])
        changed = one_line(plain[site.begin:begin] + after + plain[end:site.end])
        key = f"{name}|{before}|{changed}|{operator}"
        seen[key] += 1
        identity = hashlib.sha1(f"{key}|{seen[key]}".encode()).hexdigest()[:10]
        found.append(Mutant(identity, name, text.count("\n", 0, begin) + 1, operator, before, changed, site))

    for site in Scanner(text).scan():
        inner = code[site.begin:site.end]
        for operator, pattern, replacement in OPERATORS:
            for match in re.finditer(pattern, inner):
                add(site, operator, site.begin + match.start(), site.begin + match.end(), match.expand(replacement))
        for begin, end in operands(code, site.begin, site.end):
            add(site, "operand", begin, end, "")
        follows = code[site.end + 1:site.end + 60].lstrip()
        if site.kind == "condition" and re.match(r"(?:return|continue|break|throw)\b", follows):
            add(site, "guard", site.begin, site.end, "false")
        if site.kind == "statement":
            add(site, "left out", site.begin, site.end, "")
    return sorted(found, key=lambda mutant: (mutant.site.begin, mutant.line))


def one_line(text):
    return re.sub(r"\s+", " ", text).strip()


def with_mutants(text, chosen, header):
    """The text with mutants behind the switch. @param chosen pairs of number and mutant"""
    by_site = collections.defaultdict(list)
    for number, mutant in chosen:
        by_site[mutant.site].append((number, mutant))
    for site in sorted(by_site, key=lambda site: -site.begin):
        original = text[site.begin:site.end]
        if site.kind in ("condition", "value"):
            # The common type of two alternatives may always be true: for an optional and a bool it is an optional.
            cast = "static_cast<bool>" if site.kind == "condition" else ""
            choice = "".join(f"pcl_bsh_mutant({n}) ? {cast}({m.after}) : " for n, m in by_site[site])
            changed = f" {choice}{cast}({original})"
        else:
            choice = "".join(f"if (pcl_bsh_mutant({n})) {{ {m.after}; }} else " for n, m in by_site[site])
            changed = f"{{ {choice}{{ {original}; }} }}"
        end = site.end if site.kind in ("condition", "value") else site.end + 1  # with its semicolon: an else may follow
        text = text[:site.begin] + changed + text[end:]
    first, rest = text.split("\n", 1)
    return f'#include "{header}"\n{rest}'
