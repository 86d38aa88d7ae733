"""Names of the analyses that a study makes of a scene in addition to its amplification factors."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from reference.problem.keys import REPORT, Table, key

AnalysisNames = Annotated[list[str], Field(min_length=1)]  # list of at least one name of an analysis


class Analyses(Table):
    """
    Selection of the analyses in a report: `only` those named, or all except those to `skip`.

    `also` adds analyses that are made on request alone.
    """

    only: AnalysisNames | None = key("analyses that the report makes of the scene; all without it", models=REPORT)
    skip: AnalysisNames | None = key("analyses that the report does not make of the scene", models=REPORT)

    also: AnalysisNames | None = key("analyses besides, of those on request", models=REPORT)

    @model_validator(mode="after")
    def _check_selection(self) -> Analyses:
        """Refuse a table with both `only` and `skip`."""
        if self.only is not None and self.skip is not None:
            raise ValueError("give only or skip, not both")
        return self
