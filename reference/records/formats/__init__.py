"""
Formats of recorded accelerograms: one table of readers, and one file for each format.

The first reader that recognizes the first lines of a file reads it. A new format needs a file in this folder and an
entry in the table READERS.
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
    One format of record files, and how to read it.

    recognizes: function that returns True for the first lines of a file of this format. read: function of the text and
    the name of a file that returns its samples. suffix: files with it are of this format if no reader recognizes their
    content; "" for none.
    """

    name: str
    recognizes: Callable[[Sequence[str]], bool]
    read: Callable[..., RecordSamples]
    suffix: str = ""


READERS = (  # the first that recognizes a file reads it
    Reader(name=at2.FORMAT, recognizes=at2.recognizes_at2, read=at2.read_at2, suffix=".at2"),
    Reader(name=knet.FORMAT, recognizes=knet.recognizes_knet, read=knet.read_knet),
    Reader(name=esm.FORMAT, recognizes=esm.recognizes_esm, read=esm.read_esm),
    Reader(name=cosmos.FORMAT, recognizes=cosmos.recognizes_cosmos, read=cosmos.read_cosmos),
    Reader(name=jma.FORMAT, recognizes=jma.recognizes_jma, read=jma.read_jma),
    Reader(name=csv_table.FORMAT, recognizes=csv_table.recognizes_csv, read=csv_table.read_csv, suffix=".csv"),
)
READERS_BY_SUFFIX = {reader.suffix: reader for reader in READERS if reader.suffix}
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
    Return the samples that a record file holds. Raises RecordError with a one-line message if it cannot be read.

    name: of the file, whose suffix counts only if no reader recognizes the content. options: `step`, `unit`, `skip` and
    `column` of a plain text; `unit` alone is that of a table whose header names none.
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
