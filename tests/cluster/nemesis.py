"""Faults, one at a time, drawn at random: each is caused, lasts, and is healed."""

import signal
import time

import psycopg2

from nodes import NAMES, WAL_KEPT_MIB
from processes import send

SHORT_S, LONG_S = 8, 26


class Nemesis:
    """Draws faults from a seed. What cannot be done without namespaces of networks is left out."""

    def __init__(self, cluster, seed, say):
        import random

        self.cluster, self.say = cluster, say
        self.random = random.Random(seed)
        self.hand = []
        self.done = []  # (fault, begin, end, whether the cluster was whole before)

    def faults(self):
        everywhere = [self.kill_postgres, self.kill_postgres_and_patroni, self.switch_primary_off, self.switch_standby_off,
                      self.leave_standby_behind, self.freeze_primary, self.freeze_standby, self.kill_etcd,
                      self.freeze_etcd_majority, self.cancel_waiting_commits, self.end_backends, self.switch_over,
                      self.lose_unsent_commits]
        isolated = [self.cut_primary_off, self.cut_primary_off_its_peers, self.cut_standby_off,
                    self.fill_disk_of_primary, self.fill_disk_of_standby]
        return everywhere + (isolated if self.cluster.isolated else [])

    def draw(self):
        """Each kind comes once before one comes again, so that few minutes see most."""
        if not self.hand:
            self.hand = self.faults()
            self.random.shuffle(self.hand)
        return self.hand.pop()

    def run(self, fault, *arguments):
        self.say(f"{fault.__name__.replace('_', ' ')}")
        self.begin()
        fault(*arguments)
        self.done.append((fault.__name__, self.began, time.monotonic(), self.was_whole))

    def begin(self):
        """Until now, the fault before went on."""
        self.was_whole = self.cluster.is_whole()
        self.began = time.monotonic()

    def last_touched(self):
        """Times since when nobody touched anything. A fault that comes before the last one is over may leave nobody who could
        take over: then these are its end, too."""
        return [begin for _, begin, _, _ in self.done] + [end for _, _, end, was_whole in self.done if not was_whole]

    def primary(self):
        node = self.cluster.awaited_primary()
        self.begin()
        return node

    def standby(self, synchronous):
        for _ in range(120):
            try:
                following, waited_for = self.cluster.standbys()
            except psycopg2.Error:
                following = []  # there is no primary that could tell
            if following:
                self.begin()
                names = waited_for if synchronous and waited_for else sorted(following)
                return self.cluster.nodes[NAMES.index(self.random.choice(names))]
            time.sleep(0.5)
        raise RuntimeError(f"no standby for a minute:\n{self.cluster.list()}")

    def lasting(self):
        """Below and above the time after which another primary is chosen."""
        return self.random.choice([SHORT_S, LONG_S])

    # Deaths: the supervisor starts Patroni and etcd again, Patroni PostgreSQL.

    def kill_postgres(self):
        send([self.primary().postmaster()], signal.SIGKILL)

    def kill_postgres_and_patroni(self):
        node = self.primary()
        send(node.pids("patroni", "postgres"), signal.SIGKILL)

    def switched_off(self, node):
        node.off = {"etcd", "patroni"}
        send(node.pids(), signal.SIGKILL)
        time.sleep(self.lasting())
        node.off = set()

    def switch_primary_off(self):
        self.switched_off(self.primary())

    def switch_standby_off(self):
        self.switched_off(self.standby(synchronous=True))

    def leave_standby_behind(self):
        """Switches a standby off until nobody keeps WAL for it any more, which then is in the archive alone."""
        node = self.standby(synchronous=False)
        node.off = {"etcd", "patroni"}
        send(node.pids(), signal.SIGKILL)
        time.sleep(LONG_S)
        try:
            connection = self.cluster.connect("postgres", "postgres")
            connection.autocommit = True
            with connection.cursor() as cursor:
                for _ in range(WAL_KEPT_MIB // 16 + 4):
                    cursor.execute("SELECT pg_logical_emit_message(false, '', repeat('x', 1 << 24)), pg_switch_wal()")
                cursor.execute("CHECKPOINT")
            connection.close()
        finally:
            node.off = set()

    def kill_etcd(self):
        send(self.random.choice(self.cluster.nodes).pids("etcd"), signal.SIGKILL)

    def lose_unsent_commits(self):
        """Has the primary go on alone, and puts the standbys in its place. Only synchronous commits survive it."""
        node = self.primary()
        others = [other for other in self.cluster.nodes if other is not node]
        for one in [node, *others]:
            one.off = {"patroni"}
        send(node.pids("patroni")[:1], signal.SIGKILL)
        send([pid for other in others for pid in other.pids("patroni", "postgres")], signal.SIGKILL)
        time.sleep(3)
        send(node.pids("postgres"), signal.SIGKILL)
        for other in others:
            other.off = set()
        time.sleep(LONG_S)
        node.off = set()

    # Freezes.

    def frozen(self, pids, seconds):
        send(pids, signal.SIGSTOP)
        time.sleep(seconds)
        send(pids, signal.SIGCONT)

    def freeze_primary(self):
        self.frozen(self.primary().pids(), self.lasting())

    def freeze_standby(self):
        self.frozen(self.standby(synchronous=True).pids(), SHORT_S)

    def freeze_etcd_majority(self):
        nodes = self.random.sample(self.cluster.nodes, 2)
        self.frozen([pid for node in nodes for pid in node.pids("etcd")], self.lasting())

    # Partitions.

    def cut_primary_off(self):
        node, seconds = self.primary(), self.lasting()
        node.cable(False)
        time.sleep(seconds)
        node.cable(True)

    def cut_standby_off(self):
        node = self.standby(synchronous=True)
        node.cable(False)
        time.sleep(SHORT_S)
        node.cable(True)

    def cut_primary_off_its_peers(self):
        """Clients still reach it: the hardest one, because it does not know that it is not the primary any more."""
        node = self.primary()
        others = [other for other in self.cluster.nodes if other is not node]
        node.hide_from(others, True)
        time.sleep(self.lasting())
        node.hide_from(others, False)

    # Backends.

    def cancel_waiting_commits(self):
        """Cancels commits that wait for a frozen standby, then kills the primary before it has them."""
        node, standby = self.primary(), self.standby(synchronous=True)
        pids = standby.pids("postgres")
        send(pids, signal.SIGSTOP)
        try:
            connection = self.cluster.connect("postgres", "postgres", node)
            connection.autocommit = True
            with connection.cursor() as cursor:
                for _ in range(20):
                    cursor.execute("SELECT count(pg_cancel_backend(pid)) FROM pg_stat_activity"
                                   " WHERE usename = 'macadam' AND wait_event = 'SyncRep'")
                    time.sleep(0.1)
            connection.close()
        except psycopg2.Error:
            pass
        if self.random.random() < 0.5:
            send(node.pids("patroni", "postgres"), signal.SIGKILL)
        send(pids, signal.SIGCONT)

    def end_backends(self):
        try:
            connection = self.cluster.connect("postgres", "postgres", self.primary())
            connection.autocommit = True
            with connection.cursor() as cursor:
                for _ in range(10):
                    cursor.execute("SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity"
                                   " WHERE usename = 'macadam'")
                    time.sleep(0.2)
            connection.close()
        except psycopg2.Error:
            pass

    def switch_over(self):
        node = self.primary()
        self.cluster.control("switchover", "--leader", node.name, "--force")

    # Disks.

    def full(self, node):
        """Takes all room on the disk of a server, for a while."""
        filler = node.folder / "disk" / "filler"
        ends = time.monotonic() + self.lasting()
        with filler.open("wb") as file:
            while time.monotonic() < ends:
                try:
                    while True:
                        file.write(bytes(1 << 20))
                        file.flush()
                except OSError:
                    time.sleep(0.2)
        filler.unlink()

    def fill_disk_of_primary(self):
        self.full(self.primary())

    def fill_disk_of_standby(self):
        self.full(self.standby(synchronous=True))


def haunt(nemeses, ends, pause_s=(4, 10)):
    """Causes faults until the time is over; each but some comes to a cluster that is whole again."""
    while time.monotonic() < ends:
        nemesis = nemeses[0].random.choice(nemeses)
        try:
            nemesis.run(nemesis.draw())
            time.sleep(nemesis.random.uniform(*pause_s))
            if nemesis.random.random() < 0.7:
                seconds = nemesis.cluster.wait_until_whole(90)
                nemesis.say(f"  whole again {seconds:.0f} s later")
        except psycopg2.Error as error:  # no primary at this moment: the next fault
            nemesis.say(f"  {str(error).strip().splitlines()[0]}")
            time.sleep(1)
