"""Terminal output before a run: what would be computed, and roughly how long it would take."""

from collections.abc import Sequence
from dataclasses import replace

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from comparison.cli.options import Options
from comparison.registry import estimate_stage_seconds, estimate_study_seconds, make_study_levels, select_analyses
from comparison.runner.cache import Cache, locate_store
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import find_refusal
from comparison.study.costs import COMPILING_SECONDS, STARTING_SECONDS, WRITING_SECONDS
from comparison.study.models import models_of, why_not_spatial
from comparison.study.records import describe_records
from comparison.study.reductions import list_skipped_computations
from comparison.study.study import Study
from comparison.surfaces.surfaces import make_surface_tasks
from reference.building import Building, describe_building, word_buildings
from reference.plausibility import implausible_suite, implausible_values
from reference.problem import Family, Scene
from reference.support.arguments import name_some

MAX_LISTED_NAMES = 4  # largest number of names that a line on the terminal lists
# Headings of columns whose cells hold one number per body or several words, and may be broken between them
LISTING_COLUMNS = "change, %", "u_D, %", "median error", "95 %", "uneven", "outcomes"


def print_plan(console: Console, study: Study, options: Options) -> None:
    """Print what the run would compute (option --plan), and roughly how long it would take."""
    for reason, of in _list_refusals(study).items():
        console.print(f"{name_some(of, MAX_LISTED_NAMES)}: {reason}.", soft_wrap=True)
    _print_models(console, study, options.families)
    first = _print_analyses(console, study)
    _print_levels(console, study)
    _print_reductions(console, study)
    if study.absent:
        reasons = ", ".join(f"{analysis} ({reason})" for analysis, reason in study.absent.items())
        console.print(f"Not in the report: {reasons}.", soft_wrap=True)
    if len(study.phased) < len(study.scenes):
        console.print("A recorded motion has no phases: one point per model.")
    results = TaskResults(Cache(locate_store(options.out)), options.fresh)
    print_stored(console, results, make_surface_tasks(study), first)
    seconds = estimate_study_seconds(study, estimate_stage_seconds(study))
    wall = STARTING_SECONDS + seconds / options.jobs + WRITING_SECONDS
    compiling = f" and {COMPILING_SECONDS:.0f} s for compiling on a new installation" if study.hierarchy else ""
    console.print(f"Roughly {wall:.0f} s with {options.jobs} workers{compiling}; nothing was computed.")
    console.print(f"The report would go to {options.out}.", soft_wrap=True)


def _print_models(console: Console, study: Study, families: Sequence[Family]) -> None:
    """Print a table with a row for each scene file and model: phase pairs, how many are computed, tolerance."""
    table = make_table("file", "scenes", "model", "phase pairs", "computed", "tolerance")
    for family in families:
        for model in study.hierarchy:
            scenes = [scene for scene in family.scenes if model.applies(scene)]
            if scenes:
                points = sum(study.points(model, scene) for scene in scenes)
                computed = sum(len(study.solved(scene, model)) for scene in scenes)
                counts = f"{points:,}", f"{computed:,}", f"{model.tolerance(study.tolerance):.0e}"
                table.add_row(family.name, str(len(scenes)), model.title, *counts)
    console.print(table)


def _print_analyses(console: Console, study: Study) -> list[Task]:
    """Print the number of tasks of every analysis; return those that need no amplification over the phases."""
    first, counts = [], {}
    for each in select_analyses(study):
        tasks = [] if each.needs_surfaces else each.tasks(study.restrict_to(each.key))
        counts[each.stage] = "chosen by the surfaces" if each.needs_surfaces else len(tasks)
        first += tasks
    console.print(f"Analyses (tasks): {', '.join(f'{name} ({count})' for name, count in counts.items()) or 'none'}.")
    return first


def _print_levels(console: Console, study: Study) -> None:
    """Print the number of phases in the grid of each level, level by level; nothing for a study without phases."""
    for level in make_study_levels(study) if study.phased else ():
        models = level.study.hierarchy
        kinds = {"equations" if m.side == "reference" else m.title: len(level.study.phase_indices(m)) for m in models}
        grids = ", ".join(f"{kind} {count} x {count} phases" for kind, count in kinds.items())
        console.print(f"{level.title.capitalize()}: {grids}.")


def print_stored(console: Console, results: TaskResults, batches: Sequence[Task], others: Sequence[Task]) -> None:
    """Print how many results are stored of `batches`, the tasks of the surfaces, and of `others`, those of analyses."""
    stored, analyses = sum(map(results.holds, batches)), sum(map(results.holds, others))
    if results.cache is not None and stored + analyses:
        rest = f", {analyses} of {len(others)} analyses" if others else ""
        line = f"{stored} of {len(batches)} batches{rest} are in {results.cache.folder}: only the others are computed."
        console.print(line, soft_wrap=True)  # no line break inside the path, so that a user can copy it


def print_buildings(console: Console, named: Sequence[tuple[str, Scene]]) -> None:
    """Print the properties of the buildings as read from their scenes, then warnings of implausible values."""
    buildings = [replace(describe_building(scene), name=name) for name, scene in named]
    for line in word_buildings(buildings):
        console.print(line, soft_wrap=True, markup=False, highlight=False)
    strongest: dict[str, tuple[Scene, Building]] = {}
    for building, (name, scene) in zip(buildings, named):
        if name not in strongest or building.ground_peak > strongest[name][1].ground_peak:
            strongest[name] = scene, building
    said = {line: name for name in reversed(strongest) for line in implausible_values(*strongest[name])}
    for line, name in said.items():
        console.print(f"Warning: {name}: {line}", soft_wrap=True, markup=False)


def print_records(
    console: Console, named: Sequence[tuple[str, Scene]], short: bool = False, is_suite: bool = False
) -> None:
    """
    Print what was read of every recorded motion.

    named: name and scene of each motion. short: whether one line for each is enough. is_suite: whether the motions are
    of one suite, so that a line names those that are implausible beside the others.
    """
    names, scenes = zip(*named) if named else ((), ())
    records = describe_records(scenes, names)
    lines = [line for one in records for line in (one.short_lines if short else one.lines)]
    for line in lines + [f"Warning: {line}" for line in implausible_suite(records) if is_suite]:
        console.print(line, soft_wrap=True, markup=False, highlight=False)


def print_models_left_out(console: Console, study: Study) -> None:
    """Print motions and buildings as read, with warnings, and why scenes cannot be computed by the spatial model."""
    print_records(console, [("", scene) for scene in study.scenes])
    print_buildings(console, [(scene.name, scene) for scene in study.scenes])
    for scene in study.scenes:
        if reason := why_not_spatial(scene):
            console.print(f"{scene.name}: {reason}.", soft_wrap=True)


def _list_refusals(study: Study) -> dict[str, list[str]]:
    """Return the reasons why models would refuse scenes, each with the scenes and models concerned."""
    refused: dict[str, list[str]] = {}
    for scene in study.scenes:
        for model in models_of(scene, study.hierarchy):
            if reason := find_refusal(scene, model, model.tolerance(study.tolerance), study.full):
                refused.setdefault(reason, []).append(f"{scene.name}, {model.title}")
    return refused


def _print_reductions(console: Console, study: Study) -> None:
    """Print the computations that are skipped because the scenes do not require them."""
    if study.full:
        console.print("Every phase pair and every model is computed in full (--full).")
    elif rows := list_skipped_computations(study):
        console.print("Left out, because the scene does not require it (--full computes it):")
        for row in rows:
            console.print(
                f"  {row.what} ({row.models}; {name_some(row.scenes, MAX_LISTED_NAMES)}): {row.why}", soft_wrap=True
            )
    else:
        console.print("Nothing is left out: the scenes require all of it.")


def make_table(*headings: str) -> Table:
    """Return an empty table for the terminal; columns of words are aligned left, and broken if it is too wide."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        words = heading in ("file", "scene", "model", "motion", "difference", "step", "quantity", "verdict", "bound")
        whole = heading == "difference" or not (words or heading in LISTING_COLUMNS)
        table.add_column(heading, justify="left" if words else "right", no_wrap=whole, overflow="fold")
    return table
