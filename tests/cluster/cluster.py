"""Three PostgreSQL servers under Patroni and etcd on this machine: to try, and to test.

    cluster.py up FOLDER                      starts them and tells their address
    cluster.py down FOLDER                    ends them
    cluster.py test FOLDER PROGRAM [--minutes N] [--seed N] [--no-stall-limit]
        has clients store trips while servers are killed, frozen, cut off, switched over and run out of
        disk; then holds what was acknowledged against the ledger, and the digest against that of a replay;
        then does without synchronous commits, and expects to lose trips. Status 0 if all is as it should be.

All processes live in a namespace of their own, where the kernel lets an ordinary user have one, and end
with it, even if it is killed.
"""

import argparse
import os
import pathlib
import secrets
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))

from backup import restored_to_a_moment  # noqa: E402
from imports import Imports  # noqa: E402
from ledger import Clients, Templates, breaches, store  # noqa: E402
from nemesis import Nemesis, haunt  # noqa: E402
from nodes import Cluster, is_alive, leave_init_behind, pid_in, run, send  # noqa: E402

INSIDE = "MACADAM_CLUSTER_INSIDE"
MAX_STALL_S = 30
began = time.monotonic()


def say(words):
    print(f"{time.monotonic() - began:7.1f} s  {words}", flush=True)


def as_ordinary_user():
    """PostgreSQL refuses to run as root, which therefore becomes nobody."""
    return ["setpriv", "--reuid=nobody", "--regid=nogroup", "--clear-groups", "--"] if os.getuid() == 0 else []


def namespaces(network):
    return ["unshare", "--user", "--map-root-user", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc",
            *(["--net"] if network else []), "--"]


def can_isolate(network):
    """Whether the kernel lets an ordinary user have namespaces, and a bridge in them."""
    trial = "ip link add name bridge type bridge && ip link add name port type veth peer name eth0" if network else "true"
    trial += " && mount -t tmpfs tmpfs /mnt && unshare -U --map-user=1000 --map-group=1000 true"
    return subprocess.run([*as_ordinary_user(), *namespaces(network), "sh", "-c", trial],
                          capture_output=True, check=False, cwd="/").returncode == 0


def enter(arguments, network):
    """Runs this program once more as an ordinary user in namespaces. Returns the command and whether it is isolated."""
    folder = pathlib.Path(arguments.folder)
    folder.mkdir(parents=True, exist_ok=True)
    script = os.path.abspath(sys.argv[0])
    if subprocess.run([*as_ordinary_user(), "test", "-r", script], check=False, cwd="/").returncode != 0:
        raise SystemExit(f"cluster: nobody, whom root becomes here, cannot read {script}, expected a folder that all can read")
    if os.getuid() == 0:
        shutil.chown(folder, "nobody", "nogroup")
    isolated = can_isolate(network)
    command = [*as_ordinary_user(), *(namespaces(network) if isolated else []), sys.executable,
               script, *sys.argv[1:]]
    return command, {**os.environ, INSIDE: "isolated" if isolated else "plain"}


def supervisor_of(folder):
    """Process that keeps the servers of a folder; None if it does not run."""
    pid = pid_in(folder / "supervisor.pid")
    if pid and is_alive(pid) and b"cluster.py" in pathlib.Path(f"/proc/{pid}/cmdline").read_bytes():
        return pid
    return None


def up(arguments):
    folder = pathlib.Path(arguments.folder)
    if supervisor_of(folder):
        raise SystemExit(f"cluster: {folder} is in use, expected 'cluster down' first")
    shutil.rmtree(folder / "state", ignore_errors=True)
    command, environment = enter(arguments, network=False)
    log = (folder / "supervisor.log").open("wb")
    process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                               start_new_session=True, cwd="/")
    (folder / "supervisor.pid").write_text(f"{process.pid}\n")
    for _ in range(1500):
        if (folder / "state" / "ready").exists():
            print((folder / "state" / "ready").read_text(), end="")
            return
        if process.poll() is not None:
            break
        time.sleep(0.1)
    if supervisor_of(folder):
        down(arguments)
    raise SystemExit(f"cluster: it did not start: {(folder / 'supervisor.log').read_text()[-3000:]}")


def keep_up(arguments):
    cluster = Cluster(pathlib.Path(arguments.folder) / "state", isolated=False)
    stop = []
    signal.signal(signal.SIGTERM, lambda *_: stop.append(True))
    try:
        cluster.start()
        cluster.new_database("roads")
        (cluster.folder / "ready").write_text(
            f"{cluster.list()}PGPASSFILE={cluster.folder}/pgpass\n{cluster.address('roads')}\n")
        while not stop:
            time.sleep(0.5)
    finally:
        cluster.stop()


def down(arguments):
    folder = pathlib.Path(arguments.folder)
    pid = supervisor_of(folder)
    if pid is None:
        raise SystemExit(f"cluster: none is up in {folder}")
    inner = run("pgrep", "-P", str(pid), check=False).split()
    for one in inner or [str(pid)]:  # the first process of the namespace, which unshare waits for
        send([int(one)], signal.SIGTERM)
    for _ in range(600):
        if not is_alive(pid):
            break
        time.sleep(0.1)
    else:
        send([pid], signal.SIGKILL)


class Trial:
    """The test: the same clients and checks, with synchronous commits and without."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.folder = pathlib.Path(arguments.folder)
        self.cluster = Cluster(self.folder / "state", isolated=os.environ[INSIDE] == "isolated")
        self.breaches = []

    def start(self, *words, timeout):
        environment = {**os.environ, "PGPASSFILE": str(self.cluster.folder / "pgpass"), "HOME": str(self.folder)}
        return subprocess.run([self.arguments.program, *words], env=environment, timeout=timeout, cwd=self.folder,
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

    def simulate_trips(self):
        """A small fleet, whose drives the clients send again and again."""
        roads, sample = self.folder / "roads.gpkg", pathlib.Path(__file__).parents[2] / "sample_data" / "fleet"
        for old in self.folder.glob("*.gpkg*"):
            old.unlink()
        recipe = (sample / "recipe.toml").read_text().replace("count = 30", "count = 3").replace("[6, 10]", "[2, 3]")
        (self.folder / "recipe.toml").write_text(recipe)
        shutil.rmtree(self.folder / "fleet", ignore_errors=True)
        self.macadam("simulate", "-o", "fleet", "--network", str(sample / "network.osm.pbf"), "--recipe", "recipe.toml")
        self.macadam("init", str(roads), "--network", "fleet/network.osm.pbf")
        self.macadam("import", str(roads), "fleet/trips")
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

    def replayed(self, roads, found, templates):
        """Digest of the same trips stored one after the other, undisturbed."""
        self.new_ledger("replay", roads)
        connection = self.cluster.connect("replay")
        connection.cursor().execute("SET synchronous_commit = off")
        for number in found:
            store(connection, templates, number)
        connection.close()
        return self.digest("replay")

    def disturbed(self, roads):
        templates = self.new_ledger("ledger", roads)
        clients = Clients(self.cluster, "ledger", templates, self.folder / "history.jsonl", self.arguments.seed)
        imports = Imports(self, "imports")
        nemesis = Nemesis(self.cluster, self.arguments.seed, say)
        clients.start()
        imports.thread.start()
        time.sleep(3)
        haunt(nemesis, time.monotonic() + 60 * self.arguments.minutes)
        say(f"whole again {self.cluster.wait_until_whole(120):.0f} s after the last fault")
        time.sleep(2)
        clients.stop()
        imports.stop()
        connection = self.cluster.connect("ledger")
        wrong, found = breaches(connection, clients)
        connection.close()
        stall = clients.longest_stall_s([begin for _, begin, _ in nemesis.done])
        kinds = {name for name, _, _ in nemesis.done}
        say(f"{len(nemesis.done)} faults of {len(kinds)} kinds; {len(clients.meant)} trips meant,"
            f" {len(clients.acknowledged)} acknowledged, {len(found)} in the ledger, {clients.failures} tries failed,"
            f" {clients.doubts} commits in doubt; longest stall {stall:.1f} s after a fault,"
            f" {clients.longest_stall_s():.1f} s over several")
        for words in wrong[:10]:
            say(f"  {words}")
        self.expect(len(clients.acknowledged) > 20 * self.arguments.minutes, "the clients got trips stored")
        self.expect(not wrong, "each acknowledged trip is in the ledger once, and whole")
        if not self.arguments.no_stall_limit:
            self.expect(stall <= MAX_STALL_S, f"writes went on within {MAX_STALL_S} s of the last fault, with nobody touching anything")
        self.expect(self.digest("ledger") == self.replayed(roads, found, templates),
                    "the digest is that of an undisturbed replay")
        wrong = imports.breaches()
        say(f"macadam import: {imports.answers} times acknowledged, {len(imports.acknowledged)} trips,"
            f" {imports.failures} failed; {'; '.join(wrong) or 'no breach'}")
        self.expect(imports.answers > 0 and not wrong, "what macadam imported is there once, with the digest of a file")
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
            roads = self.simulate_trips()
            self.cluster.start()
            say(f"up\n{self.cluster.list()}")
            templates = self.disturbed(roads)
            restored_to_a_moment(self, templates)
            self.without_synchronous_commits(roads)
        finally:
            self.cluster.stop()
        return 1 if self.breaches else 0


def main():
    parser = argparse.ArgumentParser(prog="cluster", usage=__doc__)
    parser.add_argument("command", choices=("up", "down", "test"))
    parser.add_argument("folder")
    parser.add_argument("program", nargs="?")
    parser.add_argument("--minutes", type=float, default=20)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--no-stall-limit", action="store_true")
    arguments = parser.parse_args()
    sys.argv[2] = arguments.folder = os.path.abspath(arguments.folder)
    if arguments.program:
        sys.argv[3] = arguments.program = os.path.abspath(arguments.program)
    if INSIDE in os.environ:
        leave_init_behind()
    if arguments.command == "down":
        down(arguments)
    elif arguments.command == "up":
        keep_up(arguments) if INSIDE in os.environ else up(arguments)
    elif INSIDE in os.environ:
        sys.exit(Trial(arguments).run())
    else:
        if arguments.seed is None:
            arguments.seed = secrets.randbelow(1 << 31)
            sys.argv += ["--seed", str(arguments.seed)]
        command, environment = enter(arguments, network=True)
        os.execvpe(command[0], command, environment)


if __name__ == "__main__":
    main()
