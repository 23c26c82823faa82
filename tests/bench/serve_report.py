"""The server beside its peers: tiles as files by nginx, tiles by ST_AsMVT of PostGIS; pages of features; slow clients; a database that grows.

Loads are made by wrk. Each figure comes with its peer's of the same run: the machine is shared, the ratio is what counts.
"""

import contextlib
import http.client
import json
import math
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

from serve_growth import made_trips, new_version_s, reads_during_import, soak, until

SECONDS = 5  # of each load
ZOOM = 15  # where a tile of the bench's town holds about 1,000 segments
SLOW_CLIENTS = 1900


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Server:
    def __init__(self, macadam, store, *words):
        self.process = subprocess.Popen([macadam, "serve", store, "--listen", "127.0.0.1:0", *map(str, words)], stderr=subprocess.PIPE, text=True)
        for line in self.process.stderr:
            if found := re.search(r"serving on http://127\.0\.0\.1:(\d+)/", line):
                self.port = int(found[1])
                break
        threading.Thread(target=self.process.stderr.read, daemon=True).start()
        begin = time.monotonic()
        while self.get("/tiles.json")[0] == 503:
            time.sleep(0.2)
        self.tiles_s = time.monotonic() - begin

    def get(self, target):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.request("GET", target)
        response = connection.getresponse()
        answer = response.status, response.read()
        connection.close()
        return answer

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / 100  # user and system, in ticks of 10 ms

    def close(self):
        self.process.terminate()
        self.process.wait(30)


def load(port, paths, folder, connections=8, gzip=True):
    """Requests a second, and the 99th percentile in ms, of paths in turn."""
    script = folder / "paths.lua"
    quoted = ",".join(json.dumps(path) for path in paths)
    header = '{["Accept-Encoding"]="gzip"}' if gzip else "{}"
    script.write_text(f"local paths={{{quoted}}}\nlocal i=0\nrequest=function() i=i%#paths+1 return wrk.format('GET',paths[i],{header}) end\n")
    out = subprocess.run(["wrk", "-t1", f"-c{connections}", f"-d{SECONDS}s", "--latency", "-s", script, f"http://127.0.0.1:{port}"],
                         capture_output=True, text=True, check=True).stdout
    if bad := re.search(r"Non-2xx or 3xx responses: (\d+)", out):
        sys.exit(f"{bad[1]} requests failed:\n{out}")
    rate = float(re.search(r"Requests/sec:\s+([\d.]+)", out)[1])
    number, unit = re.search(r"99%\s+([\d.]+)(us|ms|s)", out).groups()
    return rate, float(number) * {"us": 1e-3, "ms": 1, "s": 1e3}[unit]


def loaded(server, *arguments, **named):
    """The same, and requests for each second of the server's CPU."""
    before = server.cpu_s()
    rate, p99_ms = load(server.port, *arguments, **named)
    return rate, p99_ms, rate * SECONDS / max(server.cpu_s() - before, 0.01)


def tiles_of(bounds, zoom, most):
    side = 2 ** zoom
    west, south, east, north = bounds
    column = lambda lon: int((lon + 180) / 360 * side)
    row = lambda lat: int((1 - math.asinh(math.tan(math.radians(lat))) / math.pi) / 2 * side)
    columns, rows = range(column(west) + 1, column(east)), range(row(north) + 1, row(south))
    return [(columns[i * 7 % len(columns)], rows[i * 5 % len(rows)]) for i in range(most)]


@contextlib.contextmanager
def nginx(files, folder):
    port = free_port()
    paths = "".join(f"{name}_temp_path {folder}/{name};" for name in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    (folder / "nginx.conf").write_text(f"""pid {folder}/pid; error_log {folder}/error.log; worker_processes 1; daemon off; user root;
events {{}} http {{ access_log off; {paths} sendfile on; tcp_nopush on; default_type application/vnd.mapbox-vector-tile;
server {{ listen 127.0.0.1:{port}; root {files}; gzip_static always; }} }}""")
    process = subprocess.Popen(["nginx", "-c", folder / "nginx.conf"])
    time.sleep(1)
    yield port
    process.terminate()
    process.wait(20)


@contextlib.contextmanager
def postgis(folder):
    """Connection words of a database with PostGIS, or None where there is none."""
    programs = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    if not programs:
        yield None
        return
    place, port = programs[-1].parent, free_port()
    data = folder / "data"
    data.mkdir()
    shutil.chown(data, "postgres", "postgres")
    folder.chmod(0o755)
    as_postgres = ["runuser", "-u", "postgres", "--"]
    subprocess.run([*as_postgres, place / "initdb", "-D", data, "-A", "trust"], check=True, capture_output=True)
    process = subprocess.Popen([*as_postgres, place / "postgres", "-D", data, "-p", str(port), "-k", "/tmp", "-c", "fsync=off", "-c", "shared_buffers=512MB"],
                               stderr=subprocess.DEVNULL)
    connection = f"host=127.0.0.1 port={port} user=postgres dbname=postgres"
    for _ in range(100):
        if subprocess.run(["psql", connection, "-c", "CREATE EXTENSION IF NOT EXISTS postgis"], capture_output=True).returncode == 0:
            break
        time.sleep(0.2)
    yield connection
    process.terminate()
    process.wait(60)


def as_mvt_rate(connection, geojson, tiles, folder):
    """Tiles a second of ST_AsMVT in one connection, as pg_tileserv asks."""
    subprocess.run(["ogr2ogr", "-f", "PostgreSQL", f"PG:{connection}", geojson, "-nln", "roads", "-lco", "GEOMETRY_NAME=geom", "-t_srs", "EPSG:3857",
                    "--config", "PG_USE_COPY", "YES"], check=True, capture_output=True)
    subprocess.run(["psql", connection, "-c", "VACUUM ANALYZE roads"], check=True, capture_output=True)
    script = folder / "tile.sql"
    cases = " ".join(f"WHEN {i} THEN {column}" for i, (column, _) in enumerate(tiles)), " ".join(f"WHEN {i} THEN {row}" for i, (_, row) in enumerate(tiles))
    script.write_text(f"\\set i random(0, {len(tiles) - 1})\n"
                      f"WITH place AS (SELECT ST_TileEnvelope({ZOOM}, CASE :i {cases[0]} END, CASE :i {cases[1]} END) AS box) "
                      "SELECT ST_AsMVT(tile) FROM (SELECT ST_AsMVTGeom(geom, box, 4096, 64, true) AS geom, iri, iri_sd, passes, class, name, highway "
                      "FROM roads, place WHERE geom && box) AS tile;\n")
    out = subprocess.run(["pgbench", "-n", "-f", script, "-c", "1", "-T", str(SECONDS), connection], capture_output=True, text=True, check=True).stdout
    return float(re.search(r"tps = ([\d.]+)", out)[1])


def slow_request(kind, token, number):
    """What a slow client sends at once; the server sees each as another one behind its proxy."""
    head = f"Host: localhost\r\nX-Forwarded-For: 10.0.{number // 256}.{number % 256}\r\n"
    return {"heads": f"GET /health HTTP/1.1\r\n{head}X: ",
            "bodies": f"PUT /v1/trips/{number:064x} HTTP/1.1\r\n{head}Authorization: Bearer {token}\r\nContent-Type: text/csv\r\n"
                      "Content-Length: 1000000\r\n\r\n",
            "readers": f"GET /assets/maplibre-gl.mjs HTTP/1.1\r\n{head}\r\n"}[kind].encode()


def slow_clients(server, kind, token):
    """The 99th percentile of /health, ms, beside clients that send a head or a body, or read a file of the page, byte by byte."""
    held = []
    for number in range(SLOW_CLIENTS):
        one = socket.socket()
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)  # the system shall not read for it
        one.settimeout(10)
        one.connect(("127.0.0.1", server.port))
        one.sendall(slow_request(kind, token, number))
        held.append(one)
    times_ms = []
    for i in range(200):
        for one in held[i % 10::10]:
            with contextlib.suppress(OSError):
                one.recv(1) if kind == "readers" else one.send(b"x")
        begin = time.monotonic()
        status, _ = server.get("/health")
        if status != 200:
            sys.exit(f"/health answers {status}")
        times_ms.append(1e3 * (time.monotonic() - begin))
    for one in held:
        one.close()
    return sorted(times_ms)[-2]


def slow_times_ms(macadam, store, folder):
    """The same for each kind, of servers of a copy, which has a token."""
    copy = folder / "slow.gpkg"
    for file in store.parent.glob(f"{store.name}*"):
        shutil.copy(file, folder / file.name.replace(store.name, copy.name))
    token = subprocess.run([macadam, "token", "create", copy, "bench", "--scope", "operator", "--quiet"],
                           capture_output=True, text=True, check=True).stdout.strip()
    times_ms = []
    for kind in ("heads", "bodies", "readers"):
        proxied = Server(macadam, copy, "--behind-proxy", "https://localhost", "--workers", "0")
        until(lambda: proxied.get("/assets/maplibre-gl.mjs")[0] == 200)  # the page is there
        times_ms.append(slow_clients(proxied, kind, token))
        proxied.close()
    return times_ms


def growth(macadam, store, work, folder, items, vector, table):
    """Rows of a table: what the server does with a copy of the store into which trips are imported."""
    growing = work / "growing.gpkg"
    for left in work.glob("growing.gpkg*"):
        left.unlink()
    for file in store.parent.glob(f"{store.name}*"):
        shutil.copy(file, work / file.name.replace(store.name, growing.name))
    server = Server(macadam, growing)
    begin = time.monotonic()
    while server.get("/site.json")[0] != 200:
        time.sleep(0.2)
    first_s = server.tiles_s, server.tiles_s + time.monotonic() - begin
    fleet = made_trips(macadam, store, json.loads(server.get("/tiles.json")[1])["bounds"], work)
    trips = sorted((fleet / "trips").iterdir())
    tiles_s, page_s, cpu_s = new_version_s(server, macadam, growing, fleet, trips[0])
    rows = [["all tiles; and the page, after the start", f"{first_s[0]:.1f} s; {first_s[1]:.1f} s"],
            ["tiles, and the page, of a new version after one trip", f"{tiles_s:.1f} s; {page_s:.1f} s; {cpu_s:.1f} s of CPU"]]
    for name, paths, some in (("1,000 features", items, trips[1:7]), ("vector tiles", vector, trips[7:])):
        alone, busy, during, ran_through = reads_during_import(server, load, paths, folder, macadam, growing, fleet, some)
        rows.append([f"{name}, one client: p99 alone; beside a process that computes; while trips are imported",
                     f"{alone:.1f} ms; {busy:.1f} ms; {during:.1f} ms" + ("" if ran_through else " (the import ended before)")])
    server.close()
    return "\n\nWhile the database grows:\n\n" + table(["what", "measured"], rows)


def soaked(server, paths, folder, minutes, table):
    first, last = soak(server, load, paths, folder, minutes)
    grown = [f"{100 * (after / before - 1):+.1f} %" for before, after in zip(first, last)]
    return f"\n\n{minutes:.0f} minutes at half load, from the first tenth to the end:\n\n" + \
        table(["what", "first", "last", "grown"], [["memory, MB", f"{first[0]:.0f}", f"{last[0]:.0f}", grown[0]],
                                                   ["open descriptors", f"{first[1]}", f"{last[1]}", grown[1]]])


def serve_report(macadam, store, work, table, soak_minutes=0):
    """Text of the section; `store` has a million segments."""
    work.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir="/tmp") as temporary:
        folder = pathlib.Path(temporary)
        folder.chmod(0o711)  # the user of PostgreSQL has a folder in it
        server = Server(macadam, store)
        bounds = json.loads(server.get("/tiles.json")[1])["bounds"]
        tiles = tiles_of(bounds, ZOOM, 64)
        vector = [f"/tiles/WebMercatorQuad/{ZOOM}/{row}/{column}" for column, row in tiles]
        files = folder / "files"
        for path in vector:
            status, body = server.get(path)
            if status != 200:
                sys.exit(f"{path}: {status}")
            file = files / path.removeprefix("/")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(body)
            subprocess.run(["gzip", "-kf", file], check=True)
        tile_rate, tile_ms, tile_cpu = loaded(server, vector, folder)
        with nginx(files, folder) as port:
            file_rate, file_ms = load(port, vector, folder)
        picture = [f"/map{path}" for path in vector[:32]]
        for path in picture:
            server.get(path)
        picture_rate, picture_ms, picture_cpu = loaded(server, picture, folder)
        items = [f"/collections/segments/items?limit=1000&offset={1000 * i}" for i in range(20)]
        server.get(items[0])  # the selection is found once for each version
        one_rate, one_ms, one_cpu = loaded(server, items, folder, connections=1)
        four_rate, four_ms, _ = loaded(server, items, folder, connections=4)
        rows = [["vector tile, held ready", f"{tile_rate:,.0f}", f"{tile_ms:.1f}", f"{tile_cpu:,.0f}", "nginx, the same as files", f"{file_rate:,.0f}",
                 f"{tile_rate / file_rate:.2f}"],
                ["picture tile, drawn before", f"{picture_rate:,.0f}", f"{picture_ms:.1f}", f"{picture_cpu:,.0f}", "", "", ""],
                ["1,000 features, one client", f"{one_rate:,.0f}", f"{one_ms:.1f}", f"{one_cpu:,.0f}", "", "", ""],
                ["1,000 features, four clients", f"{four_rate:,.0f}", f"{four_ms:.1f}", "", "", "", ""]]
        long = soaked(server, vector + items + picture, folder, soak_minutes, table) if soak_minutes else ""
        server.close()
        grown = growth(macadam, store, work, folder, items, vector, table)
        geojson = work / "roads.geojson"
        subprocess.run([macadam, "export", store, "-o", geojson, "--quiet"], check=True)
        database = folder / "postgis"
        database.mkdir()
        with postgis(database) as connection:
            if connection:
                rate = as_mvt_rate(connection, geojson, tiles, folder)
                rows.append(["", "", "", "", "ST_AsMVT, the query alone", f"{rate:,.0f}", f"{tile_rate / rate:.1f}"])
        heads_ms, bodies_ms, readers_ms = slow_times_ms(macadam, store, folder)
    return f"A store of {store.stat().st_size / 1e6:,.0f} MB; its tiles were ready {server.tiles_s:.0f} s after the start. Loads by wrk of 8 connections " + \
        f"unless said, {SECONDS} s each, on the same machine; tiles of zoom {ZOOM} of some 1,000 segments, gzipped. Beside {SLOW_CLIENTS} clients that " + \
        f"send a head byte by byte, `/health` answers within {heads_ms:.0f} ms (99 of 100); that send a body so, {bodies_ms:.0f} ms; that read a file " + \
        f"of the page so, {readers_ms:.0f} ms.\n\n" + \
        table(["what", "a second", "p99, ms", "a second of its CPU", "peer", "its, a second", "times as fast"], rows) + grown + long
