"""
One short call of the reference before its share of the work begins.

The reference is compiled on its first call on a machine and then kept on disk. One worker does that while the others
are busy with the engine, so that no two of them compile the same code side by side.

It is compiled in a process that ends: beside the build it runs what it compiled on the way there, and its mu differs in
the eleventh digit from that of every process which loads the build. An interrupted run must not show in the numbers.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
from dataclasses import replace

from comparison.plan.study import Study
from comparison.plan.tiles import Answer, Tile, solve_tile

DURATION = 0.5  # s of motion: enough to reach every function, and over in milliseconds
COMPILED = "reference:"  # the models that are
APART = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from comparison.plan.tiles import solve_tile
solve_tile(pickle.load(sys.stdin.buffer))
"""
WARM_UP = "warm-up"  # rung of the tile, which belongs to no surface


def warm_up(study: Study) -> Tile:
    """
    One phase pair of the first scene under the exact equations, which no reduction solves without stepping, or under
    the first model. Over so short a time its numbers mean nothing.
    """
    tiles = study.tiles()
    tile = next((tile for tile in tiles if tile.rung == "exact"), tiles[0])
    scene = tile.scene.with_values({"duration": DURATION})
    return replace(tile, rung=WARM_UP, scene=scene, phases=tile.phases[:1])


def warmed_up(tile: Tile) -> Answer:
    """The answer to a warm-up, from the build that is on disk by then."""
    if tile.amplification.startswith(COMPILED):
        paths, asked = pickle.dumps(sys.path), pickle.dumps(tile)  # where to find it before what needs it
        quiet = subprocess.DEVNULL
        subprocess.run([sys.executable, "-c", APART], input=paths + asked, stdout=quiet, stderr=quiet, check=False)
    return solve_tile(tile)
