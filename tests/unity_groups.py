#!/usr/bin/env python3
"""Divides the sources of a target into groups, each compiled as one file (the option MACADAM_UNITY).

unity_groups.py ROOT MAX_FILES SOURCE... prints for each source the number of its group. Names of a file's own (in an
unnamed namespace, static, or by #define) meet none of another file of the group, nor of a header that the other includes.
"""
import functools
import re
import sys
from pathlib import Path

NOT_DECLARED = {"static_assert", "if", "for", "while", "switch", "return", "operator", "alignas", "decltype", "requires"}
TYPE = re.compile(r"(?:struct|class|union|enum(?: class| struct)?)\s+(?:\[\[.*?\]\]\s*)?(\w+)\s*(?:$|[{;:]|final)")
TEST = re.compile(r"(?:TEST|TEST_F|TEST_P|TYPED_TEST)\((\w+),\s*(\w+)")
MATCHER = re.compile(r"MATCHER(?:_P\d*)?\((\w+)")
USING = re.compile(r"(?:using|namespace)\s+(?:[\w:]*::)?(\w+)\s*(?:=.*)?;")
FUNCTION_OR_VALUE = re.compile(r"[^=({;\[]*?\b(\w+)\s*(?:[=({;\[]|$)")


def outside_angles(line):
    while (shorter := re.sub(r"<[^<>]*>", "", line)) != line:
        line = shorter
    return line


def declared(line):
    """The names that a line at the left margin declares, each with what may be said twice (or None)."""
    line = re.sub(r"//.*|^\[\[\w+\]\]\s*", "", line).strip()
    if found := TEST.match(line):
        return {f"{found[1]}_{found[2]}_Test": None}
    if found := MATCHER.match(line):
        return {found[1]: None}
    if re.match(r"using namespace", line):
        return {}
    if found := re.match(r"using\s+(\w+)\s*=", line):
        return {found[1]: None}
    if found := USING.match(line):
        return {found[1]: line}
    line = re.sub(r"^template\s*", "", outside_angles(re.sub(r'"[^"]*"', "", line)))
    if found := TYPE.match(line):
        return {found[1]: None}
    found = FUNCTION_OR_VALUE.match(line)
    if not found or "operator" in line or found[1] in NOT_DECLARED or f"::{found[1]}" in found[0]:
        return {}
    return {found[1]: None}


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
    names = set()
    for line, _ in margin(header):
        if not line.startswith(("#", "namespace")):
            names |= declared(line).keys()
    return names


def own_names(path):
    names = {}
    for line, unnamed in margin(path):
        if found := re.match(r"#\s*define\s+(\w+)", line):
            names[found[1]] = None
        elif not line.startswith("#") and (unnamed or re.match(r"static |TEST|TYPED_TEST|using |namespace \w+ =", line)):
            names |= declared(line)
    return names


def meet(group, own, seen):
    """Whether a file's names and those it sees in headers meet those of a group."""
    return (any(own[name] is None or own[name] != group["own"][name] for name in own.keys() & group["own"].keys())
            or own.keys() & group["seen"] or seen & group["own"].keys())


def main():
    root, max_files, sources = Path(sys.argv[1]), int(sys.argv[2]), [Path(source) for source in sys.argv[3:]]
    groups = []
    for source in sources:
        own = own_names(source)
        seen = set().union(*(names_in(header) for header in included(source.resolve(), root)))
        fits = (number for number, group in enumerate(groups)
                if group["files"] < max_files and not meet(group, own, seen))
        number = next(fits, len(groups))
        if number == len(groups):
            groups.append({"files": 0, "own": {}, "seen": set()})
        group = groups[number]
        group["files"] += 1
        group["own"] |= own
        group["seen"] |= seen
        print(number)


main()
