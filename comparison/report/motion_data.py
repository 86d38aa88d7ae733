"""The motions that the page's script draws: their numbers packed, and where each stands among them."""

from __future__ import annotations

import base64
import gzip
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparison.analysis.trajectories import Place, StoredMotion
from comparison.report.findings import Findings
from reference.problem import Scene

Starts = dict[tuple[Place, str], int]


def packed_motions(found: Findings) -> str:
    """Every motion in order, 32-bit numbers: time (T,), position (T, N, 2), acceleration (T, N, 2)."""
    return packed(b"".join(_numbers(motion).tobytes() for motion in found.motions or []))


def packed(content: bytes) -> str:
    """Compressed and written in letters; the browser undoes both."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode()


def places(found: Findings, scene: Scene, starts: Starts) -> Iterator[dict[str, Any]]:
    own = [motion for motion in found.motions or [] if motion.place.scene == scene.name]
    alpha1, alpha2 = (np.asarray(found.surfaces[name]) for name in ("alpha1", "alpha2"))
    for place, motions in groupby(own, key=lambda motion: motion.place):
        yield {
            "row": place.row,
            "column": place.column,
            "phases": None if scene.recorded else [float(alpha1[place.row]), float(alpha2[place.column])],
            "why": place.why,
            "motions": [
                {
                    "model": motion.model,
                    "status": motion.status,
                    "error_message": motion.error_message,
                    "stick": [[round(start, 4), round(end, 4)] for start, end in motion.stick],
                    "start": starts[place, motion.model],
                    "count": len(motion.time),
                }
                for motion in motions
            ],
        }


def _numbers(motion: StoredMotion) -> NDArray[np.float32]:
    parts = (motion.time, motion.position, motion.acceleration)
    return np.concatenate([part.ravel() for part in parts]).astype("<f4")


def motion_starts(motions: Sequence[StoredMotion]) -> Starts:
    """Where the first number of every motion stands among all of them."""
    sizes = [motion.time.size + motion.position.size + motion.acceleration.size for motion in motions]
    keys = [(motion.place, motion.model) for motion in motions]
    return dict(zip(keys, np.concatenate([[0], np.cumsum(sizes)]).astype(int).tolist()))
