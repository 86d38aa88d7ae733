"""Assembly of the result of an ensemble from the demands of its motions, for its files, its page and the terminal."""

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from comparison.analyses.ensemble import result
from comparison.analyses.ensemble.analysis import EnsemblePoints
from comparison.analyses.ensemble.members import EnsembleMember, group_rows_by
from comparison.analyses.ensemble.statistics import (
    MEDIAN_INDEX,
    find_support_extremes,
    make_demand_curves,
    summarize_demands,
    summarize_spectra,
)
from comparison.json_file import finite_or_none
from comparison.study.models import EXACT, SPATIAL, TRANSLATIONAL
from reference import describe_building
from reference.building import largest_horizontal_acceleration
from reference.measures import effective_isolator, response_spectrum
from reference.problem import GRAVITY, Outcome, Scene
from reference.problem.tables import Record
from reference.records.description import describe_samples
from reference.records.motion_lists import Motion

GROUND_PERIODS = np.geomspace(0.05, 5.0, 40)  # s, periods of the ground motions' response spectra


def build_result(
    points: EnsemblePoints,
    run: Mapping[str, Any],
    tolerance: float,
    target: result.TargetSpectrum | None = None,
    listed: Mapping[str, Motion] | None = None,
) -> result.EnsembleResult:
    """
    Return the result of an ensemble: buildings, motions, statistics and curves of demands, extreme support forces.

    run: command, times and inputs of the run. tolerance: relative error asked of the engine. target: spectrum to which
    the motions are scaled, or None. listed: motions of the suite by name, with the factors and magnitudes of its list.
    """
    members = [point.member for point in points.equations]
    rows = list(summarize_demands(points))
    scales = sorted({member.scale for member in members})
    asked = "displacement", EXACT.key, scales[-1]
    moved = {row.structure: row for row in rows if (row.quantity, row.model, row.scale) == asked}
    statuses = Counter(sorted(point.status for point in points.equations))
    suite = read_suite(members, listed or {})
    return result.EnsembleResult(
        schema=result.SCHEMA,
        structures=describe_structures(members, moved),
        scales=scales,
        motions=len(suite),
        outcomes=dict(statuses.most_common()),
        stripes=rows,
        curves=list(make_demand_curves(points)),
        spectra=list(summarize_spectra(points.equations)),
        engine=result.EngineMotions(
            model=SPATIAL.key if SPATIAL.key in points.compared else TRANSLATIONAL.key,
            motions=list_engine_motions(points),
            tolerance=tolerance,
        ),
        run=run,
        target=target,
        suite=suite,
        supports=list(find_support_extremes(points)),
        ended=list_ended_motions(points),
        ground_periods=GROUND_PERIODS.tolist(),
    )


def list_engine_motions(points: EnsemblePoints) -> list[result.ChosenMotion]:
    """Return the motions chosen for the engine, each with the reasons and the outcome of every model's run."""
    statuses: dict[tuple[str, str, float], dict[str, str]] = {}
    for point in points.all_points:
        member = point.member
        statuses.setdefault((member.structure, member.motion, member.scale), {})[point.model] = point.status
    places = [(each.member.structure, each.member.motion, each.member.scale) for each in points.chosen]
    return [result.ChosenMotion(*at, each.reasons, statuses[at]) for at, each in zip(places, points.chosen)]


def list_ended_motions(points: EnsemblePoints) -> list[result.EndedMotion]:
    """Return the motions that the equations did not complete, each with the outcome and the time of its end."""
    return [
        result.EndedMotion(
            structure=at.member.structure,
            motion=at.member.motion,
            scale=at.member.scale,
            status=at.status,
            instant=finite_or_none(at.instant),
        )
        for at in points.equations
        if at.status != Outcome.OK
    ]


def read_suite(members: Sequence[EnsembleMember], listed: Mapping[str, Motion]) -> list[result.GroundMotion]:
    """Return the suite's ground motions in order, each once, at scale 1. listed: motions by name, from its list."""
    found = []
    for motion, own in group_rows_by(members, "motion").items():
        member = own[0]
        peak = largest_horizontal_acceleration(member.scene) / member.scale
        about = listed.get(motion)
        factor, magnitude = (about.factor, about.magnitude) if about else (1.0, None)
        found.append(
            result.GroundMotion(
                motion=motion,
                duration=member.scene.duration,
                peak=peak,
                factor=factor * member.factor,
                magnitude=magnitude,
                **describe_ground(member),
            )
        )
    return found


def describe_ground(member: EnsembleMember) -> dict[str, Any]:
    """
    Return the fields of `GroundMotion` on the samples of a motion: files, step, components, digest and spectrum.

    The samples have the factors of the suite's list and of the target spectrum, but not the scale of the ensemble.
    """
    samples = member.scene.record / np.array([1.0, *[member.scale] * 3])
    origin = member.scene.excitation.origin if isinstance(member.scene.excitation, Record) else ()
    read, moving = describe_samples(member.motion, origin, samples), samples[:, 1:3][:, samples[:, 1:3].any(axis=0)]
    return {
        "files": [line for line in origin if not line.startswith("times ")],
        "step": read.step,
        "components": [result.GroundComponent(one.axis, one.peak, one.peak_velocity) for one in read.directions],
        "digest": hashlib.sha256(samples.astype("<f8").tobytes()).hexdigest(),
        "spectrum": response_spectrum(samples[:, 0], moving, GROUND_PERIODS).tolist() if moving.shape[1] else (),
    }


def describe_structures(
    members: Sequence[EnsembleMember], displacements: Mapping[str, result.DemandAtScale]
) -> list[result.Structure]:
    """
    Return the structures of an ensemble, each with its weight, its building and its equivalent linear isolator.

    displacements: by structure, the largest displacements of the isolator at the largest scale. The isolator is
    linearized at their mean, or at their median where the mean is not known.
    """
    found = []
    for name, own in group_rows_by(members, "structure").items():
        scene, isolator, stripe = own[0].scene, None, displacements.get(name)
        at = {} if stripe is None else {"mean": stripe.mean.value, "median": stripe.fractiles[MEDIAN_INDEX].value}
        statistic, displacement = next(((key, value) for key, value in at.items() if value), ("", 0.0))
        friction = 0.0 if scene.lubricated else scene.dry_friction.fast
        if displacement and not scene.flat and friction:
            linear = effective_isolator(scene, displacement)
            period, damping, restoring = map(float, (linear.period, linear.damping, linear.restoring))
            isolator = result.LinearIsolator(
                displacement=displacement,
                period=period,
                damping=damping,
                restoring=restoring,
                statistic=statistic,
                friction=friction,
            )
        found.append(
            result.Structure(
                name=name,
                title=scene.title,
                bodies=len(scene.bodies),
                weight=scene.total_mass * GRAVITY,
                isolator=isolator,
                building=read_building(scene),
            )
        )
    return found


def read_building(scene: Scene) -> result.BuildingRead:
    """Return the properties of a building as read from its scene."""
    building = describe_building(scene)
    return result.BuildingRead(
        supports=building.supports,
        load_per_support=building.load_per_support,
        support_loads=None if building.support_loads is None else building.support_loads.tolist(),
        masses=scene.masses.tolist(),
        offsets=scene.offsets.tolist(),
        isolated_period=[[finite_or_none(period) for period in axis] for axis in building.isolated_period.tolist()],
        fixed_base_period=building.fixed_base_period.tolist(),
        modal_damping=building.modal_damping.tolist(),
        radius=finite_or_none(scene.radius),
        friction=() if scene.lubricated else (scene.dry_friction.slow, scene.dry_friction.fast),
        travel=scene.isolator.travel,
        sphere_radius=scene.isolator.sphere_radius,
        heights=None if building.heights is None else building.heights.tolist(),
        floors=[body.floor or "" for body in scene.bodies],
        friction_rate=None if scene.lubricated else scene.dry_friction.rate,
        stiffness=scene.stiffness.tolist(),
        sizes=[None if body.size is None else [float(value) for value in body.size] for body in scene.bodies],
    )
