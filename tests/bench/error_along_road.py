#!/usr/bin/env python3
"""How errors of fused segments hang together along a road, in a simulated fleet.

usage: error_along_road.py SEGMENTS.csv TRUTH.csv

SEGMENTS.csv is of 'macadam export', TRUTH.csv of 'macadam simulate'. Prints the correlation of
(state - truth) / sd over distances along ways, and how often the 90 % interval of the mean over
sections holds the truth, for shares and lengths of the model in mapping/analysis/correlated_mean.hpp.
"""

import collections
import csv
import math
import random
import sys

SEGMENT_M = 20
LAGS = (1, 2, 3, 5, 10, 15, 25, 50)
SECTIONS_M = (100, 200, 500)
MODELS = ((0.5, 20), (0.5, 0), (0.5, 100), (0.1, 16), (0.3, 60))  # common share, length in metres


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


def errors_by_way(segments, truth):
    """Way and direction: {middle: (error, sd)}."""
    mri = {row["segment"]: float(row["mri"]) for row in truth if row["mri"]}
    ways = collections.defaultdict(dict)
    for row in segments:
        if row["segment"] in mri and "too_slow" not in row["validity"]:
            middle = (float(row["from_m"]) + float(row["to_m"])) / 2
            error = float(row["iri"]) - mri[row["segment"]]
            ways[row["way_id"], row["direction"]][middle] = error, float(row["iri_sd"])
    return ways


def correlations(ways):
    products = collections.defaultdict(list)
    for places in ways.values():
        middles = sorted(places)
        for i, a in enumerate(middles):
            for b in middles[i:]:
                lag = round((b - a) / SEGMENT_M)
                if lag > max(LAGS):
                    break
                products[lag].append(
                    places[a][0] / places[a][1] * places[b][0] / places[b][1])
    whole = sum(products[0]) / len(products[0])
    return [(lag * SEGMENT_M, sum(products[lag]) / len(products[lag]) / whole)
            for lag in LAGS if products[lag]], whole


def correlation_of_other_roads(ways, whole, pairs=200000):
    generator = random.Random(1)
    keys = sorted(ways)
    values = {key: [error / sd for error, sd in ways[key].values()] for key in keys}
    total = 0.0
    for _ in range(pairs):
        a, b = generator.sample(keys, 2)
        total += generator.choice(values[a]) * generator.choice(values[b])
    return total / pairs / whole


def coverage(ways, section_m, share, length_m):
    held = sections = 0
    count = section_m // SEGMENT_M
    for places in ways.values():
        middles = sorted(places)
        for first in range(0, len(middles) - count + 1, count):
            part = middles[first:first + count]
            if part[-1] - part[0] > 1.15 * section_m:
                continue  # with a hole
            error = sum(places[x][0] for x in part) / count
            together = sum(places[x][1] for x in part) / count
            apart = sum(
                places[x][1] * places[y][1]
                * (math.exp(-abs(x - y) / length_m) if length_m else x == y)
                for x in part for y in part) / count ** 2
            held += abs(error) < 1.645 * math.sqrt(share * together ** 2 + (1 - share) * apart)
            sections += 1
    return (held / sections if sections else math.nan), sections


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    ways = errors_by_way(rows_of(sys.argv[1]), rows_of(sys.argv[2]))
    fades, whole = correlations(ways)
    for apart_m, correlation in fades:
        print(f"{apart_m:5d} m apart    {correlation:6.3f}")
    print(f"other roads      {correlation_of_other_roads(ways, whole):6.3f}")
    for share, length_m in MODELS:
        told = []
        for section_m in SECTIONS_M:
            held, sections = coverage(ways, section_m, share, length_m)
            told.append(f"{section_m} m: {100 * held:.1f} % of {sections}")
        print(f"common {share}, {length_m:3d} m   {',  '.join(told)}")


if __name__ == "__main__":
    main()
