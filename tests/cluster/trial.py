"""The test: clients, nemesis and checks, one phase after the other."""

import os
import pathlib
import shutil
import signal
import subprocess
import time

from backup import restored_to_a_moment
from cells import cells_on_other_clusters
from file_replay import replay
from fleets import town
from imports import Imports
from ledger import Clients, Templates, breaches
from nemesis import Nemesis, haunt
from nodes import Cluster
from processes import run, send
from workers import Workers

MAX_STALL_S = 30
began = time.monotonic()


def say(words):
    print(f"{time.monotonic() - began:7.1f} s  {words}", flush=True)


class Trial:
    """The test: the same clients and checks, with synchronous commits and without."""

    def __init__(self, arguments, isolated):
        self.arguments = arguments
        self.folder = pathlib.Path(arguments.folder) / "trial"
        self.cluster = Cluster(self.folder / "state", isolated)
        self.breaches = []
        self.started = []  # processes that may still run

    def environment(self):
        return {**os.environ, "PGPASSFILE": str(self.cluster.folder / "pgpass"), "HOME": str(self.folder),
                "TMPDIR": str(self.folder / "tmp")}

    def popen(self, *words, **options):
        process = subprocess.Popen([self.arguments.program, *words], env=self.environment(), cwd=self.folder,
                                   stdin=subprocess.DEVNULL, **options)
        self.started.append(process)
        return process

    def start(self, *words, timeout):
        return subprocess.run([self.arguments.program, *words], env=self.environment(), timeout=timeout, cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def macadam(self, *words):
        done = self.start(*words, timeout=600)
        if done.returncode != 0:
            raise RuntimeError(f"macadam {' '.join(words)}: exit {done.returncode}: {done.stderr[-2000:]}")
        return done.stdout

    def psql(self, address, *words, **options):
        environment = {"PATH": os.environ["PATH"], "PGPASSFILE": str(self.cluster.folder / "pgpass")}
        return run("psql", "-X", "-v", "ON_ERROR_STOP=1", address, *words, env=environment, timeout=300, **options)

    def say(self, words):
        say(words)

    def expect(self, holds, claim):
        say(f"{'holds' if holds else 'BREACH'}: {claim}")
        if not holds:
            self.breaches.append(claim)

    def new_file(self, name, fleet):
        """A database of the fleet's roads without trips."""
        file = self.folder / f"{name}.gpkg"
        self.macadam("init", str(file), "--network", fleet.network)
        return file

    def new_database(self, name, fleet):
        """The same on the cluster. Returns its address."""
        self.cluster.new_database(name)
        self.macadam("init", self.cluster.address(name), "--network", fleet.network)
        return self.cluster.address(name)

    def simulate_trips(self):
        """A small fleet, whose drives the clients send again and again."""
        self.fleet = town(self)
        roads = self.new_file("roads", self.fleet)
        self.macadam("import", str(roads), *map(str, self.fleet.logs))
        return roads

    def new_ledger(self, database, roads):
        self.cluster.new_database(database)
        self.macadam("copy", str(roads), self.cluster.address(database))
        connection = self.cluster.connect(database)
        templates = Templates(connection)
        connection.close()
        return templates

    def digest(self, database):
        return self.digest_at(self.cluster.address(database), database)

    def digest_at(self, address, name):
        """Digest of what a server holds, fetched into a GeoPackage."""
        file = self.folder / f"{name}.gpkg"
        file.unlink(missing_ok=True)
        self.macadam("copy", address, str(file))
        return self.macadam("info", str(file), "--digest").strip()

    def replayed(self, roads, templates, found):
        """Digest of the same trips stored one after the other in a file."""
        file = self.folder / "ledger-replay.gpkg"
        for ending in ("", ".key"):
            shutil.copy(f"{roads}{ending}", f"{file}{ending}")
        replay(file, templates, found)
        self.fuse(str(file))
        return self.macadam("info", str(file), "--digest").strip()

    def fuse(self, database):
        """Imports one more trip, the same for all, and fuses all that waits."""
        self.macadam("import", database, str(self.fleet.logs[0]), "--quiet")

    def disturbed(self, roads):
        templates = self.new_ledger("ledger", roads)
        clients = Clients(self.cluster, "ledger", templates, self.folder / "history.jsonl", self.arguments.seed)
        imports = Imports(self, "imports", self.fleet)
        workers = Workers(self, "queue", self.fleet, pause_s=6)
        nemesis = Nemesis(self.cluster, self.arguments.seed, say)
        clients.start()
        imports.thread.start()
        workers.start()
        time.sleep(3)
        haunt([nemesis], time.monotonic() + 60 * self.arguments.minutes)
        say(f"whole again {self.cluster.wait_until_whole(120):.0f} s after the last fault")
        time.sleep(2)
        clients.stop()
        imports.stop()
        workers.stop()
        connection = self.cluster.connect("ledger")
        wrong, found = breaches(connection, clients)
        connection.close()
        stall = clients.longest_stall_s(nemesis.last_touched())
        kinds = {name for name, _, _, _ in nemesis.done}
        say(f"{len(nemesis.done)} faults of {len(kinds)} kinds; {len(clients.meant)} trips meant,"
            f" {len(clients.acknowledged)} acknowledged, {len(found)} in the ledger, {clients.failures} tries failed,"
            f" {clients.doubts} commits in doubt; longest stall {stall:.1f} s, {clients.longest_stall_s():.1f} s over several"
            f" faults, {sum(not was_whole for _, _, _, was_whole in nemesis.done)} of which came before the one before was over")
        for words in wrong[:10]:
            say(f"  {words}")
        self.expect(len(clients.acknowledged) > 20 * self.arguments.minutes, "the clients got trips stored")
        self.expect(not wrong, "each acknowledged trip is in the ledger once, and whole")
        if not self.arguments.no_stall_limit:
            self.expect(stall <= MAX_STALL_S, f"writes went on within {MAX_STALL_S} s of the last fault, with nobody touching anything")
        self.fuse(self.cluster.address("ledger"))
        self.expect(self.digest("ledger") == self.replayed(roads, templates, found),
                    "the digest is that of a replay into a file")
        wrong = imports.breaches()
        say(f"macadam import: {imports.answers} times acknowledged, {len(imports.acknowledged)} trips,"
            f" {imports.failures} failed; {'; '.join(wrong) or 'no breach'}")
        self.expect(imports.answers > 0 and not wrong, "what macadam imported is there once, with the digest of a file")
        wrong = workers.breaches()
        say(f"macadam submit and worker: {workers.figures()}; {'; '.join(wrong) or 'no breach'}")
        self.expect(not wrong, "what was queued is imported once, with the digest of a file")
        return templates

    def without_synchronous_commits(self, roads):
        """The checks must find what asynchronous commits lose, or they are no good."""
        self.cluster.become_asynchronous()
        templates = self.new_ledger("asynchronous", roads)
        clients = Clients(self.cluster, "asynchronous", templates, self.folder / "asynchronous.jsonl", self.arguments.seed)
        clients.start()
        time.sleep(3)
        nemesis = Nemesis(self.cluster, self.arguments.seed, say)
        nemesis.run(nemesis.lose_unsent_commits)
        self.cluster.wait_until_whole(120)
        time.sleep(1)
        clients.stop()
        connection = self.cluster.connect("asynchronous")
        wrong, _ = breaches(connection, clients)
        connection.close()
        say(f"without synchronous commits: {'; '.join(wrong) or 'no breach'}")
        self.expect(bool(wrong), "the same checks fail without synchronous commits")

    def run(self):
        say(f"seed {self.arguments.seed}; "
            + ("servers in namespaces of their own: faults of networks and disks, too" if self.cluster.isolated else
               "this kernel lets ordinary users have no namespaces: no partitions and full disks"))
        try:
            shutil.rmtree(self.folder, ignore_errors=True)
            (self.folder / "tmp").mkdir(parents=True)
            roads = self.simulate_trips()
            self.cluster.start()
            say(f"up\n{self.cluster.list()}")
            templates = self.disturbed(roads)
            restored_to_a_moment(self, templates)
            cells_on_other_clusters(self)
            self.without_synchronous_commits(roads)
        finally:
            send([process.pid for process in self.started if process.poll() is None], signal.SIGKILL)
            self.cluster.stop()
        return 1 if self.breaches else 0
