"""Behaviour of the Python module: its values are those of the program, its errors have its words.

    PYTHONPATH=build/python MACADAM_PROGRAM=build/macadam module_test.py
"""

import csv
import datetime
import decimal
import hashlib
import io
import json
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import macadam

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = os.environ["MACADAM_PROGRAM"]
PROFILE = SOURCE / "tests/data/sorel/profile_1.txt"  # stations every 0.25 m, elevations
PROFILE_STEP_M = 0.25
TRIP = SOURCE / "sample_data/comma2k19/comma2k19_rav4.trip.csv"
WHOLE = ("--bbox=-180,-90,180,90",)


SCRATCH = tempfile.TemporaryDirectory()
CAR = pathlib.Path(SCRATCH.name, "golf.toml")


def setUpModule():
    warnings.simplefilter("ignore", macadam.DataWarning)
    macadam.add_vehicle(CAR, mass_kg=1430, wheelbase_m=2.62, body="compact")


def tearDownModule():
    SCRATCH.cleanup()


def run(*words, status=0):
    """Standard output of the program, or its message if it fails as it should."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != status:
        raise AssertionError(f"{words}: {done.returncode}: {done.stderr}")
    said = f"macadam {words[0]}: "
    refusals = [line for line in done.stderr.splitlines() if line.startswith(said)]
    return done.stdout if status == 0 else refusals[0].removeprefix(said)


def json_of(*words):
    return json.loads(run(*words, "--json", "--quiet"), parse_float=decimal.Decimal)


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


class Values(unittest.TestCase):
    """Helpers that compare a table with rows of the program."""

    def assert_same(self, table, rows):
        """Expects values that the program prints as it does, with its decimals."""
        self.assertGreater(len(rows), 0)
        self.assertEqual(table.rows, len(rows))
        for name in rows[0]:
            for value, row in zip(table[name], rows, strict=True):
                self.assert_cell(name, value, row[name])

    def assert_cell(self, name, value, expected):
        if isinstance(expected, decimal.Decimal):
            half_a_digit = 0.5000001 * 10.0 ** expected.as_tuple().exponent
            self.assertAlmostEqual(float(value), float(expected), delta=half_a_digit, msg=name)
        elif expected is None:
            self.assertIn(str(value), ("None", "nan", "NaT", "--"), name)
        elif isinstance(expected, str):
            self.assertEqual(str(value), expected, name)
        elif isinstance(expected, list):
            self.assertEqual(value, json.loads(json.dumps(expected, default=float)), name)
        else:
            self.assertEqual(int(value), expected, name)


class Iri(Values):
    def test_has_the_values_of_the_program_for_a_file(self):
        table = macadam.iri(PROFILE, length_m=100)
        rows = rows_of(run("iri", PROFILE, "--length", 100))
        self.assertEqual(list(table), list(rows[0]))
        for name in table:
            for value, row in zip(table[name], rows, strict=True):
                if name == "lead_in":
                    self.assertEqual(bool(value), row[name] == "yes")
                else:
                    self.assertAlmostEqual(value, float(row[name]), 3 if name.endswith("_m") else 4)
        self.assertEqual(table.units["from_m"], "m")
        self.assertEqual(table.units[list(table)[2]], "mm/m")
        self.assertEqual(table.details["method"], "sampled")

    def test_takes_arrays_instead_of_a_file(self):
        station_m, elevation_m = np.loadtxt(PROFILE, unpack=True)
        by_file = macadam.iri(PROFILE, length_m=50)
        placed = macadam.iri({"station_m": station_m, "profile": elevation_m}, length_m=50)
        for name in by_file:
            np.testing.assert_array_equal(placed[name], by_file[name])
        even = macadam.iri(elevation_m, step_m=PROFILE_STEP_M, length_m=50)
        np.testing.assert_allclose(even["iri_profile"], by_file["iri_profile"], rtol=1e-9)
        self.assertEqual(even["from_m"][0], 0)
        pair = macadam.iri({"left": elevation_m, "right": 2 * elevation_m}, step_m=PROFILE_STEP_M)
        np.testing.assert_allclose(pair["mri"], 1.5 * pair["iri_left"])

    def test_moves_a_mean_along(self):
        table = macadam.iri(PROFILE, continuous_m=True, unit="in/mi")
        rows = rows_of(run("iri", PROFILE, "--continuous", "--unit", "in/mi"))
        self.assertEqual(list(table), list(rows[0]))
        np.testing.assert_allclose(table["at_m"], [float(row["at_m"]) for row in rows], atol=5e-4)
        name = list(table)[1]
        np.testing.assert_allclose(table[name], [float(row[name]) for row in rows], atol=5e-5)
        self.assertEqual(table.units[name], "in/mi")

    def test_refuses_profiles_in_the_words_of_the_program(self):
        flat = np.zeros(100)
        for profile, options, words in (
                (flat, {"step_m": 0.5}, "profile: has a point every 0.5 m, expected 0 to 0.3"),
                ({"left": [0, np.nan, 0]}, {"step_m": 0.1},
                 "left: value 2 is nan, expected an elevation in metres"),
                ({"left": flat, "right": flat[1:]}, {"step_m": 0.1},
                 "right: has 99 values, expected 100, one for each station"),
                (np.zeros((4, 5)), {"step_m": 0.1},
                 "profile: has 2 dimensions, expected one value per station"),
                ({"station_m": [0, 0.1, 0.1], "left": [0, 0, 0]}, {},
                 "profile: point 3 is at 0.1 m, expected more than 0.1"),
        ):
            with self.assertRaises(macadam.InputError) as raised:
                macadam.iri(profile, **options)
            self.assertEqual(str(raised.exception), words)
        with self.assertRaises(macadam.InputError) as raised:
            macadam.iri("missing.csv")
        self.assertEqual(str(raised.exception), run("iri", "missing.csv", status=1))

    def test_names_parameters_in_usage_errors(self):
        for options, words in (
                ({"step_m": 0.1, "length_m": -5}, "length_m is -5, expected a length over 0 m"),
                ({"step_m": 0.1, "length_m": 5, "continuous_m": 8},
                 "length_m and continuous_m cannot be combined"),
                ({}, "profile is of arrays, expected either step_m or its 'station_m'"),
                ({"step_m": 0.1, "unit": "ft"}, "unit is 'ft', expected si or us or mm/m or in/mi"),
        ):
            with self.assertRaises(macadam.UsageError) as raised:
                macadam.iri(np.zeros(100), **options)
            self.assertEqual(str(raised.exception), words)
            self.assertIsInstance(raised.exception, (macadam.Error, ValueError))


class Trace(Values):
    def test_has_the_values_of_the_program(self):
        table = macadam.trace(TRIP, "suv", length_m=50)
        self.assert_same(table, json_of("trace", TRIP, "--vehicle", "suv", "--length", 50))
        self.assertEqual(table.units["speed_mps"], "m/s")
        self.assertEqual(table.units["iri"], "mm/m")
        self.assertEqual(table["iri"].dtype, np.float64)

    def test_warns_of_what_the_program_warns_of(self):
        with self.assertWarnsRegex(macadam.DataWarning, "average car|unknown car|car"):
            with warnings.catch_warnings():
                warnings.simplefilter("always")
                macadam.trace(TRIP, method="kf")

    def test_takes_arrays(self):
        drive = macadam.simulate_drive(PROFILE, CAR, speed_mps=20)
        self.assertEqual(drive.units["acc_z_mps2"], "m/s2")
        self.assertAlmostEqual(drive["t_s"][1] - drive["t_s"][0], 0.01)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "drive.trip.csv")
            macadam.write_trip(file, {**drive, "vehicle_id": "suv"})
            by_program = json_of("trace", file)
        self.assert_same(macadam.trace({**drive, "vehicle_id": "suv"}), by_program)

    def test_refuses_trips_of_arrays_that_are_none(self):
        for trip, words in (
                ({"t_s": [0, 1], "acc_z_mps2": [0]},
                 "trip: has columns of shapes t_s (2,), acc_z_mps2 (1,), expected one (n,)"),
                ({"t_s": [0, 1], "note": "two\nlines"}, "note: has several lines, expected one"),
        ):
            with self.assertRaises(macadam.InputError) as raised:
                macadam.trace(trip)
            self.assertEqual(str(raised.exception), words)
        with self.assertRaisesRegex(macadam.InputError, r"^trip(:\d+)?: "):
            macadam.trace({"t_s": [0.0, 1.0], "lat_deg": [48.0, 48.0], "lon_deg": [15.0, 15.1]})

    def test_names_parameters_in_usage_errors(self):
        with self.assertRaises(macadam.UsageError) as raised:
            macadam.trace(TRIP, length_m=0.5)
        self.assertEqual(str(raised.exception), "length_m is 0.5, expected 1 to 100000 m")


class Simulation(unittest.TestCase):
    def test_gives_trips_and_their_truth(self):
        with tempfile.TemporaryDirectory() as folder:
            fleet = macadam.simulate(pathlib.Path(folder, "fleet"),
                                     SOURCE / "sample_data/fleet/network.osm.pbf", trips=1, seed=3)
            self.assertEqual(len(fleet["trips"]), 1)
            self.assertTrue(fleet["network"].is_file())
            rows = rows_of(pathlib.Path(folder, "fleet/truth.csv").read_text("utf-8"))
            self.assertEqual(fleet["truth"].rows, len(rows))
            np.testing.assert_array_equal(fleet["truth"]["mri"], [float(row["mri"]) for row in rows])
            self.assertEqual(fleet["truth"]["way_id"].dtype, np.int64)
            car = next(iter(fleet["vehicles"].values()))
            self.assertGreater(macadam.trace(fleet["trips"][0], car, method="kf").rows, 10)
            with self.assertRaises(macadam.InputError):  # the folder is not empty
                macadam.simulate(pathlib.Path(folder, "fleet"),
                                 SOURCE / "sample_data/fleet/network.osm.pbf", trips=1)

    def test_of_a_drive_refuses_cars_and_roads_that_cannot_be_simulated(self):
        road = np.zeros(4000)
        for profile, options, words in (
                (road, {"speed_mps": 0.5}, "the speed is 0.5 m/s, expected 1 to 60"),
                ({"a": road, "b": road}, {},
                 "the profile has 2 tracks and none of them is 'left', expected left and right, or "
                 "one track"),
                (road, {"rate_hz": 0}, "imu: rate_hz is 0, expected 1 to 10000"),
        ):
            with self.assertRaises(macadam.InputError) as raised:
                macadam.simulate_drive(profile, CAR, step_m=0.1, **options)
            self.assertEqual(str(raised.exception), words)
        with self.assertRaisesRegex(macadam.InputError, "'suv' has no axles, expected its wheelbase"):
            macadam.simulate_drive(road, "suv", step_m=0.1)
        with self.assertRaises(macadam.UsageError) as raised:
            macadam.simulate_drive(road, "tank", step_m=0.1)
        self.assertRegex(str(raised.exception), "^vehicle is 'tank', expected a TOML file or one of ")


class RoadDatabase(Values):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = pathlib.Path(cls.folder.name, "roads.gpkg")
        run("init", cls.file, "--trace", TRIP)
        run("import", cls.file, TRIP)
        cls.roads = macadam.open(cls.file)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def query(self, *words):
        return json_of("query", self.file, *(words or WHOLE))

    def test_gives_segments_as_the_program_does(self):
        segments = self.roads.segments()
        self.assert_same(segments, self.query())
        self.assertEqual(segments["first_seen"].dtype, np.dtype("datetime64[D]"))
        self.assertEqual(segments["way_id"].dtype, np.int64)
        self.assertEqual(segments.units["iri"], "mm/m")
        placed = rows_of(run("query", self.file, "--format", "csv", *WHOLE))
        np.testing.assert_allclose(segments["lat_deg"], [float(row["lat_deg"]) for row in placed],
                                   atol=1e-7)

    def test_selects_as_the_program_does(self):
        segments = self.roads.segments()
        key = segments["segment"][0]
        lat, lon = segments["lat_deg"][0], segments["lon_deg"][0]
        box = (lon - 1e-3, lat - 1e-3, lon + 1e-3, lat + 1e-3)
        for selection, words in (
                ({"near": (lat, lon), "radius_m": 100}, ("--near", f"{lat},{lon}", "--radius", "100")),
                ({"bbox": box}, ("--bbox", ",".join(map(repr, map(float, box))))),
                ({"segment": key}, ("--segment", key)),
                ({"way": segments["way_id"][0]}, ("--way", segments["way_id"][0])),
                ({"all": True}, ("--all", *WHOLE)),
                ({"class_name": segments["class"][0], "min_passes": 1},
                 ("--class", segments["class"][0], "--min-passes", "1")),
        ):
            with self.subTest(selection):
                self.assert_same(self.roads.segments(**selection), self.query(*words))
        nothing = self.roads.segments(since=datetime.date(2100, 1, 1))
        self.assertEqual(nothing.rows, 0)
        self.assertEqual(list(nothing), list(segments))  # the same columns and types
        self.assertEqual(nothing["iri"].dtype, np.float64)
        self.assertEqual(nothing["last_seen"].dtype, np.dtype("datetime64[D]"))

    def test_gives_geometries(self):
        table = self.roads.segments(geometry=True)
        features = json.loads(run("query", self.file, "--format", "geojson", *WHOLE))["features"]
        self.assertEqual(list(table["geometry"]), [feature["geometry"] for feature in features])

    def test_gives_worst_sections_history_events_and_passes(self):
        worst = self.roads.worst(3, above_mm_per_m=0.5, min_length_m=40)
        self.assert_same(worst, self.query("--worst", 3, "--above", 0.5, "--min-length", 40))
        self.assertEqual(self.roads.worst(2, single_segments=True).rows, 2)
        self.assert_same(self.roads.history(), self.query("--history", *WHOLE))
        self.assertEqual(self.roads.events().rows, len(self.query("--events")))
        key = self.roads.segments()["segment"][0]
        self.assert_same(self.roads.passes(key), self.query("--segment", key, "--passes"))
        self.assertEqual(self.roads.changes(key).rows, len(self.query("--segment", key, "--changes")))

    def test_gives_sections(self):
        segments = self.roads.segments()
        file = pathlib.Path(self.folder.name, "own.csv")
        file.write_text(f"way_id,from_m,to_m\n{segments['way_id'][0]},0,200\n", encoding="utf-8")
        self.assert_same(self.roads.sections(file, length=50),
                         self.query("--sections", file, "--section-length", 50))

    def test_tells_totals(self):
        info = self.roads.info()
        self.assertEqual(info, json.loads(run("info", self.file, "--json")))
        self.assertEqual(self.roads.digest(), info["digest"])
        self.assertEqual(list(self.roads.table("classes")["class"]),
                         [row["class"] for row in info["classes"]])

    def test_answers_in_the_words_of_the_program(self):
        with self.assertRaises(macadam.InputError) as raised:
            macadam.open(TRIP)
        self.assertEqual(str(raised.exception), run("query", TRIP, *WHOLE, status=1))
        with self.assertRaises(macadam.InputError) as raised:
            self.roads.segments(segment="999+0001")
        self.assertEqual(str(raised.exception),
                         run("query", self.file, "--segment", "999+0001", status=1))
        for selection, words in (
                ({"class_name": "awful"}, "class_name is 'awful', expected good or fair or poor"),
                ({"min_passes": -1}, "min_passes is -1, expected 0 or more"),
                ({"near": (48, 15), "radius_m": -1}, "radius_m is -1, expected 0 to 100000 m"),
        ):
            with self.assertRaises(macadam.UsageError) as raised:
                self.roads.segments(**selection)
            self.assertEqual(str(raised.exception), words)

    def test_is_never_written(self):
        def state():
            return {file.name: hashlib.sha256(file.read_bytes()).hexdigest()
                    for file in pathlib.Path(self.folder.name).glob("roads.gpkg*")}

        before = state()
        roads = macadam.open(self.file)
        for read in (roads.segments, roads.worst, roads.history, roads.events, roads.info):
            read()
        self.assertEqual(state(), before)

    def test_is_read_by_ogr2ogr_as_documented(self):
        page = (SOURCE / "docs/reference/python.md").read_text("utf-8")
        lines = [line.strip() for line in page.splitlines() if line.startswith("    ogr2ogr ")]
        self.assertEqual(len(lines), 2)
        for line in lines:
            subprocess.run(shlex.split(line), cwd=self.folder.name, check=True)
        poor = json.loads(pathlib.Path(self.folder.name, "poor.geojson").read_text("utf-8"))["features"]
        self.assertEqual([feature["properties"]["segment"] for feature in poor],
                         list(self.roads.segments(class_name="poor")["segment"]))

    def test_of_a_crowd_gives_published_values_alone(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            fleet = macadam.simulate(folder / "fleet", SOURCE / "sample_data/fleet/network.osm.pbf",
                                     trips=1)
            crowd = folder / "crowd.gpkg"
            run("init", crowd, "--network", fleet["network"], "--privacy", "crowd")
            run("import", crowd, *fleet["trips"], "--method", "kf")
            key = macadam.open(crowd).segments()["segment"][0]  # to its operator
            (folder / "crowd.gpkg.key").unlink()
            public = macadam.open(crowd)
            self.assertEqual(public.segments().rows, 0)  # nothing is published of one car
            self.assertEqual(public.events().rows, 0)
            for read, words in ((public.passes, "--passes"), (public.changes, "--changes")):
                with self.assertRaises(macadam.InputError) as raised:
                    read(key)
                self.assertEqual(str(raised.exception),
                                 run("query", crowd, "--segment", key, words, status=1))


class Matching(Values):
    def test_has_the_values_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "roads.gpkg")
            run("init", file, "--trace", TRIP)
            table = macadam.match(TRIP, file, geometry=True)
            self.assert_same(table, json_of("match", TRIP, "--network", file))
            self.assertEqual(table["geometry"][0]["type"], "LineString")
            arcs = macadam.match(TRIP, file, arcs=True)
            self.assert_same(arcs, json_of("match", TRIP, "--network", file, "--arcs"))


LONG_TRACE = """
import sys, numpy as np, macadam
road = np.random.default_rng(1).normal(0, 0.002, 1_000_000).cumsum() * 0.1
drive = macadam.simulate_drive(road, sys.argv[1], step_m=0.1, speed_mps=20)
print("begins", flush=True)
try:
    macadam.trace(drive, sys.argv[1])
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


class Interpreter(unittest.TestCase):
    def test_answers_ctrl_c_in_a_long_call(self):
        child = subprocess.Popen([sys.executable, "-c", LONG_TRACE, CAR], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "begins\n")
        time.sleep(1)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.stdout.readline(), "interrupted\n")
        self.assertEqual(child.wait(), 0)
        child.stdout.close()

    def test_runs_other_threads_during_a_call(self):
        counts = []
        done = threading.Event()

        def count():
            while not done.is_set():
                counts.append(1)
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        before = len(counts)
        macadam.trace(TRIP, "suv")
        during = len(counts) - before
        done.set()
        thread.join()
        self.assertGreater(during, 10)


if __name__ == "__main__":
    unittest.main()
