"""The server of a database that grows: a new version after a trip, reads while an import runs, and a soak.

The trips are simulated over the middle of the town, once for each work folder.
"""

import pathlib
import shutil
import subprocess
import threading
import time

TRIPS = 12


def made_trips(macadam, store, bounds, work):
    """Folder with logs of trips over some square kilometres in the middle of the store, and with their cars."""
    fleet = work / "fleet"
    if not (fleet / "trips").is_dir():
        shutil.rmtree(fleet, ignore_errors=True)
        west, south = (bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2
        roads = work / "part.geojson"
        subprocess.run([macadam, "export", store, "-o", roads, "--bbox", f"{west},{south},{west + 0.03},{south + 0.02}", "--quiet"], check=True)
        subprocess.run([macadam, "simulate", "-o", fleet, "--network", roads, "--trips", str(TRIPS), "--quiet"], check=True)
    return fleet


def import_trips(macadam, store, fleet, trips):
    return subprocess.Popen([macadam, "import", store, *trips, "--vehicles", fleet / "vehicles", "--jobs", "1", "--quiet"])


def until(condition, pause_s=0.05):
    begin = time.monotonic()
    while not condition():
        time.sleep(pause_s)
    return time.monotonic() - begin


def new_version_s(server, macadam, store, fleet, trip):
    """Seconds from a commit to its tiles, and to its page; and CPU of the server meanwhile."""
    version = lambda: server.get("/tiles.json")[1]
    page = lambda: server.get("/site.json")[1]
    tiles_before, page_before = version(), page()
    import_trips(macadam, store, fleet, [trip]).wait()
    begin, cpu = time.monotonic(), server.cpu_s()
    until(lambda: version() != tiles_before)
    tiles_s = time.monotonic() - begin
    until(lambda: page() != page_before)
    return tiles_s, time.monotonic() - begin, server.cpu_s() - cpu


def reads_during_import(server, load, paths, folder, macadam, store, fleet, trips):
    """The 99th percentile of reads, ms: alone, beside a process that computes as an import does, and while an import runs."""
    server.get(paths[0])  # what is found once for a path
    alone = load(server.port, paths, folder, connections=1)[1]
    busy = subprocess.Popen(["python3", "-c", "while True: pass"])
    beside_busy = load(server.port, paths, folder, connections=1)[1]
    busy.kill()
    busy.wait()
    importing = import_trips(macadam, store, fleet, trips)
    during = load(server.port, paths, folder, connections=1)[1]
    ran_through = importing.poll() is None
    importing.wait()
    return alone, beside_busy, during, ran_through


def used(server):
    """Memory of the process, MB, and its open descriptors."""
    process = pathlib.Path("/proc") / str(server.process.pid)
    kb = next(int(line.split()[1]) for line in (process / "status").read_text().splitlines() if line.startswith("VmRSS"))
    return kb / 1024, len(list((process / "fd").iterdir()))


def soak(server, load, paths, folder, minutes):
    """Reads at full rate for half of the time. Memory and descriptors after the first tenth and at the end."""
    ends = time.monotonic() + 60 * minutes
    first_ends = time.monotonic() + 6 * minutes
    first = None
    while time.monotonic() < ends:
        begin = time.monotonic()
        load(server.port, paths, folder)
        time.sleep(time.monotonic() - begin)
        if first is None and time.monotonic() >= first_ends:
            first = used(server)
    return first or used(server), used(server)
