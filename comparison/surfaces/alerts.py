"""Alerts for the reader: scenes that a model refused, broken limits, missing values, errors of solvers, wide swings."""

from collections.abc import Iterator, Sequence
from typing import Literal

import xarray as xr
from pydantic import Field

from comparison.result_types import Part, Text
from comparison.study.models import models_of
from comparison.study.study import Study
from comparison.surfaces.acceptance import Limit
from comparison.surfaces.missing_values import MissingValues
from comparison.surfaces.surfaces import find_largest_cap_share, find_largest_travel_share

LARGE_TRAVEL_SHARE = 0.9  # share of the isolator's travel above which a displacement of the platform raises an alert
LARGE_DISPLACEMENT_SHARE = 0.5  # share of the pendulum radius rho above which a displacement raises an alert

# What a user can do about a limit of the scene that is not met
STATED_LIMIT_HELP = "read the cause of the difference, then correct the scene or the limit in its [acceptance] table"
DEFAULT_LIMIT_HELP = (  # what a user can do about a default limit that the user's engine does not meet
    "name the equations that your engine solves (docs/other-engines.md), let it state an error that holds, or state "
    "limits of its own in the table of its name below acceptance"
)


class Alert(Part):
    """One warning that a reader needs before using a number."""

    level: Literal["red", "amber"]
    """red: a model refused or a limit is broken; amber: a number is missing or to be read with care"""
    kind: Literal["refused", "limit", "lacking", "fault", "swing", "travel"]
    """model without any value, broken acceptance limit, phase pairs without a value, error message of a solver, wide
    swing of the platform"""
    scene: Text = Field(description="name of the scene")
    text: Text = Field(description="what is the matter")
    help: Text = Field(description="what helps; empty where nothing is known to")

    @property
    def line(self) -> str:
        """Return the alert in one line."""
        return f"{self.scene}: {self.text}{f'. {self.help[0].upper()}{self.help[1:]}' if self.help else ''}"


def list_alerts(
    study: Study,
    surfaces: xr.Dataset,
    gaps: Sequence[MissingValues],
    limits: Sequence[Limit],
    faults: Sequence[Alert],
) -> list[Alert]:
    """Return every alert of a run, red ones before amber ones. faults: the alerts from error messages of solvers."""
    listed = [
        *_alerts_of_missing_values(gaps),
        *_limit_alerts(limits),
        *faults,
        *_alerts_of_large_displacements(study, surfaces),
    ]
    return sorted(listed, key=lambda alert: alert.level != "red")


def _alerts_of_missing_values(gaps: Sequence[MissingValues]) -> list[Alert]:
    """Return an alert for every model without a value at some phase pairs."""
    rows = []
    for gap in gaps:
        refused = gap.points + gap.unusable == gap.asked
        rest = "" if gap.used else "; comparisons leave this model out"
        outcomes = ", ".join(
            note.outcome if note.count == gap.asked else f"{note.count} × {note.outcome}" for note in gap.outcomes
        )
        rows.append(
            Alert(
                level="red" if refused else "amber",
                kind="refused" if refused else "lacking",
                scene=gap.scene,
                text=f"{gap.title}: {gap.where}{f': {outcomes}' if outcomes else ''}{rest}",
                help="; ".join(note.advice for note in gap.outcomes),
            )
        )
    return rows


def _limit_alerts(limits: Sequence[Limit]) -> list[Alert]:
    """Return a red alert for every acceptance limit that is not met."""
    return [
        Alert(
            level="red",
            kind="limit",
            scene=limit.scene,
            text=text,
            help=DEFAULT_LIMIT_HELP if limit.default else STATED_LIMIT_HELP,
        )
        for limit in limits
        for text in limit.breach_texts
    ]


def _alerts_of_large_displacements(study: Study, surfaces: xr.Dataset) -> Iterator[Alert]:
    """Yield an alert for each model whose platform moves by a large share of the pendulum radius or of the travel."""
    swing = "the model assumes a cap that reaches so far: compare with the isolator that is to be built"
    travel = "a larger displacement ends the motion as travel reached"
    for scene in study.scenes:
        for model in models_of(scene, study.hierarchy):
            about = f"{model.title}: the platform"
            if (share := find_largest_cap_share(surfaces, scene.name, model.key)) > LARGE_DISPLACEMENT_SHARE:
                text = f"{about} moves up to {100.0 * share:.1f} % of rho from the middle"
                yield Alert(level="amber", kind="swing", scene=scene.name, text=text, help=swing)
            if (share := find_largest_travel_share(surfaces, scene, model.key)) > LARGE_TRAVEL_SHARE:
                text = f"{about} uses up to {100.0 * share:.1f} % of the isolator's travel"
                yield Alert(level="amber", kind="travel", scene=scene.name, text=text, help=travel)
