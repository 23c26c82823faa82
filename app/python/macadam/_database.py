"""A road database, read."""

from __future__ import annotations

import json
import os
from collections import abc
from datetime import date
from pathlib import Path
from typing import Any, Literal, Union

import numpy as np

from . import _macadam
from ._results import PathLike, Table, operand, run, run_table

Day = Union[str, date, np.datetime64]

# Parameters of which the program wants one.
_SELECTING = {"near", "bbox", "way", "segment", "road", "highway", "class_name", "worst", "route",
              "along", "sections", "section_length", "homogeneous", "exclude"}


class Database:
    """A road database (.gpkg) that is read and never written; see ``macadam.open``.

    Each call sees the last commit, while others may import. Of a database of a crowd, whoever does
    not hold its key gets published values alone, as from the program.

    The selection of ``segments``, ``worst``, ``history`` and ``events``; conditions are combined:

        near: (lat, lon) in degrees; nearest first. radius_m: around it, 50 by default.
        heading_deg: with near, only this driving direction, within 45 degrees; clockwise from north.
        bbox: (west, south, east, north) in degrees.
        way: id of a way. segment: a key such as ``"123456+0007"``.
        road: part of a road's name; upper and lower case are the same.
        highway: class of OpenStreetMap, such as ``"residential"``.
        class_name: class of roughness, such as ``"poor"``.
        min_passes: only segments with at least so many passes.
        since, until: only passes of these days (``"2026-05-01"`` or a date), both included, which
            excludes undated passes from all values.

    Raises:
        InputError: the file was removed or replaced, or has no such segment.
        UsageError: a condition is not valid.
    """

    def __init__(self, path: PathLike) -> None:
        self._path = Path(path)
        _macadam.check_database(os.fspath(path))

    @property
    def path(self) -> Path:
        """The file."""
        return self._path

    def __repr__(self) -> str:
        return f"<macadam.Database {str(self._path)!r}>"

    def segments(
            self, *, near: abc.Sequence[float] | None = None, radius_m: float | None = None,
            heading_deg: float | None = None, bbox: abc.Sequence[float] | None = None,
            way: int | None = None, segment: str | None = None, road: str | None = None,
            highway: str | None = None, class_name: str | None = None,
            min_passes: int | None = None, since: Day | None = None, until: Day | None = None,
            all: bool = False, geometry: bool = False) -> Table:
        """Segments, about 20 m of one direction each, in the order of their keys.

        Args:
            all: also segments without a pass.
            geometry: add a column ``geometry`` of GeoJSON geometries (longitude first, degrees).

        Returns:
            ``segment``, ``way_id``, ``name``, ``highway``, ``direction``, ``from_m`` and ``to_m``
            along the way, ``iri`` in mm/m with ``iri_sd``, ``iri_low``, ``iri_high`` (90 %),
            ``class``, ``passes``, ``vehicles``, ``first_seen``, ``last_seen``, ``lat_deg`` and
            ``lon_deg`` of the middle, and more (docs/reference/exports.md).
        """
        return self._query(
            {"all": all}, geometry, near=near, radius_m=radius_m, heading_deg=heading_deg,
            bbox=bbox, way=way, segment=segment, road=road, highway=highway, class_name=class_name,
            min_passes=min_passes, since=since, until=until)

    def worst(
            self, count: int = 10, *, min_length_m: float | None = None,
            above_mm_per_m: float | None = None, single_segments: bool = False,
            near: abc.Sequence[float] | None = None, radius_m: float | None = None,
            heading_deg: float | None = None, bbox: abc.Sequence[float] | None = None,
            way: int | None = None, segment: str | None = None, road: str | None = None,
            highway: str | None = None, class_name: str | None = None,
            min_passes: int | None = None, since: Day | None = None, until: Day | None = None,
            geometry: bool = False) -> Table:
        """The roughest sections of road, roughest first.

        Args:
            count: how many, 1 or more.
            min_length_m: minimum length of a section, 100 by default.
            above_mm_per_m: roughness of which a section begins, 0 to 100; by default the lower
                limit of the class poor.
            single_segments: segments instead of sections, with the columns of ``segments``.

        Returns:
            ``rank``, ``name``, ``highway``, ``length_m``, ``iri``, ``iri_low``, ``iri_high`` and
            ``iri_worst`` in mm/m, ``passes_least``, ``passes_median``, and ``parts``: the intervals
            on ways, a list of dicts for each row.
        """
        return self._query({
            "worst": count, "min_length_m": min_length_m,
            "above_mm_per_m": above_mm_per_m, "segments": single_segments},
            geometry, near=near, radius_m=radius_m, heading_deg=heading_deg,
            bbox=bbox, way=way, segment=segment, road=road, highway=highway, class_name=class_name,
            min_passes=min_passes, since=since, until=until)

    def history(
            self, *, near: abc.Sequence[float] | None = None, radius_m: float | None = None,
            heading_deg: float | None = None, bbox: abc.Sequence[float] | None = None,
            way: int | None = None, segment: str | None = None, road: str | None = None,
            highway: str | None = None, class_name: str | None = None,
            min_passes: int | None = None, since: Day | None = None, until: Day | None = None
            ) -> Table:
        """Roughness of the selection month by month, each from the passes of that month alone.

        Returns:
            ``month`` ("2026-03"), ``segments``, ``length_m``, ``iri``, ``iri_sd``, ``iri_low``,
            ``iri_high``, ``iri_worst`` in mm/m, ``passes_least``, ``passes_median``, ``vehicles``.
        """
        return self._query(
            {"history": True}, False, near=near, radius_m=radius_m, heading_deg=heading_deg,
            bbox=bbox, way=way, segment=segment, road=road, highway=highway, class_name=class_name,
            min_passes=min_passes, since=since, until=until)

    def events(
            self, *, near: abc.Sequence[float] | None = None, radius_m: float | None = None,
            heading_deg: float | None = None, bbox: abc.Sequence[float] | None = None,
            way: int | None = None, segment: str | None = None, road: str | None = None,
            highway: str | None = None, class_name: str | None = None,
            min_passes: int | None = None, since: Day | None = None, until: Day | None = None,
            geometry: bool = False) -> Table:
        """Potholes, bumps, joints and rails on the selected segments (docs/method/events.md)."""
        return self._query(
            {"events": True}, geometry, near=near, radius_m=radius_m, heading_deg=heading_deg,
            bbox=bbox, way=way, segment=segment, road=road, highway=highway, class_name=class_name,
            min_passes=min_passes, since=since, until=until)

    def sections(self, sections: PathLike | None = None, *, along: PathLike | None = None,
                 route: abc.Sequence[abc.Sequence[float]] | None = None, shortest: bool = False,
                 length: float | str | None = None, homogeneous: bool = False,
                 exclude: PathLike | None = None, exclude_radius_m: float | None = None,
                 min_passes: int | None = None, since: Day | None = None,
                 until: Day | None = None, geometry: bool = False) -> Table:
        """Means over sections of road (docs/reference/sections.md).

        Args:
            sections: your own sections: a table or a layer of lines.
            along: a GPX track or a layer of lines to follow instead.
            route: two positions (lat, lon) in degrees: the fastest way by car between them.
            shortest: with route, the shortest way.
            length: length into which the roads are cut: metres, or text such as ``"0.1mi"``.
            homogeneous: cut where the roughness changes instead.
            exclude: places to leave out, such as bridges: a table or lines.

        Returns:
            ``section``, ``from_m``, ``to_m``, ``length_m``, ``measured_m``, ``iri``, ``iri_sd``,
            ``iri_low``, ``iri_high``, ``iri_worst`` in mm/m, ``class``, ``covered`` (0 to 1),
            ``parts`` and more.
        """
        return self._query({
            "sections": sections, "along": along, "route": route, "shortest": shortest,
            "section_length": length, "homogeneous": homogeneous, "exclude": exclude,
            "exclude_radius_m": exclude_radius_m}, geometry,
            min_passes=min_passes, since=since, until=until)

    def passes(self, segment: str) -> Table:
        """Passes over one segment: car, time, IRI in mm/m and its standard deviation, speed.

        Raises:
            InputError: the database is of a crowd, and this user is not its operator.
        """
        return self._query({"passes": True}, False, segment=segment)

    def changes(self, segment: str) -> Table:
        """When and why the value of one segment changed; of a crowd's database as ``passes``."""
        return self._query({"changes": True}, False, segment=segment)

    def info(self) -> dict[str, Any]:
        """Totals as ``macadam info --json`` has them: trips, passes, km, classes, cars, days."""
        info: dict[str, Any] = json.loads(run("info", [operand(self._path)], {"json": True}).text)
        return info

    def table(self, name: Literal["classes", "road-classes", "cars", "months", "days", "surveys",
                                  "control-sections"]) -> Table:
        """One of the tables of ``macadam info``."""
        return run_table("info", [operand(self._path)], {"table": name})

    def digest(self) -> str:
        """SHA-256 of the content, in hex digits; equal content has an equal digest anywhere."""
        return run("info", [operand(self._path)], {"digest": True}).text.strip()

    def _query(self, options: dict[str, Any], geometry: bool, **selection: Any) -> Table:
        given = {name for name, value in {**options, **selection}.items()
                 if value is not None and value is not False}
        if not given & _SELECTING:
            selection["bbox"] = (-180, -90, 180, 90)  # the program wants it said
        return run_table("query", [operand(self._path)], {**options, **selection},
                         geometry=geometry)


def open(path: PathLike) -> Database:
    """Opens a road database for reading.

    Args:
        path: a .gpkg file that ``macadam init`` made.

    Raises:
        InputError: there is no such file, it is no road database, or of another version.
    """
    return Database(path)
