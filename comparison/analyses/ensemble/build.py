"""The result of an ensemble, from its points: all that its files, its page and the terminal show."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from comparison.analyses.ensemble import result
from comparison.analyses.ensemble.analysis import Points
from comparison.analyses.ensemble.members import Member, group_by
from comparison.analyses.ensemble.statistics import MEDIAN, curves, spectrum_bands, stripes, support_extremes
from comparison.json_file import finite_or_none
from comparison.study.models import EXACT, SPATIAL, TRANSLATIONAL
from reference import describe_building
from reference.building import horizontal_peak
from reference.measures import effective_isolator
from reference.problem import GRAVITY, Outcome, Scene
from reference.records.motion_lists import Motion


def build_result(
    points: Points,
    run: Mapping[str, Any],
    tolerance: float,
    target: result.Target | None = None,
    listed: Mapping[str, Motion] | None = None,
) -> result.EnsembleResult:
    """
    Return building, motions, statistics of the points, curves of the motions and extremes of the supports.

    listed: motions of the suite by name, with the factors and magnitudes that its list states.
    """
    members = [point.member for point in points.equations]
    rows = list(stripes(points))
    scales = sorted({member.scale for member in members})
    asked = "displacement", EXACT.key, scales[-1]
    moved = {row.structure: row for row in rows if (row.quantity, row.model, row.scale) == asked}
    statuses = Counter(sorted(point.status for point in points.equations))
    suite = read_suite(members, listed or {})
    return result.EnsembleResult(
        schema=result.SCHEMA,
        structures=structures_of(members, moved),
        scales=scales,
        motions=len(suite),
        outcomes=dict(statuses.most_common()),
        stripes=rows,
        curves=list(curves(points)),
        spectra=list(spectrum_bands(points.equations)),
        engine=result.Engine(
            SPATIAL.key if SPATIAL.key in points.compared else TRANSLATIONAL.key, engine_motions(points), tolerance
        ),
        run=run,
        target=target,
        suite=suite,
        supports=list(support_extremes(points)),
        ended=list_ended_motions(points),
    )


def engine_motions(points: Points) -> list[result.ChosenMotion]:
    """The motions of the engine, why they were chosen, and how they ended by every model."""
    statuses: dict[tuple[str, str, float], dict[str, str]] = {}
    for point in points.all_points:
        member = point.member
        statuses.setdefault((member.structure, member.motion, member.scale), {})[point.model] = point.status
    places = [(each.member.structure, each.member.motion, each.member.scale) for each in points.chosen]
    return [result.ChosenMotion(*at, each.reasons, statuses[at]) for at, each in zip(places, points.chosen)]


def list_ended_motions(points: Points) -> list[result.EndedMotion]:
    """The motions by the equations with another outcome than ok, and when it arose."""
    return [
        result.EndedMotion(
            at.member.structure, at.member.motion, at.member.scale, at.status, finite_or_none(at.instant)
        )
        for at in points.equations
        if at.status != Outcome.OK
    ]


def read_suite(members: Sequence[Member], listed: Mapping[str, Motion]) -> list[result.GroundMotion]:
    """The motions in their order, each once, with their peaks at scale 1."""
    found = []
    for motion, own in group_by(members, "motion").items():
        member = own[0]
        peak = horizontal_peak(member.scene) / member.scale
        about = listed.get(motion)
        factor, magnitude = (about.factor, about.magnitude) if about else (1.0, None)
        found.append(result.GroundMotion(motion, member.scene.duration, peak, factor * member.factor, magnitude))
    return found


def structures_of(members: Sequence[Member], displacements: Mapping[str, result.Stripe]) -> list[result.Structure]:
    """The structures in their order. displacements: their isolator displacements at the largest scale."""
    found = []
    for name, own in group_by(members, "structure").items():
        scene, isolator, stripe = own[0].scene, None, displacements.get(name)
        at = {} if stripe is None else {"mean": stripe.mean.value, "median": stripe.fractiles[MEDIAN].value}
        statistic, displacement = next(((key, value) for key, value in at.items() if value), ("", 0.0))
        friction = 0.0 if scene.lubricated else scene.dry_friction.fast
        if displacement and not scene.flat and friction:
            linear = effective_isolator(scene, displacement)
            period, damping, restoring = map(float, (linear.period, linear.damping, linear.restoring))
            isolator = result.LinearIsolator(displacement, period, damping, restoring, statistic, friction)
        weight = scene.total_mass * GRAVITY
        about = name, scene.title, len(scene.bodies), weight, isolator, read_building(scene)
        found.append(result.Structure(*about))
    return found


def read_building(scene: Scene) -> result.BuildingRead:
    """The building of a scene as it was read."""
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
        heights=None if building.heights is None else building.heights.tolist(),
        floors=[body.floor or "" for body in scene.bodies],
        friction_rate=None if scene.lubricated else scene.dry_friction.rate,
        stiffness=scene.stiffness.tolist(),
        sizes=[None if body.size is None else [float(value) for value in body.size] for body in scene.bodies],
    )
