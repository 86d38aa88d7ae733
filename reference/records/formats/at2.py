"""PEER .AT2: one direction in g, under a header with NPTS and DT."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from reference.records.numerals import MAX_LINE, WRITE_RECORD, holds_numbers, parse_number, quote_name, read_values
from reference.records.samples import RecordError, RecordSamples, make_even_samples
from reference.support.arguments import quote
from reference.support.constants import GRAVITY

FORMAT = "PEER .AT2"
MAX_HEADER_LINES = 20  # largest number of lines in the header
MAX_COUNT_DIGITS = 9  # largest number of digits of NPTS, the number of samples
SECONDS_SUFFIX = re.compile(r"S(?:EC)?$", re.IGNORECASE)  # unit of time written without a blank after the value of DT
NO_ACCELERATION = re.compile(r"\b(?:VELOCITY|DISPLACEMENT)\b", re.IGNORECASE)  # words in files without accelerations
UNIT_LINE = re.compile(r"\bUNITS\b", re.IGNORECASE)  # header line with a unit
# Matches the rest of a header line, from UNITS on, if it names g as the unit
UNIT_OF_G = re.compile(r"UNITS ?(?:OF|ARE|:|=)? ?(?:G|\(G\)|\[G\]) ?(?:\.(?: .*)?)?", re.IGNORECASE)
ACCELERATION_LINE = re.compile(r"\bACC(?:EL\w*)?\b", re.IGNORECASE)  # header line that names an acceleration
# Matches the rest of a header line, from ACC on, if it names an acceleration in g
ACCELERATION_IN_G = re.compile(r"ACC(?:EL\w*)?\b[^,;]*?(?:\bIN |, ?|[\[(])[\[(]?G[\])]? ?\.?", re.IGNORECASE)


def recognizes_at2(head: Sequence[str]) -> bool:
    """Return True if one of the first lines states NPTS and DT."""
    return any(_read_sizes(line) for line in _shorten_lines(head))


@lru_cache(maxsize=64)
def read_at2(text: str, name: str = "file.AT2") -> RecordSamples:
    """Return the samples of a PEER .AT2 file. Raises RecordError."""
    lines = text.splitlines()
    head = _shorten_lines(lines)
    counts = next(((row, sizes) for row, line in enumerate(head) if (sizes := _read_sizes(line))), None)
    if counts is None:
        raise RecordError("the header must have a line 'NPTS= 1000, DT= .0100 SEC'")
    last, (count, step) = counts
    while last + 1 < len(head) and not holds_numbers(head[last + 1]):
        last += 1
    whole = count.isascii() and count.isdecimal() and len(count) <= MAX_COUNT_DIGITS
    if not (whole and int(count) > 0):
        rule = f"must be a whole number greater than 0 of at most {MAX_COUNT_DIGITS} digits"
        raise RecordError(f"line {counts[0] + 1}: NPTS = {quote(count)}: {rule}")
    spacing = parse_number(counts[0] + 1, SECONDS_SUFFIX.sub("", step))
    if spacing <= 0.0:
        raise RecordError(f"line {counts[0] + 1}: DT = {step} s: must be greater than 0")
    table = f'{{file = {quote_name(name)}, step = {spacing:g}, unit = "...", skip = {last + 1}}}'
    _check_unit(head[: last + 1], f"{WRITE_RECORD}{table}")
    values, notes = read_values(lines[last + 1 :], last + 2, int(count), f"NPTS = {count}")
    return make_even_samples(FORMAT, spacing, GRAVITY * np.array(values), notes=notes)


def _shorten_lines(lines: Sequence[str]) -> list[str]:
    """Return the first MAX_HEADER_LINES lines, cut to MAX_LINE letters, with single blanks between words."""
    return [" ".join(line[:MAX_LINE].split()) for line in lines[:MAX_HEADER_LINES]]


def _check_unit(header: list[str], proposal: str) -> None:
    """Raise RecordError unless the header names g as the unit, and no other unit."""
    found = [(number, line) for number, line in enumerate(header, 1) if UNIT_LINE.search(line)]
    rule = "must say 'IN UNITS OF G'; in another unit "
    for number, line in found:
        at = UNIT_LINE.search(line)
        if NO_ACCELERATION.search(line):
            raise RecordError(f"line {number}: {quote(line)}: is no acceleration: take the .AT2 file of the same name")
        if at is None or not UNIT_OF_G.fullmatch(line[at.start() :]):
            raise RecordError(f"line {number}: the header names no unit that is known: {quote(line)}: {rule}", proposal)
    named = [(number, line) for number, line in enumerate(header, 1) if ACCELERATION_LINE.search(line)]
    if found or any(
        (at := ACCELERATION_LINE.search(line)) and ACCELERATION_IN_G.fullmatch(line[at.start() :]) for _, line in named
    ):
        return
    quoted = f"line {named[-1][0]}: {quote(named[-1][1])}: " if named else ""
    raise RecordError(f"{quoted}the header names no unit that is known: {rule}", proposal)


def _read_sizes(line: str) -> tuple[str, str] | None:
    """Return NPTS and DT of 'NPTS= 1000, DT= .0100 SEC' or '1000 .0100 NPTS, DT'; None for any other line."""
    words = line.replace(",", " ").replace("=", " = ").replace(":", " = ").split()
    names = [word.upper() for word in words]
    at = names.index("NPTS") if "NPTS" in names else len(names)
    match names[at : at + 6]:
        case ["NPTS", "=", _, "DT", "=", _]:
            return words[at + 2], words[at + 5]
        case ["NPTS", "DT", *_] if at >= 2:
            return words[at - 2], words[at - 1]
    return None
