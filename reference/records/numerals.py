"""Texts, units and numbers of record files, read in the same way in every format."""

from __future__ import annotations

import codecs
import json
import re
from collections.abc import Iterable, Sequence

from reference.records.samples import MAX_ACCELERATION, RecordError
from reference.support.arguments import quote
from reference.support.constants import GRAVITY

MAX_LINE = 1000  # letters of a line that are searched for words; a longer line of a CSV file is an error
MAX_CELL = 100  # letters of the longest number; a longer one is an error
MAX_HEADER_LINES = 100  # number of lines at the start of a record file in which its header is searched for
# Number of m/s^2 in each unit of acceleration
UNITS = {"m/s^2": 1.0, "m/s2": 1.0, "m/s²": 1.0, "m/s/s": 1.0, "g": GRAVITY, "cm/s^2": 0.01, "cm/s2": 0.01}
UNITS |= {"cm/s²": 0.01, "gal": 0.01, "mm/s^2": 0.001, "in/s^2": 0.0254, "ft/s^2": 0.3048}
UNIT_NAMES = "m/s^2, g, gal, cm/s^2, mm/s^2, in/s^2 or ft/s^2"  # units that error messages offer
SPELLED_UNIT = re.compile(  # matches acceleration units in spellings that UNITS does not list, such as cm/sec/sec
    r"(m|cm|mm|in|inch|inches|ft|feet)[ .*]?(?:/ ?\(?s(?:ec)?(?:\^?2|²| ?/ ?s(?:ec)?)\)?| ?s\^?-2)"
)
# Matches one number; its exponent may begin with d, as in Fortran output
NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[ed][+-]?[0-9]+)?", re.IGNORECASE | re.ASCII)
# Matches one number in a run of numbers of fixed width, with no blanks between them (Fortran output)
NUMBER_IN_RUN = re.compile(r"[+-]?(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[ed][+-]?[0-9]{1,3})?", re.IGNORECASE | re.ASCII)
NOT_FINITE_NUMBER = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE | re.ASCII)
WORD = re.compile(r"[^\W\d_]{2,}")  # two letters or more in a row: a line that has them is not a line of numbers
NUMBER_LETTERS = {*"0123456789+-.eE \t"}  # lines of these letters alone are parsed together, others number by number
WRITE_RECORD = "write record = "  # start of the part of an error message that says what to write in the scene file


def decode_text(content: bytes) -> str:
    """
    Decode a file's bytes as UTF-8 or UTF-16, or else as Latin 1, and return the text. Raises RecordError.

    Only ASCII letters and the superscript 2 carry a meaning, so bytes in another encoding may be read as Latin 1.
    """
    try:
        if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return content.decode("utf-16")
        if content[1:2] == b"\0" or content[:1] == b"\0":
            return content.decode("utf-16-le" if content[1:2] == b"\0" else "utf-16-be")
    except UnicodeDecodeError:
        raise RecordError("must be text in UTF-8") from None
    if b"\0" in content:
        raise RecordError("must be text in UTF-8")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def quote_name(name: str) -> str:
    """Return a file's name in quotes and escaped, as it must be written in a scene file (TOML)."""
    plain = name.isprintable() and not {'"', "\\"} & set(name)
    return f'"{name}"' if plain else json.dumps(name)


def unit_factor(unit: str) -> float | None:
    """Return the number of m/s^2 in an acceleration unit of any common spelling; None for an unknown unit."""
    text = " ".join(unit.lower().replace("**", "^").split()).strip(" .")
    if text in UNITS:
        return UNITS[text]
    match = SPELLED_UNIT.fullmatch(text)
    if match is None:
        return {"g's": GRAVITY, "gals": 0.01}.get(text)
    length = {"inch": "in", "inches": "in", "feet": "ft"}.get(match[1], match[1])
    return UNITS[f"{length}/s^2"]


def parse_number(line: int, cell: str) -> float:
    """Return the number in a cell of a record file; `line`: its line number, for the error. Raises RecordError."""
    if NOT_FINITE_NUMBER.fullmatch(cell):
        raise RecordError(f"line {line}: {cell}: must be finite")
    if "**" in cell:
        lost = "a Fortran field that has overflowed, its value is lost: take the record from its source"
        raise RecordError(f"line {line}: {quote(cell)}: {lost}")
    if len(cell) > MAX_CELL or not NUMBER.fullmatch(cell):
        raise RecordError(f"line {line}: {quote(cell)}: must be a number of at most {MAX_CELL} letters")
    value = float(cell.lower().replace("d", "e"))
    if abs(value) > MAX_ACCELERATION:
        raise RecordError(f"line {line}: {quote(cell)}: must be finite, at most {MAX_ACCELERATION:g} in size")
    return value


def parse_fields(line: int, text: str) -> list[float]:
    """
    Return the numbers in a line that Fortran wrote, also where no blank separates them. Raises RecordError.

    Two numbers without a blank are told apart by the sign of the second, where both have a decimal point.
    """
    values = []
    for cell in text.split():
        parts = [] if NUMBER.fullmatch(cell) or len(cell) > MAX_LINE else NUMBER_IN_RUN.findall(cell)
        signed = all(part[0] in "+-" for part in parts[1:])
        if len(parts) > 1 and signed and "".join(parts) == cell:
            values += [parse_number(line, part) for part in parts]
        else:
            values.append(parse_number(line, cell))
    return values


def parse_plain_lines(lines: Iterable[str]) -> list[float] | None:
    """Return the numbers of lines without any other text, which are parsed at once; None for other lines."""
    text = " ".join(lines)
    cells = text.split()
    if not set(text) <= NUMBER_LETTERS or max(map(len, cells), default=0) > MAX_CELL:
        return None
    try:
        values = list(map(float, cells))
    except ValueError:
        return None
    return values if max(map(abs, values), default=0.0) <= MAX_ACCELERATION else None


def holds_numbers(line: str) -> bool:
    """Return True if a line of a record file is not blank and has no words other than `nan` and `inf`."""
    return bool(line.strip()) and not any(
        not NOT_FINITE_NUMBER.fullmatch(word) for word in WORD.findall(line[:MAX_LINE])
    )


def read_values(lines: Sequence[str], first: int, count: int, stated: str) -> tuple[list[float], tuple[str, ...]]:
    """
    Return the numbers in the data lines of a record file, and notes on what was ignored or repaired.

    first: number of the first of these lines in the file. count: how many numbers there must be. stated: how the header
    states the count, such as "NPTS = 1000", for the error. A line with words behind the last number ends the data.
    Raises RecordError for another count and for text that is no number.
    """
    values = parse_plain_lines(lines)
    if values is not None and len(values) == count:
        return values, ()
    values, notes, beyond = [], [], 0
    for number, line in enumerate(lines, first):
        if len(values) >= count and not holds_numbers(line):
            if line.strip():
                notes.append(f"the lines behind the {count} values are ignored")
                break
            continue
        fields = parse_fields(number, line)
        if len(fields) > len(line.split()):
            notes.append("numbers without a blank between them are taken apart")
        values += fields
        if len(values) > count and not beyond:
            beyond = number
    if len(values) != count:
        place = f"line {beyond}: " if beyond else ""
        raise RecordError(f"{place}{len(values)} values: the header says {stated}")
    return values, tuple(dict.fromkeys(notes))
