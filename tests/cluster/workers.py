"""Trips that are submitted to a queue, and workers that import them, while workers and servers fail."""

import json
import random
import subprocess
import threading
import time

from logs import Logs

SUBMIT_S = 120  # a frozen primary holds a submission up until it goes on
LEASE_S = 20
DRAIN_S = 300


class Workers:
    """A thread that submits logs one after the other, and some that keep a worker each, and kill it now and then."""

    def __init__(self, trial, database, fleet, pause_s, count=2):
        self.trial, self.address = trial, trial.new_database(database, fleet)
        self.database, self.pause_s = database, pause_s
        self.logs = Logs(trial, database, fleet)
        self.objects = str(trial.folder / f"{database}-objects")
        self.queued = set()  # trip_id of each log whose submission was acknowledged
        self.failures, self.kills, self.ended = 0, 0, 0
        self.is_over, self.is_drained = threading.Event(), threading.Event()
        rng = random.Random(f"{trial.arguments.seed} {database}")
        self.submitting = threading.Thread(target=self._submit, args=(random.Random(rng.random()),), daemon=True)
        self.working = [threading.Thread(target=self._work, args=(random.Random(rng.random()),), daemon=True)
                        for _ in range(count)]

    def start(self):
        for thread in [self.submitting, *self.working]:
            thread.start()

    def _submit(self, rng):
        number = 0
        while not self.is_over.is_set():
            is_known = number and rng.random() < 0.15
            trip_id, log = self.logs.copy(rng.randrange(number) if is_known else number)
            number += not is_known
            for _ in range(rng.choice([1, 6])):  # some are never tried again
                if self._is_submitted(log):
                    self.queued.add(trip_id)
                    break
                self.failures += 1
                if self.is_over.wait(0.5):
                    break
            self.is_over.wait(rng.uniform(0, 2 * self.pause_s))

    def _is_submitted(self, log):
        try:
            done = self.trial.start("submit", self.address, str(log), "--objects", self.objects, "--json", "--quiet",
                                    timeout=SUBMIT_S)
        except subprocess.TimeoutExpired:
            return False
        return any(json.loads(line)["result"] in ("new", "again", "known") for line in done.stdout.splitlines())

    def _work(self, rng):
        with (self.trial.folder / f"{self.database}-workers.log").open("ab") as log:
            while not self.is_drained.is_set():
                worker = self.trial.popen("worker", self.address, "--jobs", "1", "--lease", str(LEASE_S), stdout=log, stderr=log)
                kill_at = time.monotonic() + rng.uniform(5, 30)
                while worker.poll() is None and not self.is_drained.wait(0.2):
                    if time.monotonic() > kill_at and not self.is_over.is_set():
                        worker.kill()
                        self.kills += 1
                        break
                worker.terminate()
                self.ended += worker.wait(SUBMIT_S) > 0
                self.is_drained.wait(1)

    def stop(self):
        """Submits and kills no more, and lets the workers finish."""
        self.is_over.set()
        self.submitting.join(SUBMIT_S + 10)
        self._wait_until_empty()
        self.is_drained.set()
        for thread in self.working:
            thread.join(SUBMIT_S + 10)

    def status(self):
        return json.loads(self.trial.macadam("status", self.address, "--format", "json"))

    def _wait_until_empty(self):
        ends = time.monotonic() + DRAIN_S
        while (status := self.status())["logs"]["queued"] + status["logs"]["working"] > 0:
            if time.monotonic() > ends:
                raise RuntimeError(f"the queue is not empty after {DRAIN_S} s: {status}")
            time.sleep(1)

    def breaches(self):
        """What is wrong with queue and database, in words."""
        status = self.status()
        wrong = [f"{count} logs are {state}" for state, count in status["logs"].items()
                 if count and state not in ("imported", "known")]
        wrong += [one["reason"] for one in status["failed"]]
        if not self.queued:
            wrong.append("no submission was acknowledged")
        return wrong + self.logs.breaches(self.queued)

    def figures(self):
        return (f"{len(self.queued)} logs queued, {len(self.logs.stored())} trips, {self.failures} submissions failed,"
                f" {self.kills} workers killed, {self.ended} ended with an error")
