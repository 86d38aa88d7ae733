"""
How the cost of one point of the engine grows with bodies and duration, and what long and tall frames answer.

`python tests/benchmarks/multibody_growth.py growth` prints processor time and slopes,
`python tests/benchmarks/multibody_growth.py tall [SECONDS]` the answers of frames of 2 to 20 bodies with links of
0.02 s to 0.2 s under 60 s of two- and three-directional records. A point that takes longer than SECONDS (600) is given
up.
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
from comparison.analysis.growth import fitted_slope
from reference.problem import Scene, load_scene

sys.path.insert(0, str(Path(__file__).parents[1] / "multibody"))
from scenes_at_hand import frame

PHASE = (0.3, 1.1)
BODIES, FRAME_DURATION = (2, 4, 8, 16, 32, 64, 100), 10.0
DURATIONS = (10.0, 30.0, 100.0, 300.0, 1000.0)
MODELS = ("translational", "spatial")
TALL_BODIES, LINK_PERIODS, TALL_DURATION = (2, 6, 12, 20), (0.2, 0.1, 0.05, 0.02), 60.0
RECORDS = {"two directions": "synthetic-pair", "three directions": "synthetic-triple"}


def cost_of(scene: Scene, model: str) -> tuple[float, str]:
    """Processor time of one point, s, and its status."""
    point = multibody.amplification(scene, [PHASE], model=model, max_work=1e8)
    return point.cost, str(point.status[0])


def growth() -> None:
    """Cost against bodies and against duration, with slopes."""
    cost_of(frame(1.0, 2), "translational")  # loads what the first call loads
    for model in MODELS:
        for quantity, sizes in (("bodies", BODIES), ("duration", DURATIONS)):
            costs = []
            for size in sizes:
                scene = (
                    frame(FRAME_DURATION, int(size))
                    if quantity == "bodies"
                    else load_scene("fig3-I").with_values({"duration": size})
                )
                cost, status = cost_of(scene, model)
                costs.append(cost)
                print(f"{model}, {quantity} {size:g}: {cost:.2f} s, {status}", flush=True)
            power, _ = fitted_slope(sizes, costs)
            print(f"{model}: cost grows with {quantity} to the power {power:.2f}", flush=True)


def tall_frame(count: int, period: float, record: str) -> Scene:
    """A frame under 60 s of a record, which repeats."""
    loading = load_scene(record)
    span = loading.record[-1, 0] + 0.02
    shifts = span * np.arange(math.ceil(TALL_DURATION / span))
    samples = np.vstack([loading.record + np.array([shift, 0.0, 0.0, 0.0]) for shift in shifts])
    excitation: dict[str, Any] = {"record": "repeated.csv", "samples": samples.tolist()}
    data = frame(TALL_DURATION, count, period).model_dump(exclude_none=True) | {"excitation": excitation}
    return Scene.model_validate(data)


def tall(seconds: int) -> None:
    """The answers of long and tall frames."""

    def give_up(number: int, place: Any) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, give_up)
    for model, (loading, record), count, period in product(MODELS, RECORDS.items(), TALL_BODIES, LINK_PERIODS):
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
    if sys.argv[1:2] == ["tall"]:
        tall(int(sys.argv[2]) if len(sys.argv) > 2 else 600)
    else:
        growth()
