"""
The study on the command line: `python -m comparison.run [SCENE ...]`.

Exit codes: 0 done; 1 a limit of --check is broken; 2 a wrong scene or option, before anything is computed;
3 the report could not be written; 130 interrupted.
"""

from __future__ import annotations

import shlex
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from datetime import UTC, datetime

from rich.console import Console

from comparison.effective import effective_values
from comparison.executors import process_pool
from comparison.findings import findings
from comparison.ladder import LADDER, Rung
from comparison.options import Options, UsageError, parsed
from comparison.progress import Stage, progress
from comparison.provenance import provenance
from comparison.slips import slip_effects
from comparison.store import replaced_when_complete
from comparison.study import Study
from comparison.surfaces import labelled_surfaces
from comparison.sweep import sweep
from comparison.terminal import START_UP, print_differences, print_plan
from comparison.tiles import Answer, Tile, solve_tile, unanswered
from comparison.trajectories import stored_motions
from comparison.warm_up import WARM_UP, warm_up
from reference.problem import SceneError

PLAIN_WIDTH = 120  # columns of a table that goes to a file or a pipe


def main(
    argv: Sequence[str] | None = None,
    ladder: Sequence[Rung] = LADDER,
    executor: Callable[[int], Executor] = process_pool,
) -> int:
    """Run the study the command line asks for, with the models of `ladder` on `executor(jobs)`; the exit code."""
    try:
        options = parsed(argv)
        console = Console(highlight=False, width=None if sys.stdout.isatty() else PLAIN_WIDTH)
        study = Study(options.scenes, options.grid, options.tolerance, ladder)
        if options.plan:
            print_plan(console, study, options)
            return 0
        words = sys.argv[1:] if argv is None else argv
        return _run(study, options, console, shlex.join(["python", "-m", "comparison.run", *words]), executor)
    except (SceneError, UsageError) as fault:
        print(fault, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted: nothing was written; the same command starts again", file=sys.stderr)
        return 130
    except OSError as fault:
        print(f"command line: --out = {str(options.out)!r}: the report could not be written: {fault}", file=sys.stderr)
        return 3


def _run(study: Study, options: Options, console: Console, command: str, executor: Callable[[int], Executor]) -> int:
    from comparison.report import write_report  # plotting libraries: not needed to refuse a command or to plan

    begin, began = time.monotonic(), datetime.now(UTC)
    tiles = [warm_up(study), *study.tiles()]
    titles = {WARM_UP: "compiling the reference", **{rung.key: rung.title for rung in study.ladder}}
    compiled = {rung.key for rung in study.ladder if rung.side == "reference"}
    pending = {WARM_UP}
    stages = {
        rung.title: Stage(sum(len(tile.phases) for tile in tiles if tile.rung == rung.key), study.seconds(rung))
        for rung in study.ladder
    }
    stages = {title: stage for title, stage in stages.items() if stage.points}
    stages = {titles[WARM_UP]: Stage(1, START_UP), **stages}
    console.print("On a new installation the reference is compiled first, once: that takes minutes.")
    with progress(console, stages, options.jobs) as display:

        def done(tile: Tile, answer: Answer) -> None:
            pending.discard(tile.rung)
            display.advance(titles[tile.rung], len(tile.phases))

        def ready(tile: Tile) -> bool:
            return not pending or tile.rung not in compiled

        answers = sweep(tiles, solve_tile, unanswered, done, options.jobs, executor, ready)
    tiles, answers = tiles[1:], answers[1:]
    computed = time.monotonic() - begin
    surfaces = labelled_surfaces(study, tiles, answers)
    console.print("Reading the effective values back from one motion of every model.")
    effective = effective_values(study, options.jobs, executor)
    console.print("Measuring what the slips of the print do to the surfaces.")
    effects = slip_effects(study, options.jobs, executor)
    console.print("Keeping a few motions of every scene for the report.")
    motions = stored_motions(study, surfaces, options.jobs, executor)
    faults = sorted(
        {f"{tile.scene.name}, {titles[tile.rung]}: {a.fault}" for tile, a in zip(tiles, answers) if a.fault}
    )
    run = {
        "command": command,
        "began": began.isoformat(timespec="seconds"),
        "seconds": round(computed, 1),
        "compute_seconds": round(float(surfaces["cost"].sum()), 1),
        "predicted_compute_seconds": round(sum(stage.seconds for stage in stages.values()), 1),
        "jobs": options.jobs,
        "provenance": provenance(),
    }
    found = findings(study, surfaces, effective, effects, faults, run, motions=motions)
    console.print("Drawing the figures and writing the report.")
    with replaced_when_complete(options.out) as folder:
        write_report(folder, found)
    for line in faults:
        print(f"solver: {line}", file=sys.stderr)
    for line in found.broken if options.check else []:
        print(f"limit broken: {line}", file=sys.stderr)
    _print_closing(console, options, run, time.monotonic() - begin)
    print_differences(console, found.rows)
    return 1 if options.check and found.broken else 0


def _print_closing(console: Console, options: Options, run: dict[str, object], seconds: float) -> None:
    console.print(
        f"{seconds:.0f} s with {options.jobs} workers: {run['compute_seconds']} s of compute "
        f"({run['predicted_compute_seconds']} s predicted)."
    )
    console.print(f"Report: {options.out / 'index.html'}", soft_wrap=True)  # a path is copied whole
    console.print("Next: open it in a browser; a finer look: --grid N with a larger N; what that costs: --plan.")
    console.print("Relative differences over the phases, per body:")


if __name__ == "__main__":
    sys.exit(main())
