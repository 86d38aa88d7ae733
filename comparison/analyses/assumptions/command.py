"""
How far the paper's assumptions hold: `python -m comparison.assumptions [SCENE ...]`.

Exit codes: 0 done; 2 a wrong scene or option; others as in `run_command`.
"""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from comparison.analyses.assumptions import validity
from comparison.analyses.assumptions.feature import draw_assumption_figure
from comparison.cli.arguments import STORED_RESULTS, CommandParser, command, jobs, writing
from comparison.cli.computing import computed
from comparison.cli.terminal import new_table
from comparison.runner.output import destination, publish, refuse_foreign_files
from comparison.runner.processes import Pool, process_pool
from comparison.runner.progress import wide_console
from comparison.study.models import has_spatial_data
from comparison.study.study import Study, refuse_same_names
from comparison.surfaces.figures.file_names import figure_file
from reference.problem import Scene, SceneError, builtin_scenes, load_scene

ENGINE = "multibody:amplification"  # what the workers ask


@command
def main(argv: Sequence[str], executor: Pool = process_pool) -> int:
    """Vary the scenes the command line names and print what that does; the exit code."""
    parser = CommandParser(
        "assumptions", "How far mu_i of the spatial model is from the translational one, over the ring and the heights."
    )
    parser.add_scenes("the paper's")
    parser.add_out(STORED_RESULTS)
    parser.add_computing()
    parser.add_argument("--figures", type=Path, metavar="DIR", help="write one picture per scene into this directory")
    options = parser.parse_args(argv)
    jobs(options)  # refused before anything else is looked at
    names = options.scenes or builtin_scenes()
    scenes = [_spatial(name) for name in names]
    refuse_same_names((name, scene.name) for name, scene in zip(names, scenes))
    figures = destination(options.figures, "--figures") if options.figures else None
    if figures:
        pictures = [figure_file(s.name, "assumptions", ending=end) for s in scenes for end in (".png", ".pdf")]
        refuse_foreign_files(figures, pictures, "--figures")
    console = wide_console()
    about = f"{len(validity.MANY)} variations at {len(validity.PHASES)} phase pairs over {validity.DURATION:g} s"
    console.print(f"{about} of motion: minutes for each scene.")
    assumptions, study = validity.Assumptions(validity.MANY), Study(tuple(scenes), 1, validity.CLOSE_ENOUGH)
    results = computed("assumptions", options, argv, assumptions.tasks(study), {ENGINE}, console, executor)
    found = assumptions.collect(study, None, results)
    assert found is not None, "every scene has both models of the engine"
    for scene in scenes:
        cells = [cell for cell in found.cells if cell.scene == scene.name]
        _print(console, scene, cells)
        if figures:
            with writing(figures, "--figures"):
                publish(figures, dict(draw_assumption_figure((scene, cells))), "comparison.assumptions")
    return 0


def _spatial(name: str) -> Scene:
    scene = load_scene(name)
    if scene.recorded:
        rule = "rings and heights are varied at phases, which a record has not: give a scene of two frequencies"
        raise SceneError(name, "excitation.record", scene.name, rule)
    if not has_spatial_data(scene):
        rule = "the spatial model needs supports, ring and sphere_radius of the isolator, height and size of every body"
        raise SceneError(name, "isolator, bodies", scene.name, rule)
    return scene


def _print(console: Console, scene: Scene, cells: Sequence[validity.AssumptionCell]) -> None:
    console.print(f"{scene.title} ({scene.name}): largest change of mu_i against the translational model, per body")
    table = new_table("ring, m", "heights x", "supports", "offset, m", "yaw, rad", "change, %", "u_D, %", "outcomes")
    bodies, radius = range(1, len(scene.bodies) + 1), scene.support_radius or 0.0
    for cell in cells:
        each = cell.variation
        table.add_row(
            f"{each.ring * radius:g}",
            f"{each.height:g}",
            str(each.supports or scene.isolator.support_count),
            f"{each.offset * radius:g}",
            f"{each.yaw:g}",
            "  ".join(f"{100.0 * cell.largest(body):.3f}" for body in bodies),
            "  ".join(f"{100.0 * cell.error_estimate(body):.3f}" for body in bodies),
            ", ".join(sorted(set(cell.status))),
        )
    console.print(table)
    console.print(f"{sum(cell.cost for cell in cells):.0f} s of compute")
    for line in [*map(validity.describe, validity.ranges(scene, cells)), *validity.uneven_lines(scene, cells)]:
        console.print(line)
