"""Clients that store trips and note what they meant, sent and were told; and what the ledger must then hold."""

import hashlib
import json
import random
import socket
import threading
import time

import os
import psycopg2

ANSWER_S = 10  # who is told no answer for so long hangs up: a frozen server keeps its connections


class TooLate(Exception):
    pass


class Connection:
    """Connection to the primary that hangs up if an answer takes too long."""

    def __init__(self, cluster, database):
        self.connection = cluster.connect(database)
        self.end = None
        self.is_over = threading.Event()
        self.watch = threading.Thread(target=self._watch, daemon=True)
        self.watch.start()

    def _watch(self):
        while not self.is_over.wait(0.25):
            if self.end is not None and time.monotonic() > self.end:
                duplicate = socket.socket(fileno=os.dup(self.connection.fileno()))
                duplicate.shutdown(socket.SHUT_RDWR)
                duplicate.close()
                return

    def close(self):
        self.is_over.set()
        self.watch.join()
        self.connection.close()


class Templates:
    """Drives that Macadam itself made of simulated trips: rows of a database on a server."""

    def __init__(self, connection):
        with connection.cursor() as cursor:
            cursor.execute("SELECT id, trip_id, t0_utc_ms, vehicle_model, method, distance_mm, matched_mm,"
                           " rows_read, rows_used FROM macadam.trip ORDER BY sha256")
            self.trips = cursor.fetchall()
            self.drives = {}
            cursor.execute("SELECT trip, cell, chunk, drive, passes, body, first_m, place_sd_mm, iri, iri_left"
                           " FROM macadam.drive ORDER BY trip, cell, chunk, drive")
            for trip, *drive in cursor.fetchall():
                self.drives.setdefault(trip, []).append(drive)
            cursor.execute("TRUNCATE macadam.trip, macadam.drive, macadam.audit, macadam.segment_state, macadam.chunk_state,"
                           " macadam.chunk_dirty CASCADE")
        connection.commit()

    def __len__(self):
        return len(self.trips)

    def of(self, number):
        """A trip of its own hash: a template's drives over a few neighbouring chunks."""
        row, *trip = self.trips[number % len(self.trips)]
        drives = self.drives[row]
        first = (number * 7) % len(drives)
        return trip, drives[first:first + 6]


def hash_of(number):
    return hashlib.sha256(f"trip {number}".encode()).hexdigest()


def store(connection, templates, number):
    """Stores a trip in one transaction. Returns 'new', 'known' or 'doubt'.

    A known trip is written, too: the commit then waits until a standby has it. A commit that the server
    gave up waiting for succeeds with a warning, and is in doubt.
    """
    trip, drives = templates.of(number)
    with connection.cursor() as cursor:
        cursor.execute(
            "INSERT INTO macadam.trip AS trip (sha256, trip_id, vehicle, file_name, t0_utc_ms, vehicle_model, method,"
            " distance_mm, matched_mm, rows_read, rows_used)"
            " VALUES (%s, %s, (SELECT min(id) FROM macadam.vehicle), %s, %s, %s, %s, %s, %s, %s, %s)"
            " ON CONFLICT (sha256) DO UPDATE SET sha256 = excluded.sha256 RETURNING trip.id, xmax = 0",
            (hash_of(number), f"trip-{number}", f"trip-{number}", *trip[1:]))
        row, is_new = cursor.fetchone()
        if is_new:
            for drive in drives:
                cursor.execute(
                    "INSERT INTO macadam.drive (trip, cell, chunk, drive, passes, body, first_m, place_sd_mm, iri,"
                    " iri_left) VALUES (%s, %s, %s, %s, %s, %s, %s, %s, %s, %s)", (row, *drive))
            for chunk in sorted({drive[1] for drive in drives}):
                cursor.execute("INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms) VALUES (%s, %s, %s)",
                               (chunk, row, int(1000 * time.time())))
    del connection.notices[:]
    connection.commit()
    if any("WARNING" in notice for notice in connection.notices):
        return "doubt"
    return "new" if is_new else "known"


class Clients:
    """Threads that store new trips and, now and then, known ones, and write their history to a file."""

    def __init__(self, cluster, database, templates, file, seed, count=4, pause_s=0.05):
        self.cluster, self.database, self.templates = cluster, database, templates
        self.history = file.open("w", buffering=1)
        self.lock = threading.Lock()
        self.next = 0
        self.meant, self.acknowledged, self.doubts, self.answers = set(), set(), 0, []
        self.failures = 0
        self.is_over = threading.Event()
        self.pause_s = pause_s
        self.threads = [threading.Thread(target=self._client, args=(random.Random(f"{seed} {number}"),), daemon=True)
                        for number in range(count)]

    def start(self):
        self.began = time.monotonic()
        for thread in self.threads:
            thread.start()

    def note(self, **what):
        with self.lock:
            self.history.write(json.dumps({"s": round(time.monotonic() - self.began, 3), **what}) + "\n")

    def _draw(self, rng):
        with self.lock:
            if self.next and rng.random() < 0.15:
                return rng.randrange(self.next)
            self.next += 1
            self.meant.add(self.next - 1)
            return self.next - 1

    def _client(self, rng):
        connection = None
        while not self.is_over.is_set():
            number = self._draw(rng)
            self.note(meant=number)
            for _ in range(rng.choice([1, 6])):  # some are never tried again
                try:
                    connection = connection or Connection(self.cluster, self.database)
                    connection.end = time.monotonic() + ANSWER_S
                    answer = store(connection.connection, self.templates, number)
                    connection.end = None
                except psycopg2.Error as error:
                    answer = f"failed: {str(error).strip().splitlines()[0] if str(error).strip() else 'hung up'}"
                    if connection:
                        connection.close()
                        connection = None
                    time.sleep(rng.uniform(0.1, 0.4))
                self.note(answered=number, answer=answer)
                with self.lock:
                    if answer in ("new", "known"):
                        self.acknowledged.add(number)
                        self.answers.append(time.monotonic())
                        break
                    self.doubts += answer == "doubt"
                    self.failures += answer != "doubt"
                if self.is_over.is_set():
                    break
            time.sleep(rng.uniform(0, 2 * self.pause_s))
        if connection:
            connection.close()

    def stop(self):
        self.ended = time.monotonic()
        self.is_over.set()
        for thread in self.threads:
            thread.join(60)
            if thread.is_alive():
                raise RuntimeError("a client does not end")
        self.history.close()

    def longest_stall_s(self, faults=()):
        """Longest time in which no client was told anything good, and no fault began."""
        times = sorted([self.began, *self.answers, *faults, self.ended])
        return max(after - before for before, after in zip(times, times[1:]))


def breaches(connection, clients):
    """What is wrong with the ledger, in words; and the numbers of the trips that it holds."""
    number_of = {hash_of(number): number for number in clients.meant}
    wrong, found = [], []
    with connection.cursor() as cursor:
        cursor.execute("SELECT sha256, id FROM macadam.trip")
        rows = cursor.fetchall()
        cursor.execute("SELECT trip, cell, chunk, drive, passes, body, first_m, place_sd_mm, iri, iri_left"
                       " FROM macadam.drive ORDER BY trip, cell, chunk, drive")
        drives = {}
        for trip, *drive in cursor.fetchall():
            drives.setdefault(trip, []).append([bytes(value) if isinstance(value, memoryview) else value for value in drive])
    for sha256, row in rows:
        number = number_of.get(sha256)
        if number is None:
            wrong.append(f"trip {sha256} was never meant")
            continue
        found.append(number)
        expected = sorted([bytes(value) if isinstance(value, memoryview) else value for value in drive]
                          for drive in clients.templates.of(number)[1])
        if drives.pop(row, []) != expected:
            wrong.append(f"trip {number} has other drives than were sent")
    if len(found) != len(set(found)):
        wrong.append("a trip is there twice")
    wrong += [f"drives of row {row} belong to no trip" for row in drives]
    lost = sorted(clients.acknowledged - set(found))
    if lost:
        wrong.append(f"{len(lost)} acknowledged trips are lost: {lost[:10]}")
    return wrong, sorted(found)
