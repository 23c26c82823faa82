"""Tries what docs/reference/serve.md says of nginx and systemd: its configuration with TLS before a real server, and its unit.

    behind_nginx.py SERVE.md PROGRAM
"""

import hashlib
import http.client
import json
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile
import time

PUBLIC = "roads.example.org"


def block(page, language):
    return re.search(rf"```{language}\n(.*?)```", page, re.S)[1]


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def expect(found, expected, what):
    if found != expected:
        sys.exit(f"{what}: {found!r}, expected {expected!r}")


def checked_unit(page, program, folder):
    """The unit is one, and lets the service do little."""
    if not shutil.which("systemd-analyze"):
        return
    unit = folder / "macadam.service"
    unit.write_text(block(page, "ini").replace("/usr/bin/macadam", program).replace("User=macadam", "User=daemon"))
    run = subprocess.run(["systemd-analyze", "verify", str(unit)], capture_output=True, text=True, timeout=30)
    expect([line for line in run.stderr.splitlines() if "macadam.service" in line], [], "systemd-analyze verify")
    run = subprocess.run(["systemd-analyze", "security", "--offline=true", "--no-pager", "--threshold=30", str(unit)],
                         capture_output=True, text=True, timeout=30)
    expect(run.returncode, 0, "systemd-analyze security " + run.stdout[-300:])


def nginx_configuration(page, folder, nginx_port, server_port):
    server = block(page, "nginx")
    for said, tried in [("listen 443", f"listen 127.0.0.1:{nginx_port}"),
                        (f"/etc/letsencrypt/live/{PUBLIC}/fullchain.pem", f"{folder}/cert.pem"),
                        (f"/etc/letsencrypt/live/{PUBLIC}/privkey.pem", f"{folder}/key.pem"),
                        ("http://127.0.0.1:8080", f"http://127.0.0.1:{server_port}")]:
        if said not in server:
            sys.exit(f"the configuration has no {said}")
        server = server.replace(said, tried)
    paths = "".join(f"{name}_temp_path {folder}/{name};" for name in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    return f"pid {folder}/pid; error_log {folder}/error.log; events {{}}\nhttp {{ access_log off; {paths}\n{server}\n}}\n"


def ask(trust, port, method, target, token="", body=None):
    raw = socket.create_connection(("127.0.0.1", port), timeout=20)
    connection = http.client.HTTPSConnection(PUBLIC, context=trust, timeout=20)
    connection.sock = trust.wrap_socket(raw, server_hostname=PUBLIC)
    headers = {"Content-Type": "text/csv"} | ({"Authorization": f"Bearer {token}"} if token else {})
    connection.request(method, target, body, headers)
    answer = connection.getresponse()
    text = answer.read()
    connection.close()
    return answer, text


def wait_for(trust, port):
    for _ in range(300):
        try:
            if ask(trust, port, "GET", "/health")[0].status == 200:
                return
        except OSError:
            pass
        time.sleep(0.1)
    sys.exit("no answer by way of nginx within 30 s")


def tried(trust, port, token):
    with socket.create_connection(("127.0.0.1", port), timeout=20) as raw:
        modern = ssl.create_default_context(cafile=trust.cafile)
        modern.set_alpn_protocols(["h2", "http/1.1"])
        with modern.wrap_socket(raw, server_hostname=PUBLIC) as secure:
            expect(secure.selected_alpn_protocol(), "h2", "protocol")
    with socket.create_connection(("127.0.0.1", port), timeout=20) as raw:
        old = ssl.create_default_context(cafile=trust.cafile)
        old.minimum_version, old.maximum_version = ssl.TLSVersion.TLSv1, ssl.TLSVersion.TLSv1_1
        old.set_ciphers("ALL:@SECLEVEL=0")
        try:
            old.wrap_socket(raw, server_hostname=PUBLIC)
            sys.exit("TLS 1.1 is accepted")
        except (ssl.SSLError, ConnectionError):
            pass
    answer, text = ask(trust, port, "GET", "/?f=json")
    expect(answer.status, 200, "landing page")
    expect(answer.getheader("Strict-Transport-Security"), "max-age=31536000", "HSTS")
    links = [link["href"] for link in json.loads(text)["links"]]
    expect([link for link in links if not link.startswith(f"https://{PUBLIC}/")], [], "links to elsewhere")
    expect(ask(trust, port, "GET", "/metrics")[0].status, 403, "/metrics")
    log = b"# macadam-trip 1\n"
    path = f"/v1/trips/{hashlib.sha256(log).hexdigest()}"
    expect(ask(trust, port, "PUT", path, "", log)[0].status, 401, "an upload without a token")
    answer, _ = ask(trust, port, "PUT", path, token, log)
    expect(answer.status, 202, "an upload")
    expect(answer.getheader("Location"), f"https://{PUBLIC}{path}", "its address")
    large = socket.create_connection(("127.0.0.1", port), timeout=20)
    with trust.wrap_socket(large, server_hostname=PUBLIC) as secure:
        secure.sendall(f"PUT {path} HTTP/1.1\r\nHost: {PUBLIC}\r\nContent-Length: 67108865\r\n\r\n".encode())
        expect(secure.recv(12), b"HTTP/1.1 413", "a log of more than 64 MiB")


def main(page_file, program):
    page = pathlib.Path(page_file).read_text()
    program = str(pathlib.Path(program).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # of nginx's workers
        checked_unit(page, program, folder)
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj",
                        f"/CN={PUBLIC}", "-addext", f"subjectAltName=DNS:{PUBLIC}", "-keyout", folder / "key.pem",
                        "-out", folder / "cert.pem"], check=True, capture_output=True, timeout=30)
        store = folder / "roads.gpkg"
        map_file = pathlib.Path(page_file).resolve().parents[2] / "sample_data/fleet/network.osm.pbf"
        macadam = lambda *words: subprocess.run([program, *words], check=True, capture_output=True, text=True, timeout=60).stdout
        macadam("init", store, "--network", map_file, "--privacy", "crowd", "--quiet")
        token = macadam("token", "create", store, "anna", "--quiet").strip()
        server_port, nginx_port = free_port(), free_port()
        configuration = folder / "nginx.conf"
        configuration.write_text(nginx_configuration(page, folder, nginx_port, server_port))
        trust = ssl.create_default_context(cafile=folder / "cert.pem")
        trust.cafile = folder / "cert.pem"
        running = []
        try:
            running.append(subprocess.Popen([program, "serve", store, "--listen", f"127.0.0.1:{server_port}", "--quiet",
                                             "--behind-proxy", f"https://{PUBLIC}"], stdout=subprocess.DEVNULL))
            running.append(subprocess.Popen(["nginx", "-p", folder, "-c", configuration, "-g", "daemon off;"]))
            wait_for(trust, nginx_port)
            tried(trust, nginx_port, token)
        finally:
            for process in running:
                process.terminate()
            for process in running:
                process.wait(timeout=20)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
