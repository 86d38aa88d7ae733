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
NAMED = 10  # lines whose faults are said


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
    """Return the motions that motions.csv of a folder lists; None without that file. Raises RecordError, all faults."""
    file = folder / FILE
    if not file.is_file():
        return None
    try:
        text = decode_text(read_file(file, LARGEST))
    except (OSError, RecordError) as error:
        raise RecordError(f"{FILE}: {getattr(error, 'strerror', None) or error}") from None
    lines = [line for line in text.splitlines() if line.strip()]
    if not lines:
        raise RecordError(f"{FILE}: empty: must have the columns {', '.join(COLUMNS)}")
    mark = next((mark for mark in "\t;," if mark in lines[0]), ",")
    rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=mark)]
    heads = [head.lower() for head in rows[0]]
    twice = any(heads.count(head) > 1 for head in heads if head)
    if "name" not in heads or "x" not in heads or twice or not set(heads) <= {*COLUMNS, MAGNITUDE, ""}:
        rule = f"must have the columns {', '.join(COLUMNS)}, each once, and may have {MAGNITUDE}"
        raise RecordError(f"{FILE}: line 1: {brief(lines[0])}: {rule}")
    if not rows[1:]:
        raise RecordError(f"{FILE}: no motions: must have a line for each")
    motions: dict[str, Motion] = {}
    faults = []
    for number, row in enumerate(rows[1:], 2):
        try:
            if any(row[len(heads) :]):
                raise RecordError(f"{len(row)} cells, and {len(heads)} columns: a decimal comma needs quotes")
            motion = _motion(dict(zip(heads, row)), folder)
            if motion.name in motions:
                raise RecordError(f"{brief(motion.name)}: two motions have one name")
            motions[motion.name] = motion
        except RecordError as error:
            faults.append(f"line {number}: {error}")
    if faults:
        more = f"; also {len(faults) - NAMED} more lines" if len(faults) > NAMED else ""
        raise RecordError(f"{FILE}: {'; also '.join(faults[:NAMED])}{more}")
    return MotionList(tuple(motions.values()), listed=True)


def _motion(row: Mapping[str, str], folder: Path) -> Motion:
    """One line of the file. Raises RecordError."""
    files = {axis: folder / row[axis] for axis in AXES if row.get(axis)}
    if not row.get("name") or not files:
        raise RecordError("must have a name, and a file along x, y or z")
    for file in files.values():
        if not _is_file(file):
            raise RecordError(f"{brief(file.name)}: no such file in the folder")
    factor = _number(row, "factor", MAX_FACTOR) or 1.0
    magnitude = _number(row, MAGNITUDE, MAX_MAGNITUDE)
    return Motion(row["name"], {"": files["x"]} if list(files) == ["x"] else files, factor, magnitude)


def _is_file(file: Path) -> bool:
    try:
        return file.is_file()
    except (OSError, ValueError):  # too long a name, or no name
        return False


def _number(row: Mapping[str, str], name: str, most: float) -> float | None:
    """A number of a line, None where it has none. Raises RecordError."""
    text = (row.get(name) or "").replace(",", ".")
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < abs(value) <= most:
        raise RecordError(f"{name} = {brief(text)}: must be a number up to {most:g}, not 0")
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
