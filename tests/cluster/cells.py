"""Cells on other clusters: workers import into them through the first one, while servers of all fail."""

import concurrent.futures
import json
import time

from fleets import streets_across_cells
from nemesis import Nemesis, haunt
from nodes import Cluster
from workers import Workers


def cells_on_other_clusters(trial):
    others = [Cluster(trial.folder / f"other{number}", trial.cluster.isolated, 1 + 10 * number, trial.cluster.passwords)
              for number in range(1, trial.arguments.clusters)]
    for node in trial.cluster.nodes:  # PL/Proxy and postgres_fdw connect as the server's user
        trial.cluster.write_passwords(node.folder / ".pgpass", ["macadam"])
    try:
        with concurrent.futures.ThreadPoolExecutor() as pool:
            list(pool.map(lambda other: other.start(240), others))
        for other in others:
            other.new_database("cells")
            trial.say(f"another cluster is up\n{other.list()}")
        _disturbed(trial, others)
    finally:
        for other in others:
            other.stop()


def _disturbed(trial, others):
    workers = Workers(trial, "front", streets_across_cells(trial), pause_s=2)
    front = trial.cluster.address("front", "postgres")
    cells = [str(one["cell"]) for one in json.loads(trial.macadam("cells", workers.address, "--json"))]
    addresses = [other.address("cells") for other in others]
    nemeses = [Nemesis(other, f"{trial.arguments.seed} at {number}",
                       lambda words, number=number: trial.say(f"at cluster {number}: {words}"))
               for number, other in enumerate(others, 2)]
    here = Nemesis(trial.cluster, f"{trial.arguments.seed} here", trial.say)
    duration_s = 60 * trial.arguments.minutes / 5
    workers.start()
    time.sleep(5)
    for number, cell in enumerate(cells[:-1]):  # the last one stays
        trial.macadam("cells", front, "--move", cell, "--to", addresses[number % len(addresses)])
    time.sleep(5)
    nemeses[0].run(nemeses[0].kill_postgres_and_patroni)
    time.sleep(8)
    here.run(here.kill_postgres)
    haunt([*nemeses, nemeses[0], here], time.monotonic() + duration_s / 2)
    for cluster in (*others, trial.cluster):
        cluster.wait_until_whole(120)
    to = (addresses[1:] or [front])[0]
    trial.macadam("cells", front, "--move", cells[0], "--to", to)
    trial.say("a cell is moved on")
    haunt([*nemeses, nemeses[0], here], time.monotonic() + duration_s / 2)
    for cluster in (*others, trial.cluster):
        cluster.wait_until_whole(120)
    workers.stop()
    wrong = workers.breaches()
    trial.macadam("cells", front, "--move", cells[0], "--to", to)  # again: removes what somebody read just then
    kept = [len(_trips_at(other)) for other in others]
    trial.say(f"{len(cells)} cells on {1 + len(others)} clusters: {workers.figures()}; {kept} trips at the others;"
              f" {[len(one.done) for one in nemeses]} faults there, {len(here.done)} here; {'; '.join(wrong) or 'no breach'}")
    if len(kept) > 1:
        trial.expect(kept.pop(0) == 0, "a cluster keeps nothing of a cell that moved on")
    trial.expect(len(cells) == 4 and all(kept) and not wrong,
                 f"what workers imported into {1 + len(others)} clusters is there once, with the digest of a file")


def _trips_at(cluster):
    """Trips with drives in the cells that a cluster has."""
    connection = cluster.connect("cells")
    with connection.cursor() as cursor:
        cursor.execute("SELECT relname FROM pg_class WHERE relkind = 'r' AND relname ~ '^drive_[0-9]+_[0-9]+$'")
        tables = [name for name, in cursor.fetchall()]
        trips = set()
        for name in tables:
            cursor.execute(f"SELECT trip FROM macadam.{name}")
            trips |= {trip for trip, in cursor.fetchall()}
    connection.close()
    return trips
