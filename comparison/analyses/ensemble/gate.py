"""Check of demand limits in a user's tests: computes the ensemble in this process and lists what is not met."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from comparison.analyses.ensemble.analysis import Ensemble
from comparison.analyses.ensemble.build import build_result
from comparison.analyses.ensemble.governing import choose_motions
from comparison.analyses.ensemble.limits import check_limits, compare_with_stored, read_demand_limits, word_checks
from comparison.analyses.ensemble.members import list_members, with_suite
from comparison.analyses.ensemble.result import STORED, EnsembleResult
from comparison.runner.task import Task, execute_task
from comparison.runner.task_results import TaskResults
from comparison.verdicts import MET
from reference.problem.acceptance import DemandLimits
from reference.problem.families import make_family, with_bounds
from reference.problem.scene_file import scene_tables, scene_text


def check_demands(
    source: str | Path,
    suite: str | Path | None,
    bounds: tuple[float, float] | None,
    limits: Mapping[str, Any],
    stored: str | Path | None,
    within: float,
) -> list[str]:
    """
    Return the lines that say which demands of a scene are not within their limits; an empty list if all are.

    source: scene file or name. suite, bounds: motions, and factors of a lower and an upper friction, in place of the
    scene's own. limits: by key, in place of the scene's own limits of these keys. stored: folder of an earlier
    ensemble, from whose demands these may differ by the share `within`. Raises ValueError without anything to compare
    with.
    """
    data = scene_tables(scene_text(source), str(source))
    data = data if suite is None else with_suite(data, suite)
    members = list_members([make_family(with_bounds(data, bounds), str(source))])
    asked = read_demand_limits({member.structure: member.scene for member in members})
    for member in members:
        own = asked.get(member.structure, DemandLimits()).model_dump(exclude_none=True)
        asked[member.structure] = DemandLimits.model_validate({**own, **limits})
    by_engine = any(each.uplift is not None or each.support_displacement is not None for each in asked.values())
    before = None if stored is None else STORED.load(Path(stored))
    if stored is not None and before is None:
        raise ValueError(f"stored: {str(stored)!r} has no {STORED.name}: phase-resonance ensemble --out writes one")
    if before is None and not any(each.limits_by_key() for each in asked.values()):
        raise ValueError(f"no limit: give {', '.join(DemandLimits.limited)} or stored")
    result = compute_ensemble(Ensemble(members), by_engine)
    checks = check_limits(result, asked)
    checks += [] if before is None else compare_with_stored(result, before, within)
    return word_checks(checks) if any(check.verdict != MET for check in checks) else []


def compute_ensemble(ensemble: Ensemble, engine: bool) -> EnsembleResult:
    """Compute the ensemble in this process. engine: whether Exudyn computes motions with a worst demand, too."""
    results = TaskResults()
    _compute_tasks(results, ensemble.make_equation_tasks())
    chosen = choose_motions(ensemble.collect_points(results).equations, None) if engine else []
    _compute_tasks(results, ensemble.make_engine_tasks(chosen))
    return build_result(ensemble.collect_points(results, chosen), {}, ensemble.tolerance)


def _compute_tasks(results: TaskResults, tasks: Sequence[Task]) -> None:
    """Compute in this process the tasks that have no result yet, and add their results to `results`."""
    for task in results.find_missing(tasks):
        results.put(task, execute_task(task))
