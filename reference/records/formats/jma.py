"""Strong-motion CSV of the Japan Meteorological Agency: sampling rate and unit above the columns NS, EW, UD."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from reference.records.directions import axis_of_word
from reference.records.numerals import MAX_HEADER_LINES, parse_number, unit_factor
from reference.records.samples import RecordError, RecordSamples
from reference.support.arguments import quote

FORMAT = "JMA CSV"
SAMPLING_RATE_LINE = re.compile(r"\s*SAMPLING RATE\s*[=:,]\s*([0-9.]+)\s*Hz", re.IGNORECASE)  # sampling rate, Hz
UNIT_LINE = re.compile(r"\s*UNIT\s*[=:,]\s*([^\s(,]+)", re.IGNORECASE)  # header line with the unit


def recognizes_jma(head: Sequence[str]) -> bool:
    """Return True if the first lines state a sampling rate and a unit."""
    return any(map(SAMPLING_RATE_LINE.match, head)) and any(map(UNIT_LINE.match, head))


@lru_cache(maxsize=32)
def read_jma(text: str, name: str = "file.csv") -> RecordSamples:
    """Return the samples of a CSV file of the JMA. Raises RecordError."""
    lines = text.splitlines()
    rate = next(match for line in lines if (match := SAMPLING_RATE_LINE.match(line)))
    unit = next(match for line in lines if (match := UNIT_LINE.match(line)))
    factor, sampling = unit_factor(unit[1]), parse_number(1, rate[1])
    if factor is None or sampling <= 0.0:
        raise RecordError(f"UNIT = {quote(unit[1])}, SAMPLING RATE = {rate[1]} Hz: must be gal, and greater than 0")
    top, words = _find_header(lines)
    rows = [(at, line.split(",")) for at, line in enumerate(lines[top + 1 :], top + 2) if line.strip(" ,")]
    for at, cells in rows:
        if len(cells) < len(words) or any(cell.strip() for cell in cells[len(words) :]):
            raise RecordError(f"line {at}: {len(cells)} values: the header names {len(words)} columns")
    table = np.array([[parse_number(at, cell.strip()) for cell in cells[: len(words)]] for at, cells in rows])
    table = table.reshape(-1, len(words))
    columns = {axis_of_word(word): factor * table[:, at] for at, word in enumerate(words)}
    names = {axis_of_word(word): word for word in words}
    step = 1.0 / sampling
    time = step * np.arange(len(table), dtype=float)
    return RecordSamples(format=FORMAT, time=time, directions=columns, names=names, step=step)


def _find_header(lines: Sequence[str]) -> tuple[int, list[str]]:
    """Return the index, from 0, of the header line that only names directions, and its words. Raises RecordError."""
    for at, line in enumerate(lines[:MAX_HEADER_LINES]):
        words = [word.strip() for word in line.split(",")]
        if len(words) > 1 and all(map(axis_of_word, words)):
            return at, words
    raise RecordError("the header must have a line 'NS,EW,UD'")
