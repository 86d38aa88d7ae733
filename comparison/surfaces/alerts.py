"""What a reader must know before trusting a number: refusals, broken limits, gaps, faults, wide swings. One place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

import xarray as xr

from comparison.result_types import Part, Text
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from comparison.surfaces.acceptance import Limit
from comparison.surfaces.surfaces import largest_cap_share, largest_travel_share
from comparison.surfaces.unanswered import Unanswered
from reference.problem import Scene

NEARLY_ALL = 0.9  # of the travel, that a reader must know of
WIDE = 0.5  # of rho: a displacement of the platform from the middle that a reader must know of


class Alert(Part):
    """What a reader must know before trusting a number."""

    level: Literal["red", "amber"]
    """red: a model refused or a limit is broken; amber: a number is missing or to be read with care"""
    kind: Literal["refused", "limit", "lacking", "fault", "swing", "travel"]
    """model without any value, broken acceptance limit, phase pairs without a value, error message of a solver, wide
    swing of the platform"""
    scene: Text
    """name of the scene"""
    text: Text
    """what is the matter"""
    help: Text
    """what helps; empty where nothing is known to"""

    @property
    def line(self) -> str:
        """All that in one line."""
        return ". ".join(f"{part[0].upper()}{part[1:]}" if number else part for number, part in enumerate(self._parts))

    @property
    def _parts(self) -> list[str]:
        return [f"{self.scene}: {self.text}", *([self.help] if self.help else [])]


class Fault(NamedTuple):
    """What a solver reported."""

    scene: str  # name of the scene
    text: str  # model and error message

    @property
    def line(self) -> str:
        """With the name of the scene."""
        return f"{self.scene}, {self.text}"


def alerts(
    study: Study,
    surfaces: xr.Dataset,
    unanswered: Sequence[Unanswered],
    limits: Sequence[Limit],
    faults: Sequence[Fault],
) -> list[Alert]:
    """Every alert of a run: red, where a model has no value or a limit is broken, before amber."""
    faulty = [Alert(level="amber", kind="fault", scene=fault.scene, text=fault.text, help="") for fault in faults]
    moving = [*_swings(study, surfaces), *_travels(study, surfaces)]
    listed = [*_gaps(unanswered), *_broken(limits), *faulty, *moving]
    return sorted(listed, key=lambda alert: alert.level != "red")


def _gaps(unanswered: Sequence[Unanswered]) -> list[Alert]:
    rows = []
    for lacking in unanswered:
        refused = lacking.points + lacking.unusable == lacking.asked
        rest = "" if lacking.used else "; comparisons leave this model out"
        outcomes = ", ".join(
            note.outcome if note.count == lacking.asked else f"{note.count} × {note.outcome}"
            for note in lacking.outcomes
        )
        rows.append(
            Alert(
                level="red" if refused else "amber",
                kind="refused" if refused else "lacking",
                scene=lacking.scene,
                text=f"{lacking.title}: {lacking.where}{f': {outcomes}' if outcomes else ''}{rest}",
                help="; ".join(note.advice for note in lacking.outcomes),
            )
        )
    return rows


def _broken(limits: Sequence[Limit]) -> list[Alert]:
    return [
        Alert(
            level="red",
            kind="limit",
            scene=limit.scene,
            text=text,
            help="read the cause of the difference, then correct the scene or the limit in its [acceptance] table",
        )
        for limit in limits
        for text in limit.broken_texts
    ]


def _swings(study: Study, surfaces: xr.Dataset) -> list[Alert]:
    return _moving_far(
        study,
        "swing",
        lambda scene, model: largest_cap_share(surfaces, scene.name, model.key),
        WIDE,
        "moves up to {:.1f} % of rho from the middle",
        "the model assumes a cap that reaches so far: compare with the isolator that is to be built",
    )


def _travels(study: Study, surfaces: xr.Dataset) -> list[Alert]:
    return _moving_far(
        study,
        "travel",
        lambda scene, model: largest_travel_share(surfaces, scene, model.key),
        NEARLY_ALL,
        "uses up to {:.1f} % of the isolator's travel",
        "a larger displacement ends the motion as travel reached",
    )


def _moving_far(
    study: Study,
    kind: Literal["swing", "travel"],
    share_of: Callable[[Scene, Model], float],
    limit: float,
    text: str,
    advice: str,
) -> list[Alert]:
    """Models whose platform moves by more than a share of what it may."""
    return [
        Alert(
            level="amber",
            kind=kind,
            scene=scene.name,
            text=f"{model.title}: the platform {text.format(100.0 * share)}",
            help=advice,
        )
        for scene in study.scenes
        for model in models_of(scene, study.hierarchy)
        if (share := share_of(scene, model)) > limit
    ]
