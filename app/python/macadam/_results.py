"""Runs commands of the program within this process, and hands on their results."""

from __future__ import annotations

import logging
import os
import re
import warnings
from collections import abc
from datetime import date
from typing import Any, Union

import numpy as np

from . import _macadam

PathLike = Union[str, "os.PathLike[str]"]
Array = np.ndarray[Any, np.dtype[Any]]

_log = logging.getLogger("macadam")

# Options of the program whose parameters here have a unit in their names, or another name.
_OPTIONS = {
    "above_mm_per_m": "--above",
    "class_name": "--class",
    "continuous_m": "--continuous",
    "exclude_radius_m": "--exclude-radius",
    "front_share_percent": "--front-share",
    "heading_deg": "--heading",
    "length_m": "--length",
    "mass_kg": "--mass",
    "min_length_m": "--min-length",
    "radius_m": "--radius",
    "rate_hz": "--rate",
    "step_m": "--step",
    "unit": "--units",
    "wheelbase_m": "--wheelbase",
}


class DataWarning(UserWarning):
    """What the program would warn of: doubtful input, or a result of little weight."""


class Table(dict[str, Array]):
    """Columns of rows: a NumPy array for each name, all of one length.

    Numbers are float64 with NaN where unknown, whole numbers int64 and truths bool (masked arrays
    where some are unknown), days datetime64[D] with NaT, and text, lists and geometries arrays of
    objects with None. Pandas takes it as it is: ``pandas.DataFrame(table)``.

    Attributes:
        units: unit by column, such as ``{"iri": "mm/m", "from_m": "m"}``.
        details: what holds for the whole table, such as the method of ``iri``.
    """

    def __init__(self, columns: abc.Mapping[str, Array] = {}, units: abc.Mapping[str, str] = {},
                 details: abc.Mapping[str, Any] = {}) -> None:
        super().__init__(columns)
        self.units: dict[str, str] = dict(units)
        self.details: dict[str, Any] = dict(details)

    def __len__(self) -> int:
        """Number of columns, as of any dict; rows are counted by ``table.rows``."""
        return super().__len__()

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.values()))) if self else 0

    def __repr__(self) -> str:
        return f"<macadam.Table of {self.rows} rows: {', '.join(self)}>"


def words_of(options: abc.Mapping[str, Any]) -> list[str]:
    """Words of a command line; options that are None or False are left out."""
    words: list[str] = []
    for name, value in options.items():
        option = _OPTIONS.get(name, "--" + name.replace("_", "-"))
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif name == "route":
            words += [option, *(_text(place) for place in value)]
        else:
            words.append(f"{option}={_text(value)}")
    return words


def operand(path: PathLike) -> str:
    """A path that is not taken for an option."""
    text = os.fspath(path)
    return "./" + text if text.startswith("-") else text


def _text(value: Any) -> str:
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, date):
        return value.isoformat()[:10]
    if isinstance(value, np.datetime64):
        return str(value.astype("datetime64[D]"))
    if isinstance(value, (abc.Sequence, np.ndarray)):
        return ",".join(_text(one) for one in value)
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return str(value)


def in_python_words(error: _macadam.UsageError, options: abc.Iterable[str]) -> _macadam.UsageError:
    """The same error with the names of parameters instead of those of options."""
    text = str(error)
    for name in options:
        option = _OPTIONS.get(name, "--" + name.replace("_", "-"))
        text = re.sub(re.escape(option) + r"(?![\w-])", name, text)
    return _macadam.UsageError(text)


class Result:
    """Result of a command: a table, or text."""

    def __init__(self, table: Table | None, features: list[str], text: str) -> None:
        self._table = table
        self.features = features
        self.text = text

    @property
    def table(self) -> Table:
        assert self._table is not None, "the command writes rows"
        return self._table


def run(command: str, operands: abc.Sequence[str], options: abc.Mapping[str, Any], *,
        with_features: bool = False) -> Result:
    """Runs a command. Warnings become ``DataWarning``, other messages go to the log "macadam"."""
    try:
        rows, text, messages = _macadam.run_command(command, [*words_of(options), *operands],
                                                    with_features)
    except _macadam.UsageError as error:
        raise in_python_words(error, options) from None
    for is_warning, words in messages:
        if is_warning:
            warnings.warn(words, DataWarning, stacklevel=3)
        else:
            _log.info("%s", words)
    if rows is None:
        return Result(None, [], text)
    columns, units, features = rows
    return Result(Table(columns, units), features, text)


def run_table(command: str, operands: abc.Sequence[str], options: abc.Mapping[str, Any], *,
              geometry: bool = False) -> Table:
    """Runs a command that writes rows; with ``geometry``, they have a column of that name."""
    result = run(command, operands, {**options, "json": True}, with_features=geometry)
    if geometry:
        import json

        shapes = np.empty(len(result.features), dtype=object)
        for i, feature in enumerate(result.features):
            shapes[i] = json.loads(feature)["geometry"]
        result.table["geometry"] = shapes
    return result.table
