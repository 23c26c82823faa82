#!/usr/bin/env bash
# debian13.sh SOURCE FOLDER
# Builds the program in a bare Debian 13 under FOLDER, runs the tests of the release build, and draws
# a recorded trip there by OSMesa, by EGL, and after OSMesa was removed. Pictures of both differ by at
# most 2 levels. Needs root, a Debian mirror and 8 GB; the system and what was built are kept in
# FOLDER for the next time.
set -euo pipefail

source=$1
folder=$2
jobs=${MACADAM_JOBS:-$(nproc)}
mirror=${MACADAM_DEBIAN_MIRROR:-http://deb.debian.org/debian}
[ "$(id -u)" -eq 0 ] || { echo "debian13.sh: run as root: debootstrap and chroot need it" >&2; exit 1; }

# A mount namespace of our own: what is mounted below goes when the script ends.
if [ "${MACADAM_IN_NAMESPACE:-}" != yes ]; then
    MACADAM_IN_NAMESPACE=yes exec unshare --mount --pid --fork "$0" "$@"
fi

root=$folder/trixie
if [ ! -f "$root/complete" ]; then
    rm -rf "$root"
    mkdir -p "$folder"
    debootstrap --variant=minbase trixie "$root" "$mirror"
    touch "$root/complete"
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
mkdir -p "$root/source" "$root/build" "$root/changes"
mount -t proc proc "$root/proc"
# What is written into the sources (by pip) is dropped with the mount.
mount -t tmpfs changes "$root/changes"
mkdir "$root/changes/upper" "$root/changes/work"
mount -t overlay sources -o "lowerdir=$source,upperdir=$root/changes/upper,workdir=$root/changes/work" "$root/source"
mkdir -p "$root/source/build"
mount --bind "$root/build" "$root/source/build"
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }

inside apt-get -q update
# shellcheck disable=SC2016
inside bash -c '/source/run packages test | xargs apt-get -q -y install --no-install-recommends'
# Both are drawn with, whichever of them an earlier run has left.
inside apt-get -q -y install --no-install-recommends libosmesa6 libegl1 libgl1-mesa-dri
inside cmake -S /source --preset release -D MACADAM_UNITY=ON
inside nice cmake --build /source/build/release -j "$jobs" -- -k0
inside ctest --test-dir /source/build/release -j "$jobs" --no-tests=error --output-on-failure

macadam() { inside /source/build/macadam "$@"; }
trip=/source/sample_data/comma2k19/comma2k19_rav4.trip.csv
rm -rf "$root/tmp/map"
mkdir "$root/tmp/map"
macadam --version
macadam init /tmp/map/roads.gpkg --trace "$trip"
macadam import /tmp/map/roads.gpkg "$trip"
draw() {
    for output in "$1.png" "$1.pdf" "$1.tif"; do
        inside env "MACADAM_OPENGL=$2" /source/build/macadam render /tmp/map/roads.gpkg -o "/tmp/map/$output"
        [ -s "$root/tmp/map/$output" ] || { echo "debian13.sh: $output is missing or empty" >&2; exit 1; }
    done
}
draw osmesa osmesa
draw egl egl
/usr/bin/python3 - "$root"/tmp/map/{osmesa,egl}.png <<'PYTHON'
import sys

import numpy
from osgeo import gdal

gdal.UseExceptions()
one, other = (gdal.Open(file).ReadAsArray().astype(int) for file in sys.argv[1:])
levels = numpy.abs(one - other).max()
print(f"OSMesa and EGL differ by at most {levels} levels")
sys.exit("debian13.sh: expected at most 2" if levels > 2 else 0)
PYTHON
inside dpkg --purge libosmesa6
draw without ""
cmp "$root/tmp/map/egl.png" "$root/tmp/map/without.png"
macadam report /tmp/map/roads.gpkg -o /tmp/map/report.html
echo "built and drawn in Debian 13"
