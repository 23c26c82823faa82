"""Three PostgreSQL servers under Patroni and etcd on this machine: to try, and to test.

    cluster.py up FOLDER                      starts them and tells their address
    cluster.py down FOLDER                    ends them
    cluster.py test FOLDER PROGRAM [--minutes N] [--clusters N] [--seed N] [--no-stall-limit]
        has clients and workers store trips while servers are killed, frozen, cut off, switched over and run
        out of disk; then holds what was acknowledged against the ledger, and the digest against that of a
        replay into a file; for a fifth of the time, does the same with cells on other such clusters, N with the
        first one (4); then does without synchronous commits, and expects to lose trips. Status 0 if all is as it should be.

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

from nodes import Cluster  # noqa: E402
from processes import is_alive, leave_init_behind, pid_in, run, send  # noqa: E402
from trial import Trial  # noqa: E402

INSIDE = "MACADAM_CLUSTER_INSIDE"


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


def main():
    parser = argparse.ArgumentParser(prog="cluster", usage=__doc__)
    parser.add_argument("command", choices=("up", "down", "test"))
    parser.add_argument("folder")
    parser.add_argument("program", nargs="?")
    parser.add_argument("--minutes", type=float, default=20)
    parser.add_argument("--clusters", type=int, default=4, choices=range(2, 5))
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
        sys.exit(Trial(arguments, isolated=os.environ[INSIDE] == "isolated").run())
    else:
        if arguments.seed is None:
            arguments.seed = secrets.randbelow(1 << 31)
            sys.argv += ["--seed", str(arguments.seed)]
        command, environment = enter(arguments, network=True)
        os.execvpe(command[0], command, environment)


if __name__ == "__main__":
    main()
