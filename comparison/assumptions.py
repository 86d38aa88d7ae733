"""
The paper's assumptions (i)-(vi): what the engine's models do with each, and how far they carry.

`python -m comparison.assumptions [SCENE ...]` varies the ring of supports and the heights of the bodies and prints how
far mu_i then is from the translational result, and where it stays within 1 % and 5 %. Exit codes: 0 done; 2 a wrong
scene or option; 130 interrupted.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from comparison.executors import process_pool
from comparison.ladder import has_spatial_data
from comparison.progress import wide_console
from comparison.study import Study
from comparison.variations import DURATION, MANY, PHASES, Cell, Range, assumption_cells, ranges
from reference.problem import Scene, SceneError, builtin_scenes, load_scene

TOLERANCE = 1e-3


@dataclass(frozen=True)
class Assumption:
    """One of (i)-(vi): what the paper says, what the engine's models do with it, and what measures the rest."""

    number: str
    statement: str
    engine: str
    relaxed: Literal["yes", "partly", "no"]


ASSUMPTIONS = (
    Assumption(
        "(i)",
        "all supports touch the platform along one circle",
        "The circle stays, its radius and the number of supports are free. In the translational model neither matters, "
        "because every support sees the same slip and the loads only enter by their sum.",
        "partly",
    ),
    Assumption(
        "(ii)",
        "the centres of mass lie on one axis through the centre of the circle",
        "Kept: a scene states heights, no eccentricities. The heights above the contacts, which the paper's equations "
        "do not contain, are free.",
        "no",
    ),
    Assumption(
        "(iii)",
        "the principal axes of inertia of all bodies are parallel",
        "Kept: bodies are boxes along the axes. Their moments of inertia, which do not enter translation, follow from "
        "masses and sizes.",
        "no",
    ),
    Assumption(
        "(iv)",
        "flexible bars that neither stretch nor move vertically",
        "Bars stretch by 1e-5 rho under the weight of all bodies and bend likewise; every body has its own vertical "
        "motion. With all heights zero this is all that is left, together with (v).",
        "yes",
    ),
    Assumption(
        "(v)",
        "friction acts at the contacts of supports and depressions only",
        "Kept, but every support has a contact force and a slip velocity of its own, so that friction can twist the "
        "platform. The balls stand still on the plate, as in the paper.",
        "partly",
    ),
    Assumption(
        "(vi)",
        "the bodies move translationally",
        "Dropped: six degrees of freedom for every body, contacts that open. What this changes grows with the heights "
        "over the radius of the ring.",
        "yes",
    ),
)


@dataclass(frozen=True)
class Reach:
    """How far the assumptions carry in some scenes: the cells computed and what they say, for the report."""

    scenes: Sequence[Scene]
    cells: Sequence[Cell]
    assumptions: Sequence[Assumption] = ASSUMPTIONS
    phases: Sequence[Sequence[float]] = tuple(map(tuple, PHASES.tolist()))  # rad
    duration: float = DURATION  # s

    @staticmethod
    def of(study: Study, jobs: int, executor: Callable[[int], Executor]) -> Reach | None:
        """The few cells that a study computes; None if no scene of it has a spatial model."""
        cells = assumption_cells(study, jobs, executor)
        names = {cell.scene for cell in cells}
        return Reach([scene for scene in study.scenes if scene.name in names], cells) if cells else None

    def lines(self, scene: Scene) -> list[str]:
        """One line per body, share and direction."""
        return [said(found) for found in ranges([scene], self.cells)]

    def listed(self) -> dict[str, Any]:
        """For summary.json: assumptions, phase pairs, duration, every cell and every range."""
        return {
            "assumptions": [asdict(one) for one in self.assumptions],
            "phases": [list(pair) for pair in self.phases],
            "duration": self.duration,
            "cells": [asdict(cell) for cell in self.cells],
            "ranges": [asdict(found) for found in ranges(self.scenes, self.cells)],
        }


def main(argv: Sequence[str] | None = None) -> int:
    """Vary the scenes the command line names and print what that does; the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m comparison.assumptions",
        description="How far mu_i of the spatial model is from the translational one, over the ring and the heights.",
    )
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="TOML file or built-in name (default: the paper's)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="worker processes (default %(default)s)")
    parser.add_argument("--figures", type=Path, metavar="DIR", help="write one picture per scene into this directory")
    given = parser.parse_args(argv)
    if given.jobs < 1:
        parser.error(f"--jobs {given.jobs}: must be a whole number from 1")
    try:
        scenes = [_spatial(name) for name in given.scenes or builtin_scenes()]
    except SceneError as fault:
        print(fault, file=sys.stderr)
        return 2
    console = wide_console()
    console.print(
        f"{len(MANY)} variations at {len(PHASES)} phase pairs over {DURATION:g} s of motion: minutes for each scene."
    )
    try:
        for scene in scenes:
            cells = _watched(console, scene, given.jobs)
            _print(console, scene, cells)
            if given.figures:
                from comparison.assumption_figure import assumption_figure_name, draw_assumptions

                given.figures.mkdir(parents=True, exist_ok=True)
                draw_assumptions(given.figures / assumption_figure_name(scene), scene, cells)
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    return 0


def _spatial(name: str) -> Scene:
    scene = load_scene(name)
    if not has_spatial_data(scene):
        rule = "the spatial model needs supports, ring and sphere_radius of the isolator, height and size of every body"
        raise SceneError(name, "isolator, bodies", scene.name, rule)
    return scene


def _watched(console: Console, scene: Scene, jobs: int) -> list[Cell]:
    with Progress(console=console, transient=True) as progress:
        bar = progress.add_task(scene.name, total=1 + len(MANY))
        study = Study((scene,), 1, TOLERANCE)
        return assumption_cells(study, jobs, process_pool, MANY, lambda: progress.advance(bar))


def _print(console: Console, scene: Scene, cells: Sequence[Cell]) -> None:
    console.print(f"{scene.title} ({scene.name}): largest change of mu_i against the translational model, per body")
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("ring, m", "heights x", "supports", "change, %", "u_D, %", "outcomes"):
        table.add_column(heading, justify="right", no_wrap=True)
    bodies = range(1, len(scene.bodies) + 1)
    for cell in cells:
        own = cell.variation.of(scene).isolator
        table.add_row(
            f"{own.ring:g}",
            f"{cell.variation.height:g}",
            str(own.supports),
            "  ".join(f"{100.0 * cell.largest(body):.3f}" for body in bodies),
            "  ".join(f"{100.0 * cell.uncertain(body):.3f}" for body in bodies),
            ", ".join(sorted(set(cell.status))),
        )
    console.print(table)
    console.print(f"{sum(cell.cost for cell in cells):.0f} s of compute")
    for found in ranges([scene], cells):
        console.print(said(found))


def said(found: Range) -> str:
    """One line for people: where mu_i stays within a share of the translational result."""
    what = f"mu_{found.body} stays within {100.0 * found.share:g} %"
    if found.key == "ring":
        if found.holds is None:
            return f"{what} at no ring tried, up to {found.fails:g} m"
        fails = "every smaller one tried too" if found.fails is None else f"no longer at {found.fails:g} m"
        return f"{what} with rings from {found.holds:g} m, {fails}"
    if found.holds is None:
        return f"{what} at no heights tried"
    fails = "the largest tried" if found.fails is None else f"no longer at {found.fails:g} times"
    return f"{what} with heights up to {found.holds:g} times the stated ones, {fails}"


if __name__ == "__main__":
    sys.exit(main())
