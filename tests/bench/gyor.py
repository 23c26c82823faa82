#!/usr/bin/python3
"""What a method says of the Győr recordings: median IRI by the author's road classes, and how well
two passes over the same road agree.

usage: gyor.py MACADAM FOLDER [TRACE_OPTION...]

MACADAM  the program
FOLDER   the recordings of github.com/meszdav/road-surface-quality (MIT licence), one folder each:
         rsq_q1/00, rsq_q2/00, rsq_q2/01, rsq_q3/00, rsq_q3/01, rsq_q3/02; the digit behind q is
         the class: 1 good, 2 medium, 3 bad
TRACE_OPTION  of `macadam trace`: --method kf, --channels vertical, --vehicle suv, ...

rsq_q3/00 lies on rsq_q3/02 for 1.1 km, driven in the same direction. Cells of 20 m of the one are
held beside the 20 m of the other around the nearest place (at most 15 m away, headings within 45
degrees). Correlations are of the logarithms too; intervals are 95 %, by Fisher's z as if cells were
independent.
"""

import csv
import io
import math
import statistics
import subprocess
import sys
from pathlib import Path

CELL_M = 20
FINE_M = 5
NEAR_M = 15
SHIFTS_M = range(-30, 31, FINE_M)  # GNSS once a second and its latency leave so much open


def trace(program, trip, length_m, options):
    words = [program, "trace", trip, "--length", length_m, "--quiet", *options]
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    return list(csv.DictReader(io.StringIO(done.stdout)))


def known(rows):
    """Rows whose IRI counts. 'indicative' alone does: without a vehicle file much is."""
    return [row for row in rows if row["iri"] and set(row["validity"].split("|")) <= {"ok", "indicative"}]


def print_classes(program, folder, options):
    for length_m in (CELL_M, 100):
        before = None
        for quality in (1, 2, 3):
            trips = sorted(folder.glob(f"rsq_q{quality}/*/"))
            if not trips:
                sys.exit(f"{folder}: has no recording rsq_q{quality}/*, expected some")
            iri = [float(row["iri"]) for trip in trips for row in known(trace(program, trip, length_m, options))]
            median = statistics.median(iri)
            ratio = "" if before is None else f", {median / before:.2f} times the class before"
            print(f"class {quality}, {length_m:3d} m: median IRI {median:.2f} mm/m of {len(iri)} cells{ratio}")
            before = median


def east_north_m(row):
    radius_m = 6371008.8
    lat, lon = math.radians(float(row["lat_deg"])), math.radians(float(row["lon_deg"]))
    return radius_m * lon * math.cos(math.radians(47.69)), radius_m * lat


class Way:
    """A pass in fine cells: place, heading and IRI by travel."""

    def __init__(self, rows):
        self.rows = [row for row in rows if row["lat_deg"]]
        self.at = [east_north_m(row) for row in self.rows]
        self.iri = {round(float(row["from_m"])): float(row["iri"]) for row in known(rows)}

    def heading(self, i):
        a, b = self.at[max(0, i - 3)], self.at[min(len(self.at) - 1, i + 3)]
        return math.atan2(b[1] - a[1], b[0] - a[0])

    def nearest(self, place, heading):
        """Index of the nearest cell that was driven in this direction, or None."""
        found, least = None, NEAR_M
        for i, at in enumerate(self.at):
            away = math.dist(at, place)
            turned = abs((self.heading(i) - heading + math.pi) % (2 * math.pi) - math.pi)
            if away < least and turned < math.pi / 4:
                found, least = i, away
        return found

    def mean(self, from_m):
        """IRI of a cell from there on; None where a part of it is not known."""
        parts = [self.iri.get(from_m + step) for step in range(0, CELL_M, FINE_M)]
        return None if None in parts else sum(parts) / len(parts)


def pairs(one, other, shift_m):
    """(IRI of one, IRI of the other) of every cell that both drove."""
    found = []
    for from_m in range(0, round(float(one.rows[-1]["to_m"])) - CELL_M, CELL_M):
        middle = next((i for i, row in enumerate(one.rows) if float(row["from_m"]) >= from_m + CELL_M / 2), None)
        if middle is None or (there := other.nearest(one.at[middle], one.heading(middle))) is None:
            continue
        there_m = round(float(other.rows[there]["from_m"])) - CELL_M // 2 + shift_m
        both = one.mean(from_m), other.mean(there_m)
        if None not in both:
            found.append(both)
    return found


def print_correlation(name, values):
    r = statistics.correlation([a for a, _ in values], [b for _, b in values])
    half = 1.96 / math.sqrt(len(values) - 3)
    low, high = math.tanh(math.atanh(r) - half), math.tanh(math.atanh(r) + half)
    print(f"{name}: r {r:.2f} ({low:.2f} to {high:.2f}) of {len(values)} cells of {CELL_M} m")
    return r


def print_passes(program, folder, options):
    one, other = (Way(trace(program, folder / name, FINE_M, options)) for name in ("rsq_q3/00", "rsq_q3/02"))
    logs = {shift: [(math.log(a), math.log(b)) for a, b in pairs(one, other, shift)] for shift in SHIFTS_M}
    print_correlation("two passes, IRI, places as received", pairs(one, other, 0))
    print_correlation("two passes, log IRI, places as received", logs[0])
    best = max(SHIFTS_M, key=lambda s: statistics.correlation(*map(list, zip(*logs[s]))))
    print_correlation(f"two passes, IRI, one moved by {best} m", pairs(one, other, best))
    print_correlation(f"two passes, log IRI, one moved by {best} m (the best of {len(SHIFTS_M)})", logs[best])


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, folder, options = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    print_classes(program, folder, options)
    print_passes(program, folder, options)


main()
