"""
Tables with a header: CSV with commas, semicolons or tabs, of spreadsheets, programs and people.

One column is the time, s, others are accelerations with their unit and direction. Other columns are ignored and named.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from reference.records.directions import Direction, assign_axes, parse_direction
from reference.records.numerals import (
    MAX_CELL,
    MAX_LINE,
    UNIT_NAMES,
    WRITE_RECORD,
    parse_number,
    quote_name,
    unit_factor,
)
from reference.records.samples import AXES, RecordError, RecordSamples
from reference.support.arguments import quote

FORMAT = "CSV"
HEADER_EXAMPLE = "a header such as time [s], ax [m/s^2], ay [m/s^2]"  # words in error messages
MAX_PREAMBLE = 20  # largest number of lines above the header
# Names of the column of the time in a header, in several languages
TIME_NAMES = {"time", "times", "t", "sec", "seconds", "zeit", "temps", "tempo", "tiempo", "zaman", "時間", "時刻"}
SECOND_NAMES = {"", "s", "sec", "secs", "second", "seconds", "秒"}  # spellings of the unit of time
ACCELERATION_NAMES = {  # words in a header that name an acceleration
    "a",
    "acc",
    "accel",
    "acceleration",
    "accelerations",
    "accelerogram",
    "加速度",
    "ground",
    "motion",
}
ACCELERATION_NAMES |= {"component", "comp", "dir", "direction", "ag", "beschleunigung", "accélération", "accelerazione"}
ACCELERATION_NAMES |= {"aceleración", "aceleracion", "ivme"}
# Matches a column name that joins acceleration and direction, such as ax or accNS
ACCELERATION_WITH_AXIS = re.compile(r"(?:acceleration|accel|acc|a)(x|y|z|ns|ew|ud|h1|h2|v)", re.IGNORECASE)
TEXT_IN_BRACKETS = re.compile(r"(.*?) ?[\[(]([^\[(\])]*(?:\([^()]*\))?)[\])] ?(.*)")  # a name, its unit in brackets
# Matches a number with a decimal comma
DECIMAL_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:e[+-]?[0-9]+)?", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True)
class HeaderCell:
    """
    A cell of the header, which describes one column of the table.

    place: index of the column, from 0. text: the cell. kind: "time", "acceleration", "other" for a column that is not
    needed, or "wrong" for a column with a unit of acceleration whose name is not understood. word: name of the
    direction, "" if there is none. factor: number of m/s^2 in the column's unit.
    """

    place: int
    text: str
    kind: str
    word: str = ""
    factor: float = 1.0


def recognizes_csv(head: Sequence[str]) -> bool:
    """Return True if one of the first lines is a header with a time and an acceleration."""
    return _header_row([(number, line) for number, line in enumerate(head, 1) if line.strip()], None) is not None


@lru_cache(maxsize=32)  # scenes that differ in other keys read the same files again
def read_csv(text: str, name: str = "file.csv", unit: str | None = None) -> RecordSamples:
    """Return the samples of a table; unit: for columns whose header names none. Raises RecordError."""
    separator, rows = _split_lines(text)
    found = _header_row(rows, separator)
    top, separator = (0, separator or _guess_separator(rows[0][1])) if found is None else found
    head, header = rows[top]
    cells, below = _split_cells(head, header, separator), rows[top + 1 :]
    if below and (units := _units_row(_split_cells(*below[0], separator), cells)):
        cells, below = units, below[1:]
    columns = _header_columns(head, cells, unit, name)
    notes = [f"{top} lines above the header are ignored"] if top else []
    if others := [quote(column.text) for column in columns if column.kind == "other"]:
        notes.append(f"columns that are not needed: {', '.join(others)}")
    directions = _columns_by_axis(head, [column for column in columns if column.kind == "acceleration"])
    table = _read_table(below, columns, separator)
    time = table[:, next(column.place for column in columns if column.kind == "time")]
    _check_rising(below, time)
    values = {axis: column.factor * table[:, column.place] for axis, column in directions.items()}
    names = {axis: column.word for axis, column in directions.items() if column.word}
    return RecordSamples(format=FORMAT, time=time, directions=values, names=names, notes=tuple(notes))


def _split_lines(text: str) -> tuple[str | None, list[tuple[int, str]]]:
    """
    Return the separator that the text states, or None, and its lines with their numbers. Raises RecordError if empty.

    Blank lines and comments are left out.
    """
    lines = ((number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip())
    separator, rows = _separator_line([(number, line) for number, line in lines if not line.lstrip().startswith("#")])
    while rows and not rows[-1][1].strip(",;\t "):  # a spreadsheet leaves empty lines of separators at the end
        rows.pop()
    if not rows:
        raise RecordError(f"empty: must have {HEADER_EXAMPLE}, and samples")
    return separator, rows


def _separator_line(rows: list[tuple[int, str]]) -> tuple[str | None, list[tuple[int, str]]]:
    """Return the separator that a first line `sep=;` states, and the other lines."""
    if rows and (match := re.fullmatch(r'"?sep=(.)"?', rows[0][1].strip("\r\n \ufeff"), re.IGNORECASE)):
        return match[1], rows[1:]
    return None, rows


def _guess_separator(line: str) -> str:
    """Return the separator of a header: the first of tab, semicolon and comma in it, or blanks."""
    return next((mark for mark in "\t;," if mark in line), " ")


def _header_row(rows: Sequence[tuple[int, str]], separator: str | None) -> tuple[int, str] | None:
    """
    Return the index of the header in numbered lines, and its separator; None if no line is a header.

    The header is the first line that names a time and an acceleration. separator: as the file states it, or None.
    """
    for row, (number, line) in enumerate(rows[:MAX_PREAMBLE]):
        if len(line) > MAX_LINE or line.lstrip().startswith("#"):
            continue
        mark = separator or _guess_separator(line)
        try:
            kinds = [_header_column(place, cell).kind for place, cell in enumerate(_split_cells(number, line, mark))]
        except RecordError:
            continue
        below = rows[row + 1][1].split() if row + 1 < len(rows) else kinds
        if "time" in kinds and "acceleration" in kinds and (mark != " " or len(below) == len(kinds)):
            return row, mark  # a line of words is a header only above a line of as many values
    return None


def _split_cells(number: int, line: str, separator: str) -> list[str]:
    """Return the cells of a line. Raises RecordError."""
    if len(line) > MAX_LINE:
        raise RecordError(f"line {number}: {len(line)} letters: must be at most {MAX_LINE}")
    if separator == " ":
        return re.findall(r"[^\s\[(]+(?: ?[\[(][^\])]*[\])])?|[\[(][^\])]*[\])]", line)
    try:
        cells = [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=separator))]
    except (csv.Error, StopIteration) as error:
        raise RecordError(f"line {number}: {error}") from None
    while len(cells) > 1 and not cells[-1]:  # a spreadsheet leaves empty cells at the end
        cells.pop()
    return cells


def _units_row(cells: list[str], header: list[str]) -> list[str] | None:
    """
    Return the cells of the header, each with the unit in the line below it; None if that is no line of units.

    A line of units has a unit of acceleration and no number.
    """
    units = [cell.strip(" []()") for cell in cells]
    if len(cells) > len(header) or not any(map(str.isalpha, "".join(units))):
        return None
    if any(re.fullmatch(r"[+-]?[\d.,]+(?:e[+-]?\d+)?|[+-]?(?:nan|inf\w*)", unit, re.IGNORECASE) for unit in units):
        return None
    if not any(unit_factor(unit) for unit in units):
        return None
    return [f"{name} [{unit}]" if unit else name for name, unit in zip(header, units)] + header[len(units) :]


def _header_columns(line: int, cells: list[str], unit: str | None, name: str) -> list[HeaderCell]:
    """
    Return the columns that the header describes. Raises RecordError.

    The error quotes nothing of a file without any valid column, which may be no record at all.
    """
    columns = [_header_column(place, cell) for place, cell in enumerate(cells)]
    times = [column for column in columns if column.kind == "time"]
    usable = [column for column in columns if column.kind in ("acceleration", "wrong")]
    if not times and usable and len(usable) == len(columns) and any(column.kind == "acceleration" for column in usable):
        raise RecordError(
            f"line {line}: {quote(' '.join(cells))}: must have time and at least one of ax, ay, az; without a "
            "column of the time ",
            f'{WRITE_RECORD}{{file = "...", step = 0.01, unit = "g", skip = 1, column = 1}}',
        )
    if not times or not usable:
        raise RecordError(f"line {line}: must be {HEADER_EXAMPLE}")
    return [_with_unit(line, column, unit, name) for column in columns]


def _with_unit(line: int, column: HeaderCell, unit: str | None, name: str) -> HeaderCell:
    """Return the column with its unit checked, an acceleration with its factor to m/s^2. Raises RecordError."""
    cell, (_, stated) = column.text, _name_and_unit(column.text)
    if column.kind == "time" and stated.lower() not in SECOND_NAMES:
        raise RecordError(f"line {line}: column {quote(cell)}: unknown unit {quote(stated)}: write time [s]")
    if column.kind == "wrong":
        allowed = "must be one of time, ax, ay, az with its unit"
        raise RecordError(f"line {line}: column {quote(cell)}: {allowed}")
    if column.kind != "acceleration":
        return column
    factor, shown = unit_factor(stated), column.word or "acceleration"
    if factor is None and not stated and unit is not None:
        factor = unit_factor(unit)
        if factor is None:
            raise RecordError(f"unit = {quote(unit)}: unknown unit: must be one of {UNIT_NAMES}")
    elif unit is not None and factor is not None and unit_factor(unit) != factor:
        raise RecordError(f"line {line}: column {quote(cell)}: the scene says unit = {quote(unit)}: remove one of them")
    if factor is None:
        quoted = f"unknown unit {quote(stated)}" if stated else "no unit"
        if stated:
            rule = f"write {shown} [m/s^2], {shown} [g] or {shown} [cm/s^2]; units are {UNIT_NAMES}"
        else:
            rule = f'write {shown} [g], or record = {{file = {quote_name(name)}, unit = "g"}}; units are {UNIT_NAMES}'
        raise RecordError(f"line {line}: column {quote(cell)}: {quoted}: {rule}")
    return replace(column, factor=factor)


def _name_and_unit(cell: str) -> tuple[str, str]:
    """Return name and unit in a cell of the header: 'ax [g]', 'NS(gal)', 'Acceleration in g', 'Acc, m/s2', 'acc_g'."""
    text = " ".join(cell.split())
    if match := TEXT_IN_BRACKETS.fullmatch(text):
        unit = match[2].strip()
        unit = unit.partition("(")[0].strip() if unit_factor(unit) is None else unit
        return f"{match[1]} {match[3]}".strip(), unit
    for match in re.finditer(r"[ ,_/]+(?:in )?", text):
        name, unit = text[: match.start()], text[match.end() :]
        if name and (unit_factor(unit) is not None or (name.lower() in TIME_NAMES and unit.lower() in SECOND_NAMES)):
            return name, unit
    return text, ""


def _header_column(place: int, cell: str) -> HeaderCell:
    """Return what a cell of the header says of its column, without the factor of the unit."""
    name, unit = _name_and_unit(cell)
    words = [word for word in re.split(r"[\s_.:/]+", name.lower()) if word]
    if words and all(word in TIME_NAMES for word in words):
        return HeaderCell(place, cell, "time")
    rest = [word for word in words if word not in ACCELERATION_NAMES]
    if words and not rest:
        return HeaderCell(place, cell, "acceleration")
    named = len(rest) < len(words)  # a word says that the column is an acceleration
    if len(rest) == 1 and ACCELERATION_WITH_AXIS.fullmatch(rest[0]):
        return HeaderCell(place, cell, "acceleration", word=name)
    if len(rest) == 1 and parse_direction(rest[0]) is not None and (named or unit or not rest[0].isdigit()):
        if unit and unit_factor(unit) is None and not named:
            return HeaderCell(place, cell, "other")  # its unit is not one of acceleration: N [counts], v [m/s]
        return HeaderCell(place, cell, "acceleration", word=rest[0].upper() if len(rest[0]) < 4 else rest[0])
    return HeaderCell(place, cell, "wrong" if unit_factor(unit) is not None else "other")


def _columns_by_axis(line: int, columns: Sequence[HeaderCell]) -> dict[str, HeaderCell]:
    """
    Return the columns of accelerations by axis. Raises RecordError if their names do not determine the axes.

    The key is "" for a single column without the name of an axis.
    """
    words = [column.word.lower() for column in columns]
    if twice := [column.word for column in columns if words.count(column.word.lower()) > 1]:
        raise RecordError(f"line {line}: column {twice[0] or 'of the acceleration'} is there twice")
    known = [one for one in map(_direction_of, columns) if one is not None]
    axes = {one.axis: column for one, column in zip(known, columns)}
    if len(axes) == len(columns) and set(axes) <= set(AXES):
        return {axis: axes[axis] for axis in AXES if axis in axes}
    if len(columns) == 1:
        return {"": columns[0]}  # the only column names no direction, or an azimuth
    places = assign_axes(known) if len(known) == len(columns) else None
    if places is None:
        listed = ", ".join(quote(column.text) for column in columns)
        raise RecordError(
            f"line {line}: columns {listed}: two have one direction, or none is told: name them ax, ay, az"
        )
    return {axis: columns[number] for axis, number in places.items()}


def _direction_of(column: HeaderCell) -> Direction | None:
    """Return the direction that a column of the header names; None if it names none."""
    fused = ACCELERATION_WITH_AXIS.fullmatch(column.word)
    return parse_direction(fused[1] if fused else column.word)


def _read_table(rows: Sequence[tuple[int, str]], columns: Sequence[HeaderCell], separator: str) -> np.ndarray:
    """Return the values of all columns, (K, len(columns)), with zeros in those not needed. Raises RecordError."""
    needed = [column.place for column in columns if column.kind != "other"]
    table, commas, points = np.zeros((len(rows), len(columns))), 0, 0
    for row, (number, line) in enumerate(rows):
        cells = line.split() if separator == " " else _split_cells(number, line, separator)
        if len(cells) == 1 and not cells[0]:
            raise RecordError(f"line {number}: only separators: remove it")
        if len(cells) != len(columns):
            hint = ""
            if separator == "," and len(cells) == 2 * len(columns):
                hint = "; decimal commas need another separator: a semicolon or a tab"
            raise RecordError(f"line {number}: {len(cells)} values: the header names {len(columns)} columns{hint}")
        for place in needed:
            cell = cells[place]
            if "," in cell and len(cell) <= MAX_CELL and DECIMAL_COMMA.fullmatch(cell):
                cell, commas = cell.replace(",", "."), number
            elif "." in cell:
                points = number
            table[row, place] = parse_number(number, cell)
        if commas and points:
            raise RecordError(
                f"line {number}: decimal commas (line {commas}) and decimal points (line {points}): take one"
            )
    return table


def _check_rising(rows: Sequence[tuple[int, str]], time: np.ndarray) -> None:
    """Raise RecordError where a time is not later than the time before."""
    if len(time) > 1 and not (steps := np.diff(time) > 0.0).all():
        row = int(np.argmin(steps)) + 1
        late = f"line {rows[row][0]}: time {time[row]:g} s after {time[row - 1]:g} s: must rise"
        if time[row] == time[row - 1]:
            late += "; where times have too few digits write {file = ..., step = ..., unit = ..., skip = 1, column = 2}"
        raise RecordError(late)
