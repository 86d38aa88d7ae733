"""
One short call of every compiled model before the workers share the work.

The reference is compiled on its first call on a machine and then kept on disk. Done once, in one worker, before the
others start, no two of them compile the same code side by side, and the user is told what is going on.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace

from rich.console import Console

from comparison.study import Study
from comparison.sweep import sweep
from comparison.tiles import Tile, solve_tile, unanswered

DURATION = 0.5  # s of motion: enough to reach every function, and over in milliseconds


def first_calls(study: Study) -> list[Tile]:
    """One phase pair of every scene under every model of the reference, over a short time."""
    compiled = {rung.key for rung in study.ladder if rung.side == "reference"}
    return [
        replace(tile, scene=tile.scene.model_copy(update={"duration": DURATION}), phases=tile.phases[:1])
        for tile in study.tiles()
        if tile.rung in compiled and tile.first == 0
    ]


def warm_up(console: Console, study: Study, executor: Callable[[int], Executor]) -> None:
    """Have the equations compiled. What fails here fails again in the run itself, where it is answered for."""
    begin = time.monotonic()
    console.print("Compiling the reference's equations: about a minute on a new installation, then kept on disk.")
    calls = first_calls(study)  # over so short a time their numbers mean nothing
    sweep(calls, solve_tile, unanswered, lambda tile, answer: None, 1, executor)
    console.print(f"Ready after {time.monotonic() - begin:.0f} s.")
