"""
Recorded accelerograms: CSV, all directions in one file, and PEER NGA .AT2, one direction per file.

Both, and arrays, end as samples (K, 4): time from the first sample on, s, and acceleration along x, y, z, m/s^2, zero
along a direction that was not recorded. `excitation.py` defines the motion between samples.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference.support.arguments import brief, check_array
from reference.support.constants import GRAVITY

Array = NDArray[np.float64]

AXES = ("x", "y", "z")
COLUMNS = ("time", "ax", "ay", "az")
UNITS = {"m/s^2": 1.0, "m/s2": 1.0, "m/s²": 1.0, "m/s/s": 1.0, "g": GRAVITY, "cm/s^2": 0.01, "cm/s2": 0.01}
UNITS |= {"cm/s²": 0.01, "gal": 0.01}

LARGEST = 2**24  # bytes of the largest file: half an hour at 200 Hz along three directions
MAX_LINE, MAX_CELL = 1000, 100  # letters of a line of the header, and of a number
COLUMN = re.compile(r"(\w+) ?(?:[\[(]([^\[(\])]*)[\])])?")
HEADER = "a header such as time [s], ax [m/s^2], ay [m/s^2]"
MAX_HEADER_LINES = 20
UNIT_LINE = re.compile(r"\bUNITS\b", re.IGNORECASE)
UNIT_OF_G = re.compile(r"UNITS ?(?:OF|ARE|:|=)? ?(?:G|\(G\)|\[G\]) ?(?:\.(?: .*)?)?", re.IGNORECASE)
NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:e[+-]?[0-9]+)?", re.IGNORECASE | re.ASCII)
NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE | re.ASCII)
PLAIN = {*"0123456789+-.eE \t"}
MAX_COUNT_DIGITS = 9  # digits of NPTS
MAX_ACCELERATION = 1e300  # finite in any unit
MIN_INTERVAL = 1e-9  # s, between samples
ACCELERATIONS = "(K,) along x, (K, 2) along x and y or (K, 3), m/s^2"
STEP_MISMATCH = 1e-6  # relative: DT is printed with four to six digits


class RecordError(ValueError):
    """Contents that are no record: one line with the place in it, what stands there, and the rule."""


@lru_cache(maxsize=32)  # a family whose other keys run reads its record once
def read_csv_samples(text: str) -> Array:
    """Return samples (K, 4) of a CSV file: time and some of ax, ay, az with their units. Raises RecordError."""
    lines = ((number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip())
    rows = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if not rows:
        raise RecordError(f"empty: must have {HEADER}, and samples")
    head, header = rows[0]
    columns = _parse_columns(head, _split_cells(head, header))
    names = [name for name, _ in columns]
    for name in names:
        if names.count(name) > 1:
            raise RecordError(f"line {head}: column {name} is there twice")
    if "time" not in names or len(names) < 2:
        raise RecordError(f"line {head}: {brief(header.strip())}: must have time and at least one of ax, ay, az")
    samples = np.zeros((len(rows) - 1, 4))
    for row, (number, line) in enumerate(rows[1:]):
        cells = _split_cells(number, line)
        if len(cells) != len(columns):
            raise RecordError(f"line {number}: {len(cells)} values: the header names {len(columns)} columns")
        for (name, unit), cell in zip(columns, cells):
            samples[row, COLUMNS.index(name)] = unit * _parse_number(number, cell)
        if row and samples[row, 0] <= samples[row - 1, 0]:
            raise RecordError(f"line {number}: time {samples[row, 0]:g} s after {samples[row - 1, 0]:g} s: must rise")
    return _finish_samples(samples)


def read_at2_samples(texts: Mapping[str, str]) -> Array:
    """Return samples (K, 4) of PEER NGA .AT2 files of one DT, by the axis of each. Raises RecordError."""
    steps, values = {}, {}
    for axis, text in texts.items():
        steps[axis], values[axis] = _parse_at2(axis, text)
    for (first, step), (second, other) in pairwise(steps.items()):
        if abs(step - other) > STEP_MISMATCH * step:
            raise RecordError(f"DT = {step:g} s along {first} and {other:g} s along {second}: must be the same")
    samples = np.zeros((max(map(len, values.values())), 4))
    samples[:, 0] = next(iter(steps.values())) * np.arange(len(samples))
    for axis, column in values.items():
        samples[: len(column), 1 + AXES.index(axis)] = GRAVITY * column
    return _finish_samples(samples)


@lru_cache(maxsize=32)
def _parse_at2(axis: str, text: str) -> tuple[float, Array]:
    """Return DT, s, and the accelerations of one file, in g."""
    lines = text.splitlines()
    header = [" ".join(line[:MAX_LINE].split()) for line in lines[:MAX_HEADER_LINES]]
    counts = next(((row, sizes) for row, line in enumerate(header) if (sizes := _parse_counts(line))), None)
    if counts is None:
        raise RecordError(f"{axis}: the header must have a line 'NPTS= 1000, DT= .0100 SEC'")
    last, (count, step) = counts
    while last + 1 < len(header) and not _begins_with_a_number(header[last + 1]):
        last += 1
    _check_unit(axis, header[: last + 1])
    whole = count.isascii() and count.isdecimal() and len(count) <= MAX_COUNT_DIGITS
    if not (whole and int(count) > 0):
        rule = f"must be a whole number greater than 0 of at most {MAX_COUNT_DIGITS} digits"
        raise RecordError(f"{axis}: NPTS = {brief(count)}: {rule}")
    spacing = _parse_number(counts[0] + 1, step)
    if spacing <= 0.0:
        raise RecordError(f"{axis}: DT = {step} s: must be greater than 0")
    values = _parse_plain_numbers(lines[last + 1 :])
    if values is None:
        try:
            values = [
                _parse_number(number, cell)
                for number, line in enumerate(lines[last + 1 :], last + 2)
                for cell in line.split()
            ]
        except RecordError as error:
            raise RecordError(f"{axis}: {error}") from None
    if len(values) != int(count):
        raise RecordError(f"{axis}: {len(values)} values: the header says NPTS = {count}")
    return spacing, np.array(values)


def _parse_plain_numbers(lines: list[str]) -> list[float] | None:
    """Return the numbers of lines that have nothing else, as of most files; None where each cell must be parsed."""
    text = " ".join(lines)
    cells = text.split()
    if not set(text) <= PLAIN or max(map(len, cells), default=0) > MAX_CELL:
        return None
    try:
        values = list(map(float, cells))
    except ValueError:
        return None
    return values if max(map(abs, values), default=0.0) <= MAX_ACCELERATION else None


def _check_unit(axis: str, header: list[str]) -> None:
    """Raise RecordError unless the header names g as the unit, and no other."""
    lines = [line for line in header if UNIT_LINE.search(line)]
    for line in lines or [""]:
        at = UNIT_LINE.search(line)
        if at is None or not UNIT_OF_G.fullmatch(line[at.start() :]):
            quoted = f": {brief(line)}" if line else ""
            raise RecordError(f"{axis}: the header names no unit that is known{quoted}: must say 'IN UNITS OF G'")


def _parse_counts(line: str) -> tuple[str, str] | None:
    """Return NPTS and DT of 'NPTS= 1000, DT= .0100 SEC' or '1000 .0100 NPTS, DT', if the line is one of them."""
    words = line.replace(",", " ").replace("=", " = ").split()
    names = [word.upper() for word in words]
    at = names.index("NPTS") if "NPTS" in names else len(names)
    match names[at : at + 6]:
        case ["NPTS", "=", _, "DT", "=", _]:
            return words[at + 2], words[at + 5]
        case ["NPTS", "DT", *_] if at >= 2:
            return words[at - 2], words[at - 1]
    return None


def _begins_with_a_number(line: str) -> bool:
    first = line.split()[:1]
    return bool(first) and bool(NUMBER.fullmatch(first[0]) or NOT_FINITE.fullmatch(first[0]))


def _split_cells(number: int, line: str) -> list[str]:
    if len(line) > MAX_LINE:
        raise RecordError(f"line {number}: {len(line)} letters: must be at most {MAX_LINE}")
    try:
        return [cell.strip() for cell in next(csv.reader(io.StringIO(line)))]
    except csv.Error as error:
        raise RecordError(f"line {number}: {error}") from None


def _parse_columns(line: int, cells: list[str]) -> list[tuple[str, float]]:
    """Return names and SI units of the columns. A line without any valid column is no header, and not quoted."""
    columns, errors = [], []
    for cell in cells:
        try:
            columns.append(_parse_column(line, " ".join(cell.split())))
        except RecordError as error:
            errors.append(error)
    if errors:
        raise errors[0] if columns else RecordError(f"line {line}: must be {HEADER}")
    return columns


def _parse_column(line: int, cell: str) -> tuple[str, float]:
    match = COLUMN.fullmatch(cell)
    if match is None or match[1].lower() not in COLUMNS:
        raise RecordError(f"line {line}: column {brief(cell)}: must be one of time, ax, ay, az with its unit")
    name, unit = match[1].lower(), (match[2] or "").strip()
    units = {"s": 1.0} if name == "time" else UNITS
    allowed = "time [s]" if name == "time" else f"{name} [m/s^2], {name} [g] or {name} [cm/s^2]"
    if unit.lower() not in units:
        quoted = f"unknown unit {brief(unit)}" if unit else "no unit"
        raise RecordError(f"line {line}: column {brief(cell)}: {quoted}: write {allowed}")
    return name, units[unit.lower()]


def _parse_number(line: int, cell: str) -> float:
    if NOT_FINITE.fullmatch(cell):
        raise RecordError(f"line {line}: {cell}: must be finite")
    if len(cell) > MAX_CELL or not NUMBER.fullmatch(cell):
        raise RecordError(f"line {line}: {brief(cell)}: must be a number of at most {MAX_CELL} letters")
    value = float(cell)
    if abs(value) > MAX_ACCELERATION:
        raise RecordError(f"line {line}: {brief(cell)}: must be finite, at most {MAX_ACCELERATION:g} in size")
    return value


def samples_of_arrays(time: Any, acceleration: Any) -> Array:
    """Return samples (K, 4) of times (K,), s, and accelerations along one to three axes, m/s^2. Raises RecordError."""
    instants = _check_numbers("time", time, "(K,), s")
    values = _check_numbers("acceleration", acceleration, ACCELERATIONS)
    columns = values[:, None] if values.ndim == 1 else values
    if instants.ndim != 1:
        raise RecordError(f"time: shape {instants.shape}: must be (K,), s")
    if columns.ndim != 2 or len(columns) != len(instants) or not 1 <= columns.shape[1] <= 3:
        raise RecordError(f"acceleration: shape {values.shape} at {len(instants)} instants: must be {ACCELERATIONS}")
    samples = np.zeros((len(instants), 4))
    samples[:, 0], samples[:, 1 : 1 + columns.shape[1]] = instants, columns
    return _finish_samples(samples)


def check_samples(samples: Any) -> Array:
    """Return read-only samples (K, 4) whose time counts from the first. Raises RecordError."""
    array = np.array(_check_numbers("samples", samples, "(K, 4)"))
    if array.ndim != 2 or array.shape[1] != 4:
        raise RecordError(f"samples: shape {array.shape}: must be (K, 4): s and m/s^2 along x, y, z")
    return _finish_samples(array)


def _check_numbers(name: str, values: Any, shape: str) -> Array:
    try:
        array = check_array(name, values, f"must be {shape}")
    except ValueError as error:
        raise RecordError(str(error)) from None
    if np.abs(array).max(initial=0.0) > MAX_ACCELERATION:
        raise RecordError(f"{name}: must be at most {MAX_ACCELERATION:g} in size")
    return array


def _finish_samples(samples: Array) -> Array:
    """Return the samples with the first at 0 s, read-only."""
    if len(samples) < 2:
        raise RecordError(f"{len(samples)} samples: must have at least 2")
    samples[:, 0] -= samples[0, 0]
    shortest = float(np.diff(samples[:, 0]).min())
    if shortest < MIN_INTERVAL:
        raise RecordError(f"{shortest:g} s from sample to sample: must be at least {MIN_INTERVAL:g} s")
    samples.setflags(write=False)
    return samples
