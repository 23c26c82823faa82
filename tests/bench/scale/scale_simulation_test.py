#!/usr/bin/python3
"""Compares the simulation of docs/scale.md with closed forms, in seconds.

    scale_simulation_test.py     0 if all agree; else 1, and what differs on stderr

Seeds are fixed; tolerances leave some three standard errors.
"""

import math
import sys

import numpy as np

from scale_simulation import (CHUNKS_A_TRIP, CPU_S_A_PASS, DAY, FUSED_A_CPU_S, FUSION_SHARE, HOUR, PASSES_A_TRIP, PASSES_AN_HOUR,
                              PRIMARY_FAILS, SEGMENTS_A_CHUNK, WEEK, WORKERS_FAIL, Clock, fused_in_turns, served_by_many,
                              served_by_one, times, week_of)

JOBS = 600_000
different = []


def expect(words, found, right, tolerance):
    print(f"{words}: {found:.4g}, expected {right:.4g} within {tolerance:.0%}")
    if not abs(found - right) <= tolerance * right:
        different.append(words)


def wait_of_erlang(servers, busy):
    """Mean wait in M/M/c by Erlang C, in mean service times."""
    offered, blocked = busy * servers, 1.0
    for n in range(1, servers + 1):  # Erlang B
        blocked = offered * blocked / (n + offered * blocked)
    return blocked / (1 - busy * (1 - blocked)) / (servers - offered)


def expect_queues(rng):
    one = np.ones(JOBS)
    for servers, busy in ((1, 0.8), (36, 0.9)):
        at = np.cumsum(rng.exponential(1 / (busy * servers), JOBS))
        takes = rng.exponential(1, JOBS)
        expect(f"wait in M/M/{servers}", (served_by_many(at, takes, servers) - at - takes).mean(), wait_of_erlang(servers, busy), 0.06)
        # Cosmetatos, Some approximate equilibrium results for the multi-server queue M/G/r, 1976; exact for one server.
        less = 0.5 * (1 + (1 - busy) * (servers - 1) * (math.sqrt(4 + 5 * servers) - 2) / (16 * busy * servers))
        expect(f"wait in M/D/{servers}", (served_by_many(at, one, servers) - at - one).mean(), less * wait_of_erlang(servers, busy), 0.06)
    at = np.cumsum(rng.exponential(1.25, JOBS))
    expect("one server of many, or one", served_by_one(at, one).mean(), served_by_many(at, one, 1).mean(), 1e-9)


def expect_recovery(rng):
    """Jobs come 2 a second, ten servers take 4: what waits after two hours is gone after another two."""
    at, takes, stop = np.cumsum(rng.exponential(0.5, 60_000)), np.full(60_000, 2.5), Clock([(HOUR, 3 * HOUR)])
    late = stop.time(served_by_many(stop.of(at), takes, 10)) > served_by_many(at, takes, 10) + 1
    expect("hours of a queue of two hours, as a fluid", (at[late][-1] - 3 * HOUR) / HOUR, 2, 0.05)
    waits = stop.time(stop.of(np.array([0.5 * HOUR, 2 * HOUR, 3.5 * HOUR])) + 1)
    expect("an end after a stop", waits[1], 3 * HOUR + 1, 1e-9)
    expect("an end before and one later", waits[0] + waits[2], 4 * HOUR + 2, 1e-9)


def expect_country():
    country, hours = times(1), 100e6 / PASSES_AN_HOUR
    week, hard = week_of(country), week_of(country, [WORKERS_FAIL], [PRIMARY_FAILS])
    expect("cores that estimate, as on paper", week.passes.sum() * CPU_S_A_PASS / WEEK, hours * CPU_S_A_PASS * PASSES_AN_HOUR / DAY, 0.01)
    expect("trips a week, as on paper", len(week.arrive), 7 * country.passes_a_day / PASSES_A_TRIP, 0.01)
    expect("Little's law", week.waiting(np.arange(0, WEEK, 7)).mean(), len(week.arrive) / WEEK * week.lag.mean(), 0.01)
    came = np.searchsorted(week.arrive, WORKERS_FAIL[1]) - np.searchsorted(week.arrive, WORKERS_FAIL[0])
    expect("trips that wait when workers return", hard.waiting(WORKERS_FAIL[1]), came + week.waiting(WORKERS_FAIL[0]), 0.01)

    passes = 365 * country.passes_a_day / country.segments
    lag, _ = fused_in_turns(country, week.stored, passes)
    expect("seconds until all chunks had their turn", np.median(lag),
           country.segments * passes / (FUSION_SHARE * country.cores * FUSED_A_CPU_S), 0.03)
    _, share = fused_in_turns(country, week.stored, 0.1)  # some chunks are driven twice before they are fused
    expect("cores' time that fusion of few passes takes", share,
           country.trips_a_s * CHUNKS_A_TRIP * SEGMENTS_A_CHUNK * 0.1 / FUSED_A_CPU_S / country.cores, 0.1)


def main():
    rng = np.random.default_rng(7)
    expect_queues(rng)
    expect_recovery(rng)
    expect_country()
    if different:
        sys.exit(f"differ from what is known by another road: {'; '.join(different)}")


if __name__ == "__main__":
    main()
