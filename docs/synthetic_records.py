"""
The synthetic records that are shipped as examples: `python docs/synthetic_records.py FOLDER` writes them again.

The ground's velocity along axis k = 0, 1, 2 (x, y, z) over 0 <= t <= T is
    v_k(t) = w(t) sum_j f_j^(-1/2) sin(2 pi f_j t + 2 pi j (k + 1) (sqrt(5) - 1) / 2),   w(t) = sin^2(pi (t/T)^0.7),
f_j = 0.5 * 1.3^j Hz, j = 0 ... 11, so it is zero at both ends; the acceleration is its derivative, scaled so that its
largest sample is the peak given. No earthquake ever moved like this.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from reference.records.samples import Array
from reference.support.constants import GRAVITY

PER_LINE = 5  # values in a line of an .AT2 file
DESCRIPTION = "Synthetic, made by this project, no measurement: velocity along axis k = 0, 1, 2 (x, y, z)"
FORMULA = (
    "sin^2(pi (t/T)^0.7) sum_j f_j^-0.5 sin(2 pi f_j t + 2 pi j (k+1) 0.618034), f_j = 0.5 1.3^j Hz, j = 0..11,"
    " T = {:g} s; its derivative, scaled to the peak"
)


def acceleration(axis: int, time: Array, peak: float) -> Array:
    """The formula above at `time` (T,), s, from 0 to its end; peak: largest absolute sample, m/s^2."""
    j = np.arange(12)
    omega = 2.0 * np.pi * 0.5 * 1.3**j
    angle = np.multiply.outer(time, omega) + np.pi * j * (axis + 1) * (np.sqrt(5.0) - 1.0)
    wave, rate = np.sin(angle) @ omega**-0.5, np.cos(angle) @ omega**0.5
    part = (time / time[-1]) ** 0.7
    slope = np.divide(0.7 * part, time, out=np.zeros_like(time), where=time > 0.0)
    window = np.sin(np.pi * part) ** 2
    value = np.pi * slope * np.sin(2.0 * np.pi * part) * wave + window * rate
    value[-1] = 0.0  # but for rounding
    return np.asarray(peak * value / np.abs(value).max())


def csv_text(duration: float, step: float, peaks: tuple[float, float]) -> str:
    """Two horizontal directions as CSV."""
    time = step * np.arange(round(duration / step) + 1, dtype=float)
    columns = [time, *(acceleration(axis, time, peak) for axis, peak in enumerate(peaks))]
    rows = [",".join(f"{value:.6g}" for value in row) for row in zip(*columns)]
    header = [f"# {DESCRIPTION}", f"# {FORMULA.format(duration)}", "time [s],ax [m/s^2],ay [m/s^2]"]
    return "\n".join([*header, *rows]) + "\n"


def at2_text(axis: int, duration: float, step: float, peak: float) -> str:
    """One direction as PEER NGA .AT2, in g."""
    time = step * np.arange(round(duration / step) + 1, dtype=float)
    values = [f"{value:15.7E}" for value in acceleration(axis, time, peak) / GRAVITY]
    lines = ["".join(values[first : first + PER_LINE]) for first in range(0, len(values), PER_LINE)]
    header = [DESCRIPTION, FORMULA.format(duration), f"ACCELERATION TIME SERIES ALONG {'XYZ'[axis]} IN UNITS OF G"]
    return "\n".join([*header, f"NPTS= {len(values):6d}, DT= {step:.4f} SEC,", *lines]) + "\n"


def texts() -> dict[str, str]:
    """The shipped records by file name."""
    triple = [at2_text(axis, 12.0, 0.02, peak) for axis, peak in enumerate((2.0, 2.4, 0.6))]
    named = {f"synthetic-triple-{axis}.AT2": text for axis, text in zip("xyz", triple)}
    return {"synthetic-pair.csv": csv_text(16.0, 0.02, (2.5, 1.8)), **named}


if __name__ == "__main__":
    for name, text in texts().items():
        (Path(sys.argv[1]) / name).write_text(text)
