"""Three servers on one machine: each runs etcd, Patroni and PostgreSQL 15 or newer as an ordinary user.

In a test each server has a network namespace behind a bridge and a small disk (tmpfs) of its own, so
that cables can be cut and disks be filled; elsewhere it has an address of the loopback device.
"""

import json
import os
import pathlib
import secrets
import shlex
import shutil
import signal
import subprocess
import threading
import time
import urllib.request

import psycopg2
import yaml

from processes import pid_in, run, send, tree

NAMES = ("n1", "n2", "n3")
DATABASE_PORT, REST_PORT, ETCD_PORT, PEER_PORT = 15432, 18008, 12379, 12380
STANZA = "macadam"
SCRIPTS = pathlib.Path(__file__).parents[2] / "packaging" / "cluster"
PGBACKREST_PUSH, PGBACKREST_GET = SCRIPTS / "pgbackrest_push.sh", SCRIPTS / "pgbackrest_get.sh"
TTL_S = 20  # the shortest that Patroni's manual allows
DISK_MIB = 1000
WAL_KEPT_MIB = 64
ROLES = ("postgres", "replicator", "rewinder", "patroni", "macadam")


def programs():
    """Folder of the newest PostgreSQL that Debian installed."""
    found = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/postgres"), key=lambda file: int(file.parts[4]))
    if not found:
        raise SystemExit("cluster: no PostgreSQL below /usr/lib/postgresql; ./run cluster installs it")
    return found[-1].parent


class Node:
    """One server. etcd and Patroni are started again 2 s after they ended, as systemd does."""

    def __init__(self, cluster, number):
        self.cluster = cluster
        self.name = NAMES[number]
        host = cluster.first_host + number
        self.address = f"10.77.0.{host}" if cluster.isolated else f"127.0.77.{host}"
        self.folder = cluster.folder / self.name
        self.data = self.folder / "disk" / "data"
        self.backups = self.folder / "pgbackrest.conf"
        self.link = f"port{host}"
        self.holder = None  # process that keeps the network namespace
        self.running = {}  # program: its process
        self.ended_at = {}
        self.off = set()  # programs that are not started again

    def prepare(self):
        if len(str(self.folder)) > 80:
            raise RuntimeError(f"{self.folder}: its name is too long for a Unix socket in it, expected 80 bytes at most")
        (self.folder / "disk").mkdir(parents=True, exist_ok=True)
        (self.folder / "etcd").mkdir(mode=0o700, exist_ok=True)
        if self.cluster.isolated:
            for disk, mib in (("disk", DISK_MIB), ("etcd", 200)):
                run("mount", "-t", "tmpfs", "-o", f"size={mib}m,mode=0700", "tmpfs", str(self.folder / disk))
            self.holder = subprocess.Popen(["unshare", "-n", "sleep", "infinity"])
            while os.readlink(f"/proc/{self.holder.pid}/ns/net") == os.readlink("/proc/self/ns/net"):
                time.sleep(0.01)
            inside = ["nsenter", "-t", str(self.holder.pid), "-n", "ip"]
            run("ip", "link", "add", self.link, "type", "veth", "peer", "name", "eth0", "netns", str(self.holder.pid))
            run("ip", "link", "set", self.link, "master", "bridge", "up")
            run(*inside, "link", "set", "lo", "up")
            run(*inside, "addr", "add", f"{self.address}/24", "dev", "eth0")
            run(*inside, "link", "set", "eth0", "up")
        self.backups.write_text(
            f"[global]\nrepo1-path={self.cluster.repository}\nrepo1-retention-full=2\nstart-fast=y\nprocess-max=1\n"
            f"log-level-file=off\nlog-level-console=warn\nlock-path={self.folder}/lock\nspool-path={self.folder}/spool\n"
            f"compress-type=zst\n[{STANZA}]\npg1-path={self.data}\npg1-port={DATABASE_PORT}\n"
            f"pg1-socket-path={self.folder}\npg1-user=postgres\n")
        (self.folder / "patroni.yml").write_text(yaml.safe_dump(self.settings(), sort_keys=False))
        (self.folder / "patroni.yml").chmod(0o600)

    def settings(self):
        """Patroni's configuration: docs/cluster.md explains it."""
        passwords = self.cluster.passwords
        hosts = [node.address for node in self.cluster.nodes]
        network = "10.77.0.0/24" if self.cluster.isolated else "127.0.0.0/8"
        return {
            "scope": "macadam",
            "name": self.name,
            "restapi": {
                "listen": f"{self.address}:{REST_PORT}",
                "connect_address": f"{self.address}:{REST_PORT}",
                "authentication": {"username": "patroni", "password": passwords["patroni"]},
            },
            "ctl": {"authentication": {"username": "patroni", "password": passwords["patroni"]}},
            "etcd": {"hosts": [f"{host}:{ETCD_PORT}" for host in hosts]},
            "bootstrap": {
                "dcs": {
                    "ttl": TTL_S,
                    "loop_wait": 2,
                    "retry_timeout": 4,
                    "primary_start_timeout": 5,
                    "synchronous_mode": True,
                    "synchronous_mode_strict": True,
                    "failsafe_mode": True,
                    "postgresql": {
                        "use_pg_rewind": True,
                        "remove_data_directory_on_rewind_failure": True,
                        "use_slots": True,
                        "parameters": {
                            "max_connections": 60,
                            "wal_level": "replica",
                            "archive_mode": True,
                            "archive_timeout": "60s",
                            "wal_log_hints": True,
                            "max_wal_size": "128MB",
                            "wal_keep_size": f"{WAL_KEPT_MIB}MB",
                            "max_slot_wal_keep_size": "256MB",
                            "wal_retrieve_retry_interval": "1s",
                            "wal_sender_timeout": "5s",
                            "wal_receiver_timeout": "5s",
                        },
                    },
                },
                "initdb": ["data-checksums", {"encoding": "UTF8"}, {"locale": "C.UTF-8"}],
            },
            "postgresql": {
                "listen": f"{self.address}:{DATABASE_PORT}",
                "connect_address": f"{self.address}:{DATABASE_PORT}",
                "bin_dir": str(programs()),
                "data_dir": str(self.data),
                "pgpass": str(self.folder / "pgpass"),
                "basebackup": [{"checkpoint": "fast"}],
                "authentication": {
                    "superuser": {"username": "postgres", "password": passwords["postgres"]},
                    "replication": {"username": "replicator", "password": passwords["replicator"]},
                    "rewind": {"username": "rewinder", "password": passwords["rewinder"]},
                },
                "recovery_conf": {"restore_command": f"sh {shlex.quote(str(PGBACKREST_GET))} %f %p"},
                "parameters": {
                    "archive_command": f"sh {shlex.quote(str(PGBACKREST_PUSH))} %p",
                    "unix_socket_directories": str(self.folder),
                    "password_encryption": "scram-sha-256",
                    "shared_buffers": "48MB",
                    "jit": False,
                    "tcp_user_timeout": "5s",
                    "tcp_keepalives_idle": 5,
                    "tcp_keepalives_interval": 2,
                    "tcp_keepalives_count": 3,
                },
                "pg_hba": [
                    "local all postgres scram-sha-256",
                    f"host all all {network} scram-sha-256",
                    f"host replication replicator {network} scram-sha-256",
                ],
            },
        }

    def commands(self):
        members = ",".join(f"{node.name}=http://{node.address}:{PEER_PORT}" for node in self.cluster.nodes)
        here, peer = f"http://{self.address}:{ETCD_PORT}", f"http://{self.address}:{PEER_PORT}"
        return {
            "etcd": ["etcd", "--enable-v2", "--name", self.name, "--data-dir", str(self.folder / "etcd" / "data"),
                     "--listen-client-urls", here, "--advertise-client-urls", here,
                     "--listen-peer-urls", peer, "--initial-advertise-peer-urls", peer,
                     "--initial-cluster", members, "--initial-cluster-token", "macadam",
                     "--heartbeat-interval", "200", "--election-timeout", "2000", "--logger", "zap"],
            "patroni": ["patroni", str(self.folder / "patroni.yml")],
        }

    def as_user(self, command):
        """PostgreSQL refuses to run as root, even as the root of a namespace."""
        if not self.cluster.isolated and os.geteuid() != 0:
            return command
        command = ["unshare", "-U", "--map-user=1000", "--map-group=1000", "--", *command]
        return ["nsenter", "-t", str(self.holder.pid), "-n", "--", *command] if self.holder else command

    def environment(self, **more):
        return {"PATH": f"{programs()}:/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", "HOME": str(self.folder),
                "PGBACKREST_CONFIG": str(self.backups), **more}

    def run(self, *command):
        """Runs a command on this server."""
        return run(*self.as_user(command), env=self.environment(PGPASSFILE=str(self.cluster.folder / "pgpass")), cwd="/",
                   timeout=300)

    def pgbackrest(self, *words):
        return self.run("pgbackrest", f"--stanza={STANZA}", *words)

    def start(self, program):
        with (self.folder / f"{program}.log").open("ab") as log:
            self.running[program] = subprocess.Popen(
                self.as_user(self.commands()[program]), stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                cwd=self.folder, env=self.environment())

    def supervise(self):
        for program in set(self.commands()) - self.off:
            process = self.running.get(program)
            if process is not None and process.poll() is None:
                continue
            ended_at = self.ended_at.setdefault(program, time.monotonic())
            if process is None or time.monotonic() - ended_at > 2:
                self.ended_at.pop(program)
                self.start(program)

    def postmaster(self):
        return pid_in(self.data / "postmaster.pid")

    def pids(self, *which):
        """Processes of etcd, patroni or postgres, all of them without a name."""
        roots = [self.running[name].pid for name in ("etcd", "patroni") if name in self.running and (not which or name in which)]
        if not which or "postgres" in which:
            roots.append(self.postmaster())
        return tree(roots)

    def cable(self, is_in):
        run("ip", "link", "set", self.link, "up" if is_in else "down")

    def hide_from(self, others, hidden):
        """Loses all packets between this server and others, without a word to either; clients still reach both."""
        for one, other in [(self, other) for other in others] + [(other, self) for other in others]:
            words = ["nsenter", "-t", str(one.holder.pid), "-n", "ip", "neigh"]
            if hidden:
                run(*words, "replace", other.address, "lladdr", "02:00:00:00:00:99", "nud", "permanent", "dev", "eth0")
            else:
                run(*words, "del", other.address, "dev", "eth0")


def lay_bridge():
    """Connects the network namespaces of servers, and this one."""
    if run("ip", "link", "show", "bridge", check=False):
        return
    run("ip", "link", "set", "lo", "up")
    run("ip", "link", "add", "bridge", "type", "bridge", "forward_delay", "0")
    run("ip", "addr", "add", "10.77.0.254/24", "dev", "bridge")
    run("ip", "link", "set", "bridge", "up")


class Cluster:
    """The three servers, and a thread that starts again what ended.

    A second cluster beside the first one has other hosts, and the same passwords.
    """

    def __init__(self, folder, isolated, first_host=1, passwords=None):
        self.folder = pathlib.Path(folder)
        self.first_host = first_host
        self.repository = self.folder / "backup"  # of WAL and backups, no part of a server
        self.isolated = isolated
        self.synchronous = True
        self.passwords = passwords or {role: secrets.token_hex(16) for role in ROLES}
        self.nodes = [Node(self, number) for number in range(len(NAMES))]
        self.is_stopping = threading.Event()
        self.supervisor = threading.Thread(target=self._supervise, daemon=True)

    def hosts(self):
        return ",".join(node.address for node in self.nodes)

    def address(self, database, role="macadam"):
        """libpq finds the primary among the three by itself."""
        hosts = ",".join(f"{node.address}:{DATABASE_PORT}" for node in self.nodes)
        return f"postgresql://{role}@{hosts}/{database}?target_session_attrs=read-write&connect_timeout=3"

    def connect(self, database, role="macadam", node=None, **options):
        """Connects to the primary, or to one server."""
        return psycopg2.connect(
            host=node.address if node else self.hosts(), port=DATABASE_PORT, dbname=database, user=role,
            password=self.passwords[role], connect_timeout=3, tcp_user_timeout=5000,
            target_session_attrs="any" if node else "read-write", **options)

    def start(self, deadline_s=120):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True, mode=0o700)
        self.repository.mkdir(mode=0o700)
        if self.isolated:
            lay_bridge()
        for node in self.nodes:
            node.prepare()
        self.write_passwords(self.folder / "pgpass", ROLES)
        self.supervisor.start()
        self.wait_until_whole(deadline_s)
        self.awaited_primary().pgbackrest("stanza-create")

    def write_passwords(self, file, roles):
        file.write_text("".join(f"*:*:*:{role}:{self.passwords[role]}\n" for role in roles))
        file.chmod(0o600)

    def _supervise(self):
        while not self.is_stopping.wait(0.5):
            for node in self.nodes:
                node.supervise()

    def stop(self):
        self.is_stopping.set()
        if self.supervisor.is_alive():
            self.supervisor.join()
        for program in ("patroni", "etcd"):
            processes = [node.running[program] for node in self.nodes if program in node.running]
            for process in processes:
                process.terminate()
            for process in processes:
                try:
                    process.wait(20)
                except subprocess.TimeoutExpired:
                    pass
        for node in self.nodes:
            send(node.pids(), signal.SIGKILL)
            node.holder and node.holder.kill()

    def primary(self):
        """The server that takes writes; None at the moment."""
        for node in self.nodes:
            try:
                connection = self.connect("postgres", "postgres", node)
            except psycopg2.Error:
                continue
            try:
                with connection.cursor() as cursor:
                    cursor.execute("SET statement_timeout = '3s'; SELECT pg_is_in_recovery()")
                    if not cursor.fetchone()[0]:
                        return node
            except psycopg2.Error:
                continue
            finally:
                connection.close()
        return None

    def awaited_primary(self):
        for _ in range(120):
            node = self.primary()
            if node:
                return node
            time.sleep(0.5)
        raise RuntimeError(f"no primary for a minute:\n{self.list()}")

    def members(self):
        """Members by name, as Patroni sees them: {role, state, timeline, lag, ...}; empty if it does not answer."""
        for node in self.nodes:
            try:
                with urllib.request.urlopen(f"http://{node.address}:{REST_PORT}/cluster", timeout=2) as answer:
                    return {member["name"]: member for member in json.load(answer)["members"]}
            except (OSError, ValueError, KeyError):
                continue
        return {}

    def standbys(self):
        """Names of the standbys that follow the primary, and of those of them that commits wait for."""
        connection = self.connect("postgres", "postgres")
        with connection.cursor() as cursor:
            cursor.execute("SELECT application_name FROM pg_stat_replication WHERE state = 'streaming'")
            following = {name for name, in cursor.fetchall()}
        connection.close()
        roles = {name: member["role"] for name, member in self.members().items() if name in following}
        return list(roles), [name for name, role in roles.items() if role == "sync_standby"]

    def is_whole(self):
        """Whether both standbys stream and one of them is waited for: another may take over then."""
        try:
            following, waited_for = self.standbys()
        except psycopg2.Error:
            return False
        return len(following) == 2 and bool(waited_for or not self.synchronous)

    def wait_until_whole(self, deadline_s):
        """Returns the seconds."""
        began = time.monotonic()
        while True:
            if self.is_whole():
                return time.monotonic() - began
            if time.monotonic() - began > deadline_s:
                raise RuntimeError(f"the cluster is not whole after {deadline_s} s:\n{self.list()}\n"
                                   f"its logs are below {self.folder}")
            time.sleep(0.5)

    def become_asynchronous(self):
        self.control("edit-config", "--force", "-s", "synchronous_mode=false", "-s", "synchronous_mode_strict=false",
                     check=True)
        self.synchronous = False
        while self.standbys()[1]:
            time.sleep(0.5)

    def control(self, *words, check=False):
        """Runs patronictl."""
        node = self.nodes[0]
        return run("patronictl", "-c", str(node.folder / "patroni.yml"), *words, check=check, timeout=60,
                   env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "HOME": str(self.folder)})

    def list(self):
        return self.control("list")

    def new_database(self, name):
        """Creates a database with PostGIS that role macadam owns."""
        connection = self.connect("postgres", "postgres")
        connection.autocommit = True
        with connection.cursor() as cursor:
            cursor.execute("SELECT 1 FROM pg_roles WHERE rolname = 'macadam'")
            if not cursor.fetchone():
                cursor.execute("CREATE ROLE macadam LOGIN PASSWORD %s", (self.passwords["macadam"],))
            cursor.execute(f"CREATE DATABASE {name} OWNER macadam")
        connection.close()
        while True:
            try:
                connection = self.connect(name, "postgres")
                break
            except psycopg2.OperationalError as error:  # of a standby that does not have it yet
                if "does not exist" not in str(error):
                    raise
                time.sleep(0.5)
        with connection, connection.cursor() as cursor:
            cursor.execute("CREATE EXTENSION postgis")
        connection.close()
