"""A backup of the cluster with pgBackRest, restored to a moment, from which forgotten trips are taken out again."""

import pathlib
import shutil
import signal
import subprocess
import time

import psycopg2

from ledger import hash_of, store
from nodes import PGBACKREST_PUSH, programs
from processes import send, tree

RESTORED_PORT = 15433
AGAIN = pathlib.Path(__file__).parents[2] / "packaging" / "cluster" / "forget_listed.sql"

# As `macadam forget` does in a file: the trip goes, a mark stays.
FORGET = """
INSERT INTO macadam.forgotten VALUES (encode(sha256(convert_to('macadam forgot ' || %(hash)s, 'UTF8')), 'hex'));
DELETE FROM macadam.drive WHERE trip = (SELECT id FROM macadam.trip WHERE sha256 = %(hash)s);
DELETE FROM macadam.trip WHERE sha256 = %(hash)s;
"""


class Backup:
    def __init__(self, cluster):
        self.cluster = cluster

    def finish_wal(self):
        """Waits until all that was committed is in the repository."""
        connection = self.cluster.connect("postgres", "postgres")
        connection.autocommit = True
        with connection.cursor() as cursor:
            cursor.execute("SELECT pg_walfile_name(pg_switch_wal())")
            name = cursor.fetchone()[0]
        connection.close()
        marks = self.cluster.awaited_primary().data / "pg_wal" / "archive_status"
        for _ in range(240):
            waiting = sorted(mark.stem for mark in marks.glob("*.ready"))
            if name not in waiting and not any(one[:8] < name[:8] for one in waiting):
                return
            time.sleep(0.25)
        raise RuntimeError(f"WAL was not archived in a minute: {waiting}")

    def restore(self, moment):
        """Starts a server, apart from the cluster, with the database of a moment."""
        node = self.cluster.nodes[0]
        data = self.cluster.folder / "restored"
        shutil.rmtree(data, ignore_errors=True)
        data.mkdir(mode=0o700)
        node.pgbackrest(f"--pg1-path={data}", "--type=time", f"--target={moment}", "--target-action=promote", "restore")
        # Patroni's settings, which the backup has, name the files of the server that it was taken of.
        settings = {"hba_file": data / "pg_hba.conf", "ident_file": data / "pg_ident.conf",
                    "port": RESTORED_PORT, "listen_addresses": node.address, "unix_socket_directories": "",
                    "archive_mode": "off", "synchronous_standby_names": "", "primary_conninfo": "", "primary_slot_name": ""}
        with (self.cluster.folder / "restored.log").open("wb") as log:
            self.process = subprocess.Popen(
                node.as_user([str(programs() / "postgres"), "-D", str(data),
                              *(word for name, value in settings.items() for word in ("-c", f"{name}={value}"))]),
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd="/", env=node.environment())
        for _ in range(240):
            try:
                connection = self.connect("postgres", "postgres")
                with connection.cursor() as cursor:
                    cursor.execute("SELECT pg_is_in_recovery()")
                    still = cursor.fetchone()[0]
                connection.close()
                if not still:
                    return
            except psycopg2.Error:
                pass
            time.sleep(0.5)
        raise RuntimeError(f"the restored server does not start: {self.cluster.folder}/restored.log")

    def connect(self, database, role="macadam"):
        return psycopg2.connect(host=self.cluster.nodes[0].address, port=RESTORED_PORT, dbname=database, user=role,
                                password=self.cluster.passwords[role])

    def address(self, database):
        return f"postgresql://macadam@{self.cluster.nodes[0].address}:{RESTORED_PORT}/{database}"

    def stop(self):
        send(tree([self.process.pid]), signal.SIGKILL)


def is_refused(node, *command):
    """Whether pgBackRest has the file of WAL with other content."""
    try:
        node.run(*command)
    except RuntimeError as error:
        if "[045]" not in str(error):
            raise
        return True
    return False


def archive_goes_on(trial, backup):
    """A rewound server holds a segment of an ended timeline that another one archived with another end."""
    trial.cluster.control("switchover", "--leader", trial.cluster.awaited_primary().name, "--force")
    trial.cluster.wait_until_whole(120)
    primary = trial.cluster.awaited_primary()
    wal = primary.data / "pg_wal"
    history = max(wal.glob("*.history"))
    ended, fork, *_ = [line.split() for line in history.read_text().splitlines() if line][-1]
    log, place = (int(digits, 16) for digits in fork.split("/"))
    segment = wal / f"{int(ended):08X}{log:08X}{place >> 24:08X}"
    connection = trial.cluster.connect("postgres", "postgres")
    with connection.cursor() as cursor:
        cursor.execute("SELECT pg_walfile_name(pg_current_wal_lsn())")
        content = (wal / cursor.fetchone()[0]).read_bytes()
    connection.close()
    apart = trial.cluster.folder / "apart"
    apart.mkdir(exist_ok=True)
    other = apart / segment.name
    other.write_bytes(content[:-1] + b"1")
    is_refused(primary, "pgbackrest", "--stanza=macadam", "archive-push", str(other))  # or another is there already
    other.write_bytes(content[:-1] + b"2")
    (apart / history.name).write_text(history.read_text().replace(fork, f"{log + 1:X}/0"))
    trial.expect(is_refused(primary, "sh", str(PGBACKREST_PUSH), str(other)),
                 "a segment that two servers wrote in one timeline is not archived")
    mark = wal / "archive_status" / f"{segment.name}.ready"
    mark.with_suffix(".done").unlink(missing_ok=True)
    shutil.copy(other, segment)
    mark.touch()
    backup.finish_wal()
    trial.expect(not mark.exists(), "the archive goes on past a segment beyond the end of its timeline, which another server archived")


def restored_to_a_moment(trial, templates):
    """The digest is that of the moment, and who was forgotten later is forgotten again."""
    backup = Backup(trial.cluster)
    archive_goes_on(trial, backup)
    trial.cluster.awaited_primary().pgbackrest("--type=full", "backup")
    trial.say("backup taken")
    first = 1_000_000  # trips that nobody else stores
    connection = trial.cluster.connect("ledger")
    for number in range(first, first + 20):
        store(connection, templates, number)
    digest = trial.digest("ledger")
    with connection.cursor() as cursor:
        cursor.execute("SELECT clock_timestamp()::text")
        moment = cursor.fetchone()[0]
    connection.commit()
    time.sleep(1)
    forgotten = hash_of(first + 7)
    with connection.cursor() as cursor:
        cursor.execute(FORGET, {"hash": forgotten})
    for number in range(first + 20, first + 30):
        store(connection, templates, number)
    connection.commit()
    address = trial.cluster.address("ledger")
    marks = trial.psql(address, "-Atc", "SELECT mark FROM macadam.forgotten")
    connection.close()
    backup.finish_wal()
    backup.restore(moment)
    try:
        trial.expect(trial.digest_at(backup.address("ledger"), "restored") == digest,
                     "a backup restored to a moment has the digest of that moment")
        trial.psql(backup.address("ledger"), "-f", str(AGAIN), input=marks)
        restored = backup.connect("ledger")
        with restored.cursor() as cursor:
            cursor.execute("SELECT count(*), count(*) FILTER (WHERE sha256 = %s) FROM macadam.trip"
                           " WHERE sha256 = ANY(%s)", (forgotten, [hash_of(number) for number in range(first, first + 30)]))
            trips, back = cursor.fetchone()
            cursor.execute("SELECT count(*) FROM macadam.drive WHERE trip NOT IN (SELECT id FROM macadam.trip)")
            orphans = cursor.fetchone()[0]
        restored.close()
        trial.expect((trips, back, orphans) == (19, 0, 0), "a trip forgotten after the backup does not come back with it")
    finally:
        backup.stop()
