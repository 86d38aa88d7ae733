"""What the terminal says before a run: the plan, its cost, and what was chosen for a tolerance or a budget."""

from __future__ import annotations

from collections.abc import Mapping

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from comparison.analysis.targets import describe
from comparison.cli.budgeted import allotment, listed_steps
from comparison.cli.options import Options
from comparison.execution.cache import Cache, store_beside
from comparison.execution.keys import batch_key
from comparison.execution.task_results import TaskResults
from comparison.registry import chosen_analyses, first_tasks, predicted_costs
from comparison.study.accuracy_record import recorded
from comparison.study.batches import refusal_of
from comparison.study.models import models_of, why_not_spatial
from comparison.study.overhead import COMPILED_ONCE, LOADING, START_UP, WRITING
from comparison.study.planning import StudyPlan
from comparison.study.reductions import reductions
from comparison.study.study import Study


def print_plan(console: Console, study: Study, options: Options) -> None:
    """What would be computed and its predicted cost."""
    refused = _refused(study)
    for (scene, title), reason in refused.items():
        console.print(f"{scene}, {title}: {reason}.", soft_wrap=True)
    if options.budget is None:
        _print_costs(console, study, options, refused)
    else:
        _print_steps(console, study, options.budget, options.jobs)
    _print_reductions(console, study)
    if study.absent:
        reasons = ", ".join(f"{analysis} ({reason})" for analysis, reason in study.absent.items())
        console.print(f"Not in the report: {reasons}.", soft_wrap=True)
    if len(study.phased) < len(study.scenes):
        console.print("A recorded motion has no phases: one point per model.")
    store, batches = Cache(store_beside(options.out)), study.batches()
    if not options.fresh and (stored := sum(store.holds(batch_key(batch)) for batch in batches)):
        asked, known = first_tasks(study, chosen_analyses(study)), TaskResults(store)
        others = f"{sum(map(known.holds, asked))} of {len(asked)} analyses"
        console.print(
            f"{stored} of {len(batches)} batches are in {store.folder} already, {others}: they are not computed again."
        )
    console.print(f"Costs were recorded on one core of {recorded().machine}; another machine scales them all alike.")
    if tried := [scene.name for scene in study.scenes if scene.digest() not in recorded().seconds]:
        console.print(f"Not recorded, so tried here at a few phase pairs: {', '.join(tried)}.", soft_wrap=True)
    console.print(COMPILED_ONCE)
    console.print(f"{'No surface' if tried else 'Nothing'} was computed. The report would go to {options.out}.")


def print_models_left_out(console: Console, study: Study) -> None:
    """A line for every scene that states only a part of what a model needs."""
    for scene in study.scenes:
        if reason := why_not_spatial(scene):
            console.print(f"{scene.name}: {reason}.", soft_wrap=True)


def _refused(study: Study) -> dict[tuple[str, str], str]:
    """Why a surface would have no value, by name of the scene and title of the model."""
    return {
        (scene.name, model.title): reason
        for scene in study.scenes
        for model in models_of(scene, study.hierarchy)
        if (reason := refusal_of(scene, model, model.tolerance(study.tolerance), study.full))
    }


def _print_costs(console: Console, study: Study, options: Options, refused: Mapping[tuple[str, str], str]) -> None:
    """A row for every scene and model, the analyses, and the time of the whole run."""
    table = new_table("scene", "model", "points", "computed", "tolerance", "s on one core")
    total = 0.0
    for scene in study.scenes:
        for model in models_of(scene, study.hierarchy):
            points, computed = study.points(model, scene), len(study.solved(scene, model))
            seconds = 0.0 if (scene.name, model.title) in refused else study.seconds_of(scene, model)
            total += seconds
            cells = str(points), str(computed), f"{model.tolerance(study.tolerance):.0e}", f"{seconds:.1f}"
            table.add_row(scene.name, model.title, *cells)
    console.print(table)
    costs = predicted_costs(study, chosen_analyses(study))
    others = ", ".join(f"{name} {seconds:.0f} s ({tasks})" for name, (tasks, seconds) in costs.items() if tasks)
    console.print(f"Beside the surfaces, s on one core and tasks: {others or 'nothing'}.")
    total += sum(seconds for _, seconds in costs.values())
    wall = LOADING + START_UP + total / options.jobs + WRITING
    over = f"{study.grid} x {study.grid} phases, " if study.phased else ""
    console.print(f"{over}{options.jobs} worker processes: about {wall:.0f} s.")


def _print_steps(console: Console, study: Study, budget: float, jobs: int) -> None:
    """The steps of a budget in their order, and when each would be done."""
    share = allotment(study, budget, jobs)
    titles = {model.key: model.title for model in study.hierarchy if model.side == "engine"}
    table = new_table("step", "s on one core", "report after, s")
    after = budget - share.surfaces + START_UP
    for step in listed_steps(study):
        after += step.seconds / jobs
        table.add_row(describe(step, titles).replace("×", "x"), f"{step.seconds:.1f}", f"{after:.0f}")
    console.print(table)
    console.print(f"After {budget:g} s the steps that are complete by then make the report.")
    if share.dropped:
        console.print(f"Left out, because they would take too much of this time: {', '.join(share.dropped)}.")


def _print_reductions(console: Console, study: Study) -> None:
    """What the scenes do not require, and what that saves."""
    if study.full:
        console.print("Every phase pair and every model is computed in full (--full).")
    elif rows := reductions(study):
        console.print("Left out, because the scene does not require it (--full computes it):")
        for row in rows:
            console.print(f"  {row.scene}: {row.what} ({row.models}): cost {row.cost}: {row.why}")
    else:
        console.print("Nothing is left out: the scenes require all of it.")


def print_tolerance(console: Console, plan: StudyPlan, options: Options) -> None:
    """What `--tolerance` chose, and what is expected of it."""
    study = plan.study
    console.print(f"Chosen for --tolerance {options.tolerance:g}, by the recorded accuracy and cost:")
    table = new_table("model", "phases per axis", "asked for", "s of compute")
    for model in study.hierarchy:
        if any(model.applies(scene) for scene in study.scenes):
            asked = f"{model.tolerance(study.tolerance):.0e}"
            table.add_row(model.title, str(len(study.axis(model))), asked, f"{study.seconds(model):.1f}")
    console.print(table)
    for line in plan.omitted:
        console.print(f"Left out: {line}.")
    if not any(model.side == "engine" for model in study.hierarchy):
        console.print("NO ENGINE MODEL is left: this study compares the equations with each other only.")
    console.print(f"Expected: every mu to {study.tolerance:g} at 99 % of the points; {plan.compute:.1f} s of compute.")


def new_table(*headings: str) -> Table:
    """An empty table: words to the left, numbers to the right. Where it is too wide words are folded, never numbers."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        words = heading in ("scene", "model", "difference", "step", "quantity")
        whole = heading == "difference" or not words
        table.add_column(heading, justify="left" if words else "right", no_wrap=whole, overflow="fold")
    return table
