#!/usr/bin/env python3
"""Divides the sources of a target into groups, each compiled as one file (the option MACADAM_UNITY).

unity_groups.py ROOT MAX_FILES SOURCE... prints for each source the number of its group. Names of a file's own (in an
unnamed namespace, static, or by #define) meet none of another file of the group, nor of a header that the other includes,
and no two headers of a group declare one name as different things.
"""
import functools
import re
import sys
from pathlib import Path

NOT_DECLARED = {"static_assert", "if", "for", "while", "switch", "return", "operator", "alignas", "decltype", "requires"}
TYPE = re.compile(r"(?:struct|class|union|enum(?: class| struct)?)\s+(?:\[\[.*?\]\]\s*)?(\w+)\s*($|[{;:]|final)")
TEST = re.compile(r"(?:TEST|TEST_F|TEST_P|TYPED_TEST)\((\w+),\s*(\w+)")
MATCHER = re.compile(r"MATCHER(?:_P\d*)?\((\w+)")
USING = re.compile(r"(?:using|namespace)\s+(?:[\w:]*::)?(\w+)\s*(?:=.*)?;")
FUNCTION_OR_VALUE = re.compile(r"[^=({;\[]*?\b(\w+)\s*([=({;\[])")
NAMESPACE = re.compile(r"namespace\s+(?:\w+::)*(\w+)\s*\{")


def outside_angles(line):
    while (shorter := re.sub(r"<[^<>]*>", "", line)) != line:
        line = shorter
    return line


def declared(line):
    """The name that a line at the left margin declares, and as what; (None, None) if it declares none."""
    line = re.sub(r"//.*|^\[\[\w+\]\]\s*", "", line).strip()
    if found := TEST.match(line):
        return f"{found[1]}_{found[2]}_Test", "type"
    if found := MATCHER.match(line):
        return found[1], "function"
    if found := re.match(r"using\s+(\w+)\s*=", line):
        return found[1], "alias"
    if found := USING.match(line):
        return (None, None) if line.startswith("using namespace") else (found[1], line)
    if found := NAMESPACE.match(line):
        return found[1], "namespace"
    line = re.sub(r"^template\s*", "", outside_angles(re.sub(r'"[^"]*"', "", line)))
    if found := TYPE.match(line):
        return found[1], "type of elsewhere" if found[2] == ";" else "type"
    found = FUNCTION_OR_VALUE.match(line)
    if not found or "operator" in line or found[1] in NOT_DECLARED or f"::{found[1]}" in found[0]:
        return None, None
    return found[1], "function" if found[2] == "(" else "value"


def margin(path):
    """Each unindented line, and whether it stands in an unnamed namespace."""
    unnamed = False
    for line in path.read_text(encoding="utf-8").splitlines():
        if re.match(r"namespace\s*\{", line):
            unnamed = True
        elif re.match(r"\}\s*//\s*namespace\s*$", line):
            unnamed = False
        elif re.match(r"[A-Za-z_\[#]", line):
            yield line, unnamed


@functools.cache
def included(path, root):
    """Our own headers that a file includes, and those include."""
    headers = set()
    for name in re.findall(r'^#include "([^"]+)"', path.read_text(encoding="utf-8"), re.MULTILINE):
        for header in (root / name, root / "tests" / name, path.parent / name):
            if header.is_file():
                headers |= {header} | included(header, root)
                break
    return frozenset(headers)


@functools.cache
def names_in(header):
    """What a header declares: (name, as what)."""
    lines = (line for line, _ in margin(header) if not line.startswith("#"))
    return frozenset(found for found in map(declared, lines) if found[0])


def own_names(path):
    """What a file keeps to itself, by name."""
    names = {}
    for line, unnamed in margin(path):
        if found := re.match(r"#\s*define\s+(\w+)", line):
            names[found[1]] = "macro"
        elif not line.startswith("#") and (unnamed or re.match(r"static |TEST|TYPED_TEST|using |namespace \w+ =", line)):
            name, kind = declared(line)
            names |= {name: kind} if name else {}
    return names


def may_both_stand(one, other):
    """Whether two headers may declare a name as these."""
    return {one, other} in ({"function"}, {"namespace"}, {"type of elsewhere"}, {"type", "type of elsewhere"}) or one == other and ";" in one


class Group:
    def __init__(self):
        self.files = 0
        self.own = {}
        self.headers = set()
        self.seen = {}  # by name: as what the headers declare it

    def takes(self, own, headers):
        if any(name in self.own and (own[name] != self.own[name] or ";" not in own[name]) for name in own):
            return False  # only a using-declaration may be repeated
        if any(name in self.seen for name in own):
            return False
        return all(name not in self.own and all(may_both_stand(kind, seen) for seen in self.seen.get(name, ()))
                   for header in headers - self.headers for name, kind in names_in(header))

    def add(self, own, headers):
        self.files += 1
        self.own |= own
        for header in headers - self.headers:
            for name, kind in names_in(header):
                self.seen.setdefault(name, set()).add(kind)
        self.headers |= headers


def main():
    root, max_files, sources = Path(sys.argv[1]), int(sys.argv[2]), [Path(source) for source in sys.argv[3:]]
    groups = []
    for source in sources:
        own, headers = own_names(source), included(source.resolve(), root)
        group = next((group for group in groups if group.files < max_files and group.takes(own, headers)), None)
        if group is None:
            group = Group()
            groups.append(group)
        group.add(own, headers)
        print(groups.index(group))


main()
