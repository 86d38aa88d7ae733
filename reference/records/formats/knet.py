"""K-NET and KiK-net: one direction in counts, under 17 lines with the sampling rate and the scale factor."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from reference.records.numerals import parse_number, read_values
from reference.records.samples import RecordError, RecordSamples, evenly_spaced

FORMAT = "K-NET"
RATE = re.compile(r"Sampling Freq\(Hz\)\s+([0-9.]+) ?Hz")
SCALE = re.compile(r"Scale Factor\s+([0-9.]+) ?\(gal\)/([0-9.]+)")
LASTING = re.compile(r"Duration Time\(s\)\s+([0-9.]+)")
WAY = re.compile(r"Dir\.\s+(\S+)")
NUMBERED = {"1": "NS", "2": "EW", "3": "UD", "4": "NS", "5": "EW", "6": "UD"}  # KiK-net: borehole, then surface
HEADER = 17  # lines


def recognizes_knet(head: Sequence[str]) -> bool:
    """Tell whether the first lines state a scale factor in gal."""
    return any(map(SCALE.match, head)) and any(map(RATE.match, head))


@lru_cache(maxsize=64)
def read_knet(text: str, name: str = "file.EW") -> RecordSamples:
    """Return what such a file holds, its zero line left in. Raises RecordError."""
    lines = text.splitlines()
    head = lines[:HEADER]
    found = [next((match for line in head if (match := what.match(line))), None) for what in (RATE, SCALE, WAY)]
    if found[0] is None or found[1] is None:
        raise RecordError("the header must state 'Sampling Freq(Hz)' and 'Scale Factor 3920(gal)/6182761'")
    rate, full, counts = (parse_number(1, cell) for cell in (found[0][1], *found[1].groups()))
    if not (rate > 0.0 and counts > 0.0):
        raise RecordError("Sampling Freq(Hz) and Scale Factor must be greater than 0")
    count = sum(len(line.split()) for line in lines[HEADER:])
    values, _ = read_values(lines[HEADER:], HEADER + 1, count, f"{count} values")
    lasting = next((parse_number(1, match[1]) for line in head if (match := LASTING.match(line))), None)
    if lasting is not None and abs(count - lasting * rate) > rate:
        raise RecordError(f"{count} values: Duration Time(s) and Sampling Freq(Hz) say {lasting * rate:g}")
    word = NUMBERED.get(found[2][1], found[2][1]) if found[2] else ""
    return evenly_spaced(FORMAT, 1.0 / rate, 0.01 * full / counts * np.array(values), word)
