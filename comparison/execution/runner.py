"""
The tiles and errands of a study, each from the cache if it is there, else computed, stored at once, shown as progress.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.console import Console

from comparison.execution.cache import Cache
from comparison.execution.executors import Pool
from comparison.execution.keys import stored_tile, tile_key
from comparison.execution.progress import Stage, progress
from comparison.execution.splitting import halves, joined
from comparison.execution.sweep import sweep
from comparison.execution.task import Errand, Fetched, run_errand
from comparison.execution.task_cache import Answers
from comparison.execution.warm_up import WARM_UP, warm_up
from comparison.study.batches import Answer, Tile, solve_tile, unanswered
from comparison.study.overhead import COMPILED_ONCE, START_UP
from comparison.study.study import Study
from reference.problem import Outcome

COMPILING = "compiling the reference"


@dataclass(frozen=True)
class Computed:
    """`answers` to `tiles`, in their order. stored: how many were there before."""

    tiles: Sequence[Tile]
    answers: Sequence[Answer]
    stored: int


def computed(
    study: Study,
    cache: Cache,
    console: Console,
    jobs: int,
    executor: Pool,
    errands: Sequence[Errand] = (),
    answers: Answers | None = None,
) -> Computed:
    """
    Every tile of the study and every errand, the missing ones computed on `executor` in one sweep.

    What errands gave is in `answers`. Raises StoreError and ExecutorLostError.
    """
    answers = Answers(cache) if answers is None else answers
    tiles = study.tiles()
    found = {place: answer for place, tile in enumerate(tiles) if (answer := stored_tile(cache, tile)) is not None}
    missing = [place for place in range(len(tiles)) if place not in found]
    open_ = answers.missing(errands)
    stages = _stages(study, tiles, missing, errands, open_)
    if found:
        others = f", {len(errands) - len(open_)} of {len(errands)} analyses" if errands else ""
        stored = f"{len(found)} of {len(tiles)} tiles{others} are in {cache.folder}: only the others are computed."
        console.print(stored, soft_wrap=True)  # a path is copied whole
    if missing or open_:
        rest = [tiles[place] for place in missing]
        found |= zip(missing, _solved(study, rest, open_, cache, answers, console, stages, jobs, executor))
    return Computed(tiles, [found[place] for place in range(len(tiles))], len(tiles) - len(missing))


def fetched(errands: Sequence[Errand], answers: Answers, console: Console, jobs: int, executor: Pool) -> None:
    """Every errand, the missing ones computed on `executor`; what they gave is in `answers`. Raises as `computed`."""
    open_ = sorted(answers.missing(errands), key=lambda errand: -errand.seconds)
    if not open_:
        return
    with progress(console, _errand_stages(errands, open_), jobs) as display:

        def done(errand: Errand, found: Fetched | None) -> None:
            answers.put(errand, found)
            display.advance(errand.stage, 1)

        sweep(open_, run_errand, _nothing, done, jobs, executor)


def _stages(
    study: Study, tiles: Sequence[Tile], missing: Sequence[int], errands: Sequence[Errand], open_: Sequence[Errand]
) -> dict[str, Stage]:
    stages = {COMPILING: Stage(1, START_UP)} if missing or open_ else {}
    for rung in study.ladder:
        own = {place: len(tile.phases) for place, tile in enumerate(tiles) if tile.rung == rung.key}
        if own:
            points = sum(own.values())
            left = sum(own[place] for place in missing if place in own)
            stages[rung.title] = Stage(points, study.seconds(rung), points - left)
    return stages | _errand_stages(errands, open_)


def _errand_stages(errands: Sequence[Errand], open_: Sequence[Errand]) -> dict[str, Stage]:
    stages = {}
    for name in dict.fromkeys(errand.stage for errand in errands):
        own = [errand.seconds for errand in errands if errand.stage == name]
        left = sum(errand.stage == name for errand in open_)
        stages[name] = Stage(len(own), sum(own), len(own) - left)
    return stages


def _solved(
    study: Study,
    tiles: Sequence[Tile],
    errands: Sequence[Errand],
    cache: Cache,
    answers: Answers,
    console: Console,
    stages: dict[str, Stage],
    jobs: int,
    executor: Pool,
) -> list[Answer]:
    titles = {WARM_UP: COMPILING, **{rung.key: rung.title for rung in study.ladder}}
    compiled = {rung.key for rung in study.ladder if rung.side == "reference"}
    pending = {WARM_UP}
    console.print(COMPILED_ONCE)
    with progress(console, stages, jobs) as display:

        def done(piece: Piece, answer: Answer | Fetched | None) -> None:
            if isinstance(piece, Errand):
                assert not isinstance(answer, Answer)
                answers.put(piece, answer)
                display.advance(piece.stage, 1)
                return
            assert isinstance(answer, Answer)
            if piece.rung != WARM_UP:
                cache.put(tile_key(piece), answer)
            pending.discard(piece.rung)
            display.advance(titles[piece.rung], len(piece.phases))

        def ready(piece: Piece) -> bool:
            needs = piece.compiled if isinstance(piece, Errand) else piece.rung in compiled
            return not (pending and needs)

        # the longest errands first: no worker is left with one when the others are done
        asked: list[Piece] = [warm_up(study), *tiles, *sorted(errands, key=lambda errand: -errand.seconds)]
        found = sweep(asked, _run, _lost, done, jobs, executor, ready, _split, _join)
        return [answer for answer in found if isinstance(answer, Answer)][1:]  # without the warm-up


Piece = Tile | Errand


def _run(piece: Piece) -> Answer | Fetched | None:
    return run_errand(piece) if isinstance(piece, Errand) else solve_tile(piece)


def _lost(piece: Piece, outcome: Outcome, fault: str) -> Answer | Fetched | None:
    return None if isinstance(piece, Errand) else unanswered(piece, outcome, fault)


def _nothing(errand: Errand, outcome: Outcome, fault: str) -> Fetched | None:
    """The analysis asks again by itself and says in its own way that there is no answer."""
    return None


def _split(piece: Piece) -> Sequence[Piece]:
    return () if isinstance(piece, Errand) else halves(piece)


def _join(piece: Piece, answers: Sequence[Answer | Fetched | None]) -> Answer | Fetched | None:
    assert isinstance(piece, Tile), "errands are not split"
    return joined(piece, [answer for answer in answers if isinstance(answer, Answer)])
