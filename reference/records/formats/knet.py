"""K-NET and KiK-net: one direction in counts, under 17 lines with the sampling rate and the scale factor."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from reference.records.numerals import parse_number, read_values
from reference.records.samples import RecordError, RecordSamples, make_even_samples

FORMAT = "K-NET"
SAMPLING_RATE_LINE = re.compile(r"Sampling Freq\(Hz\)\s+([0-9.]+) ?Hz")  # header line with the sampling rate, Hz
SCALE_FACTOR_LINE = re.compile(r"Scale Factor\s+([0-9.]+) ?\(gal\)/([0-9.]+)")  # header line: gal per count, as a ratio
DURATION_LINE = re.compile(r"Duration Time\(s\)\s+([0-9.]+)")  # header line with the duration, s
DIRECTION_LINE = re.compile(r"Dir\.\s+(\S+)")  # header line with the direction
# Channels of KiK-net: 1 to 3 in the borehole, 4 to 6 at the surface
DIRECTION_OF_CHANNEL = {"1": "NS", "2": "EW", "3": "UD", "4": "NS", "5": "EW", "6": "UD"}
HEADER_LINES = 17  # number of lines in the header


def recognizes_knet(head: Sequence[str]) -> bool:
    """Return True if the first lines state a scale factor in gal."""
    return any(map(SCALE_FACTOR_LINE.match, head)) and any(map(SAMPLING_RATE_LINE.match, head))


@lru_cache(maxsize=64)
def read_knet(text: str, name: str = "file.EW") -> RecordSamples:
    """Return the samples of a K-NET or KiK-net file without correction of the zero line. Raises RecordError."""
    lines = text.splitlines()
    head = lines[:HEADER_LINES]
    found = [
        next((match for line in head if (match := what.match(line))), None)
        for what in (SAMPLING_RATE_LINE, SCALE_FACTOR_LINE, DIRECTION_LINE)
    ]
    if found[0] is None or found[1] is None:
        raise RecordError("the header must state 'Sampling Freq(Hz)' and 'Scale Factor 3920(gal)/6182761'")
    rate, full, counts = (parse_number(1, cell) for cell in (found[0][1], *found[1].groups()))
    if not (rate > 0.0 and counts > 0.0):
        raise RecordError("Sampling Freq(Hz) and Scale Factor must be greater than 0")
    count = sum(len(line.split()) for line in lines[HEADER_LINES:])
    values, _ = read_values(lines[HEADER_LINES:], HEADER_LINES + 1, count, f"{count} values")
    lasting = next((parse_number(1, match[1]) for line in head if (match := DURATION_LINE.match(line))), None)
    if lasting is not None and abs(count - lasting * rate) > rate:
        raise RecordError(f"{count} values: Duration Time(s) and Sampling Freq(Hz) say {lasting * rate:g}")
    word = DIRECTION_OF_CHANNEL.get(found[2][1], found[2][1]) if found[2] else ""
    return make_even_samples(FORMAT, 1.0 / rate, 0.01 * full / counts * np.array(values), word)
