"""Known answers in place of what a study finds beside its surfaces, and the answers of one analysis alone."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
import xarray as xr
from known_conditioning import known_curves

import comparison.registry
from comparison.evidence.claims.checks import StatementVerdict
from comparison.evidence.claims.table import ClaimTable, make_claim_table
from comparison.evidence.trends import fit_trend
from comparison.runner.analysis import Analysis
from comparison.runner.runner import Runner
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET
from reference.problem import Amplification

SCALES = (1.0, 0.5, 0.25)
ASKED = "effective", "assumptions", "measured", "completion", "pictures"  # of the hierarchy, or of its surfaces


class Known(Analysis[Any]):
    """In place of another analysis: computes nothing and says `value`, or what that returns for study and surfaces."""

    def __init__(self, other: Analysis[Any], value: Any) -> None:
        self.key, self.stage, self.level, self.value = other.key, other.stage, other.level, value

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        return []

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Any:
        return self.value(study, surfaces) if callable(self.value) else self.value


def analyses_are(patch: pytest.MonkeyPatch, **known: Any) -> None:
    """A study runs the analyses that ask its own models; the others have known answers, or none."""
    analyses = [
        analysis if analysis.key in {*ASKED} - {*known} else Known(analysis, known.get(analysis.key))
        for analysis in comparison.registry.ANALYSES
    ]
    patch.setattr(comparison.registry, "ANALYSES", analyses)


def collected(analysis: Any, study: Any, surfaces: xr.Dataset | None = None, executor: Any = ThreadPoolExecutor) -> Any:
    """What an analysis says of a study, its tasks executed on two workers and stored nowhere."""
    results = TaskResults()
    Runner(results, 2, executor).run(analysis.tasks(study, surfaces))
    return analysis.collect(study, surfaces, results)


def computed(work: Any, executor: Any = ThreadPoolExecutor) -> Any:
    """What the work of a command says, its tasks executed on two workers and stored nowhere."""
    results = TaskResults()
    Runner(results, 2, executor).run(work.tasks())
    return work.collect(results)


def known_claims() -> ClaimTable:
    """As integrated six statements are met and one is not compared; as literal supremum seven are met."""
    met, no = StatementVerdict(MET, "periodic 4 and 3"), StatementVerdict(NOT_MET, "|x_2 - y_2| up to 0")
    lacking = StatementVerdict(NOT_COMPARED, "fig3-I: rim reached")
    return make_claim_table(
        {"as integrated": [met] * 6 + [no] * 9 + [lacking], "literal supremum": [met] * 7 + [no] * 9}
    )


def known_others() -> dict[str, Any]:
    """Known statements of the paper; curves over speeds; one trend that falls like s^2, one that is only noise."""
    sizes = np.array([[4e-3, 1e-3, 2.5e-4]])
    return {
        "claims": known_claims(),
        "scaling": [fit_trend("fig3-I", 1, "exact minus small, supremum", SCALES, sizes, 1e-3 * sizes, 2.0)],
        "conditioning": known_curves(),
        "convergence": [fit_trend("fig3-I", 2, "engine against resolved", SCALES, sizes, 2.0 * sizes, 1.0)],
    }


def with_engine_off_by(monkeypatch: pytest.MonkeyPatch, factor: float, error: float = 1e-6) -> None:
    """Every model answers with mu = 2, the engine's models with `factor` times that."""

    def import_function(path: str):  # type: ignore[no-untyped-def]
        if path.endswith(":refusal"):
            return lambda scene, **settings: ""
        return answering(factor if "multibody" in path else 1.0, error)

    monkeypatch.setattr("comparison.study.batches.import_function", import_function)


def answering(factor: float, error: float):  # type: ignore[no-untyped-def]
    def amplification(scene, phases, **settings):  # type: ignore[no-untyped-def]
        mu = np.full((len(phases), len(scene.bodies)), 2.0 * factor)
        ok, never = np.full(len(phases), "ok"), np.full(len(phases), np.nan)
        return Amplification(mu, np.full_like(mu, error), ok, never, 0.0)

    return amplification
