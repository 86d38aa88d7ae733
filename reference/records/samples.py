"""
Samples of one record file, and the samples (K, 4) that the files of a recorded motion make together.

The columns are the time from the first sample on, s, and the accelerations along x, y and z, m/s^2, which are zero
along a direction that was not recorded. `problem/excitation.py` defines the motion between samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference.records.directions import axis_of_word
from reference.support.arguments import check_array
from reference.support.scene_error import one_line

Array = NDArray[np.float64]

AXES = ("x", "y", "z")  # directions of an acceleration, in the order of the columns of samples
MAX_FILE_BYTES = 2**24  # largest size of a record file: half an hour at 200 Hz along three directions
MAX_ACCELERATION = 1e300  # m/s^2, largest sample that is accepted: it stays finite in any unit
MIN_INTERVAL = 1e-9  # s, shortest time between two samples of a record that is accepted
# Shapes of accelerations that an error message asks for
ACCELERATION_SHAPES = "(K,) along x, (K, 2) along x and y or (K, 3), m/s^2"
STEP_MISMATCH = 1e-6  # largest accepted relative difference in time step between two files of a motion
TIME_MISMATCH = 0.01  # largest accepted difference between the times of two files of a motion, over their time step


class RecordError(ValueError):
    """
    Error for a file that is no readable record.

    said: one line with the place in the file, the text there and what it must be. proposal: the end of the message,
    which says what to write in the scene file instead.
    """

    def __init__(self, said: str, proposal: str = "") -> None:
        """Set the two parts of the message."""
        super().__init__(f"{said}{proposal}")
        self.said, self.proposal = said, proposal


@dataclass(frozen=True)
class RecordSamples:
    """
    Samples of ground acceleration that were read from one record file.

    format: name of its format. time: (K,), s, as the file has it. directions: accelerations (K,), m/s^2, by axis; the
    key is "" if the file does not say along which axis. names: what the file calls its directions, by axis. step: time
    step, s, if the file states it in place of times. notes: sentences on what was ignored or repaired.
    """

    format: str
    time: Array
    directions: Mapping[str, Array]
    names: Mapping[str, str] = field(default_factory=dict)
    step: float | None = None
    notes: tuple[str, ...] = ()


def make_even_samples(
    format: str, step: float, values: Array, word: str = "", notes: tuple[str, ...] = ()
) -> RecordSamples:
    """Return samples, m/s^2, at a constant step, s, of the direction that the file calls `word`. Raises RecordError."""
    if not step >= MIN_INTERVAL:
        raise RecordError(f"step = {step:g} s: must be at least {MIN_INTERVAL:g} s")
    axis, time = axis_of_word(word), step * np.arange(len(values), dtype=float)
    names = {axis: word} if axis else {}
    return RecordSamples(format=format, time=time, directions={axis: values}, names=names, step=step, notes=notes)


def files_by_axis(record: Any) -> dict[str, Any]:
    """Return the files that a scene's `record` names, by axis x, y, z; a file without an axis is under ""."""
    return record if isinstance(record, dict) and "file" not in record else {"": record}


def file_name(file: Any) -> Any:
    """Return the name of a record file, which a scene gives alone or as `file` in a table with options."""
    return file.get("file") if isinstance(file, dict) else file


def join_directions(files: Mapping[str, RecordSamples]) -> Array:
    """
    Return samples (K, 4), time and acceleration along x, y and z, joined from the files of one motion by axis.

    The key "" stands for a single file; if this names no axis, it is taken along x. A file that ends before the others
    is followed by zeros. Raises RecordError for files that do not fit together.
    """
    columns: dict[str, tuple[RecordSamples, Array]] = {}
    for axis, content in files.items():
        if axis and len(content.directions) > 1:
            held = ", ".join(f"{one} = {content.names.get(one, one)}" for one in content.directions)
            raise RecordError(f"{axis}: the file holds several directions ({held}): give it alone, without x, y, z")
        for own, values in content.directions.items():
            columns[axis or own or "x"] = content, values
    _check_same_steps({axis: content for axis, (content, _) in columns.items()})
    longest = max((content for content, _ in columns.values()), key=lambda content: len(content.time))
    first, _ = next(iter(columns.values()))
    samples = np.zeros((len(longest.time), 4))
    samples[:, 0] = longest.time if first.step is None else first.step * np.arange(len(samples))
    for axis, (_, values) in columns.items():
        samples[: len(values), 1 + AXES.index(axis)] = values
    return finish_samples(samples)


def _check_same_steps(files: Mapping[str, RecordSamples]) -> None:
    """Raise RecordError unless the files of all directions, by axis, were sampled at the same instants."""
    for (first, one), (second, other) in pairwise(files.items()):
        if one.step is not None and other.step is not None:
            if abs(one.step - other.step) > STEP_MISMATCH * one.step:
                raise RecordError(
                    f"DT = {one.step:.9g} s along {first} and {other.step:.9g} s along {second}: must be the same"
                )
        elif one is not other:
            count = min(len(one.time), len(other.time))
            times = [content.time[:count] - content.time[:1].sum() for content in (one, other)]  # sum: 0 if empty
            apart = np.abs(times[0] - times[1]).max(initial=0.0)
            if count < 2 or apart > TIME_MISMATCH * np.diff(times[0]).min():
                raise RecordError(f"other instants along {first} than along {second}: must be the same")


def make_samples(time: Any, acceleration: Any) -> Array:
    """Return samples (K, 4) made of times (K,), s, and accelerations along 1 to 3 axes, m/s^2. Raises RecordError."""
    instants = _check_numbers("time", time, "(K,), s")
    values = _check_numbers("acceleration", acceleration, ACCELERATION_SHAPES)
    columns = values[:, None] if values.ndim == 1 else values
    if instants.ndim != 1:
        raise RecordError(f"time: shape {instants.shape}: must be (K,), s")
    if columns.ndim != 2 or len(columns) != len(instants) or not 1 <= columns.shape[1] <= 3:
        raise RecordError(
            f"acceleration: shape {values.shape} at {len(instants)} instants: must be {ACCELERATION_SHAPES}"
        )
    samples = np.zeros((len(instants), 4))
    samples[:, 0], samples[:, 1 : 1 + columns.shape[1]] = instants, columns
    return finish_samples(samples)


def check_samples(samples: Any) -> Array:
    """Return samples (K, 4), from an array or nested lists, read-only and with the first at 0 s. Raises RecordError."""
    array = np.array(_check_numbers("samples", samples, "(K, 4)"))
    if array.ndim != 2 or array.shape[1] != 4:
        raise RecordError(f"samples: shape {array.shape}: must be (K, 4): s and m/s^2 along x, y, z")
    return finish_samples(array)


def _check_numbers(name: str, values: Any, shape: str) -> Array:
    """Return times or accelerations as an array, checked to be finite and not too large. Raises RecordError."""
    try:
        array = check_array(name, values, f"must be {shape}")
    except ValueError as error:
        raise RecordError(str(error)) from None
    if np.abs(array).max(initial=0.0) > MAX_ACCELERATION:
        raise RecordError(f"{name}: must be at most {MAX_ACCELERATION:g} in size")
    return array


def finish_samples(samples: Array) -> Array:
    """Return samples (K, 4), shifted in place to start at 0 s and made read-only. Raises RecordError for bad times."""
    if len(samples) < 2:
        raise RecordError(f"{len(samples)} samples: must have at least 2")
    samples[:, 0] -= samples[0, 0]
    shortest = float(np.diff(samples[:, 0]).min())
    if shortest < MIN_INTERVAL:
        raise RecordError(f"{shortest:g} s from sample to sample: must be at least {MIN_INTERVAL:g} s")
    samples.setflags(write=False)
    return samples


def word_origin(files: Mapping[str, tuple[str, RecordSamples]]) -> list[str]:
    """
    Return lines of text on where samples come from: one for each file, and one for each note on a file.

    files: by axis, the name of the file and its samples.
    """
    lines = []
    for axis, (name, content) in files.items():
        told = ", ".join(
            f"{one} = {word}" for one, word in content.names.items() if word.lower() not in (one, f"a{one}")
        )
        along = axis if axis else "x" if list(content.directions) == [""] else ""
        lines.append(f"{f'{along}: ' if along else ''}{one_line(name)}, {content.format}{f', {told}' if told else ''}")
    return lines + [f"{one_line(name)}: {note}" for name, content in files.values() for note in content.notes]


def subtract_zero_line(samples: Array, how: str) -> None:
    """Subtract in place, from each direction of samples (K, 4), its "mean", or its "linear" trend by least squares."""
    time = samples[:, 0] - samples[:, 0].mean()
    for values in samples[:, 1:].T:
        if values.any():
            slope = float(time @ values / (time @ time)) if how == "linear" else 0.0
            values -= values.mean() + slope * time
