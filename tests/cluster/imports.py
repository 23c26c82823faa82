"""Imports by the program itself, one after the other, while servers fail."""

import gzip
import json
import re
import subprocess
import threading
import time

COPIES = 8
IMPORT_S = 120  # a frozen primary holds an import up until it goes on


class Imports:
    """`macadam import` of one log at a time, each again and again, into a database on the cluster."""

    def __init__(self, trial, database):
        self.trial, self.address = trial, trial.cluster.address(database)
        self.database = database
        trial.cluster.new_database(database)
        trial.macadam("init", self.address, "--network", "fleet/network.osm.pbf")
        self.logs = self._logs()
        self.acknowledged, self.failures, self.answers = {}, 0, 0
        self.is_over = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def _logs(self):
        """The shortest trip of the fleet under several names, which make it as many trips."""
        folder = self.trial.folder / "logs"
        folder.mkdir(exist_ok=True)
        log = min((self.trial.folder / "fleet" / "trips").glob("*.gz"), key=lambda file: file.stat().st_size)
        text, files = gzip.decompress(log.read_bytes()), []
        for number in range(COPIES):
            files.append(folder / f"copy-{number}.trip.csv.gz")
            named = re.sub(rb"(?m)^# trip_id: .*$", f"# trip_id: copy-{number}".encode(), text, count=1)
            files[-1].write_bytes(gzip.compress(named, 1, mtime=0))
        return files

    def _run(self):
        number = 0
        while not self.is_over.is_set():
            log = self.logs[number % COPIES]
            number += 1
            try:
                done = self.trial.start("import", self.address, str(log), "--json", "--quiet", "--jobs", "1",
                                        timeout=IMPORT_S)
            except subprocess.TimeoutExpired:
                self.failures += 1
                continue
            results = [json.loads(line) for line in done.stdout.splitlines()]
            stored = {one["sha256"]: log for one in results if one.get("result") in ("imported", "known")}
            self.acknowledged.update(stored)
            self.answers += bool(stored)
            if not stored or done.returncode != 0:
                self.failures += 1
                time.sleep(0.5)

    def stop(self):
        self.is_over.set()
        self.thread.join(IMPORT_S + 10)

    def breaches(self):
        """What is wrong with the database, in words."""
        connection = self.trial.cluster.connect(self.database)
        with connection.cursor() as cursor:
            cursor.execute("SELECT sha256, trip_id FROM macadam.trip")
            found = dict(cursor.fetchall())
        connection.close()
        lost = set(self.acknowledged) - set(found)
        wrong = [f"{len(lost)} imported trips are lost"] if lost else []
        logs = [str(log) for log in self.logs if log.name.removesuffix(".trip.csv.gz") in found.values()]
        self.trial.macadam("import", self.address, *logs, "--quiet")  # fuses what an end cut short
        replay = self.trial.folder / "imports-replay.gpkg"
        for old in self.trial.folder.glob("imports-replay.gpkg*"):
            old.unlink()
        self.trial.macadam("init", str(replay), "--network", "fleet/network.osm.pbf")
        self.trial.macadam("import", str(replay), *logs, "--quiet")
        if self.trial.digest(self.database) != self.trial.macadam("info", str(replay), "--digest").strip():
            wrong.append("the digest is not that of the same imports into a file")
        return wrong
