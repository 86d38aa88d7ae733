"""The measured files, as their authors publish them, read where the user has them."""

import io
import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.io import loadmat

from comparison.result_types import Array
from reference.problem import SceneError
from reference.support.files import read_file

LARGEST = 2**24  # bytes of a file
MAX_SAMPLES = 2_000_000
FRAME = re.compile(r"s_b_(\d{1,5})g_([xy])\.mat")
DECAY, LARGE = "SingleDataFreeSwing_1_Dt_0_0001.mat", "SinglePendulumDataForParameterEstimation.mat"
FRAME_SOURCE = (
    "single-storey frame with a brass-to-steel contact, Marino, Cicirello, Data-Centric Engineering 2023 "
    "(arXiv 2303.03858), rig in Nonlinear Dynamics 99 (2020) 1781-1799: github.com/l-marino/switching-GPLFM, commit "
    "01dc3d9 (GPL-3.0), files s_b_<weight>g_x.mat and s_b_<weight>g_y.mat"
)
PENDULUM_SOURCE = (
    f"swinging pendulum: github.com/dynamicslab/MultiArm-Pendulum, commit e99a7e1 (MIT), files {DECAY} and {LARGE}"
)


class Shaken(NamedTuple):
    """One run of the frame: weight of the disc, kg; time, s; motions of top plate and base, mm, (T,)."""

    weight: float
    time: Array
    plate: Array
    base: Array

    @property
    def name(self) -> str:
        """For tables."""
        return f"frame, {1e3 * self.weight:g} g"


class Swing(NamedTuple):
    """A free swing: time, s, and angle from hanging, rad, (T,)."""

    time: Array
    angle: Array


class Measured(NamedTuple):
    """What a folder holds."""

    runs: list[Shaken]
    decay: Swing | None
    large: Swing | None


def read_folder(folder: Path) -> Measured:
    """The measured files in a folder and in the folders directly in it. Raises SceneError, one line."""
    if not folder.is_dir():
        raise wrong_file(folder, "must be a folder with the measured files")
    files: dict[str, Path] = {}
    for file in sorted([*folder.glob("*.mat"), *folder.glob("*/*.mat")]):
        if file.name in files:
            rule = f"must hold each file once: also {files[file.name].relative_to(folder)}; leave one of them"
            raise wrong_file(file, rule)
        files[file.name] = file
    named = [match for name in files if (match := FRAME.fullmatch(name))]
    plates, bases = ({match[1]: files[match[0]] for match in named if match[2] == axis} for axis in "xy")
    for grams in plates.keys() ^ bases.keys():
        missing = "y" if grams in plates else "x"
        raise wrong_file(folder, f"s_b_{grams}g_{missing}.mat is missing beside its partner")
    runs = []
    for grams in sorted(plates, key=int):
        x, y = _content(plates[grams], "t", "x"), _content(bases[grams], "t", "y")
        time = _series(plates[grams], "t", x["t"])
        plate = _series(plates[grams], "x", x["x"], len(time))
        runs.append(Shaken(int(grams) * 1e-3, time, plate, _series(bases[grams], "y", y["y"], len(time))))
    decay = _decay(files[DECAY]) if DECAY in files else None
    large = _large(files[LARGE]) if LARGE in files else None
    if not (runs or decay or large):
        rule = f"holds none of the measured files: s_b_<weight>g_x.mat with s_b_<weight>g_y.mat, {DECAY}, {LARGE}"
        raise wrong_file(folder, rule)
    return Measured(runs, decay, large)


def _decay(file: Path) -> Swing:
    content = _content(file, "Theta1")["Theta1"]
    try:
        instants = _series(file, "Theta1.time", content["time"])
        return Swing(instants, _series(file, "Theta1.values", content["signals"]["values"], len(instants)) - np.pi)
    except (KeyError, IndexError, TypeError) as error:
        raise wrong_file(file, "Theta1 must be a structure with time and signals.values") from error


def _large(file: Path) -> Swing:
    content = _content(file, "Time_id", "Time_vad", "Y_id", "Y_vad")
    try:
        time, angle = (
            np.concatenate([np.atleast_2d(part)[0] for name in names for part in content[name]])
            for names in (("Time_id", "Time_vad"), ("Y_id", "Y_vad"))
        )
    except (IndexError, TypeError, ValueError) as error:
        raise wrong_file(file, "Y_id must be cells of angles and rates, (2, T)") from error
    instants = _series(file, "Time", time)
    return Swing(instants, _series(file, "Y", angle, len(instants)) - np.pi)


def _content(file: Path, *names: str) -> dict[str, Any]:
    try:
        content = loadmat(io.BytesIO(read_file(file, LARGEST)), variable_names=names, simplify_cells=True)
    except OSError as error:
        raise wrong_file(file, error.strerror or "cannot be read") from None
    except Exception as error:  # whatever scipy makes of bytes that are no such file
        raise wrong_file(file, "must be a MATLAB file of version 5 to 7.2") from error
    for name in names:
        if name not in content:
            raise wrong_file(file, f"must hold the variable {name}")
    return dict(content)


def _series(file: Path, name: str, values: Any, count: int | None = None) -> Array:
    """A column of finite samples; rising at even steps where it is the time, `count` is None."""
    series = np.asarray(values)
    if series.dtype.kind not in "fiu" or series.ndim != 1 or not 500 <= len(series) <= MAX_SAMPLES:
        raise wrong_file(file, f"{name} must be one column of 500 to {MAX_SAMPLES} numbers")
    series = series.astype(float)
    if count is not None and len(series) != count:
        raise wrong_file(file, f"{name} must have as many samples as the time, {count}, not {len(series)}")
    if not np.isfinite(series).all():
        raise wrong_file(file, f"{name} must be finite numbers")
    steps = np.diff(series)
    if count is None and not (steps.min() > 0.0 and np.ptp(steps) < 1e-3 * steps.mean()):
        raise wrong_file(file, f"{name} must rise in even steps")
    return series


def wrong_file(file: Path | str, rule: str) -> SceneError:
    """Return what is wrong with a file, in one line."""
    return SceneError("command line", "FOLDER", str(file), rule)
