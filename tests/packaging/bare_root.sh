#!/usr/bin/env bash
# bare_root.sh BUILD FOLDER
# Makes the .deb of BUILD, installs it into a bare Debian 12 under FOLDER, which has no tools of a
# build, maps a recorded trip there as an ordinary user, does the same with the package of the Python
# module, removes both, and looks for what they left. Needs root and a Debian mirror; a tar of the bare system is kept in FOLDER.
set -euo pipefail

build=$1
folder=$2
mirror=${MACADAM_DEBIAN_MIRROR:-http://deb.debian.org/debian}
[ "$(id -u)" -eq 0 ] || { echo "bare_root.sh: run as root: debootstrap and chroot need it" >&2; exit 1; }

# A mount namespace of our own: what is mounted below goes when the script ends.
if [ "${MACADAM_IN_NAMESPACE:-}" != yes ]; then
    MACADAM_IN_NAMESPACE=yes exec unshare --mount --pid --fork "$0" "$@"
fi

mkdir -p "$folder"
rm -rf "$folder/packages"
(cd "$folder" && cpack --config "$build/CPackConfig.cmake" -G DEB -B "$folder/packages" >/dev/null)
package=$(echo "$folder"/packages/macadam_*.deb)
python_package=$(echo "$folder"/packages/python3-macadam_*.deb)

if [ ! -f "$folder/base.tar" ]; then
    rm -rf "$folder/base"
    debootstrap --variant=minbase bookworm "$folder/base" "$mirror"
    tar -C "$folder/base" -cf "$folder/base.tar.part" .
    mv "$folder/base.tar.part" "$folder/base.tar"
    rm -rf "$folder/base"
fi
root=$(mktemp -d "$folder/root.XXXXXX")
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf "$root"' EXIT
tar -C "$root" -xf "$folder/base.tar"
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp "$package" "$root/root/macadam.deb"
cp "$python_package" "$root/root/python3-macadam.deb"
mount -t proc proc "$root/proc"

inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
as_user() { chroot --userspec=driver "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/home/driver "$@"; }
packages() { inside dpkg-query -W -f '${Package} ${db:Status-Status}\n' | sort; }

before=$(packages)
inside apt-get -q update
inside apt-get -q -y install --no-install-recommends /root/macadam.deb
inside useradd --create-home driver
for tool in g++ cc make cmake python3; do
    ! inside sh -c "command -v $tool" || { echo "bare_root.sh: the bare system has $tool" >&2; exit 1; }
done

trip=/usr/share/doc/macadam/examples/comma2k19/comma2k19_rav4.trip.csv
fleet=/usr/share/doc/macadam/examples/fleet
as_user macadam --version
as_user macadam init /home/driver/roads.gpkg --trace "$trip"
as_user macadam import /home/driver/roads.gpkg "$trip"
for output in map.png map.pdf map.tif; do
    as_user macadam render /home/driver/roads.gpkg -o "/home/driver/$output"
done
as_user macadam report /home/driver/roads.gpkg -o /home/driver/report.pdf
for output in roads.geojson roads.fgb roads.shp roads.pmtiles; do
    as_user macadam export /home/driver/roads.gpkg -o "/home/driver/$output"
done
as_user macadam simulate -o /home/driver/fleet --network "$fleet/network.osm.pbf" --recipe "$fleet/recipe.toml" --trips 1
as_user macadam convert "$trip" -o /home/driver/trip.rawlog
for output in map.png map.pdf map.tif report.pdf roads.geojson roads.fgb roads.shp roads.pmtiles trip.rawlog; do
    [ -s "$root/home/driver/$output" ] || { echo "bare_root.sh: $output is missing or empty" >&2; exit 1; }
done

inside apt-get -q -y install --no-install-recommends /root/python3-macadam.deb
as_user python3 - "$trip" <<'PYTHON'
import sys

import macadam
import numpy

profile = 0.005 * numpy.sin(numpy.arange(4000) * 2 * numpy.pi * 0.05 / 6)  # 200 m of waves of 6 m
roughness = macadam.iri(profile, step_m=0.05)["iri_profile"]
assert 3 < roughness[0] < 8, roughness  # its mean slope is 3.3 mm/m, and such waves count more
trace = macadam.trace(sys.argv[1])
assert len(trace["iri"]) > 10, trace
roads = macadam.open("/home/driver/roads.gpkg")
assert len(roads.segments(bbox=(-180, -90, 180, 90))["segment"]) > 10
PYTHON

inside apt-get -q -y purge --autoremove python3-macadam macadam
rm -rf "$root/root/macadam.deb" "$root/root/python3-macadam.deb" "$root/home/driver"
left=$(find "$root" -xdev -iname '*macadam*' -not -path "$root/var/log/*" -not -path "$root/proc/*")
[ -z "$left" ] || { echo "bare_root.sh: the package left: $left" >&2; exit 1; }
diff <(echo "$before") <(packages) || { echo "bare_root.sh: packages were left" >&2; exit 1; }
echo "installed, used and removed without a trace"
