"""
What long and tall frames answer: 2 to 20 bodies, links of 0.02 s to 0.2 s, 60 s of two- and three-directional records.

`python tests/benchmarks/tall_frames.py [SECONDS]` prints a line for each. One that takes longer than SECONDS (600) is
given up.
"""

from __future__ import annotations

import math
import signal
import sys
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

import multibody
from reference.problem import Scene, load_scene

sys.path.insert(0, str(Path(__file__).parents[1] / "multibody"))
from scenes_at_hand import frame

PHASE = (0.3, 1.1)
MODELS = ("translational", "spatial")
BODIES, LINK_PERIODS, DURATION = (2, 6, 12, 20), (0.2, 0.1, 0.05, 0.02), 60.0
RECORDS = {"two directions": "synthetic-pair", "three directions": "synthetic-triple"}


def tall_frame(count: int, period: float, record: str) -> Scene:
    """A frame under 60 s of a record, which repeats."""
    loading = load_scene(record)
    span = loading.record[-1, 0] + 0.02
    shifts = span * np.arange(math.ceil(DURATION / span))
    samples = np.vstack([loading.record + np.array([shift, 0.0, 0.0, 0.0]) for shift in shifts])
    excitation: dict[str, Any] = {"record": "repeated.csv", "samples": samples.tolist()}
    data = frame(DURATION, count, period).model_dump(exclude_none=True) | {"excitation": excitation}
    return Scene.model_validate(data)


def answers(seconds: int) -> None:
    """The answers of long and tall frames."""

    def give_up(number: int, place: Any) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, give_up)
    for model, (loading, record), count, period in product(MODELS, RECORDS.items(), BODIES, LINK_PERIODS):
        scene = tall_frame(count, period, record)
        signal.alarm(seconds)
        try:
            point = multibody.amplification(scene, [PHASE], model=model)
            error = float((point.error / point.mu).max())
            result = f"{point.status[0]}, error {error:.1e}, {point.cost:.1f} s"
        except TimeoutError:
            result = f"given up after {seconds} s"
        finally:
            signal.alarm(0)
        print(f"{model}, {loading}, {count} bodies, links of {period:g} s: {result}", flush=True)


if __name__ == "__main__":
    answers(int(sys.argv[1]) if len(sys.argv) > 1 else 600)
