"""Installs the module by pip from the source tree, offline, and matches a trip with what is there: the
plug-ins are found beside it."""

import os
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[3]
TRIP = SOURCE / "sample_data/comma2k19/comma2k19_rav4.trip.csv"

with tempfile.TemporaryDirectory() as folder:
    site = os.path.join(folder, "site")
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index",
                    "--root-user-action", "ignore", "--target", site, SOURCE], check=True)
    roads = os.path.join(folder, "roads.gpkg")
    subprocess.run([os.environ["MACADAM_PROGRAM"], "init", roads, "--trace", TRIP], check=True)
    use = "import macadam, sys; print(macadam.__file__); assert macadam.match(*sys.argv[1:]).rows > 0"
    said = subprocess.run([sys.executable, "-c", use, TRIP, roads], env={**os.environ, "PYTHONPATH": site},
                          check=True, capture_output=True, text=True).stdout
    assert said.startswith(site), said
