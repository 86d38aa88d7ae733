"""
Formats of recorded accelerograms: one table of readers, and one file for each format.

A reader is (name, what it recognizes in the first lines, function of text and file name, suffix). The first that
recognizes a file reads it. A new format is one file in this folder and its line in the table.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from reference.records.formats import at2, cosmos, csv_table, esm, jma, knet, plain_text
from reference.records.numerals import MAX_HEADER_LINES, UNIT_NAMES, decode_text
from reference.records.samples import Array, RecordError, RecordSamples, join_directions
from reference.support.arguments import quote


class Reader(NamedTuple):
    """
    One format: its name, a function that recognizes the first lines of a file, and a function that reads it.

    suffix: of the files that are of this format where no reader recognizes their content; "" for none.
    """

    name: str
    recognizes: Callable[[Sequence[str]], bool]
    read: Callable[..., RecordSamples]
    suffix: str = ""


READERS = (  # readers of all formats: the first that recognizes a file reads it
    Reader(at2.FORMAT, at2.recognizes_at2, at2.read_at2, ".at2"),
    Reader(knet.FORMAT, knet.recognizes_knet, knet.read_knet),
    Reader(esm.FORMAT, esm.recognizes_esm, esm.read_esm),
    Reader(cosmos.FORMAT, cosmos.recognizes_cosmos, cosmos.read_cosmos),
    Reader(jma.FORMAT, jma.recognizes_jma, jma.read_jma),
    Reader(csv_table.FORMAT, csv_table.recognizes_csv, csv_table.read_csv, ".csv"),
)
READERS_BY_SUFFIX = {reader.suffix: reader for reader in READERS if reader.suffix}  # by suffix of the file
NETWORK_SUFFIX = re.compile(r"\.(?:v[0-3][ac]?|raw|smc|mseed|sac|evt|kmi)", re.IGNORECASE)  # raw files of networks
OPTIONS = ("file", *plain_text.OPTIONS)  # keys of a scene's record that is a single file


def recognize_format(text: str, suffix: str = "") -> Reader | None:
    """Return the reader for a text by its first lines, or else by the suffix of its file; None for a plain text."""
    head = text[: 2**16].splitlines()[:MAX_HEADER_LINES]
    known = next((reader for reader in READERS if reader.recognizes(head)), None)
    if known is None and not plain_text.begins_with_numbers(head):
        return READERS_BY_SUFFIX.get(suffix.lower())
    return known


def read_record(content: bytes, name: str, options: Mapping[str, Any] | None = None) -> RecordSamples:
    """
    Return the samples and directions that a file holds. Raises RecordError with a one-line message if unreadable.

    name: of the file, which tells nothing that its content does not. options: `step`, `unit`, `skip` and `column` of
    a plain text; `unit` alone is that of a table whose header names none.
    """
    given, text = dict(options or {}), decode_text(content)
    if plain_text.has_options(given):
        return plain_text.read_plain_text(text, name, **given)
    suffix = name[name.rfind(".") :] if "." in name else ""
    reader = recognize_format(text, suffix)
    if NETWORK_SUFFIX.fullmatch(suffix) and (reader is None or reader.name == csv_table.FORMAT):
        raise RecordError("a file of a network that is not read as it is: docs/guide/networks.md converts it to CSV")
    if reader is None:
        return plain_text.read_plain_text(text, name, **given)
    if given and reader.read is not csv_table.read_csv:
        raise RecordError(
            f"{reader.name} states its own unit: remove unit, or state step, unit and skip of a plain text"
        )
    if given and not isinstance(given["unit"], str):
        raise RecordError(f"unit = {quote(given['unit'])}: must be one of {UNIT_NAMES}")
    return reader.read(text, name, **given)


def read_csv_samples(text: str) -> Array:
    """Return the samples (K, 4) of a CSV file: s, and m/s^2 along x, y, z. Raises RecordError."""
    return join_directions({"": csv_table.read_csv(text)})
