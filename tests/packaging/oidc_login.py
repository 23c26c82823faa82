"""Tries what docs/reference/serve.md says of Apache: staff log in at an OpenID Connect provider, and are operators then.

    oidc_login.py SERVE.md PROGRAM NODE PROVIDER.mjs

A client follows the redirections of a browser with its cookies: without the login nobody gets to the server, and a header
that a client sends itself names nobody.
"""

import html
import http.cookiejar
import os
import pathlib
import re
import secrets
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request

from behind_nginx import blocks, expect, free_port, replaced

MODULES = "mpm_event authn_core authz_core authz_user auth_openidc headers proxy proxy_http ssl"
NAME = "staff.roads.example.org"


def apache_configuration(page, folder, ports, secret):
    site = replaced(blocks(page, "apache")[0], [
        ("<VirtualHost *:443>", f"<VirtualHost 127.0.0.1:{ports['staff']}>"),
        (f"https://{NAME}/oidc", f"http://127.0.0.1:{ports['staff']}/oidc"),
        ("SSLEngine on", ""),  # a test of nginx has TLS
        (f"SSLCertificateFile    /etc/letsencrypt/live/{NAME}/fullchain.pem", ""),
        (f"SSLCertificateKeyFile /etc/letsencrypt/live/{NAME}/privkey.pem", ""),
        ("https://login.example.org", f"http://127.0.0.1:{ports['login']}"),
        ("exec:/bin/cat /etc/macadam/oidc-secret", secret), ("exec:/bin/cat /etc/macadam/oidc-key", secrets.token_hex(16)),
        ("/run/macadam/staff", f"{folder}/staff")])
    modules = "".join(f"LoadModule {name}_module /usr/lib/apache2/modules/mod_{name}.so\n" for name in MODULES.split())
    user = "User www-data\nGroup root\n" if os.geteuid() == 0 else ""  # of the group of the socket
    return f"ServerRoot {folder}\nPidFile {folder}/pid\nErrorLog {folder}/error.log\nDefaultRuntimeDir {folder}\nMutex file:{folder}\n" \
           f"ServerName {NAME}\nListen 127.0.0.1:{ports['staff']}\n{modules}{user}{site}"


class Browser:
    def __init__(self):
        self.cookies = http.cookiejar.CookieJar()
        self.opener = urllib.request.build_opener(urllib.request.ProxyHandler({}), urllib.request.HTTPCookieProcessor(self.cookies))

    def get(self, address, form=None, headers=()):
        """Status, address and text of the page to which an address leads."""
        data = urllib.parse.urlencode(form).encode() if form is not None else None
        try:
            answer = self.opener.open(urllib.request.Request(address, data, {"Accept": "text/html,*/*", **dict(headers)}), timeout=20)
        except urllib.error.HTTPError as error:
            answer = error
        return answer.status, answer.geturl(), answer.read().decode()


def form_of(page):
    """Address and hidden fields of a page's form."""
    action = re.search(r'<form[^>]*action="([^"]+)"', page)
    if not action:
        sys.exit(f"no form in {page[:500]!r}")
    hidden = re.findall(r'<input type="hidden" name="([^"]+)" value="([^"]*)"', page)
    return html.unescape(action[1]), dict(hidden)


def logged_in(browser, address, name):
    """What the address shows once the forms of the provider are filled in."""
    status, place, page = browser.get(address)
    expect((status, "/interaction/" in place), (200, True), "the way of a stranger")
    action, fields = form_of(page)
    status, place, page = browser.get(action, {**fields, "login": name, "password": "any"})
    action, fields = form_of(page)  # of consent
    return browser.get(action, fields)


def tried(ports):
    staff, login = (f"http://127.0.0.1:{ports[name]}" for name in ("staff", "login"))
    trips = f"{staff}/v1/trips"
    forged = {"X-Forwarded-User": "mallory"}
    for headers in ({}, forged, {"Authorization": "Bearer x"}, {"Cookie": "mod_auth_openidc_session=x"}):
        _, place, _ = Browser().get(trips, headers=headers)
        expect(place.startswith(login), True, f"a stranger with {headers} is sent to {place}, to the login")
    expect(Browser().get(trips, headers={"Accept": "application/json"})[0], 401, "a program that cannot log in")
    carla = Browser()
    status, place, page = logged_in(carla, trips, "carla")
    expect((status, place, page.strip()), (200, trips, '{"trips":[]}'), "trips after the login")
    for target in ("/collections/trips/items", "/?f=json"):
        expect(carla.get(staff + target)[0], 200, target)
    expect(carla.get(trips, headers=forged)[0], 200, "a header of hers beside that of the proxy")
    status, _, _ = carla.get(f"{staff}/oidc?code=x&state=y")
    expect(status in (400, 401, 500), True, f"an answer that the provider did not give: {status}")
    thief = Browser()
    for cookie in carla.cookies:
        if "openidc_session" in cookie.name:
            cookie.value = secrets.token_hex(16)
            thief.cookies.set_cookie(cookie)
    expect(len(thief.cookies), 1, "cookies of a session")
    expect(thief.get(trips)[1].startswith(login), True, "a session that the proxy did not begin leads to the login")


def wait_for(ready, what):
    for _ in range(300):
        if ready():
            return
        time.sleep(0.1)
    sys.exit(f"{what} does not answer within 30 s")


def answers(address):
    try:
        urllib.request.build_opener(urllib.request.ProxyHandler({})).open(address, timeout=5).close()
    except urllib.error.HTTPError:
        return True
    except OSError:
        return False
    return True


def main(page_file, program, node, provider):
    page = pathlib.Path(page_file).read_text()
    map_file = pathlib.Path(page_file).resolve().parents[2] / "sample_data/fleet/network.osm.pbf"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # of Apache's workers
        store, secret = folder / "roads.gpkg", secrets.token_hex(32)
        subprocess.run([program, "init", store, "--network", map_file, "--quiet"], check=True, capture_output=True, timeout=60)
        ports = {each: free_port() for each in ("staff", "login")}
        (folder / "apache.conf").write_text(apache_configuration(page, folder, ports, secret))
        running = []
        try:
            running.append(subprocess.Popen([node, provider, str(ports["login"]), secret, f"http://127.0.0.1:{ports['staff']}/oidc"],
                                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env={**os.environ, "NODE_NO_WARNINGS": "1"}))
            expect(running[0].stdout.readline(), "ready\n", "the provider")
            running.append(subprocess.Popen([program, "serve", store, "--quiet", "--listen", f"unix:{folder}/staff", "--staff-header",
                                             "X-Forwarded-User", "--workers", "0", "--behind-proxy", f"https://{NAME}"], stdout=subprocess.DEVNULL))
            wait_for((folder / "staff").exists, "macadam serve")
            running.append(subprocess.Popen(["apache2", "-d", folder, "-f", folder / "apache.conf", "-D", "FOREGROUND"]))
            wait_for(lambda: answers(f"http://127.0.0.1:{ports['staff']}/oidc"), "Apache")
            try:
                tried(ports)
            except SystemExit:
                print((folder / "error.log").read_text()[-3000:], file=sys.stderr)
                raise
        finally:
            for process in running:
                process.terminate()
            for process in running:
                process.wait(timeout=20)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
