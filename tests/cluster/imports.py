"""Imports by the program itself, one after the other, while servers fail."""

import json
import subprocess
import threading
import time

from logs import Logs

COPIES = 8
IMPORT_S = 120  # a frozen primary holds an import up until it goes on


class Imports:
    """`macadam import` of one log at a time, each again and again, into a database on the cluster."""

    def __init__(self, trial, database, fleet):
        self.trial, self.address = trial, trial.new_database(database, fleet)
        self.logs = Logs(trial, database, fleet)
        self.acknowledged, self.failures, self.answers = set(), 0, 0
        self.is_over = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        number = 0
        while not self.is_over.is_set():
            trip_id, log = self.logs.copy(number % COPIES)
            number += 1
            try:
                done = self.trial.start("import", self.address, str(log), "--json", "--quiet", "--jobs", "1",
                                        timeout=IMPORT_S)
            except subprocess.TimeoutExpired:
                self.failures += 1
                continue
            results = [json.loads(line).get("result") for line in done.stdout.splitlines()]
            is_stored = "imported" in results or "known" in results
            if is_stored:
                self.acknowledged.add(trip_id)
                self.answers += 1
            if not is_stored or done.returncode != 0:
                self.failures += 1
                time.sleep(0.5)

    def stop(self):
        self.is_over.set()
        self.thread.join(IMPORT_S + 10)

    def breaches(self):
        """What is wrong with the database, in words."""
        return self.logs.breaches(self.acknowledged)
