"""What a study finds beside its surfaces: the paper's claims, the scaling test, and what the steps tend to."""

from __future__ import annotations

from typing import Any

from comparison.analysis.claims.table import claims_tested
from comparison.analysis.convergence import convergence_trends
from comparison.analysis.scaling import scaling_trends
from comparison.analysis.tasks import paper_complete
from comparison.execution.executors import Pool
from comparison.study.study import Study


def further_findings(study: Study, jobs: int, executor: Pool) -> dict[str, Any]:
    """Fields of `Findings`: claims (None unless the study has every scene of the paper), scaling, convergence."""
    claims = claims_tested(jobs, executor) if paper_complete(study) else None
    scaling = scaling_trends(study, jobs, executor) if study.phased else None
    convergence = convergence_trends(study, jobs, executor) if study.phased else None
    return {"claims": claims, "scaling": scaling, "convergence": convergence}
