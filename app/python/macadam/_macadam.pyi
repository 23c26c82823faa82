from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

__version__: str

class Error(Exception): ...
class InputError(Error): ...
class UsageError(Error, ValueError): ...

_Array = np.ndarray[Any, np.dtype[Any]]

def run_command(
    name: str, words: Sequence[str], with_features: bool = ...
) -> tuple[
    tuple[dict[str, _Array], dict[str, str], list[str]] | None, str, list[tuple[bool, str]]
]: ...
def iri(
    words: Sequence[str],
    tracks: Sequence[tuple[str, npt.ArrayLike]] = ...,
    stations: npt.ArrayLike | None = ...,
) -> tuple[dict[str, _Array], dict[str, str], dict[str, Any]]: ...
def simulate(
    words: Sequence[str],
    profile: str,
    tracks: Sequence[tuple[str, npt.ArrayLike]],
    stations: npt.ArrayLike | None,
    step_m: float | None,
    numbers: Mapping[str, float],
) -> tuple[dict[str, _Array], dict[str, str]]: ...
def check_database(path: str) -> None: ...
