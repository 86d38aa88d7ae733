"""COSMOS and CSMIP V2 with one channel: a block of accelerations in Fortran fields, below a line that announces it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from reference.records.numerals import parse_number, unit_factor
from reference.records.samples import RecordError, RecordSamples, make_even_samples
from reference.support.arguments import quote

FORMAT = "COSMOS V2"
BLOCK_HEADER = re.compile(  # COSMOS: line above the block of accelerations
    r"\s*(?P<count>[0-9]{1,9}) acceleration pts,.*units ?= ?(?P<unit>[^,(]+)"
    r".*format ?= ?\([0-9]+[fe](?P<width>[0-9]{1,3})\.",
    re.IGNORECASE,
)
CSMIP_BLOCK_HEADER = re.compile(  # CSMIP: line above the block of accelerations
    r"\s*(?P<count>[0-9]{1,9}) points of accel data equally spaced at\s+(?P<step>[0-9.]+) sec, in (?P<unit>[^\s.(]+)",
    re.IGNORECASE,
)
CSMIP_FIELD_WIDTH = 10  # letters in a field of CSMIP's Fortran format 8F10.3
REAL_HEADER = re.compile(  # line above the header's real numbers, with their count and the width of their fields
    r"\s*([0-9]{1,9}) Real-header values follow on +([0-9]{1,9}) lines, Format ?= ?\([0-9]+[FE]([0-9]{1,3})\.",
    re.IGNORECASE,
)
STEP_PLACE = 33  # index, from 0, of the sampling interval, s, among the header's real numbers


def recognizes_cosmos(head: Sequence[str]) -> bool:
    """Return True if one of the first lines announces accelerations as COSMOS or CSMIP files do."""
    return any(BLOCK_HEADER.match(line) or CSMIP_BLOCK_HEADER.match(line) for line in head)


@lru_cache(maxsize=32)
def read_cosmos(text: str, name: str = "file.V2") -> RecordSamples:
    """Return the samples of a COSMOS or CSMIP V2 file. Raises RecordError."""
    lines = text.splitlines()
    blocks = [
        (at, found)
        for at, line in enumerate(lines)
        if (found := BLOCK_HEADER.match(line) or CSMIP_BLOCK_HEADER.match(line))
    ]
    if len(blocks) != 1:
        rule = "must be one: take the channels apart, see the page Records of national networks"
        raise RecordError(f"{len(blocks)} channels of acceleration: {rule}")
    at, block = blocks[0]
    factor = unit_factor(block["unit"])
    if factor is None:
        raise RecordError(f"line {at + 1}: {quote(block['unit'])}: must be the unit of an acceleration, as cm/sec2")
    width = int(block.groupdict().get("width") or CSMIP_FIELD_WIDTH)
    values: list[float] = []
    for number, line in enumerate(lines[at + 1 :], at + 2):
        if len(values) >= int(block["count"]):
            break
        values += _split_fields(number, line, width)
    if len(values) != int(block["count"]):
        raise RecordError(f"{len(values)} values: line {at + 1} says {block['count']}")
    step = block.groupdict().get("step")
    spacing = _header_step(lines) if step is None else parse_number(at + 1, step)
    return make_even_samples(FORMAT, spacing, factor * np.array(values))


def _header_step(lines: Sequence[str]) -> float:
    """Return the sampling interval, s, from the real numbers of the header. Raises RecordError."""
    for at, line in enumerate(lines):
        if found := REAL_HEADER.match(line):
            rows = lines[at + 1 : at + 1 + int(found[2])]
            values = [
                value for number, row in enumerate(rows, at + 2) for value in _split_fields(number, row, int(found[3]))
            ]
            if len(values) > STEP_PLACE:
                return values[STEP_PLACE]
    raise RecordError("no real header with the sampling interval, 'Real-header values follow on'")


def _split_fields(number: int, line: str, width: int) -> list[float]:
    """Return the numbers in line `number` of a file, in fields of `width` letters each. Raises RecordError."""
    cells = [line[at : at + width].strip() for at in range(0, len(line.rstrip()), max(width, 1))]
    return [parse_number(number, cell) for cell in cells if cell]
