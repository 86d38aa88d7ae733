"""
How far the paper's assumptions hold: `phase-resonance assumptions [SCENE ...]`.

Exit codes: 0 done; 2 a wrong scene or option; others as in `run_command`.
"""

import math
from collections.abc import Sequence

from rich.console import Console

from comparison.analyses.assumptions.statements import (
    NO_EFFECT,
    assumption_lines,
    describe_direction,
    describe_range,
    describe_verdict,
    largest_change,
)
from comparison.analyses.assumptions.trials import DURATION, SUFFICIENT_ERROR
from comparison.analyses.assumptions.validity import MORE_PHASES, MORE_SIZES, Assumptions, Validity
from comparison.analyses.assumptions.variations import DIRECTED, MANY, Variation
from comparison.cli.arguments import STORED_RESULTS_HELP, CommandParser, command, read_number_of_jobs
from comparison.cli.computing import compute_tasks
from comparison.cli.terminal import make_table
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import make_wide_console
from comparison.study.models import has_spatial_data
from comparison.study.study import Study, refuse_same_names
from reference.problem import Scene, SceneError, builtin_scenes, load_scene

ENGINE = "multibody:amplification"  # import path of the engine function that the workers call


@command
def main(argv: Sequence[str], executor: Pool = make_process_pool) -> int:
    """Print how each scene's amplification changes if its supports and bodies are varied; return the exit code."""
    parser = CommandParser(
        "assumptions",
        "How far mu_i of the spatial model is from the translational one, over rings, heights, ovals, offsets, angles.",
    )
    parser.add_scenes("the paper's")
    parser.add_out(STORED_RESULTS_HELP)
    parser.add_computing()
    options = parser.parse_args(argv)
    read_number_of_jobs(options)  # only to refuse a wrong --jobs before scenes are read
    names = options.scenes or builtin_scenes()
    scenes = [_load_spatial_scene(name) for name in names]
    refuse_same_names((name, scene.name) for name, scene in zip(names, scenes))
    console = make_wide_console()
    about = f"{len(MANY)} variations, and up to {MORE_SIZES} sizes of an oval, an offset and an angle"
    about = f"{about} in the worst direction, at {len(MORE_PHASES)} phase pairs over at most {DURATION:g} s of motion"
    console.print(f"{about}: minutes for each scene.")
    assumptions = Assumptions(
        variations=MANY, phases=MORE_PHASES, sizes=MORE_SIZES, directed=tuple((key,) for key in DIRECTED)
    )
    study = Study(tuple(scenes), 1, SUFFICIENT_ERROR)
    results = compute_tasks("assumptions", options, argv, assumptions.tasks(study), {ENGINE}, console, executor)
    found = assumptions.collect(study, None, results)
    assert found is not None, "every scene has both models of the engine"
    for scene in scenes:
        _print_assumptions(console, scene, found)
    console.print(describe_verdict(found))
    return 0


def _load_spatial_scene(name: str) -> Scene:
    """Return a scene of two loading harmonics with the data that the spatial model needs; else raise SceneError."""
    scene = load_scene(name)
    if scene.recorded:
        rule = "rings and heights are varied at phases, which a record has not: give a scene of two frequencies"
        raise SceneError(name, "excitation.record", scene.name, rule)
    if not has_spatial_data(scene):
        rule = "the spatial model needs supports, ring and sphere_radius of the isolator, height and size of every body"
        raise SceneError(name, "isolator, bodies", scene.name, rule)
    return scene


def _print_assumptions(console: Console, scene: Scene, found: Validity) -> None:
    """
    Print a table with a row for each variation of a scene.

    A row has, for each body, the change of its amplification and the uncertainty u_D of that change, both in percent.
    """
    cells = [cell for cell in found.cells if cell.scene == scene.name]
    about = f"largest change of mu_i, {found.reading}, against the translational model, per body"
    console.print(f"{scene.title} ({scene.name}): {about}")
    table = make_table("ring, m", "heights x", "supports", "uneven", "change, %", "u_D, %", "outcomes")
    bodies, radius = range(1, len(scene.bodies) + 1), scene.support_radius or 0.0
    for cell in cells:
        varied = cell.variation
        changes = [largest_change(found, cell, body) for body in bodies]
        table.add_row(
            f"{varied.ring * radius:g}",
            f"{varied.height:g}",
            str(varied.supports or scene.isolator.support_count),
            _word_uneven_variation(varied, radius),
            "  ".join(f"{100.0 * each.size:+.3f}" if math.isfinite(each.size) else "none" for each in changes),
            "  ".join(f"{100.0 * each.error:.3f}" if math.isfinite(each.error) else "none" for each in changes),
            NO_EFFECT if cell.no_effect else ", ".join(sorted(set(cell.status))),
        )
    console.print(table)
    console.print(f"{sum(cell.cost for cell in cells):.0f} s of compute")
    limits = [describe_range(each) for each in found.ranges if each.scene == scene.name]
    directions = [describe_direction(scene, each) for each in found.directions if each.scene == scene.name]
    for line in dict.fromkeys([*directions, *limits, *assumption_lines(found, scene)]):
        console.print(line)


def _word_uneven_variation(variation: Variation, radius: float) -> str:
    """Return how a variation narrows the ring of supports, moves or rotates bodies. radius: of the stated ring, m."""
    towards = f"at {math.degrees(variation.direction):.0f}°"
    parts = [f"oval {variation.oval:.2g} {towards}"] if variation.oval else []
    parts += [f"{variation.offset * radius:.2g} m {towards}"] if variation.offset else []
    parts += [f"yaw {variation.yaw:.2g}"] if variation.yaw else []
    return ", ".join(parts)
