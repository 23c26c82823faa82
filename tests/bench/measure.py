#!/usr/bin/python3
"""Measures the program and its parts and writes what was found as Markdown.

usage: measure.py BUILD_DIR WORK_DIR OUT.md [--keep DOC.md] [--kubicka DIR] [--cars N] [--side N] [--soak MINUTES] [NAME...]

BUILD_DIR      a release build with the target `benches`
WORK_DIR       where the measured data is made and kept between runs
--keep DOC.md  also puts what was measured in the place of those sections of a document
--kubicka DIR  recorded trips for `match` (docs/benchmarks.md)
--cars N       largest fleet for `calibration`, 2,500 unless given; each car has 1,000 passes
--side N       crossings along a side of the town of `growth`, 223 unless given: a million segments, 20 million passes; 705
               are ten times as many, and need 60 GB of disk in /tmp
--soak MINUTES how long `serve` also works at half load, to see whether it grows
NAME           start process estimation match store writers growth calibration render vector_tile web serve; all when none
               is named

Machines are shared and noisy. So what is to be compared runs turn by turn in one go, the figure is
the median of the turns, and the ratio is what counts. CPU seconds are user and system together.
"""

import argparse
import datetime
import functools
import json
import multiprocessing
import os
import random
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from match_report import match_report
from serve_report import serve_report

SOURCE = Path(__file__).resolve().parents[2]
FLEET = SOURCE / "sample_data" / "fleet"
TRIPS = 160  # enough for 20 CPU seconds of import


def say(text):
    print(text, file=sys.stderr, flush=True)


class Usage:
    """What one run of a program took."""

    def __init__(self, wall_s, cpu_s, peak_mb):
        self.wall_s, self.cpu_s, self.peak_mb = wall_s, cpu_s, peak_mb


def run(words):
    begin = time.monotonic()
    child = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = child.stderr.read()
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))} failed: {errors.decode()}")
    return Usage(time.monotonic() - begin, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def median(runs):
    return Usage(*(statistics.median(getattr(one, name) for one in runs) for name in ("wall_s", "cpu_s", "peak_mb")))


def in_turns(turns, *commands):
    """Each command is (before, words). Returns one median per command."""
    taken = [[] for _ in commands]
    for turn in range(turns):
        for number, (before, words) in enumerate(commands):
            before()
            taken[number].append(run(words))
            say(f"  turn {turn + 1}: {taken[number][-1].wall_s:.2f} s  {Path(words[0]).name} {' '.join(map(str, words[1:3]))}")
    return [median(runs) for runs in taken]


def nothing():
    pass


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def start(macadam, work):
    version, help_ = in_turns(9, (nothing, [macadam, "--version"]), (nothing, [macadam, "import", "--help"]))
    return table(
        ["command", "wall ms", "peak MB"],
        [["--version", f"{version.wall_s * 1e3:.0f}", f"{version.peak_mb:.0f}"],
         ["import --help", f"{help_.wall_s * 1e3:.0f}", f"{help_.peak_mb:.0f}"]])


def fleet(macadam, work):
    """A year of the sample fleet's driving, made once."""
    folder = work / f"fleet-{TRIPS}"
    if not (folder / "truth.csv").exists():
        shutil.rmtree(folder, ignore_errors=True)
        say(f"simulating {TRIPS} trips into {folder}")
        took = run([macadam, "simulate", "-o", folder, "--network", FLEET / "network.osm.pbf",
                    "--recipe", FLEET / "recipe.toml", "--trips", TRIPS, "--seed", 1, "--jobs", os.cpu_count()])
        (folder / "simulated.json").write_text(json.dumps(vars(took)))
    return folder


def hours_and_mb(trips):
    """Recorded hours by the last time stamp of each log, and MB on disk."""
    seconds = 0.0
    for trip in trips:
        tail = subprocess.run(f"gzip -dc '{trip}' | tail -n 2 | head -n 1", shell=True, capture_output=True, text=True, check=True)
        seconds += float(tail.stdout.split(",")[0])
    return seconds / 3600, sum(trip.stat().st_size for trip in trips) / 1e6


def process(macadam, work):
    folder = fleet(macadam, work)
    trips = sorted((folder / "trips").iterdir())
    empty, store = work / "empty.gpkg", work / "store.gpkg"
    empty.unlink(missing_ok=True)
    run([macadam, "init", empty, "--network", folder / "network.osm.pbf"])

    def fresh():
        shutil.copyfile(empty, store)

    def importing(paths, jobs):
        return fresh, [macadam, "import", store, *paths, "--vehicles", folder / "vehicles", "--method", "kf", "--jobs", jobs, "--quiet"]

    text = import_tables(trips, importing)
    text += output_tables(macadam, work, store)
    simulated = json.loads((folder / "simulated.json").read_text())
    hours, mb = hours_and_mb(trips)
    text += "### Simulating\n\n" + table(
        ["what", "trips", "hours of driving", "MB of .gz", "wall s", "CPU s", "x real time per CPU"],
        [["simulate", str(TRIPS), f"{hours:.1f}", f"{mb:.0f}", f"{simulated['wall_s']:.0f}", f"{simulated['cpu_s']:.0f}",
          f"{hours * 3600 / simulated['cpu_s']:.0f}"]])
    text += "\n" + profile_table(macadam, work)
    return text


def write_profile(file):
    """Two wheel tracks of 1,000 km at 50 mm: 50 km of a rough road, again and again."""
    noise, tracks, left, right = random.Random(1), [], 0.0, 0.0
    for _ in range(1_000_000):
        both = noise.gauss(0, 0.0008)
        left += both + noise.gauss(0, 0.0004) - 1e-5 * left
        right += both + noise.gauss(0, 0.0004) - 1e-5 * right
        tracks.append(f",{left:.5f},{right:.5f}\n")
    with file.with_suffix(".part").open("w") as out:
        out.write("station_m,left_m,right_m\n")
        for first in range(0, 20_000_000, len(tracks)):
            out.writelines(f"{(first + i) / 20:.2f}{one}" for i, one in enumerate(tracks))
    file.with_suffix(".part").rename(file)


def profile(work):
    """Made once, in a process of its own: what this one holds would be counted to its children."""
    file = work / "profile-1000km.csv"
    if not file.exists():
        say(f"writing {file}")
        writer = multiprocessing.Process(target=write_profile, args=(file,))
        writer.start()
        writer.join()
    return file


def profile_table(macadam, work):
    file = profile(work)
    pieces, rough, lines = in_turns(
        3, (nothing, [macadam, "iri", file, "--length", 100]),
        (nothing, [macadam, "iri", file, "--continuous", "--threshold", 5]),
        (nothing, ["wc", "-l", file]))
    mb = file.stat().st_size / 1e6
    return f"### Reference IRI of 1,000 km at 50 mm, two tracks ({mb:.0f} MB of CSV)\n\n" + table(
        ["what", "wall s", "CPU s", "peak MB"],
        [[name, f"{used.wall_s:.1f}", f"{used.cpu_s:.1f}", f"{used.peak_mb:.0f}"]
         for name, used in (("iri --length 100", pieces), ("iri --continuous --threshold 5", rough),
                            ("wc -l of the same file", lines))]) + "\n"


def import_tables(trips, importing):
    hours, mb = hours_and_mb(trips)
    one, two, unpack = in_turns(3, importing(trips, 1), importing(trips, 2),
                                (nothing, ["gzip", "-dc", *trips]))
    rows = [[name, f"{len(trips)}", f"{used.wall_s:.1f}", f"{used.cpu_s:.1f}", f"{used.peak_mb:.0f}",
             f"{hours * 3600 / used.cpu_s:,.0f}", f"{one.wall_s / used.wall_s:.2f}"]
            for name, used in (("import --jobs 1", one), ("import --jobs 2", two), ("gzip -dc of the same logs", unpack))]
    text = f"### Importing {hours:.1f} h of driving ({mb:.0f} MB)\n\n" + table(
        ["what", "trips", "wall s", "CPU s", "peak MB", "x real time per CPU", "times faster than --jobs 1"], rows)
    rows = []
    for part in (8, 4, 2, 1):
        some = trips[: len(trips) // part]
        (used,) = in_turns(1, importing(some, 1))
        rows.append([str(len(some)), f"{used.cpu_s:.2f}", f"{used.cpu_s / len(some) * 1e3:.0f}", f"{used.peak_mb:.0f}"])
    return text + "\nGrowth with the number of trips, one job:\n\n" + table(
        ["trips", "CPU s", "CPU ms a trip", "peak MB"], rows) + "\n"


def output_tables(macadam, work, store):
    """Questions and outputs of the store that the last import left, beside GDAL's tools."""
    ours, theirs = work / "ours.geojson", work / "theirs.geojson"

    def gone(*files):
        return lambda: [file.unlink(missing_ok=True) for file in files]

    answer = subprocess.run([macadam, "query", store, "--worst", "1", "--json"], capture_output=True, check=True).stdout
    lat, lon = (json.loads(answer)[0][name] for name in ("lat_deg", "lon_deg"))
    west, south, east, north = lon - 0.01, lat - 0.006, lon + 0.01, lat + 0.006
    asked = in_turns(
        7,
        (nothing, [macadam, "query", store, "--bbox", f"{west},{south},{east},{north}", "--format", "geojson"]),
        (nothing, ["ogr2ogr", "-f", "GeoJSON", "/dev/stdout", store, "roughness", "-spat", west, south, east, north]),
        (gone(ours), [macadam, "export", store, "-o", ours, "--quiet"]),
        (gone(theirs), ["ogr2ogr", "-f", "GeoJSON", "-lco", "RFC7946=YES", theirs, store, "roughness"]),
        (gone(work / "map.png"), [macadam, "render", store, "-o", work / "map.png", "--size", "2048x2048", "--quiet"]),
        (gone(work / "report.html"), [macadam, "report", store, "-o", work / "report.html", "--quiet"]),
        (nothing, [macadam, "info", store]))
    names = ["query --bbox", "ogr2ogr -spat", "export .geojson", "ogr2ogr to GeoJSON", "render 2048 x 2048", "report", "info"]
    beside = ["", f"{asked[1].cpu_s / asked[0].cpu_s:.1f}", "", f"{asked[3].cpu_s / asked[2].cpu_s:.1f}", "", "", ""]
    return "### Asking and handing on\n\n" + table(
        ["what", "wall ms", "CPU ms", "peak MB", "CPU, times the line above"],
        [[name, f"{used.wall_s * 1e3:.0f}", f"{used.cpu_s * 1e3:.0f}", f"{used.peak_mb:.0f}", ratio]
         for name, used, ratio in zip(names, asked, beside)]) + "\n"


# What something is measured beside: the same work by other means.
PEERS = {"filter_of_macadam": "filter_as_in_the_paper", "draw_in_macadam": "draw_in_cairo", "make_store": "insert_under_triggers",
         "add_batch<false>": "insert_bare_rows", "export_tiles_in_macadam": "export_tiles_in_gdal"}


def peak_mb(program, name):
    """Of a process that does nothing else."""
    return run([program, f"--benchmark_filter=^{re.escape(name)}$", "--benchmark_min_time=0.01"]).peak_mb


def ratio_to_peer(name, times):
    """CPU of the peer over ours, for the same size; empty where there is no peer."""
    own, _, size = name.partition("/")
    peer = f"{PEERS.get(own)}/{size}"
    return f"{times[peer] / times[name]:.1f}" if peer in times else ""


def part(build, name, note):
    """One program of Google Benchmark as a table of CPU times, memory, ratios and counters."""
    say(f"{name}_bench")
    program = build / "tests" / "bench" / f"{name}_bench"
    done = subprocess.run([program, "--benchmark_format=json"], capture_output=True, check=True)
    found = json.loads(done.stdout)["benchmarks"]
    times = {one["name"]: one["cpu_time"] for one in found if one["run_type"] == "iteration"}
    rows = []
    for one in found:
        if one.get("aggregate_name") == "RMS":
            continue
        if one.get("aggregate_name") == "BigO":
            rows.append([one["run_name"], f"grows as {one['big_o']}", "", "", ""])
            continue
        counters = ", ".join(f"{key} {one[key]:,.1f}" if key.endswith("_ms") else f"{key} {one[key]:,.0f}" for key in
                             ("samples/s", "x_real_time", "fixes/s", "edges", "found", "segments", "segments/s", "bytes/segment",
                              "passes/s", "p50_ms", "p99_ms", "worst_ms", "lines") if key in one)
        rows.append([one["name"], f"{one['cpu_time']:.2f} {one['time_unit']}", f"{peak_mb(program, one['name']):.0f}",
                     ratio_to_peer(one["name"], times), counters])
    return f"{note}\n\n" + table(["what", "CPU", "peak MB", "CPU of the peer, times ours", "of it"], rows)


PARTS = {
    "estimation": "The filter as the paper writes it (matrices of any size, covariance at every sample) beside ours, "
                  "and the whole way from vibration to IRI, on 15 minutes to 2 hours at 100 Hz.",
    "store": "Stores made, beside the same rows inserted under the triggers that keep a GeoPackage's R-tree; about 1,400 segments "
             "out of stores of growing size; trips of 500 passes added and fused one by one, and many at once: `<true>` lays each "
             "pass on the others (docs/method/fusion.md), `<false>` has no traces to. `add_batch` is 1,000 trips at once, `<true>` with "
             "traces and states, `<false>` the rows of passes alone, beside SQLite's own insertion of such rows into a bare table.",
    "render": "The streets of towns of growing size at 2048 x 2048, beside Cairo with casing and round joins. "
              "Ours begins by waking the software renderer, which costs the small towns most.",
    "vector_tile": "A gzipped vector tile from the store by its place and from memory; then all tiles of a zoom of a town, beside GDAL's "
                   "driver that makes them from a GeoPackage of the same segments, which holds them ready.",
}
TITLES = {"start": "Start", "process": "Whole commands", "estimation": "Estimation", "match": "Matching", "store": "Store",
          "writers": "Writers of a PostgreSQL server", "growth": "Growth of a PostgreSQL server",
          "calibration": "Calibration", "render": "Picture", "vector_tile": "Vector tiles", "web": "Web page", "serve": "Server"}


def kept(document, sections):
    """The document with sections put in the place of those of the same titles, in the order of TITLES."""
    head, _, measured = document.partition("<!-- measured -->\n")
    old = {one.split("\n", 1)[0]: "## " + one for one in re.split(r"^## ", measured, flags=re.MULTILINE)[1:]}
    new = {TITLES[name]: text for name, text in sections.items()}
    both = [(new.get(title) or old.get(title, "")).rstrip("\n") for title in TITLES.values()]
    return head + "<!-- measured -->\n" + "\n\n".join(one for one in both if one) + "\n"


def machine():
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown processor")
    return f"{model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} when it began"


@functools.cache
def tile_store(build, work, side):
    """A town of that many crossings a side with one pass over each segment; 223 are a million segments."""
    file = work / f"tile-town-{side}.gpkg"
    file.unlink(missing_ok=True)
    say(f"making {file}")
    tile_bench(build, "make", file, side)
    return file


def tile_bench(build, *words):
    say(f"tile_bench {words[0]}")
    program = build / "tests" / "bench" / "tile_bench"
    return subprocess.run([program, *map(str, words)], stdout=subprocess.PIPE, check=True, text=True).stdout


def picture_tiles(build, work, macadam):
    """Picture tiles out of a million segments, beside Mapnik with its OGR plugin and Cairo."""
    store = tile_store(build, work, 223)
    return "\n### Picture tiles out of a million segments\n\n" + \
        "Medians over 64 tiles, three rounds, milliseconds of CPU. Mapnik reads the same GeoPackage by its OGR plugin and draws " + \
        "casing and core, both directions on each other; ours draws each at its side; Cairo draws the lines that ours did.\n\n" + \
        table(["tile", "query", "draw", "PNG", "all, ms of CPU", "Mapnik + OGR", "its png8", "both", "times ours",
               "Cairo, drawing alone", "times ours"], []) + \
        tile_bench(build, "pictures", store) + "\n" + tile_bench(build, "map", store) + "\n" + tile_jobs(work, macadam, store)


def tile_jobs(work, macadam, store):
    """What a second process gains: a whole command, wall time and the CPU time of all its processes."""
    out = work / "tiles.mbtiles"

    def export(jobs):
        words = [macadam, "export", store, "-o", out, "--tiles", "picture", "--zoom", "15-16", "--bbox", "13.05,51.03,13.25,51.13"]
        return lambda: out.unlink(missing_ok=True), [*words, "--jobs", jobs, "--quiet"]

    one, two = in_turns(3, export(1), export(2))
    return "`export --tiles picture` of zooms 15 and 16 of a third of the town:\n\n" + table(
        ["--jobs", "wall s", "CPU s of all", "wall, times as fast", "CPU s, two shared evenly, times as fast"],
        [["1", f"{one.wall_s:.2f}", f"{one.cpu_s:.2f}", "", ""],
         ["2", f"{two.wall_s:.2f}", f"{two.cpu_s:.2f}", f"{one.wall_s / two.wall_s:.2f}", f"{2 * one.cpu_s / two.cpu_s:.2f}"]])


def vector_tiles(build, work):
    """Vector tiles asked of stores by their places."""
    head = table(["tile", "query", "encode", "gzip", "all, ms of CPU"], [])
    rows = "".join(tile_bench(build, "vectors", tile_store(build, work, side)) for side in (56, 112, 223))
    return "\n### Vector tiles out of stores, by their places\n\n" + \
        "Medians over 64 tiles, three rounds, milliseconds of CPU: the box is asked of the store, the segments become a tile, the tile is " + \
        "gzipped as in files.\n\n" + head + rows


def web_page(build, work, macadam):
    """The page of a site of a million segments in Chromium, beside a plain page with one GeoJSON of the same data."""
    store, site, geojson = tile_store(build, work, 223), work / "web" / "site", work / "web" / "roads.geojson"
    shutil.rmtree(site.parent, ignore_errors=True)
    site.parent.mkdir()
    made = run([macadam, "export", store, "-o", site, "--format", "site", "--quiet"])
    run([macadam, "export", store, "-o", geojson, "--quiet"])
    files = sum(file.stat().st_size for file in site.rglob("*") if file.is_file()) / 1e6
    say("the page in Chromium")
    rows = subprocess.run(["node", SOURCE / "web" / "tests" / "bench.mjs", site, geojson], stdout=subprocess.PIPE, check=True, text=True).stdout
    return f"The site of a million segments takes {made.wall_s:.0f} s and {made.peak_mb:.0f} MB to export and has {files:.0f} MB; the GeoJSON has " + \
        f"{geojson.stat().st_size / 1e6:.0f} MB. Debian's Chromium, loopback, gzip, the CPU slowed 4 times until the first whole picture; then panning at " + \
        "1280 x 800 at zooms 11, 13 and 15 (GeoJSON: 14) at full speed: frames a second and, a frame, CPU of the page's thread and of the " + \
        "process that draws, by software: there is no graphics card.\n\n" + \
        table(["page", "first picture", "transferred", "panning", "memory of its process"], []) + rows


def on_server(program, *words):
    """What a program prints that works on a PostgreSQL server of its own, which syncs to the disk of /tmp."""
    programs = max(Path("/usr/lib/postgresql").glob("*/bin"))
    folder = Path(tempfile.mkdtemp(prefix="macadam-pg-", dir="/tmp"))  # paths of sockets are short
    ordinary = ["setpriv", "--reuid=nobody", "--regid=nogroup", "--clear-groups"] if os.geteuid() == 0 else []
    if ordinary:
        shutil.chown(folder, "nobody", "nogroup")
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "own"), "XDG_CONFIG_HOME": str(folder / "own")}
    (folder / "own").mkdir()

    def call(*words):
        return subprocess.run([str(word) for word in words], check=True, text=True, stdout=subprocess.PIPE, cwd="/", env=environment).stdout

    call(*ordinary, programs / "initdb", "-D", folder / "data", "-U", "bench", "-A", "trust", "-E", "UTF8", "--locale=C.UTF-8")
    control = [*ordinary, programs / "pg_ctl", "-D", folder / "data", "-w", "-l", folder / "data" / "log"]
    call(*control, "-o", f"-c listen_addresses= -c unix_socket_directories={folder} -c shared_buffers=512MB -c max_wal_size=4GB", "start")
    try:
        call(programs / "psql", "-qX", "-h", folder, "-U", "bench", "postgres", "-c", "CREATE EXTENSION postgis")
        say(program.name)
        return call(program, f"postgresql://bench@/postgres?host={folder}", *words)
    finally:
        call(*control, "-m", "immediate", "stop")
        shutil.rmtree(folder)


def writers(build):
    """Trips stored by up to four writers."""
    return "Trips of 500 passes on some 90 chunks, with traces, each in a transaction that is synced; beside them the same rows in a " + \
        "COPY into a table without keys (tests/bench/server/server_writers.cpp); medians of three rounds, in turns.\n\n" + \
        on_server(build / "tests" / "bench" / "server_writers")


def growth(build, side):
    """What a database costs while its passes double."""
    return "Trips as above, by four writers, until each segment has 20 passes (tests/bench/server/server_growth.cpp). At each doubling what " + \
        "waits is fused for 20 s by one connection, and squares of 1 km are read as `query --bbox` does.\n\n" + \
        on_server(build / "tests" / "bench" / "server_growth", side)


def calibration(build, work, macadam, cars):
    """`calibrate` and `info` of fleets that double, to `cars`."""
    rows = []
    for fleet in (cars // 8, cars // 4, cars // 2, cars):
        file = work / f"fleet-{fleet}.gpkg"
        for left in work.glob(f"{file.name}*"):
            left.unlink()
        say(f"making {file}")
        made = subprocess.run([build / "tests" / "bench" / "calibration_fleet", file, str(round(fleet ** 0.5))],
                              stdout=subprocess.PIPE, check=True, text=True).stdout.split(", ")
        done, shown = run([macadam, "calibrate", file, "--quiet"]), run([macadam, "info", file])
        passes = int(made[1].split()[0])
        rows.append([made[0].split()[0], f"{passes:,}", f"{done.wall_s:.1f}", f"{done.cpu_s:.1f}", f"{1e6 * done.cpu_s / passes:.1f}",
                     f"{done.peak_mb:.0f}", f"{shown.wall_s:.1f}", f"{shown.peak_mb:.0f}"])
        file.unlink()
    return "`calibrate` of fleets that double, fusion of all segments included: ten trips of 100 passes for each car near its home, some " + \
        "50 passes for each segment, one car in a hundred changes (tests/bench/calibration_fleet.cpp; `./run bench --cars 10000 " + \
        "calibration`). Then `info`.\n\n" + table(
            ["cars", "passes", "wall s", "CPU s", "CPU µs a pass", "peak MB", "info, wall s", "info, peak MB"], rows)


def measured(name, arguments, macadam):
    if name == "calibration":
        return calibration(arguments.build, arguments.work, macadam, arguments.cars)
    if name == "writers":
        return writers(arguments.build)
    if name == "growth":
        return growth(arguments.build, arguments.side)
    if name == "start":
        return start(macadam, arguments.work)
    if name == "process":
        return process(macadam, arguments.work)
    if name == "web":
        return web_page(arguments.build, arguments.work, macadam)
    if name == "serve":
        return serve_report(macadam, tile_store(arguments.build, arguments.work, 223), arguments.work / "serve", table, arguments.soak)
    if name == "match":
        return match_report(arguments.build, arguments.kubicka)
    text = part(arguments.build, name, PARTS[name])
    if name == "store":
        say("large_store")
        large = subprocess.run([arguments.build / "tests" / "bench" / "large_store"], capture_output=True, check=True, text=True)
        text += "\n### A large store\n\n" + large.stdout
    if name == "render":
        text += picture_tiles(arguments.build, arguments.work, macadam)
    if name == "vector_tile":
        text += vector_tiles(arguments.build, arguments.work)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("build", "work", "out"):
        parser.add_argument(name, type=lambda word: Path(word).resolve())
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--kubicka", type=Path)
    parser.add_argument("--cars", type=int, default=2500)
    parser.add_argument("--side", type=int, default=223)
    parser.add_argument("--soak", type=float, default=0, metavar="MINUTES")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_intermixed_args()
    if unknown := set(arguments.names) - set(TITLES):
        sys.exit(f"measure.py: no bench '{unknown.pop()}'; there are {', '.join(TITLES)}")
    arguments.work.mkdir(parents=True, exist_ok=True)
    sections = {}
    for name in (name for name in TITLES if name in (arguments.names or TITLES)):
        when = f"Measured on {datetime.date.today()}: {machine()}."
        sections[name] = f"## {TITLES[name]}\n\n{when}\n\n" + measured(name, arguments, SOURCE / "build" / "macadam")
    text = "\n".join(sections.values())
    arguments.out.write_text(text)
    print(text)
    if arguments.keep:
        arguments.keep.write_text(kept(arguments.keep.read_text(), sections))


main()
