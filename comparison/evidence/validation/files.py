"""
Measured files as their authors publish them, read from a folder of the user.

A process of its own with limits of memory and time reads a file, and hands back columns of numbers: a file that ends
the process that reads it costs one line.
"""

import io
import os
import re
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.io import loadmat, whosmat

from comparison.result_types import Array
from comparison.runner.processes import TimeLimitError, WorkerDiedError, Workers
from reference.problem import SceneError
from reference.support.files import read_file

try:
    import resource
except ImportError:  # Windows cannot limit the memory or time of a process.
    resource = None  # type: ignore[assignment]

MAX_FILE_BYTES = 2**24  # size in bytes above which a measured file is refused
MAX_SAMPLES = 2_000_000  # number of samples in a column of a measured file above which it is refused
MAX_READING_SECONDS = 30.0  # s of processor time after which reading a file is given up; published ones take below 1 s
MAX_READING_BYTES = 2**29  # bytes of memory that reading a file may take: a column of MAX_SAMPLES takes 2^24
DURATION_RANGE = (1.0, 1e4)  # s, shortest and longest measured motion that is not refused
MAX_READINGS = {"mm": 1e4, "rad": 1e3}  # largest measured displacement or angle that is not refused, by unit
# Data types of a MATLAB file that are accepted as columns of numbers; logical values are not
NUMERIC_TYPES = {"double", "single", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
# Matches file names of measured shaken-frame motions; groups: mass of the disc, g; x for top plate or y for base
FRAME_FILE_NAME = re.compile(r"s_b_(\d{1,5})g_([xy])\.mat")
# Names of the published files with the pendulum's decay and with its large swings
DECAY_FILE, LARGE_SWING_FILE = "SingleDataFreeSwing_1_Dt_0_0001.mat", "SinglePendulumDataForParameterEstimation.mat"
FRAME_SOURCE = (  # publication and download place of the measured frame runs
    "single-storey frame with a brass-to-steel contact, Marino, Cicirello, Data-Centric Engineering 2023 "
    "(arXiv 2303.03858), rig in Nonlinear Dynamics 99 (2020) 1781-1799: github.com/l-marino/switching-GPLFM, commit "
    "01dc3d9 (GPL-3.0), files s_b_<weight>g_x.mat and s_b_<weight>g_y.mat"
)
LARGE_SWING_VARIABLES = ("Time_id", "Time_vad", "Y_id", "Y_vad")  # names of times, then angles, in LARGE_SWING_FILE
PENDULUM_SOURCE = (  # download place of the measured pendulum swings
    "swinging pendulum: github.com/dynamicslab/MultiArm-Pendulum, commit e99a7e1 (MIT), files "
    f"{DECAY_FILE} and {LARGE_SWING_FILE}"
)


class FrameRun(NamedTuple):
    """One measured run of the shaken frame."""

    weight: float  # kg, mass of the disc that presses on the plate
    time: Array  # s, instants
    plate: Array  # mm, position of the top plate at each instant
    base: Array  # mm, position of the base at each instant

    @property
    def name(self) -> str:
        """Return the name of the run with the mass of its disc, for tables."""
        return f"frame, {1e3 * self.weight:g} g"


class FreeSwing(NamedTuple):
    """A measured free swing of a pendulum: T instants, s, and angles from its lowest position, rad."""

    time: Array
    angle: Array


class MeasuredFiles(NamedTuple):
    """Measurements found in a folder; what it does not hold is empty or None."""

    runs: list[FrameRun]
    decay: FreeSwing | None  # free decay of the pendulum
    large: FreeSwing | None  # large swings of the pendulum


def read_folder(folder: Path) -> MeasuredFiles:
    """Return the measurements in a folder and its direct subfolders. Raises SceneError for a faulty or missing file."""
    if not os.path.isdir(folder):
        raise make_file_error(folder, "must be a folder with the measured files")
    files: dict[str, Path] = {}
    for file in sorted([*folder.glob("*.mat"), *folder.glob("*/*.mat")]):
        if file.name in files:
            rule = f"must hold each file once: also {files[file.name].relative_to(folder)}; leave one of them"
            raise make_file_error(file, rule)
        files[file.name] = file
    named = [match for name in files if (match := FRAME_FILE_NAME.fullmatch(name))]
    plates, bases = ({match[1]: files[match[0]] for match in named if match[2] == axis} for axis in "xy")
    for grams in plates.keys() ^ bases.keys():
        missing = "y" if grams in plates else "x"
        raise make_file_error(folder, f"s_b_{grams}g_{missing}.mat is missing, but its partner is there")
    workers = Workers(1)
    try:
        runs = [_read_frame_run(workers, int(grams), plates[grams], bases[grams]) for grams in sorted(plates, key=int)]
        decay = (
            _read_swing(workers, files[DECAY_FILE], select_decay_columns, ("Theta1",)) if DECAY_FILE in files else None
        )
        large = (
            _read_swing(workers, files[LARGE_SWING_FILE], select_large_swing_columns, LARGE_SWING_VARIABLES)
            if LARGE_SWING_FILE in files
            else None
        )
    finally:
        workers.abandon()
    if not (runs or decay or large):
        rule = "holds none of the measured files: s_b_<weight>g_x.mat with s_b_<weight>g_y.mat"
        raise make_file_error(folder, f"{rule}, {DECAY_FILE}, {LARGE_SWING_FILE}")
    return MeasuredFiles(runs, decay, large)


def _read_frame_run(workers: Workers, grams: int, plate: Path, base: Path) -> FrameRun:
    """Return a measured run of the frame with a disc of `grams`, read from the files of its plate and base."""
    x, y = (_read_columns(workers, file, dict, ("t", name)) for file, name in ((plate, "x"), (base, "y")))
    time = _check_series(plate, "t", x["t"])
    motion = _check_series(plate, "x", x["x"], len(time), "mm")
    ground = _check_series(base, "y", y["y"], len(time), "mm")
    if np.ptp(ground) == 0.0:
        raise make_file_error(base, "y must move: every sample of the base is the same")
    own = _check_series(base, "t", y["t"])
    if len(own) != len(time) or np.abs(own - time).max() > 0.5 * (time[1] - time[0]):
        raise make_file_error(base, f"t must be the same as in {plate.name}")
    return FrameRun(grams * 1e-3, time, motion, ground)


def _read_swing(
    workers: Workers, file: Path, columns: Callable[[Any], Mapping[str, Any]], names: Sequence[str]
) -> FreeSwing:
    """Return a measured free swing of the pendulum: instants, s, and angles, rad."""
    found = _read_columns(workers, file, columns, names)
    (first, instants), (second, angles) = found.items()
    time = _check_series(file, first, instants)
    angle = _check_series(file, second, angles, len(time), "rad")
    if np.ptp(angle) == 0.0:
        raise make_file_error(file, f"{second} must move: every sample is the same")
    return FreeSwing(time, angle - np.pi)  # The published angles are pi at the lowest position.


def select_decay_columns(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return times and angles from the MATLAB structure Theta1 in the file of the decay."""
    try:
        return {"Theta1.time": content["Theta1"]["time"], "Theta1.values": content["Theta1"]["signals"]["values"]}
    except (KeyError, IndexError, TypeError):
        raise ValueError("Theta1 must be a structure with time and signals.values") from None


def select_large_swing_columns(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return times and angles joined from the MATLAB cells in the file of large swings."""
    try:
        return {
            shown: np.concatenate([np.atleast_2d(part)[0] for name in names for part in content[name]])
            for shown, names in (("Time", LARGE_SWING_VARIABLES[:2]), ("Y", LARGE_SWING_VARIABLES[2:]))
        }
    except (IndexError, TypeError, ValueError):
        raise ValueError("Y_id must be cells of angles and rates, (2, T)") from None


def _read_columns(
    workers: Workers, file: Path, columns: Callable[[Any], Mapping[str, Any]], names: Sequence[str]
) -> Mapping[str, Any]:
    """Return the columns of a measured file, read in a separate process. Raises SceneError if it is faulty."""
    try:
        found: Any = workers.start(partial(read_columns, file, columns, tuple(names)), MAX_READING_SECONDS).result()
    except TimeLimitError:
        found = f"takes more than {MAX_READING_SECONDS:g} s to read: must be a MATLAB file with columns of numbers"
    except WorkerDiedError:
        found = "ends the process that reads it: must be a MATLAB file with columns of numbers"
    if isinstance(found, str):
        raise make_file_error(file, found)
    return dict(found)


def read_columns(
    file: Path, columns: Callable[[Any], Mapping[str, Any]], names: tuple[str, ...]
) -> Mapping[str, Any] | str:
    """Return the columns of numbers in a file, by name, or what is wrong with it. Runs inside a worker process."""
    try:
        with limit_memory(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = read_file(file, MAX_FILE_BYTES)
            kinds = {name: kind for name, _, kind in whosmat(io.BytesIO(data))}
            for name in names:
                if name not in kinds:
                    return f"must hold the variable {name}"
                if columns is dict and kinds[name] not in NUMERIC_TYPES:
                    return _rule_of_column(name)
            found = loadmat(io.BytesIO(data), variable_names=names, simplify_cells=True)
    except OSError as error:
        return error.strerror or "cannot be read"
    except MemoryError:
        limit = f"{MAX_READING_BYTES / 2**20:.0f} MiB"
        return f"takes more than {limit} to read: must be a MATLAB file with columns of numbers"
    except Exception:  # SciPy raises errors of many types for a file that is not a MATLAB file.
        return "must be a MATLAB file of version 5 to 7.2"
    try:
        listed = columns({name: found[name] for name in names})
    except ValueError as error:
        return str(error)
    for name, values in listed.items():
        if not isinstance(values, np.ndarray) or values.dtype.kind not in "fiu" or values.size > 3 * MAX_SAMPLES:
            return _rule_of_column(name)
    return listed


@contextmanager
def limit_memory() -> Iterator[None]:
    """Let this process take at most MAX_READING_BYTES of memory more than now, if the system states how much it has."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except (OSError, ValueError):
        pages = 0
    if not pages or resource is None:
        yield
        return
    before = resource.getrlimit(resource.RLIMIT_AS)
    most = pages * resource.getpagesize() + MAX_READING_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (most if before[1] < 0 else min(most, before[1]), before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def _rule_of_column(name: str) -> str:
    """Return the rule that a column of measured numbers must keep, in words."""
    return f"{name} must be one column of 500 to {MAX_SAMPLES} numbers"


def _check_series(file: Path, name: str, values: Any, count: int | None = None, unit: str = "") -> Array:
    """
    Return a column of a file as floats; raise SceneError if it is faulty.

    count, unit: number of instants and unit of a column of motions; the column of times has neither.
    """
    series = np.asarray(values)
    if series.dtype.kind not in "fiu" or series.ndim != 1 or not 500 <= len(series) <= MAX_SAMPLES:
        raise make_file_error(file, _rule_of_column(name))
    series = series.astype(float)
    if count is not None and len(series) != count:
        raise make_file_error(file, f"{name} must have as many samples as the time, {count}, not {len(series)}")
    if not np.isfinite(series).all():
        raise make_file_error(file, f"{name} must be finite numbers")
    if count is None:
        _refuse_time(file, name, series)
    elif (farthest := float(np.abs(series).max())) > MAX_READINGS[unit]:
        rule = f"{name} must be a motion of at most {MAX_READINGS[unit]:g} {unit}, not {farthest:.3g} {unit}"
        raise make_file_error(file, rule)
    return series


def _refuse_time(file: Path, name: str, series: Array) -> None:
    """Raise SceneError if a time column does not rise in even steps or its duration is outside DURATION_RANGE."""
    with np.errstate(all="ignore"):
        steps, span = np.diff(series), float(series[-1] - series[0])
        even = np.ptp(steps) < 1e-3 * steps.mean()
    if not even:
        raise make_file_error(file, f"{name} must rise in even steps")
    if not DURATION_RANGE[0] <= span <= DURATION_RANGE[1]:
        raise make_file_error(
            file, f"{name} must span {DURATION_RANGE[0]:g} to {DURATION_RANGE[1]:g} s, not {span:.3g} s"
        )


def make_file_error(file: Path | str, rule: str) -> SceneError:
    """Return the error for a faulty measured file, which names it however long its path is; `rule`: what it must be."""
    if isinstance(file, Path) and file.suffix == ".mat":
        return SceneError("command line", "FOLDER", str(file.parent), f"{file.name}: {rule}")
    return SceneError("command line", "FOLDER", str(file), rule)
