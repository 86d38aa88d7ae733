"""
Plain text: numbers whose step, unit, header and column the scene states, `{file = "a.acc", step = 0.01, unit = "g"}`.

Without these a file is refused, and the line to write is proposed with what its header says.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any, NamedTuple

import numpy as np

from reference.records.numerals import (
    MAX_HEADER_LINES,
    MAX_LINE,
    NUMBER,
    NUMBER_IN_RUN,
    UNIT_NAMES,
    WRITE_RECORD,
    holds_numbers,
    parse_fields,
    parse_plain_lines,
    quote_name,
    unit_factor,
)
from reference.records.samples import MIN_INTERVAL, Array, RecordError, RecordSamples, make_even_samples
from reference.support.arguments import as_float, quote

FORMAT = "plain text"
OPTIONS = ("step", "unit", "skip", "column")  # keys with which a scene states how to read a plain text
MAX_SKIP = 10_000  # largest number of lines that `skip` leaves out
MAX_COLUMN = 100  # largest column number that `column` may state
MAX_STEP_VARIATION = 0.01  # a column is a time if its steps differ by at most this share of their mean
MAX_RECORD_COLUMNS = 4  # lines of at most so many values may be table rows (time, 3 directions), which need `column`
PROPOSAL_ROWS = 50  # lines of numbers that are read to propose options for a plain text
MIN_TIME_ROWS = 3  # smallest number of rows that show whether a column is a time
NAMED_UNIT = re.compile(  # unit of acceleration in a header
    r"\b(?:[cm]?m|in|ft) ?/ ?s(?:ec)?(?: ?/ ?s(?:ec)?|\^?\*{0,2}2)|\bgals?\b|[(\[]g[)\]]|(?<=\bin )g\b|(?<=\bof )g\b",
    re.IGNORECASE,
)
NAMED_STEP = re.compile(  # sampling interval or rate in a header
    r"(?:\bd_?t\b|\bdelta ?t\b|\bstep\b|\binterval\b|\bspacing(?: of)?)[^0-9.,;]{0,20}"
    r"(?P<step>[0-9]*\.?[0-9]+(?:e-?[0-9]+)?)"
    r"|(?P<rate>[0-9]+(?:\.[0-9]*)?) ?(?:hz|sps)\b",
    re.IGNORECASE,
)
# Words of a header whose numbers are a spectrum, not accelerations over time
NO_RECORD = re.compile(r"\bspectr|\bfourier\b", re.IGNORECASE)
# A line of two numbers: the number of samples and the sampling interval, s
COUNT_AND_STEP = re.compile(r"\s*([0-9]+)[\s,]+([0-9]*\.[0-9]+(?:e-?[0-9]+)?)\s*", re.IGNORECASE)


def read_plain_text(
    text: str, name: str, step: Any = None, unit: Any = None, skip: Any = 0, column: Any = None
) -> RecordSamples:
    """
    Return the samples in a plain text, whose first `skip` lines are its header. Raises RecordError.

    step: time step, s. unit: one of `UNIT_NAMES`. column: number, from 1, of the column with the accelerations, or 0 if
    all numbers in file order are accelerations. If step or unit is missing, the error proposes the line to write.
    """
    if step is None or unit is None:
        raise RecordError("plain text needs step and unit: ", propose_line(text, name))
    spacing, factor = as_float(step), unit_factor(unit) if isinstance(unit, str) else None
    if not MIN_INTERVAL <= spacing < np.inf:
        raise RecordError(f"step = {quote(step)}: must be a number of seconds, at least {MIN_INTERVAL:g}")
    if factor is None:
        raise RecordError(f"unit = {quote(unit)}: must be one of {UNIT_NAMES}")
    for key, value, lowest, highest in (("skip", skip, 0, MAX_SKIP), ("column", column, 0, MAX_COLUMN)):
        whole = isinstance(value, int) and not isinstance(value, bool) and lowest <= value <= highest
        if not whole and not (key == "column" and value is None):
            raise RecordError(f"{key} = {quote(value)}: must be a whole number from {lowest} to {highest}")
    return replace(_read_stated(text, name, spacing, factor, skip, column), format=f"{FORMAT} in {unit}")


@lru_cache(maxsize=64)  # the cache hashes the arguments, whose types the caller has checked
def _read_stated(text: str, name: str, spacing: float, factor: float, skip: int, column: int | None) -> RecordSamples:
    """
    Return the samples of a plain text with checked options. Raises RecordError.

    spacing: time step, s. factor: number of m/s^2 in the text's unit. skip, column: as in `read_plain_text`.
    """
    lines, propose = text.splitlines(), partial(propose_line, text, name)
    if skip >= len(lines):
        raise RecordError(f"skip = {skip}: the file has {len(lines)} lines: ", propose())
    rows, notes = _read_rows(lines, skip, propose)
    values = _column_values(rows, column, any(map(COUNT_AND_STEP.fullmatch, lines[:skip])), propose)
    _check_stated_count(lines[:skip], len(values))
    seen = _even_step([row for _, row in rows]) if column is not None and column > 1 else None
    if seen is not None and abs(seen - spacing) > MAX_STEP_VARIATION * spacing:
        notes.append(f"the first column rises by {seen:g}, and the scene says step = {spacing:g} s: one is wrong")
    return make_even_samples(FORMAT, spacing, factor * np.array(values), notes=tuple(notes))


class Proposal(NamedTuple):
    """Options with which a plain text may be read."""

    step: float  # s
    unit: str
    skip: int  # number of lines of the header
    columns: tuple[int, ...]  # numbers from 1; () if all values in file order are accelerations
    missing: tuple[str, ...]  # "step" and "unit" if the text does not state them, so that they are only guessed


def propose_options(text: str) -> Proposal | str:
    """
    Return options with which a plain text may be read, or a sentence on why it is no record.

    Step and unit are those in its header. Where it names none, they are guesses.
    """
    lines = text.splitlines()
    start = _first_data_line(lines)
    if start is None:
        return "it has no lines of numbers: it is no record"
    header = "\n".join(line[:MAX_LINE] for line in lines[:start])
    if NO_RECORD.search(header):
        return "its header names spectra: it is no record"
    body = [line[:MAX_LINE] for line in lines[start : start + PROPOSAL_ROWS]]
    if "." not in "".join(body):  # the text has decimal commas
        body = [line.replace(",", ".") for line in body]
    rows = [cells for line in body if (cells := _parse_number_line(line))]
    time = _even_step(rows)
    step, unit = _read_step(header), NAMED_UNIT.search(header)
    known = step if step is not None else time
    stated = unit[0].strip("()[]") if unit else None
    counted = any(map(COUNT_AND_STEP.fullmatch, lines[:start]))
    missing = tuple(word for word, value in (("step", known), ("unit", stated)) if value is None)
    columns = _propose_columns(rows, time is not None, counted)
    spacing = 0.01 if known is None else known
    return Proposal(step=spacing, unit=stated or "g", skip=start, columns=columns, missing=missing)


def _propose_columns(rows: Sequence[Sequence[float]], timed: bool, counted: bool) -> tuple[int, ...]:
    """
    Return the numbers, from 1, of the columns of accelerations; () if all values in file order are accelerations.

    timed: True if the first column is a time. counted: True if the header states the number of values.
    """
    side_by_side = len(rows) > 1 and len({*map(len, rows)}) == 1 and 1 < len(rows[0]) <= MAX_RECORD_COLUMNS
    if not timed and (counted or not side_by_side):
        return ()
    return tuple(range(2 if timed else 1, len(rows[0]) + 1))


def propose_line(text: str, name: str) -> str:
    """Return the line of a scene file with which a plain text is read; for any other text, why it is no record."""
    proposal = propose_options(text)
    if isinstance(proposal, str):
        return proposal
    parts = [f"file = {quote_name(name)}", f"step = {proposal.step:g}", f'unit = "{proposal.unit}"']
    parts += [f"skip = {proposal.skip}"] if proposal.skip else []
    parts += [f"column = {proposal.columns[0]}"] if proposal.columns else []
    return f"{WRITE_RECORD}{{{', '.join(parts)}}}{word_guesses(proposal.missing)}"


def word_guesses(missing: Sequence[str]) -> str:
    """Return words on which of step and unit the file leaves open, so that they are guessed; "" if it states both."""
    return f", with the {' and the '.join(missing)} of your source, which the file does not state" if missing else ""


def _first_data_line(lines: Sequence[str]) -> int | None:
    """Return the index, from 0, of the first line of data; a line that states their count and step is not data."""
    for number, line in enumerate(lines[:MAX_HEADER_LINES]):
        if _parse_number_line(line) and not _states_count(lines, number):
            return number
    return None


def _states_count(lines: Sequence[str], number: int) -> bool:
    """Return True if line `number`, from 0, has a count and a step, and exactly that many values follow it."""
    stated = COUNT_AND_STEP.fullmatch(lines[number][:MAX_LINE])
    behind = sum(len(line.split()) for line in lines[number + 1 :])
    return stated is not None and len(stated[1]) < 10 and int(stated[1]) == behind


def _parse_number_line(line: str) -> list[float] | None:
    """Return the numbers of a line that has nothing else; None for any other line."""
    cells = re.split(r"[\s;,]+", line[:MAX_LINE].strip())
    if not all(cells) or not all(
        NUMBER.fullmatch(cell) or "".join(NUMBER_IN_RUN.findall(cell)) == cell for cell in cells
    ):
        return None
    try:
        return parse_fields(0, " ".join(cells))
    except RecordError:
        return None


def _read_step(header: str) -> float | None:
    """Return the sampling interval, s, that a header states; None if it states none."""
    for line in header.splitlines():
        if match := COUNT_AND_STEP.fullmatch(line):
            return as_float(float(match[2])) or None
        if match := NAMED_STEP.search(line):
            value = float(match["step"] or match["rate"])
            return None if value <= 0.0 else value if match["step"] else 1.0 / value
    return None


def _read_rows(
    lines: Sequence[str], skip: int, propose: Callable[[], str]
) -> tuple[list[tuple[int, list[float]]], list[str]]:
    """Return the numbers of every line behind the header with its line number, and notes. Raises RecordError."""
    data = [(number, line) for number, line in enumerate(lines[skip:], skip + 1) if line.strip()]
    joined = "".join(line for _, line in data)
    commas = "," in joined and "." not in joined
    rows, glued = [], False
    for number, line in data:
        plain = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", line) if commas else line.replace(",", " ")
        plain = plain.replace(";", " ")
        values = parse_plain_lines([plain])
        if values is None:
            if number == skip + 1 and not holds_numbers(line):
                raise RecordError(f"line {number}: {quote(line.strip())}: must be numbers: ", propose())
            values = parse_fields(number, plain)
            glued = glued or len(values) > len(plain.split())
        rows.append((number, values))
    notes = ["numbers without a blank between them are taken apart"] if glued else []
    return rows, notes + (["commas are read as decimal commas"] if commas else [])


def _column_values(
    rows: Sequence[tuple[int, list[float]]], column: int | None, counted: bool, propose: Callable[[], str]
) -> list[float]:
    """
    Return the values in column `column`, from 1, or all in file order for 0 or None. Raises RecordError.

    rows: line number and numbers of each line. counted: True if the header states how many values there are. propose:
    returns the end of the error, which says what to write.
    """
    if column:
        for number, row in rows:
            if len(row) < column:
                raise RecordError(f"line {number}: {len(row)} values: column = {column}: must have as many")
        return [row[column - 1] for _, row in rows]
    _check_widths(rows, column is None, counted, propose)
    return [value for _, row in rows for value in row]


def _check_widths(
    rows: Sequence[tuple[int, list[float]]], column_unstated: bool, counted: bool, propose: Callable[[], str]
) -> None:
    """Raise RecordError if the lines may be rows of a table whose column is not stated, or if they differ in length."""
    widths = [len(row) for _, row in rows]
    alike = len(set(widths)) == 1 and widths[0] > 1
    if column_unstated and alike and _even_step([row for _, row in rows]) is not None:
        rule = "the first of them rises evenly as a time does: state the column"
        raise RecordError(f"line {rows[0][0]}: {widths[0]} values a line, {rule}: ", propose())
    if column_unstated and alike and not counted and len(rows) > 1 and widths[0] <= MAX_RECORD_COLUMNS:
        rule = f"{widths[0]} values a line: state column, from 1; column = 0 takes all of them in their order"
        raise RecordError(f"line {rows[0][0]}: {rule}: ", propose())
    other = widths[min(1, len(widths) - 1)] if widths else 0
    for (number, _), width in zip(rows[:-1], widths):
        if width != other:
            rule = f"{width} values, {other} in other lines: a header, or a broken line"
            raise RecordError(f"line {number}: {rule}: ", propose())


def _check_stated_count(header: Sequence[str], count: int) -> None:
    """Raise RecordError if a header line of count and step states another number of values than `count`."""
    for number, line in enumerate(header, 1):
        stated = COUNT_AND_STEP.fullmatch(line[:MAX_LINE])
        if stated and int(stated[1][:9]) != count:
            rule = "leave column out to take all values of a line, or take the missing ones from the source"
            raise RecordError(f"{count} values: line {number} states {stated[1]}: {rule}")


def _even_step(rows: Sequence[Sequence[float]]) -> float | None:
    """Return the mean step of the first of several columns if it rises evenly, as a time does; None otherwise."""
    if len(rows) < MIN_TIME_ROWS or min(map(len, rows)) < 2:
        return None
    steps: Array = np.diff([row[0] for row in rows])
    if steps.min() <= 0.0 or np.ptp(steps) > max(MAX_STEP_VARIATION * steps.mean(), 1e-5):
        return None
    return float(f"{steps.mean():.6g}")


def begins_with_numbers(head: Sequence[str]) -> bool:
    """Return True if the first line that is not blank has numbers only."""
    first = next((line for line in head if line.strip()), "")
    return _parse_number_line(first) is not None


def has_options(table: Mapping[str, Any]) -> bool:
    """Return True if the table of a file states options that only a plain text needs."""
    return any(key in table for key in ("step", "skip", "column"))
