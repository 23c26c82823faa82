"""The engines, each by itself: no database is needed."""

from __future__ import annotations

import os
import tempfile
from collections import abc
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _macadam
from ._files import read_truth, write_trip
from ._results import PathLike, Table, in_python_words, operand, run, run_table, words_of

Profile = Union[PathLike, npt.ArrayLike, abc.Mapping[str, npt.ArrayLike]]
Trip = Union[PathLike, abc.Mapping[str, Union[npt.ArrayLike, str]]]


def iri(profile: Profile, *, step_m: float | None = None, from_m: float | None = None,
        to_m: float | None = None, length_m: float | None = None,
        continuous_m: float | bool | None = None, envelope: bool = True,
        unit: Literal["mm/m", "in/mi"] = "mm/m") -> Table:
    """Computes the reference IRI of a measured profile (ASTM E1926).

    Args:
        profile: a file (.csv, .txt, .erd, .pro); or the elevations of one wheel track in metres,
            shape (n,); or a mapping of tracks such as ``{"left": z, "right": z}``, each of shape
            (n,), which may have the stations as ``"station_m"``, rising.
        step_m: distance between points in metres, over 0 and up to 0.3; required for arrays without
            stations. A file in .csv or .txt then has no stations.
        from_m, to_m: part that is reported, in metres; by default all. The profile before it serves
            as lead-in.
        length_m: length of the reported segments in metres; by default one segment.
        continuous_m: base of a moving mean in metres instead, or True for 7.62 (25 ft).
        envelope: False if the profile has been smoothed by the 250 mm moving average already.
        unit: unit of the values.

    Returns:
        A row for each segment: ``from_m``, ``to_m`` (or ``at_m`` of a moving mean),
        ``iri_TRACK`` for each track; ``mri`` and (not of a moving mean) ``hri``, if there are tracks
        named left and right; ``lead_in``: True within 60 m of the start, where the initial state of
        the simulated car may still show. ``details`` has ``method`` ("sampled", or "exact" on uneven
        stations), ``step_m`` and ``envelope_samples``.

    Raises:
        InputError: the profile cannot be read, has a step over 0.3 m, values that are not finite or
            stations that do not rise, or is shorter than what is asked for.
        UsageError: a parameter is out of its range.
    """
    options: dict[str, Any] = {
        "step_m": step_m, "from_m": from_m, "to_m": to_m, "length_m": length_m,
        "continuous_m": continuous_m, "no_envelope": not envelope, "unit": unit}
    name, tracks, stations = _profile(profile, step_m)
    try:
        columns, units, details = _macadam.iri([*words_of(options), name], tracks, stations)
    except _macadam.UsageError as error:
        raise in_python_words(error, options) from None
    return Table(columns, units, details)


def _profile(profile: Profile, step_m: float | None) -> tuple[
        str, list[tuple[str, npt.ArrayLike]], npt.ArrayLike | None]:
    """The file of a profile; or a name for messages, its tracks and stations."""
    if isinstance(profile, (str, os.PathLike)):
        return operand(profile), [], None
    given = dict(profile) if isinstance(profile, abc.Mapping) else {"profile": profile}
    stations = given.pop("station_m", None)
    if not given:
        raise _macadam.UsageError("profile has no track, expected elevations beside station_m")
    if (stations is None) == (step_m is None):
        raise _macadam.UsageError("profile is of arrays, expected either step_m or its 'station_m'")
    return "profile", list(given.items()), stations


@contextmanager
def _trip_file(trip: Trip) -> abc.Iterator[PathLike]:
    """The file of a trip; one that is made for a trip of arrays, which messages do not name."""
    if not isinstance(trip, abc.Mapping):
        yield trip
        return
    with tempfile.TemporaryDirectory(prefix="macadam-") as folder:
        file = Path(folder, "trip.trip.csv")
        write_trip(file, trip)
        try:
            yield file
        except _macadam.InputError as error:
            raise _macadam.InputError(str(error).replace(str(file), "trip")) from None


def trace(trip: Trip, vehicle: PathLike | None = None, *, length_m: float = 20,
          vehicles: PathLike | None = None, vehicle_id: str | None = None,
          mapping: PathLike | None = None, method: Literal["smoother", "kf"] = "smoother",
          channels: str | None = None, filters: bool = True,
          rate_hz: float | None = None) -> Table:
    """Estimates the IRI along one trip, without a map.

    Args:
        trip: a trip log (.trip.csv, .gz, .zst), a phone's export (a folder or .zip), or the columns
            of a trip log as arrays: ``t_s``, ``acc_z_mps2``, ``speed_mps``, ... with NaN for no
            sample, each of shape (n,); text such as ``"vehicle_id"`` is a line of its head
            (docs/reference/trip-logs.md).
        vehicle: the car: a built-in model (``"golden-car"``, ``"generic"``, ``"suv"``, ...) or a
            TOML file. By default it is looked up by the trip's vehicle_id.
        length_m: length of the reported segments in metres, 1 to 100,000.
        vehicles: a folder of TOML files, of which the trip takes the one of its vehicle_id.
        vehicle_id: name of the car of a log that names none.
        mapping: a TOML file that says what the columns of a foreign log are.
        method: ``"smoother"`` (two axles, both tracks) or ``"kf"``, the published Kalman filter.
        channels: sensors, such as ``"vertical,pitch"``; by default those that the log has.
        filters: False switches the method's own filters off, for noise-free simulated logs.
        rate_hz: sampling rate at which the method runs; by default the log's, at most 200.

    Returns:
        A row for each ``length_m`` of travel: ``from_m``, ``to_m``; ``t_s``, ``lat_deg``,
        ``lon_deg`` of its middle; ``speed_mps``; ``iri`` with ``iri_sd`` and its 90 % interval
        ``iri_low``, ``iri_high``; ``iri_left``, ``iri_right``, ``mri``, ``hri``, all in mm/m;
        ``index``: which of them ``iri`` is, "MRI" or "HRI"; ``validity``: "ok", or why it is
        unknown (NaN) or of little weight.

    Raises:
        InputError: the log or the vehicle cannot be read, lacks a sensor, or is too short.
        UsageError: a parameter is out of its range.
    """
    with _trip_file(trip) as file:
        return run_table("trace", [operand(file)], {
            "vehicle": vehicle, "length_m": length_m, "vehicles": vehicles,
            "vehicle_id": vehicle_id, "mapping": mapping, "method": method, "channels": channels,
            "no_filters": not filters, "rate_hz": rate_hz})


def match(trip: Trip, network: PathLike, *, arcs: bool = False, geometry: bool = False,
          mapping: PathLike | None = None, layer: str | None = None, id_column: str | None = None,
          oneway_column: str | None = None) -> Table:
    """Matches a trip to the road network.

    Args:
        trip: a trip log or a GPX track, or arrays as for ``trace``; positions suffice.
        network: the roads: .osm.pbf, .osm, a road database, its network file, or any line layer
            that GDAL reads.
        arcs: list every pair of consecutive nodes instead of parts of edges.
        geometry: add a column ``geometry`` of GeoJSON geometries (None off the network).
        mapping: a TOML file that says what the columns of a foreign log are.
        layer, id_column, oneway_column: of line layers.

    Returns:
        A row for each passage of an edge, part off the network and gap, in driving order:
        ``way_id``, ``from_node``, ``to_node``, ``direction``, ``from_m`` and ``to_m`` along the way,
        ``offset_sd_m``, ``t_enter_s``, ``t_leave_s``, ``confidence`` (0 to 1), ``kind`` ("road",
        "off_network" or "gap") and ``reason``. With ``arcs``: ``from_node``, ``to_node``,
        ``way_id``, ``t_enter_s``.

    Raises:
        InputError: the trip or the network cannot be read.
    """
    with _trip_file(trip) as file:
        return run_table("match", [operand(file)], {
            "network": network, "arcs": arcs, "mapping": mapping, "layer": layer,
            "id_column": id_column, "oneway_column": oneway_column}, geometry=geometry)


def simulate(output: PathLike, network: PathLike, *, recipe: PathLike | None = None, seed: int = 1,
             trips: int | None = None, jobs: int | None = None) -> dict[str, Any]:
    """Simulates trips of known cars over the roads of a map, with the true IRI.

    Args:
        output: the folder for the files: new or empty. It appears when all are complete.
        network: road map: .osm.pbf, .osm, or any line layer that GDAL reads.
        recipe: scenario file (TOML); by default the sample recipe.
        seed: each number gives another fleet on other roads; the same gives the same bytes.
        trips: number of trips instead of that of the recipe.
        jobs: number of trips that are computed at the same time.

    Returns:
        ``trips``: paths of the logs in the order of their names; ``vehicles``: path of the file of
        each car by its name; ``network``: path of the map; ``truth``: table of the true ``iri_left``,
        ``iri_right``, ``mri`` and ``hri`` in mm/m of each ``segment``, with ``way_id``,
        ``direction``, ``from_m`` and ``to_m``.

    Raises:
        InputError: the network or the recipe cannot be used, or the folder is not empty.
    """
    run("simulate", [], {"output": output, "network": network, "recipe": recipe, "seed": seed,
                         "trips": trips, "jobs": jobs})
    folder = Path(output)
    return {
        "trips": sorted((folder / "trips").iterdir()),
        "vehicles": {file.stem: file for file in sorted((folder / "vehicles").iterdir())},
        "network": folder / "network.osm.pbf",
        "truth": read_truth(folder / "truth.csv"),
    }


def add_vehicle(path: PathLike, *, mass_kg: float, wheelbase_m: float,
                body: Literal["small", "compact", "saloon", "estate", "suv", "van", "pickup"],
                tyres: str | None = None, front_share_percent: float | None = None,
                mount: Literal["holder", "fixed"] = "holder") -> None:
    """Writes the file of a car, all parameters estimated from what its owner knows.

    Args:
        path: the file, whose name ends in .toml; the car is called like it.
        mass_kg: kerb mass as in the registration papers, plus a usual load.
        wheelbase_m: distance between the axles.
        body: kind of car.
        tyres: size as on the tyre, such as ``"205/55R16"``.
        front_share_percent: share of the mass on the front axle; by default usual for the body.
        mount: of the sensor: in the holder of a phone, or screwed or taped to the car.

    Raises:
        UsageError: a value is out of its range.
    """
    run("vehicles", ["add"], {
        "mass_kg": mass_kg, "wheelbase_m": wheelbase_m, "body": body, "tyres": tyres,
        "front_share_percent": front_share_percent, "mount": mount, "output": path})


def simulate_drive(profile: Profile, vehicle: PathLike, *, step_m: float | None = None,
                   speed_mps: float = 20, rate_hz: float = 100, noise_mps2: float = 0.03,
                   noise_radps: float = 0.001, friction_n: float = 40, seed: int = 1) -> Table:
    """Simulates what a car's inertial sensor reads on a measured profile at constant speed.

    The model (two axles, four wheels, friction, tyres) has none of the estimator's code.

    Args:
        profile, step_m: as for ``iri``, with even stations: tracks named left and right, or one
            track under all wheels.
        vehicle: a built-in model with axles or a TOML file.
        speed_mps: 1 to 60.
        rate_hz: samples a second.
        noise_mps2, noise_radps: standard deviation of a sample.
        friction_n: Coulomb friction in each suspension, if the vehicle states none.
        seed: of the noise and of the tyres.

    Returns:
        Columns of a trip log, which ``trace`` takes: ``t_s``, ``acc_x_mps2``, ``acc_y_mps2``,
        ``acc_z_mps2``, ``gyro_x_radps``, ``gyro_y_radps``, ``gyro_z_radps``, ``speed_mps``. At time
        0 the centre of gravity is over the first station.

    Raises:
        InputError: the profile has uneven stations or other tracks, the vehicle has no axles, or a
            parameter is out of its range.
    """
    name, tracks, stations = _profile(profile, step_m)
    numbers = {"speed_mps": speed_mps, "rate_hz": rate_hz, "noise_mps2": noise_mps2,
               "noise_radps": noise_radps, "friction_n": friction_n, "seed": seed}
    options = {"vehicle": vehicle}
    try:
        columns, units = _macadam.simulate(words_of(options), name, tracks, stations, step_m, numbers)
    except _macadam.UsageError as error:
        raise in_python_words(error, options) from None
    return Table(columns, units)
