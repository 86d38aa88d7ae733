"""The tiles of a study, each from the store if it is there, else computed, stored at once, and shown as progress."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.console import Console

from comparison.plan.study import Study
from comparison.plan.tiles import Answer, Tile, solve_tile, unanswered
from comparison.sweep.executors import Pool
from comparison.sweep.halves import halves, joined
from comparison.sweep.progress import Stage, progress
from comparison.sweep.sweep import sweep
from comparison.sweep.tile_store import TileStore
from comparison.sweep.warm_up import START_UP, WARM_UP, warm_up

COMPILING = "compiling the reference"


@dataclass(frozen=True)
class Computed:
    """`answers` to `tiles`, in their order. stored: how many were there before."""

    tiles: Sequence[Tile]
    answers: Sequence[Answer]
    stored: int


def computed(study: Study, store: TileStore, console: Console, jobs: int, executor: Pool) -> Computed:
    """Every tile of the study, the missing ones computed on `executor`. Raises StoreError and ExecutorLostError."""
    tiles = study.tiles()
    found = {place: answer for place, tile in enumerate(tiles) if (answer := store.get(tile)) is not None}
    missing = [place for place in range(len(tiles)) if place not in found]
    stages = _stages(study, tiles, missing)
    if found:
        stored = f"{len(found)} of {len(tiles)} tiles are in {store.folder}: only the others are computed."
        console.print(stored, soft_wrap=True)  # a path is copied whole
    if missing:
        rest = [tiles[place] for place in missing]
        found |= zip(missing, _solved(study, rest, store, console, stages, jobs, executor))
    return Computed(tiles, [found[place] for place in range(len(tiles))], len(tiles) - len(missing))


def _stages(study: Study, tiles: Sequence[Tile], missing: Sequence[int]) -> dict[str, Stage]:
    stages = {COMPILING: Stage(1, START_UP)} if missing else {}
    for rung in study.ladder:
        own = {place: len(tile.phases) for place, tile in enumerate(tiles) if tile.rung == rung.key}
        if own:
            points = sum(own.values())
            left = sum(own[place] for place in missing if place in own)
            stages[rung.title] = Stage(points, study.seconds(rung), points - left)
    return stages


def _solved(
    study: Study,
    tiles: Sequence[Tile],
    store: TileStore,
    console: Console,
    stages: dict[str, Stage],
    jobs: int,
    executor: Pool,
) -> list[Answer]:
    titles = {WARM_UP: COMPILING, **{rung.key: rung.title for rung in study.ladder}}
    compiled = {rung.key for rung in study.ladder if rung.side == "reference"}
    pending = {WARM_UP}
    console.print("On a new installation the reference is compiled first, once: that takes minutes.")
    with progress(console, stages, jobs) as display:

        def done(tile: Tile, answer: Answer) -> None:
            if tile.rung != WARM_UP:
                store.put(tile, answer)
            pending.discard(tile.rung)
            display.advance(titles[tile.rung], len(tile.phases))

        def ready(tile: Tile) -> bool:
            return not pending or tile.rung not in compiled

        asked = [warm_up(study), *tiles]
        return sweep(asked, solve_tile, unanswered, done, jobs, executor, ready, halves, joined)[1:]
