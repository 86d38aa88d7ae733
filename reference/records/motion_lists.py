"""The file motions.csv of a folder, which lists the motions of a suite, their files by direction, and their factors."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from reference.records.numerals import decode_text
from reference.records.samples import AXES, RecordError
from reference.support.arguments import name_some, quote
from reference.support.files import read_file
from reference.support.scene_error import one_line

FILE_NAME = "motions.csv"  # name of the file that lists the motions of a folder
COLUMNS = ("name", *AXES, "factor")  # columns of motions.csv
OPTION_COLUMNS = ("step", "unit", "skip", "column")  # optional columns with options of plain texts
MAGNITUDE_COLUMN = "magnitude"  # optional column with the magnitude of the earthquake
MAX_BYTES = 2**20  # largest size of motions.csv, bytes
MAX_NAMED_FILES = 3  # largest number of ignored files of a kind that a sentence names
MAX_FACTOR = 1e6  # largest scale factor of a motion
MAX_STEP = 1e3  # s, largest sampling interval of a plain text
MAX_NUMBER = 10_000  # largest number of lines to skip, and largest number of a column
MAX_MAGNITUDE = 10.0  # largest magnitude of an earthquake
MAX_LISTED_FAULTS = 10  # largest number of lines whose faults an error lists


@dataclass(frozen=True)
class Motion:
    """
    One motion of a suite.

    files: by axis; "" stands for one file with all directions. factor: scale factor of the accelerations. magnitude: of
    the earthquake, None if it is not stated. options: step, unit, skip and column of plain texts, by axis. line: number
    of its line in motions.csv, 0 if no line lists it. folder: of motions.csv.
    """

    name: str
    files: Mapping[str, Path]
    factor: float = 1.0
    magnitude: float | None = None
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    line: int = field(default=0, compare=False)
    folder: Path | None = field(default=None, compare=False)


@dataclass(frozen=True)
class MotionList:
    """
    Motions of a folder in their order, and its other files, which are ignored.

    ignored: number of ignored files of each kind, such as "texts". names: names of those that may be meant as records,
    by kind. proposal: sentence on what to write so that one of them is read. listed: True if motions.csv lists the
    motions.
    """

    motions: tuple[Motion, ...]
    ignored: Mapping[str, int] = field(default_factory=dict)
    names: Mapping[str, Sequence[str]] = field(default_factory=dict)
    proposal: str = ""
    listed: bool = False

    @property
    def sentence(self) -> str:
        """Return a sentence on the content of the folder, with an example of how components were paired."""
        first = self.motions[0].files
        how = f"as {FILE_NAME} lists them" if self.listed else "" if "" in first else "paired by name"
        if list(first) == ["x"]:
            how = "one component each"
        example = ", ".join(f"{axis} = {one_line(file.name)}" for axis, file in first.items() if axis)
        upright = sum("z" in motion.files for motion in self.motions)
        parts = [
            f"{len(self.motions)} motion{'' if len(self.motions) == 1 else 's'}",
            *([how] if how else []),
            *([f"{upright} with a vertical one"] if "y" in first else []),
        ]
        others = ", ".join(f"{self._count_ignored(kind)}{self._list_ignored_names(kind)}" for kind in self.ignored)
        return (
            ", ".join(parts)
            + (f": {example}{', and so on' if len(self.motions) > 1 else ''}" if example else "")
            + (f". Ignored: {others}." if others else ".")
            + (f" {self.proposal}" if self.proposal else "")
        )

    def _count_ignored(self, kind: str) -> str:
        """Return the number of ignored files of a kind, in words."""
        return f"1 {kind.removesuffix('s')}" if self.ignored[kind] == 1 else f"{self.ignored[kind]} {kind}"

    def _list_ignored_names(self, kind: str) -> str:
        """Return the names of ignored files of a kind in brackets, or ""."""
        names = [one_line(name) for name in self.names.get(kind, ())]
        return f" ({name_some(names, MAX_NAMED_FILES)})" if names else ""


def read_motion_list(folder: Path) -> MotionList | None:
    """Return the motions that motions.csv of a folder lists; None without it. Raises RecordError with all faults."""
    file = folder / FILE_NAME
    if not os.path.isfile(file):
        return None
    try:
        text = decode_text(read_file(file, MAX_BYTES))
    except (OSError, RecordError) as error:
        raise RecordError(f"{FILE_NAME}: {getattr(error, 'strerror', None) or error}") from None
    heads, rows = _split_cells(text)
    motions: dict[str, Motion] = {}
    faults = []
    for number, row in rows:
        try:
            if any(row[len(heads) :]):
                raise RecordError(f"{len(row)} cells, and {len(heads)} columns: a decimal comma needs quotes")
            motion = replace(_read_motion(dict(zip(heads, row)), folder), line=number, folder=folder)
            if motion.name in motions:
                raise RecordError(f"{quote(motion.name)}: two motions have one name")
            motions[motion.name] = motion
        except RecordError as error:
            faults.append(f"line {number}: {error}")
    if faults:
        left = len(faults) - MAX_LISTED_FAULTS
        more = f"; also {left} more line{'' if left == 1 else 's'}" if left > 0 else ""
        raise RecordError(f"{FILE_NAME}: {'; also '.join(faults[:MAX_LISTED_FAULTS])}{more}")
    return MotionList(tuple(motions.values()), listed=True)


def _split_cells(text: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Return the column names in lower case, and (line number, cells) of every other line. Raises RecordError."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    reader = csv.reader(text.splitlines(), delimiter=next((mark for mark in "\t;," if mark in first), ","))
    rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if any(map(str.strip, row))]
    if not rows:
        raise RecordError(f"{FILE_NAME}: empty: must have the columns {', '.join(COLUMNS)}")
    number, heads = rows[0][0], [head.lower() for head in rows[0][1]]
    twice = any(heads.count(head) > 1 for head in heads if head)
    if (
        "name" not in heads
        or "x" not in heads
        or twice
        or not set(heads) <= {*COLUMNS, *OPTION_COLUMNS, MAGNITUDE_COLUMN, ""}
    ):
        optional = ", ".join((*OPTION_COLUMNS, MAGNITUDE_COLUMN))
        rule = f"must have the columns {', '.join(COLUMNS)}, each once, and may have {optional}"
        raise RecordError(f"{FILE_NAME}: line {number}: {quote(first)}: {rule}")
    if not rows[1:]:
        raise RecordError(f"{FILE_NAME}: no motions: must have a line for each")
    return heads, rows[1:]


def _read_motion(row: Mapping[str, str], folder: Path) -> Motion:
    """Return the motion in one line of the file, whose cells are given by column. Raises RecordError."""
    columns = [_whole_number("column", word) for word in (row.get("column") or "").split()]
    files = _find_files(row, folder, columns)
    stated = {"step": _number(row, "step", MAX_STEP), "unit": row.get("unit") or None}
    stated["skip"] = _whole_number("skip", row["skip"]) if row.get("skip") else None
    axes = [""] if list(files) == ["x"] else list(files)
    options: dict[str, Any] = {axis: {key: part for key, part in stated.items() if part is not None} for axis in axes}
    for place, axis in enumerate(axes if columns else ()):
        options[axis]["column"] = columns[min(place, len(columns) - 1)]
    factor, magnitude = _number(row, "factor", MAX_FACTOR) or 1.0, _number(row, MAGNITUDE_COLUMN, MAX_MAGNITUDE)
    known = {axis: given for axis, given in options.items() if given}
    paths = dict(zip(axes, files.values()))
    return Motion(name=row["name"], files=paths, factor=factor, magnitude=magnitude, options=known)


def _find_files(row: Mapping[str, str], folder: Path, columns: Sequence[int]) -> dict[str, Path]:
    """
    Return the files of the motion in one line of the list by axis. Raises RecordError.

    columns: numbers in the line's cell "column". Several numbers of a single file are its columns along x, y and z.
    """
    files = {axis: folder / row[axis] for axis in AXES if row.get(axis)}
    if not row.get("name") or not files:
        raise RecordError("must have a name, and a file along x, y or z")
    if list(files) == ["x"] and len(columns) > 1:
        files = dict.fromkeys(AXES[: len(columns)], files["x"])
    if len(columns) > 1 and len(columns) != len(files):
        rule = f"must be one column, or one for each of {', '.join(files)}"
        raise RecordError(f"column = {quote(row['column'])}: {rule}")
    for file in files.values():
        if not os.path.isfile(file):
            raise RecordError(f"{quote(file.name)}: no such file in the folder")
    return files


def _whole_number(name: str, text: str) -> int:
    """Return the whole number up to MAX_NUMBER that a cell states; name: its column. Raises RecordError."""
    if not (text.isascii() and text.isdigit() and len(text) < 10 and int(text) <= MAX_NUMBER):
        raise RecordError(f"{name} = {quote(text)}: must be a whole number up to {MAX_NUMBER}")
    return int(text)


def _number(row: Mapping[str, str], name: str, most: float) -> float | None:
    """Return the number in column `name` of a line, at most `most`; None for an empty cell. Raises RecordError."""
    text = (row.get(name) or "").replace(",", ".")
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < abs(value) <= most:
        raise RecordError(f"{name} = {quote(text)}: must be a number up to {most:g}, not 0")
    return value


def _name_in_list(file: Path, folder: Path | None) -> str:
    """Return the path of a file as motions.csv in `folder` states it, relative if inside; its name without a folder."""
    if folder is None:
        return file.name
    return str(file.relative_to(folder) if file.is_relative_to(folder) else file)


def motion_list_text(motions: Iterable[Motion]) -> str:
    """
    Return the text of motions.csv with these motions; a file with all directions is listed under x.

    Raises RecordError for a name that a line of the list cannot hold.
    """
    motions = list(motions)
    stating, rated = any(motion.options for motion in motions), any(motion.magnitude is not None for motion in motions)
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([*COLUMNS, *OPTION_COLUMNS * stating, *[MAGNITUDE_COLUMN] * rated])
    for motion in motions:
        names = {axis or "x": _name_in_list(file, motion.folder) for axis, file in motion.files.items()}
        for name in (motion.name, *names.values()):
            if not name.isprintable() or name != name.strip():
                rule = f"{FILE_NAME} lists printable names without blanks at their ends: rename the file"
                raise RecordError(f"{quote(name)}: {rule}")
        row = [motion.name, *(names.get(axis, "") for axis in AXES), f"{motion.factor:.12g}"]
        stated = next(iter(motion.options.values()), {})
        columns = [str(each["column"]) for each in motion.options.values() if "column" in each]
        columns = columns[:1] if len({*columns}) == 1 else columns
        step = f"{stated['step']:.12g}" if "step" in stated else ""
        row += [step, str(stated.get("unit", "")), str(stated.get("skip", "")), " ".join(columns)] if stating else []
        row += ["" if motion.magnitude is None else f"{motion.magnitude:.12g}"] if rated else []
        writer.writerow(row)
    return stream.getvalue()
