"""A cell on another cluster: workers import into it through the first one, while servers of both fail."""

import json
import time

from nemesis import Nemesis, haunt
from nodes import Cluster
from workers import Workers

FIRST_HOST = 11


def cell_on_another_cluster(trial):
    other = Cluster(trial.folder / "other", trial.cluster.isolated, FIRST_HOST, trial.cluster.passwords)
    for node in trial.cluster.nodes:  # PL/Proxy and postgres_fdw connect as the server's user
        trial.cluster.write_passwords(node.folder / ".pgpass", ["macadam"])
    try:
        other.start()
        other.new_database("cells")
        trial.say(f"another cluster is up\n{other.list()}")
        _disturbed(trial, other)
    finally:
        other.stop()


def _disturbed(trial, other):
    workers = Workers(trial, "front", pause_s=2)
    front = trial.cluster.address("front", "postgres")
    cells = [str(one["cell"]) for one in json.loads(trial.macadam("cells", workers.address, "--json"))]
    there = Nemesis(other, f"{trial.arguments.seed} there", lambda words: trial.say(f"of the cell: {words}"))
    here = Nemesis(trial.cluster, f"{trial.arguments.seed} here", trial.say)
    workers.start()
    time.sleep(5)
    trial.macadam("cells", front, "--move", cells[0], "--to", other.address("cells"))
    time.sleep(5)
    ends = time.monotonic() + 60 * trial.arguments.minutes / 5
    there.run(there.kill_postgres_and_patroni)
    time.sleep(8)
    here.run(here.kill_postgres)
    haunt([there, there, here], ends)
    for cluster in (other, trial.cluster):
        cluster.wait_until_whole(120)
    workers.stop()
    wrong = workers.breaches()
    connection = other.connect("cells")
    with connection.cursor() as cursor:
        cursor.execute("SELECT relname FROM pg_class WHERE relkind = 'r' AND relname ~ '^drive_[0-9]+_[0-9]+$'")
        tables = [name for name, in cursor.fetchall()]
        cursor.execute(" UNION ALL ".join(f"SELECT trip FROM macadam.{name}" for name in tables))
        trips = {trip for trip, in cursor.fetchall()}
    connection.close()
    trial.say(f"cell {cells[0]} of {len(cells)} on another cluster: {workers.figures()}; {len(trips)} trips there;"
              f" {len(there.done)} faults there, {len(here.done)} here; {'; '.join(wrong) or 'no breach'}")
    trial.expect(len(trips) > 0 and not wrong, "what workers imported into two clusters is there once, with the digest of a file")
