"""The file motions.csv of a folder: the motions of a suite, their files by direction, and their factors."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from reference.records.numerals import decode_text
from reference.records.samples import AXES, RecordError
from reference.support.arguments import brief
from reference.support.files import read_file
from reference.support.scene_error import one_line

FILE = "motions.csv"
COLUMNS = ("name", *AXES, "factor")
MAGNITUDE = "magnitude"  # column that a list may have, too
LARGEST = 2**20  # bytes
MAX_FACTOR = 1e6
MAX_MAGNITUDE = 10.0


@dataclass(frozen=True)
class Motion:
    """
    One motion of a suite: its name, its files by axis, "" where one file holds all directions, and its factor.

    magnitude: of the earthquake, None where the list does not state it.
    """

    name: str
    files: Mapping[str, Path]
    factor: float = 1.0
    magnitude: float | None = None


@dataclass(frozen=True)
class MotionList:
    """The motions of a folder in their order, and how many other files of which kind it has."""

    motions: tuple[Motion, ...]
    ignored: Mapping[str, int] = field(default_factory=dict)
    listed: bool = False  # in motions.csv

    @property
    def sentence(self) -> str:
        """Return the content of the folder in words, with an example of how components were paired."""
        first = self.motions[0].files
        how = f"as {FILE} lists them" if self.listed else "" if "" in first else "paired by name"
        if not self.listed and list(first) == ["x"]:
            how = "one component each"
        example = ", ".join(f"{axis} = {one_line(file.name)}" for axis, file in first.items() if axis)
        upright = sum("z" in motion.files for motion in self.motions)
        parts = [
            f"{len(self.motions)} motions",
            *([how] if how else []),
            *([f"{upright} with a vertical one"] if "y" in first else []),
        ]
        others = ", ".join(f"{count} {kind}" for kind, count in self.ignored.items())
        return (
            ", ".join(parts)
            + (f": {example}{', and so on' if len(self.motions) > 1 else ''}" if example else "")
            + (f". Ignored: {others}." if others else ".")
        )


def read_motion_list(folder: Path) -> MotionList | None:
    """Return the motions that motions.csv of a folder lists; None without that file. Raises RecordError, OSError."""
    file = folder / FILE
    if not file.is_file():
        return None
    text = decode_text(read_file(file, LARGEST))
    lines = [line for line in text.splitlines() if line.strip()]
    if not lines:
        raise RecordError(f"{FILE}: empty: must have the columns {', '.join(COLUMNS)}")
    mark = next((mark for mark in "\t;," if mark in lines[0]), ",")
    rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=mark)]
    heads = [head.lower() for head in rows[0]]
    if "name" not in heads or "x" not in heads or not set(heads) <= {*COLUMNS, MAGNITUDE, ""}:
        rule = f"must have the columns {', '.join(COLUMNS)}, and may have {MAGNITUDE}"
        raise RecordError(f"{FILE}: line 1: {brief(lines[0])}: {rule}")
    motions = [_motion(number, dict(zip(heads, row)), folder) for number, row in enumerate(rows[1:], 2)]
    if not motions:
        raise RecordError(f"{FILE}: no motions: must have a line for each")
    names = [motion.name for motion in motions]
    for number, name in enumerate(names, 2):
        if names.index(name) != number - 2:
            raise RecordError(f"{FILE}: line {number}: {brief(name)}: two motions have one name")
    return MotionList(tuple(motions), listed=True)


def _motion(number: int, row: Mapping[str, str], folder: Path) -> Motion:
    """One line of the file. Raises RecordError."""
    files = {axis: folder / row[axis] for axis in AXES if row.get(axis)}
    if not row.get("name") or not files:
        raise RecordError(f"{FILE}: line {number}: must have a name, and a file along x, y or z")
    for file in files.values():
        if not file.is_file():
            raise RecordError(f"{FILE}: line {number}: {brief(file.name)}: no such file in the folder")
    factor = _number(number, row, "factor", MAX_FACTOR) or 1.0
    magnitude = _number(number, row, MAGNITUDE, MAX_MAGNITUDE)
    return Motion(row["name"], {"": files["x"]} if list(files) == ["x"] else files, factor, magnitude)


def _number(number: int, row: Mapping[str, str], name: str, most: float) -> float | None:
    """A number of a line, None where it has none. Raises RecordError."""
    text = (row.get(name) or "").replace(",", ".")
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < abs(value) <= most:
        raise RecordError(f"{FILE}: line {number}: {name} = {brief(text)}: must be a number up to {most:g}, not 0")
    return value


def motion_list_text(motions: Iterable[Motion]) -> str:
    """Return motions.csv with these motions: a file that holds all directions stands under x."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    for motion in motions:
        names = {axis or "x": file.name for axis, file in motion.files.items()}
        writer.writerow([motion.name, *(names.get(axis, "") for axis in AXES), f"{motion.factor:g}"])
    return stream.getvalue()
