"""Simulated fleets, whose trips the tests store."""

import math
import pathlib

SAMPLE = pathlib.Path(__file__).parents[2] / "sample_data" / "fleet"
BLOCK_M, CROSSINGS = 100, 10


class Fleet:
    """Short trips over a road network, in a folder of the trial."""

    def __init__(self, trial, name, network, trips, length_km):
        recipe = trial.folder / f"{name}.toml"
        recipe.write_text((SAMPLE / "recipe.toml").read_text().replace("count = 30", f"count = {trips}")
                          .replace("[6, 10]", str(length_km)))
        trial.macadam("simulate", "-o", name, "--network", str(network), "--recipe", str(recipe))
        self.network = str(trial.folder / name / "network.osm.pbf")
        self.logs = sorted((trial.folder / name / "trips").glob("*.gz"))


def town(trial):
    return Fleet(trial, "fleet", SAMPLE / "network.osm.pbf", 3, [0.8, 1.5])


def streets_across_cells(trial):
    """Streets in four cells: a grid around the corner of four map tiles of zoom 8, some of its ways across a border."""
    file = trial.folder / "streets.osm"
    lat_deg, lon_deg = math.degrees(math.atan(math.sinh(math.pi * (1 - 2 * 89 / 256)))), 139 * 360 / 256 - 180
    high_deg = BLOCK_M / 111_195
    wide_deg = high_deg / math.cos(math.radians(lat_deg))
    rows = range(CROSSINGS)
    nodes = [f'<node id="{1 + x + CROSSINGS * y}" lat="{lat_deg + (y - 4.5) * high_deg:.7f}" lon="{lon_deg + (x - 4.5) * wide_deg:.7f}"/>'
             for y in rows for x in rows]
    streets = [[1 + x + CROSSINGS * y for x in rows] for y in rows] + [[1 + x + CROSSINGS * y for y in rows] for x in rows]
    blocks = [street[first:first + 3] for street in streets for first in range(0, CROSSINGS - 1, 2)]
    ways = [f'<way id="{number}">' + "".join(f'<nd ref="{node}"/>' for node in block) + '<tag k="highway" v="residential"/></way>'
            for number, block in enumerate(blocks, 1)]
    file.write_text("<osm version='0.6'>\n" + "\n".join(nodes + ways) + "\n</osm>\n")
    return Fleet(trial, "streets", file, 12, [1, 2])
