"""ESM .ASC: one direction, one value a line, under lines such as SAMPLING_INTERVAL_S: 0.005."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from reference.records.numerals import parse_number, read_values, unit_factor
from reference.records.samples import RecordError, RecordSamples, make_even_samples
from reference.support.arguments import quote

FORMAT = "ESM .ASC"
HEADER_ENTRY = re.compile(r"([A-Z][A-Z0-9_/^\[\]]*): ?(.*)")  # name and value in a line of the header


def recognizes_esm(head: Sequence[str]) -> bool:
    """Return True if one of the first lines states the sampling interval as ESM does."""
    return any(line.startswith("SAMPLING_INTERVAL_S:") for line in head)


@lru_cache(maxsize=64)
def read_esm(text: str, name: str = "file.ASC") -> RecordSamples:
    """Return the samples of an ESM .ASC file. Raises RecordError."""
    lines = text.splitlines()
    size = next((at for at, line in enumerate(lines) if not HEADER_ENTRY.fullmatch(line.strip())), len(lines))
    stated = {match[1]: match[2] for line in lines[:size] if (match := HEADER_ENTRY.fullmatch(line.strip()))}
    step, count, unit = (stated.get(key, "").strip() for key in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS"))
    factor = unit_factor(unit)
    if factor is None:
        raise RecordError(f"UNITS: {quote(unit)}: must be that of an acceleration, as cm/s^2")
    if not (count.isascii() and count.isdecimal() and len(count) < 10):
        raise RecordError(f"NDATA: {quote(count)}: must be a whole number")
    values, notes = read_values(lines[size:], size + 1, int(count), f"NDATA: {count}")
    word = stated.get("STREAM", "").strip()
    return make_even_samples(FORMAT, parse_number(1, step), factor * np.array(values), word, notes)
