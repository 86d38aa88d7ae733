"""What the terminal says before a run: the plan, its cost, and what was chosen for a tolerance or a budget."""

from __future__ import annotations

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from comparison.cli.options import Options
from comparison.execution.cache import Cache, store_beside
from comparison.execution.keys import batch_key
from comparison.execution.task_results import TaskResults
from comparison.registry import chosen_analyses, first_tasks, predicted_costs
from comparison.study.accuracy_record import recorded
from comparison.study.batches import refusal_of
from comparison.study.models import RECORDED_ON
from comparison.study.overhead import COMPILED_ONCE, START_UP, WRITING
from comparison.study.planning import StudyPlan
from comparison.study.reductions import reductions
from comparison.study.study import Study


def print_plan(console: Console, study: Study, options: Options) -> None:
    """What would be computed and its predicted cost."""
    table = new_table("scene", "model", "points", "computed", "tolerance", "s on one core")
    total, refused = 0.0, []
    for scene in study.scenes:
        for model in study.hierarchy:
            if not model.applies(scene):
                continue
            points, computed = study.points(model, scene), len(study.solved(scene, model))
            reason = refusal_of(scene, model, model.tolerance(study.tolerance), study.full)
            refused += [f"{scene.name}, {model.title}: {reason}"] if reason else []
            seconds = 0.0 if reason else study.seconds_of(scene, model)
            total += seconds
            cells = str(points), str(computed), f"{model.tolerance(study.tolerance):.0e}", f"{seconds:.1f}"
            table.add_row(scene.name, model.title, *cells)
    console.print(table)
    _print_reductions(console, study)
    analyses = chosen_analyses(study)
    costs = predicted_costs(study, analyses)
    others = ", ".join(f"{name} {seconds:.0f} s ({tasks})" for name, (tasks, seconds) in costs.items() if tasks)
    console.print(f"Beside the surfaces, s on one core and tasks: {others or 'nothing'}.")
    if study.absent:
        reasons = ", ".join(f"{analysis} ({reason})" for analysis, reason in study.absent.items())
        console.print(f"Not in the report: {reasons}.", soft_wrap=True)
    total += sum(seconds for _, seconds in costs.values())
    wall = START_UP + total / options.jobs + WRITING
    if len(study.phased) < len(study.scenes):
        console.print("A recorded motion has no phases: one point per model.")
    for line in refused:
        console.print(f"{line}.", soft_wrap=True)
    over = f"{study.grid} x {study.grid} phases, " if study.phased else ""
    console.print(f"{over}{options.jobs} worker processes: about {wall:.0f} s.")
    store, batches = Cache(store_beside(options.out)), study.batches()
    if not options.fresh and (stored := sum(store.holds(batch_key(batch)) for batch in batches)):
        asked, known = first_tasks(study, analyses), TaskResults(store)
        others = f"{sum(map(known.holds, asked))} of {len(asked)} analyses"
        console.print(
            f"{stored} of {len(batches)} batches are in {store.folder} already, {others}: they are not computed again."
        )
    if not options.by_trade:
        console.print(f"Costs were recorded on {RECORDED_ON}; another machine scales them all alike.")
        if uncalibrated := [scene.name for scene in study.scenes if scene.digest() not in recorded().seconds]:
            console.print(
                f"Not recorded, so guessed from the paper's scenes in proportion to the duration, and easily ten times "
                f"too low for more bodies or shorter periods: {', '.join(uncalibrated)}.",
                soft_wrap=True,
            )
    console.print(COMPILED_ONCE)
    console.print(f"Nothing was computed. The report would go to {options.out}.")


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


def print_study_plan(console: Console, plan: StudyPlan, options: Options) -> None:
    """What `--tolerance` or `--budget` chose, and what is expected of it."""
    study = plan.study
    asked = [f"--tolerance {options.tolerance:g}"] if options.tolerance is not None else []
    asked += [f"--budget {options.budget:g}"] if options.budget is not None else []
    console.print(f"Chosen for {' '.join(asked)}, by the measured trade and the speed of this machine:")
    table = new_table("model", "phases per axis", "asked for", "s of compute")
    for model in study.hierarchy:
        if any(model.applies(scene) for scene in study.scenes):
            cells = (
                str(len(study.axis(model))),
                f"{model.tolerance(study.tolerance):.0e}",
                f"{study.seconds(model):.1f}",
            )
            table.add_row(model.title, *cells)
    console.print(table)
    for line in plan.omitted:
        console.print(f"Left out: {line}.")
    if not any(model.side == "engine" for model in study.hierarchy):
        console.print("NO ENGINE MODEL is left: this study compares the equations with each other only.")
    if not plan.with_analyses:
        console.print(
            "Left out: motions, claims, scaling, convergence, assumptions varied: they do not fit the budget."
        )
    console.print(
        f"Expected: every mu to {study.tolerance:g} at 99 % of the points; {plan.compute:.1f} s of compute, "
        f"about {plan.wall:.0f} s in all with {options.jobs} workers."
    )


def new_table(*headings: str) -> Table:
    """An empty table: words to the left, numbers to the right."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        words = heading in ("scene", "model", "difference")
        table.add_column(heading, justify="left" if words else "right", no_wrap=True)
    return table
