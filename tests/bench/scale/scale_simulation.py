#!/usr/bin/python3
"""Plays a week of a town, a country and ten countries, from the unit costs that docs/scale.md states as measured.

usage: scale_simulation.py OUT_DIR     writes scale.md and scale.svg

Trips arrive at random (Poisson) by hour and day as road traffic does, with exponential lengths. Cores take them first come, first
served; estimated, they queue for one primary server. Chunks that trips drove wait to be fused, which takes at most a fifth of
the cores' time (job_worker.cpp), so that estimation has the rest. On Thursday at 16:00 all workers fail for two hours, on
Friday at 17:00, the busiest hour of the week, the primary server for 30 s, during which workers wait, too.

Left out: the network, times at which phones send, roads that are driven more than others, locks.
"""

import heapq
import math
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

DOCS = Path(__file__).resolve().parents[3] / "docs"
HOUR, DAY, WEEK = 3600.0, 86400.0, 7 * 86400.0

# Road transport by hour and, from Monday, by day: Denier van der Gon et al., Description of current temporal emission patterns
# and sensitivity of predicted AQ for temporal emission patterns, TNO, MACC deliverable D_D-EMIS_1.3, 2011, SNAP 7. Means are 1.
BY_HOUR = np.array([0.19, 0.09, 0.06, 0.05, 0.09, 0.22, 0.86, 1.84, 1.86, 1.41, 1.24, 1.20,
                    1.32, 1.44, 1.45, 1.59, 2.03, 2.08, 1.51, 1.06, 0.74, 0.62, 0.61, 0.44])
BY_DAY = np.array([1.02, 1.06, 1.08, 1.10, 1.14, 0.81, 0.79])
BY_HOUR_OF_WEEK = np.outer(BY_DAY, BY_HOUR).ravel()

PASSES_A_TRIP = 500.0
CHUNKS_A_TRIP = 90.0
SEGMENTS_A_CHUNK = 25.0
PASSES_AN_HOUR = 2500.0  # of 20 m, at 50 km/h
FUSION_SHARE = 0.2
WORKERS_FAIL = (3 * DAY + 16 * HOUR, 3 * DAY + 18 * HOUR)
PRIMARY_FAILS = (4 * DAY + 17 * HOUR, 4 * DAY + 17 * HOUR + 30)


def stated(pattern):
    """A number of docs/scale.md, so that the costs played are those that it tells."""
    found = re.search(pattern, (DOCS / "scale.md").read_text())
    if not found:
        sys.exit(f"docs/scale.md: found no '{pattern}', expected the cost that was measured")
    return float(found[1].replace(",", ""))


CPU_S_A_PASS = stated(r"(\d+) CPU s an hour of driving") / PASSES_AN_HOUR
LOG_BYTES_A_PASS = stated(r"gzip \| ([\d.]+) MB an hour") * 1e6 / PASSES_AN_HOUR
TRIPS_STORED_A_S = stated(r"(\d+)/s with priority, load 11")
FUSED_A_CPU_S = stated(r"([\d,]+) a CPU s of worker and server")
DRIVE_BYTES_A_PASS = stated(r"with trace and indexes \| (\d+) bytes")
WAL_BYTES_A_PASS = stated(r"its WAL \| at most (\d+) bytes")


@dataclass
class Place:
    name: str
    segments: float
    passes_a_day: float
    cores: int

    @property
    def trips_a_s(self):
        return self.passes_a_day / PASSES_A_TRIP / DAY


def times(scale, name="", cores=None):
    """So many countries, with 36 cores each unless given."""
    return Place(name, 10e6 * scale, 100e6 * scale, cores or 36 * scale)


def arrivals(place, rng):
    """Times at which trips arrive in a week."""
    counts = rng.poisson(place.trips_a_s * HOUR * BY_HOUR_OF_WEEK)
    return np.sort(np.repeat(np.arange(len(counts)) * HOUR, counts) + rng.uniform(0, HOUR, counts.sum()))


class Clock:
    """Time in which servers work: it stands still while they are down, and work goes on afterwards where it was."""

    def __init__(self, downs=()):
        downs = np.array(sorted(downs)).reshape(-1, 2)
        lengths = downs[:, 1] - downs[:, 0]
        self.still = np.concatenate([[0.0], np.cumsum(lengths)])
        self.worked = downs[:, 0] - self.still[:-1]  # at each begin
        self.times = np.concatenate([[0.0], downs.ravel(), [10 * WEEK]])
        self.work = np.concatenate([[0.0], np.repeat(self.worked, 2), [10 * WEEK - self.still[-1]]])

    def of(self, time):
        return np.interp(time, self.times, self.work)

    def time(self, worked):
        return worked + self.still[np.searchsorted(self.worked, worked, "left")]


def served_by_many(arrive, service, servers):
    """Ends of jobs that servers take first come, first served (Kiefer and Wolfowitz)."""
    free = [0.0] * servers
    end = np.empty(len(arrive))
    step = 500_000  # lists of Python are large
    for first in range(0, len(arrive), step):
        ends = []
        for at, takes in zip(arrive[first:first + step].tolist(), service[first:first + step].tolist()):
            done = max(at, free[0]) + takes
            heapq.heapreplace(free, done)
            ends.append(done)
        end[first:first + step] = ends
    return end


def served_by_one(arrive, service):
    """The same of one server (Lindley)."""
    done = np.cumsum(service)
    return done + np.maximum.accumulate(arrive - done + service)


def fused_in_turns(place, stored, kept):
    """Fuses chunks in the order in which they became due, minute by minute, in the share of the cores' time; uniform roads.

    kept: passes of a segment that each fusion reads. Returns seconds from a pass to a value with it, minute by minute of the
    middle of the week, and the share of the cores' time that was used."""
    minute = 60.0
    chunks = place.segments / SEGMENTS_A_CHUNK
    drives = np.histogram(stored, np.arange(0, WEEK + minute, minute))[0] * CHUNKS_A_TRIP
    room = FUSION_SHARE * place.cores * FUSED_A_CPU_S * minute / (kept * SEGMENTS_A_CHUNK)
    marked, fused, waiting = np.empty(len(drives)), np.empty(len(drives)), 0.0
    for i, driven in enumerate(drives):
        fused[i] = min(waiting, room)  # what was marked in minutes before: chunks are due after 45 s
        marked[i] = (chunks - waiting) * -math.expm1(-driven / chunks)  # the others are marked already
        waiting += marked[i] - fused[i]
    ends = np.arange(1, len(drives) + 1) * minute
    lag = np.interp(np.cumsum(marked), np.cumsum(fused), ends) - ends + minute
    return lag[len(lag) // 7:5 * len(lag) // 7], FUSION_SHARE * fused.mean() / room


@dataclass
class Week:
    arrive: np.ndarray
    stored: np.ndarray
    passes: np.ndarray

    @property
    def lag(self):
        return self.stored - self.arrive

    def waiting(self, at):
        """Trips that wait or are worked on."""
        return np.searchsorted(self.arrive, at, "right") - np.searchsorted(np.sort(self.stored), at, "right")

    def late(self, calm, since, until):
        """Seconds from `since` to the last arrival whose trip is later than in a calm week, but for what fails from `until` on."""
        other = self.arrive[(self.arrive > since) & (self.stored < until) & (self.lag > calm.lag + 1)]
        return other[-1] - since if len(other) else 0.0


def week_of(place, workers_down=(), primary_down=()):
    rng = np.random.default_rng(1)
    arrive = arrivals(place, rng)
    passes = rng.exponential(PASSES_A_TRIP, len(arrive))
    workers, primary = Clock([*workers_down, *primary_down]), Clock(primary_down)
    worked, written = passes * CPU_S_A_PASS, passes / PASSES_A_TRIP / TRIPS_STORED_A_S
    estimated = workers.time(served_by_many(workers.of(arrive), worked / (1 - FUSION_SHARE), place.cores))
    order = np.argsort(estimated, kind="stable")
    stored = np.empty(len(arrive))
    stored[order] = primary.time(served_by_one(primary.of(estimated[order]), written[order]))
    return Week(arrive, stored, passes)


def span(seconds):
    unit, length = next(((unit, length) for unit, length in (("s", 1), ("min", 60), ("h", HOUR)) if seconds < 100 * length), ("d", DAY))
    return f"{seconds / length:.{0 if seconds > 9.95 * length else 1}f} {unit}"


def short(number):
    return f"{number:.0f}" if number >= 9.5 else f"{number:.1g}"


def row(place):
    calm, hard = week_of(place), week_of(place, [WORKERS_FAIL], [PRIMARY_FAILS])
    most, end = BY_HOUR_OF_WEEK.max(), WORKERS_FAIL[1]
    cores = calm.passes.sum() * CPU_S_A_PASS / (place.cores * (1 - FUSION_SHARE) * WEEK)
    primary = calm.passes.sum() / PASSES_A_TRIP / TRIPS_STORED_A_S / WEEK
    cells = [place.name, short(place.passes_a_day / DAY * LOG_BYTES_A_PASS * 8e-6 * most),
             f"{short(100 * cores)} %, {short(100 * cores * most)} %", f"{short(100 * primary * most)} %"]
    if cores > 1:
        cells += [f"{calm.waiting(WEEK):,} on Sunday", f"grows by {span((cores - 1) * DAY)} a day", "", ""]
    else:
        cells += [f"{calm.waiting(np.arange(0, WEEK, 10)).max():,}", ", ".join(map(span, (*np.quantile(calm.lag, [0.5, 0.99]), calm.lag.max()))),
                  f"{hard.waiting(end):,}; {span(hard.late(calm, end, PRIMARY_FAILS[0]))}", span(hard.late(calm, PRIMARY_FAILS[1], WEEK))]
    print("  ".join(cells), file=sys.stderr, flush=True)
    return cells, (calm, hard)


def table(head, rows):
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (head, ["---", *["--:"] * (len(head) - 1)], *rows)) + "\n"


def fusion_rows(country, calm):
    for words, days in (("of a month", 30), ("of a year", 365), ("of a year, a fifth of them fused", 73)):
        lag, share = fused_in_turns(country, calm.stored, days * country.passes_a_day / country.segments)
        yield [words, f"{span(np.median(lag))}, {span(lag.max())}", f"{short(100 * share)} %"]


def growth(week):
    """What a week adds."""
    return ", ".join(f"{short(week.passes.sum() * bytes_each / 1e9)} GB of {what}" for what, bytes_each in (
        ("logs", LOG_BYTES_A_PASS), ("drives", DRIVE_BYTES_A_PASS), ("WAL", WAL_BYTES_A_PASS)))


def report():
    """The tables; weeks of one and of two countries on 36 cores, calm and with failures."""
    places = [Place("town, 1 core", 50e3, 0.5e6, 1), times(1, "country, 36 cores"), times(2, "2 countries, 36 cores", 36),
              times(4, "4 countries, 36 cores", 36), times(8, "8 countries, 288 cores"), times(10, "10 countries, 360 cores")]
    rows = [row(place) for place in places]
    country, two = rows[1][1], rows[2][1]
    text = table(["", "logs, Mbit/s", "cores busy", "primary busy", "trips waiting, most", "lag", "workers fail", "primary fails"],
                 [cells for cells, _ in rows])
    text += "\n" + table(["passes kept", "value with a pass after", "cores' time"], fusion_rows(places[1], country[0]))
    return text + f"\nA week of a country: {growth(country[0])}.\n", country, two


def picture(country, failing, two):
    """The week of a country: trips that arrive, and how late they are stored."""
    bins, left, right = np.arange(0, WEEK + 1, 1200), 64, 640
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 720 430" font-family="sans-serif" font-size="12">',
             '<rect width="720" height="430" fill="#fff"/>']

    def write(x, y, words, anchor="start", colour="#222"):
        parts.append(f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}" fill="{colour}" stroke="#fff" stroke-width="4" '
                     f'paint-order="stroke">{words}</text>')

    def level(y, words, style='stroke="#ddd"'):
        parts.append(f'<path d="M{left} {y:.1f}H{right}" {style}/>')
        write(left - 8, y + 4, words, "end")

    def line(values, y, colour):
        points = " ".join(f"{x_of(at):.1f},{y(value):.1f}" for at, value in zip(bins, values))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>')

    def x_of(time):
        return left + (right - left) * time / WEEK

    def rate_y(rate):
        return 150 - 20 * rate

    def lag_y(seconds):
        return 390 - 180 * math.log10(max(seconds, 1)) / math.log10(DAY)

    def latest(week):
        most = np.zeros(len(bins) - 1)
        np.maximum.at(most, np.digitize(week.arrive, bins) - 1, week.lag)
        return most

    for day, words in enumerate(("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")):
        parts.append(f'<path d="M{x_of(day * DAY):.1f} 30V150M{x_of(day * DAY):.1f} 210V390" stroke="#ddd"/>')
        write(x_of((day + 0.5) * DAY), 410, words, "middle")
    for rate in (0, 2, 4, 6):
        level(rate_y(rate), rate)
    for seconds, words in ((1, "1 s"), (60, "1 min"), (HOUR, "1 h"), (DAY, "1 day")):
        level(lag_y(seconds), words)
    write(left, 20, "Trips of a country that end, a second")
    write(left, 198, "Longest time from the end of a trip until it is stored")
    room = rate_y(36 * (1 - FUSION_SHARE) / (PASSES_A_TRIP * CPU_S_A_PASS))
    level(room, "", 'stroke="#b23" stroke-dasharray="5 3"')
    write(right + 4, room + 4, "36 cores", colour="#b23")
    line(np.histogram(country.arrive, bins)[0] / 1200, rate_y, "#1f6fb2")
    for week, colour, y, words in ((two, "#888", 246, "2 countries"), (failing, "#b23", 264, "failures"), (country, "#1f6fb2", 282, "1 country")):
        line(latest(week), lag_y, colour)
        write(right + 4, y, words, colour=colour)
    write(x_of(WORKERS_FAIL[0]) - 4, 300, "workers", "end", "#b23")
    write(x_of(PRIMARY_FAILS[0]), 300, "primary", "middle", "#b23")
    return "\n".join([*parts, "</svg>"]) + "\n"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    text, country, two = report()
    (out / "scale.md").write_text(text)
    (out / "scale.svg").write_text(picture(*country, two[0]))
    print(text)


if __name__ == "__main__":
    main()
