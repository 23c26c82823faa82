"""Holds the plan of the house: which folder includes which (the lists of docs/architecture.md), and
which floor may touch the outside world.

    layering.py ROOT             0 if the sources under ROOT keep to it; else 1, and each breach on stderr
    layering.py ROOT --refuses   proves that breaches are found, on copies with one of them each
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BELOW = {
    "estimator": set(),
    "mapping": {"estimator"},
    "storage": {"mapping", "estimator"},
    "render": {"mapping", "estimator"},
    "app": {"storage", "render", "mapping", "estimator"},
}
MAX_FILES = 21

# Floors that only compute include no files, clocks, consoles, threads, databases or pictures.
# (<stop_token> is a value that says "no longer wanted"; it starts nothing.)
PURE = {"estimator", "mapping"}
OUTSIDE_WORLD = re.compile(
    r"<(iostream|fstream|cstdio|stdio\.h|print|filesystem|chrono|ctime|time\.h|thread|mutex|future|random_device"
    r"|unistd\.h|fcntl\.h|sys/|sqlite3\.h|gdal|ogr|osmium|archive\.h|zlib\.h|zstd\.h|GL/|EGL/|png\.h|ft2build\.h|hb\.h"
    r"|nlohmann|CLI|toml\+\+)"
)
FOREIGN = re.compile(r"<(gdal|ogr|hdf5|sqlite3|osmium|mrpt|archive|png|ft2build|hb|GL/|EGL/|CLI|nlohmann|toml)")

# GDAL opens and creates files in one place, which decides what a map may be.
GDAL_ACCESS = "storage/gdal/gdal_access.cpp"
GDAL_OPENING = re.compile(
    r"GDALOpen|GDALDataset::Open|OGROpen|OGRSFDriver|GDALAllRegister|OGRRegisterAll|GDALRegister|RegisterOGR"
    r"|GetDriverByName|GetGDALDriverManager|GDALIdentify|GDALVectorTranslate|GDALWarp|GDALBuildVRT|GDALTranslate"
)

# HDF5 is opened in one place, in a process of its own.
HDF5_ACCESS = "storage/trips/signals/hdf5_process.cpp"
HDF5_OPENING = re.compile(r"<hdf5|\bH5[A-Z]{1,2}[a-z]\w*\(")

# NOTIFY takes a lock of the whole PostgreSQL server until its transaction has committed: commits wait for each other.
COMMENT = re.compile(r"(^|\s)//.*", re.M)
NOTIFYING = re.compile(r"\bNOTIFY\b|(?i:pg_notify)")

# Headers that are slow to compile are included by one .cpp each; of JSON by one that writes and one that reads.
SLOW = {"CLI11": ("<CLI/", 1), "the JSON library": ("<nlohmann/", 2), "the TOML library": ("<toml++", 1)}


def plan(root):
    """Folder -> folders of its floor that it may include."""
    rows = re.findall(r"^\* `((?:%s)[a-z/]*)`(?: \(([a-z/, ]*)\))?: .+$" % "|".join(BELOW),
                      (root / "docs/architecture.md").read_text(), re.M)
    return {folder: {f"{folder.split('/')[0]}/{used.strip()}" for used in uses.split(",") if used.strip()}
            for folder, uses in rows}


def circle(arrows):
    """Folders that include each other in a circle; empty if there is none."""
    done = set()

    def walk(folder, path):
        if folder in path:
            return [*path[path.index(folder):], folder]
        if folder in done:
            return []
        for used in sorted(arrows.get(folder, ())):
            if found := walk(used, [*path, folder]):
                return found
        done.add(folder)
        return []

    return next((found for folder in sorted(arrows) if (found := walk(folder, []))), [])


def include_breaches(name, text, allowed):
    folder, floor = str(pathlib.PurePosixPath(name).parent), name.split("/")[0]
    for include in re.findall(r'^#include (["<].*)$', text, re.M):
        path = include.strip('"<>')
        other, other_floor = str(pathlib.PurePosixPath(path).parent), path.split("/")[0]
        if include.startswith('"') and other_floor in BELOW:
            if other_floor != floor and other_floor not in BELOW[floor]:
                yield f"{name}: {floor} may not use {other_floor}: {include}"
            elif other_floor == floor and other not in {folder, *allowed.get(folder, ())}:
                yield f"{name}: {folder} may not use {other} (docs/architecture.md): {include}"
        if floor in PURE and OUTSIDE_WORLD.match(include):
            yield f"{name}: {floor} computes only: {include}"
        if name.endswith(".hpp") and FOREIGN.match(include):
            yield f"{name}: foreign libraries stay inside .cpp files: {include}"


def breaches(root):
    allowed = plan(root)
    sources = {str(file.relative_to(root)): file.read_text()
               for floor in BELOW for file in sorted((root / floor).rglob("*.[ch]pp"))}
    if len(sources) < 20:
        yield f"only {len(sources)} files under {root}: is this the right folder?"
    for name, text in sources.items():
        yield from include_breaches(name, text, allowed)
        if name != GDAL_ACCESS and (opening := GDAL_OPENING.search(text)):
            yield f"{name}: only {GDAL_ACCESS} opens files by GDAL: {opening[0]}"
        if name != HDF5_ACCESS and (opening := HDF5_OPENING.search(text)):
            yield f"{name}: only {HDF5_ACCESS} opens HDF5: {opening[0]}"
        if sending := NOTIFYING.search(COMMENT.sub("", text)):
            yield f"{name}: no NOTIFY, which makes commits wait for each other: {sending[0]}"
    for library, (header, most) in SLOW.items():
        users = [name for name, text in sources.items() if f"#include {header}" in text]
        if len(users) > most:
            yield f"too many files include {library}: {', '.join(users)}"
    counts = {}
    for name in sources:
        folder = str(pathlib.PurePosixPath(name).parent)
        counts[folder] = counts.get(folder, 0) + 1
    for folder in sorted(counts.keys() - allowed.keys()):
        yield f"{folder}: has no line in docs/architecture.md"
    for folder in sorted(allowed.keys() - counts.keys()):
        yield f"{folder}: has a line in docs/architecture.md and no source"
    for folder, count in counts.items():
        if count > MAX_FILES:
            yield f"{folder}: holds {count} files, {MAX_FILES} at most: has it one purpose?"
    if found := circle(allowed):
        yield f"docs/architecture.md: folders use each other in a circle: {' -> '.join(found)}"


def refuses(root, name, line, words):
    with tempfile.TemporaryDirectory() as scratch:
        copy = pathlib.Path(scratch)
        for floor in BELOW:
            shutil.copytree(root / floor, copy / floor)
        (copy / "docs").mkdir()
        shutil.copy(root / "docs/architecture.md", copy / "docs")
        file = copy / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text((file.read_text() if file.exists() else "") + line + "\n")
        said = subprocess.run([sys.executable, __file__, copy], capture_output=True, text=True, check=False)
    if said.returncode == 0 or words not in said.stderr:
        return [f"'{line}' in {name} was not refused with '{words}': {said.stderr}"]
    return []


BREACHES = [
    ("estimator/motion/new.cpp", '#include "mapping/network/segment.hpp"', "estimator may not use mapping"),
    ("storage/text/new.cpp", '#include "render/map/layout.hpp"', "storage may not use render"),
    ("mapping/geometry/new.cpp", '#include "mapping/fusion/fusion.hpp"', "mapping/geometry may not use mapping/fusion"),
    ("mapping/fusion/new.cpp", "#include <fstream>", "mapping computes only"),
    ("estimator/motion/new.cpp", "#include <iostream>", "estimator computes only"),
    ("render/map/new.cpp", "#include <nlohmann/json.hpp>", "too many files include the JSON library"),
    ("storage/rasters/new.cpp", "auto map = GDALDataset::Open(name);", f"only {GDAL_ACCESS} opens files by GDAL"),
    ("storage/trips/signals/new.cpp", "#include <hdf5.h>", f"only {HDF5_ACCESS} opens HDF5"),
    ("storage/jobs/new.cpp", 'server.run("NOTIFY jobs");', "no NOTIFY, which makes commits wait for each other"),
    ("app/jobs/new.cpp", 'server.run("SELECT pg_notify($1, $2)");', "no NOTIFY"),
    ("storage/attic/new.cpp", "int x;", "storage/attic: has no line in docs/architecture.md"),
    ("docs/architecture.md", "* `mapping/lost`: Lost", "mapping/lost: has a line in docs/architecture.md"),
    ("docs/architecture.md", "* `mapping/geometry` (fusion): All", "folders use each other in a circle"),
]


def main():
    root = pathlib.Path(sys.argv[1])
    if sys.argv[2:] == ["--refuses"]:
        found = [words for breach in BREACHES for words in refuses(root, *breach)]
    else:
        found = list(breaches(root))
    print("\n".join(found), file=sys.stderr)
    sys.exit(bool(found))


main()
