"""Tries what docs/reference/serve.md says of nginx and systemd: its configuration with TLS before a real server, and its unit.

    behind_nginx.py SERVE.md PROGRAM

testssl.sh finds nothing to mend in its TLS; staff who logged in are operators, by a header that nobody else can send.
"""

import hashlib
import http.client
import http.server
import json
import os
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time

PUBLIC = "roads.example.org"


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", page, re.S)


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
    unit.write_text(blocks(page, "ini")[0].replace("/usr/bin/macadam", program).replace("User=macadam", "User=daemon"))
    run = subprocess.run(["systemd-analyze", "verify", str(unit)], capture_output=True, text=True, timeout=30)
    expect([line for line in run.stderr.splitlines() if "macadam.service" in line], [], "systemd-analyze verify")
    run = subprocess.run(["systemd-analyze", "security", "--offline=true", "--no-pager", "--threshold=30", str(unit)],
                         capture_output=True, text=True, timeout=30)
    expect(run.returncode, 0, "systemd-analyze security " + run.stdout[-300:])


def replaced(text, pairs):
    for said, tried in pairs:
        if said not in text:
            sys.exit(f"the configuration has no {said}")
        text = text.replace(said, tried)
    return text


def nginx_configuration(page, folder, ports):
    public, location = blocks(page, "nginx")
    public = replaced(public, [("listen 443", f"listen 127.0.0.1:{ports['public']}"),
                               (f"/etc/letsencrypt/live/{PUBLIC}/fullchain.pem", f"{folder}/cert.pem"),
                               (f"/etc/letsencrypt/live/{PUBLIC}/privkey.pem", f"{folder}/key.pem"),
                               ("http://127.0.0.1:8080", f"http://127.0.0.1:{ports['server']}")])
    location = replaced(location, [("/run/macadam/staff", f"{folder}/staff")])
    login = f"location = /oauth2/auth {{ internal; proxy_pass http://127.0.0.1:{ports['login']}; proxy_pass_request_body off; " \
            "proxy_set_header Content-Length \"\"; }"
    staff = f"server {{ listen 127.0.0.1:{ports['staff']} ssl; ssl_certificate {folder}/cert.pem; " \
            f"ssl_certificate_key {folder}/key.pem;\n{location}\n{login} }}"
    paths = "".join(f"{name}_temp_path {folder}/{name};" for name in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    user = "user root;" if os.geteuid() == 0 else ""  # of the group of the socket
    return f"{user} pid {folder}/pid; error_log {folder}/error.log; events {{}}\n" \
           f"http {{ access_log off; {paths}\n{public}\n{staff}\n}}\n"


class Login(http.server.BaseHTTPRequestHandler):
    """Knows one session, as a proxy for OpenID Connect does after a login."""

    def do_GET(self):
        self.send_response(202 if self.headers.get("Cookie") == "session=carla's" else 401)
        self.send_header("X-Auth-Request-User", "carla")
        self.end_headers()

    def log_message(self, *words):
        pass


def ask(trust, port, method, target, token="", body=None, more=()):
    raw = socket.create_connection(("127.0.0.1", port), timeout=20)
    connection = http.client.HTTPSConnection(PUBLIC, context=trust, timeout=20)
    connection.sock = trust.wrap_socket(raw, server_hostname=PUBLIC)
    headers = {"Content-Type": "text/csv"} | ({"Authorization": f"Bearer {token}"} if token else {}) | dict(more)
    connection.request(method, target, body, headers)
    answer = connection.getresponse()
    text = answer.read()
    connection.close()
    return answer, text


def wait_for(trust, port, more=()):
    for _ in range(300):
        try:
            if ask(trust, port, "GET", "/health", more=more)[0].status == 200:
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
    packed = {"Accept-Encoding": "gzip"}
    answer, _ = ask(trust, port, "GET", "/api", more=packed)
    expect(answer.getheader("Content-Encoding"), "gzip", "the encoding of what all may see")
    answer, _ = ask(trust, port, "GET", "/v1/trips", token, more=packed)
    expect(answer.getheader("Content-Encoding"), None, "the encoding of what one client may see")
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


def tried_staff(trust, ports, folder):
    expect((folder / "staff").stat().st_mode & 0o777, 0o660, "permissions of the socket")
    forged = {"X-Forwarded-User": "carla"}
    logged_in = {"Cookie": "session=carla's"}
    for target in ("/v1/trips", "/collections/trips/items"):
        expect(ask(trust, ports["staff"], "GET", target, more=logged_in)[0].status, 200, f"{target} for staff")
        expect(ask(trust, ports["staff"], "GET", target, more=forged)[0].status, 401, f"{target} for who is not logged in")
        expect(ask(trust, ports["public"], "GET", target, more=forged)[0].status, 401, f"{target} at the public server")
    both = ask(trust, ports["staff"], "GET", "/v1/trips", more={**logged_in, "X-Forwarded-User": "eve, mallory"})
    expect(both[0].status, 200, "the header of a client beside that of the proxy")


def tried_by_testssl(port, folder):
    """Nothing that counts is worse than LOW: this certificate need not be revoked."""
    report = folder / "testssl.json"
    subprocess.run(["testssl", "--quiet", "--color", "0", "--warnings", "batch", "--ip", "127.0.0.1", "--add-ca", folder / "cert.pem",
                    "--jsonfile", report, "--protocols", "--std", "--pfs", "--server-preference", "--server-defaults", "--headers",
                    "--vulnerable", f"{PUBLIC}:{port}"], check=False, stdout=subprocess.DEVNULL, timeout=900)
    found = {one["id"]: one for one in json.loads(report.read_text())}
    for protocol, words in [("SSLv2", "not offered"), ("SSLv3", "not offered"), ("TLS1", "not offered"), ("TLS1_1", "not offered"),
                            ("TLS1_2", "offered"), ("TLS1_3", "offered with final"), ("HSTS_time", "365 days (=31536000 seconds) > 15552000 seconds"),
                            ("cert_chain_of_trust", "passed."), ("heartbleed", "not vulnerable, no heartbeat extension"),
                            ("cipherlist_AVERAGE", "not offered"), ("cipherlist_STRONG", "offered")]:
        expect(found.get(protocol, {"finding": "nothing"})["finding"], words, f"testssl.sh: {protocol}")
    expect(found["LUCKY13"]["severity"], "OK", "testssl.sh: LUCKY13")
    worse = {one["id"]: one["finding"] for one in found.values() if one["severity"] in ("MEDIUM", "HIGH", "CRITICAL")}
    worse.pop("cert_revocation", None)
    worse.pop("BREACH", None)  # of pages for all; what one client may see is not compressed
    expect(worse, {}, "testssl.sh")


def main(page_file, program):
    page = pathlib.Path(page_file).read_text()
    program = str(pathlib.Path(program).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # of nginx's workers
        checked_unit(page, program, folder)
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "200", "-subj",
                        f"/CN={PUBLIC}", "-addext", f"subjectAltName=DNS:{PUBLIC}", "-keyout", folder / "key.pem",
                        "-out", folder / "cert.pem"], check=True, capture_output=True, timeout=30)
        store = folder / "roads.gpkg"
        map_file = pathlib.Path(page_file).resolve().parents[2] / "sample_data/fleet/network.osm.pbf"
        macadam = lambda *words: subprocess.run([program, *words], check=True, capture_output=True, text=True, timeout=60).stdout
        macadam("init", store, "--network", map_file, "--privacy", "crowd", "--quiet")
        token = macadam("token", "create", store, "anna", "--quiet").strip()
        ports = {name: free_port() for name in ("server", "public", "staff", "login")}
        configuration = folder / "nginx.conf"
        configuration.write_text(nginx_configuration(page, folder, ports))
        trust = ssl.create_default_context(cafile=folder / "cert.pem")
        trust.cafile = folder / "cert.pem"
        login = http.server.ThreadingHTTPServer(("127.0.0.1", ports["login"]), Login)
        threading.Thread(target=login.serve_forever, daemon=True).start()
        running = []
        try:
            serve = [program, "serve", store, "--quiet", "--behind-proxy", f"https://{PUBLIC}"]
            running.append(subprocess.Popen([*serve, "--listen", f"127.0.0.1:{ports['server']}"], stdout=subprocess.DEVNULL))
            running.append(subprocess.Popen([*serve, "--listen", f"unix:{folder}/staff", "--staff-header", "X-Forwarded-User", "--workers", "0"],
                                            stdout=subprocess.DEVNULL))
            running.append(subprocess.Popen(["nginx", "-p", folder, "-c", configuration, "-g", "daemon off;"]))
            wait_for(trust, ports["public"])
            tried(trust, ports["public"], token)
            wait_for(trust, ports["staff"], {"Cookie": "session=carla's"})
            tried_staff(trust, ports, folder)
            tried_by_testssl(ports["public"], folder)
        finally:
            for process in running:
                process.terminate()
            for process in running:
                process.wait(timeout=20)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
