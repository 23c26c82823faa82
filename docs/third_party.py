#!/usr/bin/python3
"""Writes THIRD-PARTY.md: whose work is compiled into Macadam, linked to it or shipped with it.

    docs/third_party.py BUILD > THIRD-PARTY.md       BUILD is a finished release build folder
    docs/third_party.py BUILD --check                exit 1 if THIRD-PARTY.md is not what that prints

The lists come from the build itself: the headers that its compilers read, and the libraries that
the linked files name. Licences come from the copyright files of Debian's packages.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PRODUCT = ("app/", "estimator/", "mapping/", "storage/", "render/")
# Compiler, C and C++ library: their licences let programs have any licence (GCC runtime library
# exception; LGPL for what is linked).
TOOLCHAIN = re.compile(r"^(libc6|libc6-dev|libgcc-.*|libgcc-s1|libstdc\+\+.*|linux-libc-dev|libasan.*|libubsan.*)$")
# Opened by name at run time, so that no linked file names them.
OPENED_LATE = ["libOSMesa.so.8", "libEGL.so.1"]
# Packages whose copyright file is prose. The names are of https://spdx.org/licenses.
PROSE = {
    "libsqlite3-0": "public domain",
    "libsqlite3-dev": "public domain",
    "libzstd1": "BSD-3-Clause or GPL-2",
    "libfribidi0": "LGPL-2.1+",
    "libfribidi-dev": "LGPL-2.1+",
    "zlib1g": "Zlib",
    "zlib1g-dev": "Zlib",
    "libexpat1": "Expat",
    "libexpat1-dev": "Expat",
    "libbz2-1.0": "bzip2-1.0.6",
    "libbz2-dev": "bzip2-1.0.6",
    "libcairo2": "LGPL-2.1 or MPL-1.1",
    "libcairo2-dev": "LGPL-2.1 or MPL-1.1",
    "libfontconfig-dev": "MIT",
    "libosmesa6": "Expat",
    "libqpdf-dev": "Apache-2.0 or Artistic-2.0",
    "libqpdf29": "Apache-2.0 or Artistic-2.0",
    "libpython3.11-dev": "PSF-2.0",
    "python3.11-dev": "PSF-2.0",
    "libpython3.13-dev": "PSF-2.0",
    "python3.13-dev": "PSF-2.0",
}
SHIPPED = [
    ("ColorBrewer 2.0, scheme RdYlBu (mapping/style/colour_ramp.cpp)",
     "Apache-2.0; Copyright (c) 2002 Cynthia Brewer, Mark Harrower and The Pennsylvania State University"),
    ("sample_data/comma2k19", "MIT; Copyright (c) 2018 comma.ai (sample_data/README.md)"),
    ("sample_data/gyor", "MIT; Copyright (c) 2020 David Meszaros (sample_data/README.md)"),
    ("sample_data/fleet/network.osm.pbf, sample_data/networks",
     "ODbL 1.0; (c) OpenStreetMap contributors (SOURCE.md beside them)"),
]


def lines_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def headers_of(build):
    """Headers of the system that the product's own objects were compiled with."""
    found, is_product = set(), False
    for line in lines_of("ninja", "-C", str(build), "-t", "deps"):
        if line and not line[0].isspace():
            is_product = line.startswith(PRODUCT)
        elif is_product and line.strip().startswith("/usr/"):
            found.add(str(Path(line.strip()).resolve()))
    if not found:
        sys.exit(f"{build}: no compiled product found, expected a finished build")
    return found


def static_libraries_of(build):
    """Archives of the system of which the product contains a part."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    return {re.search(r"^MACADAM_MUSL_LIBRARY:FILEPATH=(.+)$", cache, re.MULTILINE)[1]}


def libraries_of(build):
    """Shared libraries that the program, its plug-ins and the Python module name."""
    folder = build.parent if (build.parent / "macadam").exists() else build
    linked = [folder / "macadam", *sorted((folder / "lib").glob("macadam_*")),
              *(folder / "python/macadam").glob("_macadam.*.so")]
    names, paths = set(OPENED_LATE), {}
    for file in linked:
        for line in lines_of("readelf", "-dW", str(file)):
            if match := re.search(r"\(NEEDED\).*\[(.+)\]", line):
                names.add(match[1])
    for line in lines_of("/sbin/ldconfig", "-p"):
        if match := re.match(r"\s+(\S+) \(.*x86-64.*\) => (\S+)", line):
            paths.setdefault(match[1], match[2])
    return {str(Path(paths[name]).resolve()) for name in names if name in paths}


def packages_of(files):
    names = [name for file in files for name in (file, file.removeprefix("/usr"))]  # either is listed
    owners = subprocess.run(["dpkg", "-S", *names], capture_output=True, text=True).stdout
    found = {line.split(":")[0] for line in owners.splitlines()}
    return {name for name in found if not TOOLCHAIN.match(name)}


def copyright_of(package):
    return Path(f"/usr/share/doc/{package}/copyright").read_text(encoding="utf-8", errors="replace")


def stanzas_of(text):
    """Fields of the paragraphs of a machine-readable copyright file."""
    for block in re.split(r"\n\s*\n", text):
        fields, name = {}, None
        for line in block.splitlines():
            if match := re.match(r"([A-Za-z-]+):\s*(.*)", line):
                name = match[1]
                fields[name] = match[2].strip()
            elif name and line[:1].isspace():
                fields[name] += "\n" + line
        yield fields


def licence_of(package):
    if package in PROSE:
        return PROSE[package]
    for fields in stanzas_of(copyright_of(package)):
        if fields.get("Files", "").strip().split("\n")[0].split(" ")[0] == "*" and "License" in fields:
            return fields["License"].strip().split("\n")[0].strip()
    sys.exit(f"{package}: its copyright file names no licence for 'Files: *'; add it to PROSE")


def words_of(licence, stanzas):
    """The words of a licence from the paragraph that states them, or from any that has some."""
    named = [f for f in stanzas if f.get("License", "").split("\n")[0].strip() == licence]
    texts = [f["License"].partition("\n")[2] for f in sorted(named, key=lambda f: "Files" in f)]
    return next((text for text in texts if text.strip()), "")


def text_of(package):
    """Whose it is, and the words of its licence."""
    stanzas = list(stanzas_of(copyright_of(package)))
    main = next(f for f in stanzas if f.get("Files", "").strip().split("\n")[0].split(" ")[0] == "*")
    owners = [line.strip() for line in main.get("Copyright", "").splitlines() if line.strip()]
    name, _, words = main["License"].strip().partition("\n")
    if not words.strip():
        words = "\n\n".join(words_of(each, stanzas) for each in re.split(r" and(?:/or)? | or ", name.strip()))
    if not words.strip():
        sys.exit(f"{package}: its copyright file has no words of {name}; add it to PROSE")
    plain = [re.sub(r"^ ?\.?$", "", line.rstrip()).removeprefix(" ") for line in words.splitlines()]
    return "\n".join([*(f"Copyright {owner}" for owner in owners), "", *plain]).rstrip()


def table(packages):
    yield "| Debian package | licence |"
    yield "|---|---|"
    for package in sorted(packages):
        yield f"| {package} | {licence_of(package)} |"


def npm_rows():
    """Packages of the page by its lock file; those that only build and test it are left out."""
    lock = json.loads((ROOT / "web/package-lock.json").read_text(encoding="utf-8"))
    yield "| npm package | version | licence |"
    yield "|---|---|---|"
    for path, package in sorted(lock["packages"].items()):
        if path and not package.get("dev"):
            yield f"| {path.removeprefix('node_modules/')} | {package['version']} | {package['license']} |"


def document(build):
    libraries = packages_of(libraries_of(build))
    compiled_in = packages_of(headers_of(build) | static_libraries_of(build))
    yield "# Third-party work"
    yield ""
    yield "Macadam itself is under the Apache License 2.0 ([LICENSE](LICENSE)). This page is made from a"
    yield "finished build by `docs/third_party.py`; `./run test` checks that it is complete."
    yield ""
    yield "## Compiled in"
    yield ""
    yield "Headers of these packages are part of the program, and the elementary functions of musl-dev. Headers of"
    yield "those that also have a library below are declarations. The C++ standard library is under GPL-3 with the"
    yield "GCC runtime library exception, which leaves the licence of compiled programs free."
    yield ""
    yield from table(compiled_in)
    yield ""
    yield "## Linked"
    yield ""
    yield "Shared libraries of Debian 12 that the program opens; they are not shipped with it."
    yield ""
    yield from table(libraries)
    yield ""
    yield "## In the page"
    yield ""
    yield "What the page of `export --format site` brings from npm, with its texts of licences in `assets/licences.txt`."
    yield ""
    yield from npm_rows()
    yield ""
    yield "## Shipped data"
    yield ""
    yield "| what | licence and owner |"
    yield "|---|---|"
    for what, licence in SHIPPED:
        yield f"| {what} | {licence} |"
    yield ""
    yield "## Licence texts of what is compiled in"
    for package in sorted(compiled_in - set(PROSE)):
        yield ""
        yield f"### {package}: {licence_of(package)}"
        yield ""
        yield "```text"
        yield text_of(package)
        yield "```"


def main():
    if len(sys.argv) not in (2, 3) or (len(sys.argv) == 3 and sys.argv[2] != "--check"):
        sys.exit(__doc__)
    text = "\n".join(document(Path(sys.argv[1]).resolve())) + "\n"
    if len(sys.argv) == 2:
        sys.stdout.write(text)
        return
    kept = (ROOT / "THIRD-PARTY.md").read_text(encoding="utf-8")
    rows = {line for line in text.splitlines() if line.startswith("| ")}
    missing = sorted(rows - set(kept.splitlines()))
    if missing:
        sys.exit("THIRD-PARTY.md lacks these rows; make it anew with docs/third_party.py:\n" + "\n".join(missing))


if __name__ == "__main__":
    main()
