"""Statistics of demands over the motions, demand curves of the motions, and extremes of the single supports."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from comparison.analyses.ensemble import result
from comparison.analyses.ensemble.analysis import EnsemblePoints, MotionDemandsAtScale
from comparison.analyses.ensemble.members import group_rows_by
from comparison.analyses.ensemble.quantities import DEMANDS, FRACTILES, SMALLEST_IS_WORST, Quantity, unit_of_demand
from comparison.json_file import finite_or_none
from reference.measures import Estimate
from reference.measures.distribution import fractile

MEDIAN_INDEX = FRACTILES.index(0.5)  # index of the median in FRACTILES


def list_quantities(points: Sequence[MotionDemandsAtScale]) -> list[Quantity]:
    """Return name and body of every demand that any motion has, in the order of `DEMANDS`."""
    order = {name: place for place, name in enumerate(DEMANDS)}
    names = {quantity for point in points for quantity in point.values}
    return sorted(names, key=lambda quantity: (order[quantity[0]], quantity[1]))


def summarize_demands(points: EnsemblePoints) -> Iterator[result.DemandAtScale]:
    """Yield the statistics of every demand at every scale, by the equations and by models that computed all motions."""
    yield from _summarize_points(points.equations)
    motions = {
        (name, scale): len(own) for (name, scale), own in _group_by_structure_and_scale(points.equations).items()
    }
    for own in points.compared.values():
        whole = [each for key, each in _group_by_structure_and_scale(own).items() if len(each) == motions[key] > 1]
        yield from _summarize_points([point for each in whole for point in each])


def _group_by_structure_and_scale(
    points: Sequence[MotionDemandsAtScale],
) -> dict[tuple[str, float], list[MotionDemandsAtScale]]:
    """Return the demands of single motions grouped by name of the structure and scale."""
    groups: dict[tuple[str, float], list[MotionDemandsAtScale]] = {}
    for point in points:
        groups.setdefault((point.member.structure, point.member.scale), []).append(point)
    return groups


def _summarize_points(points: Sequence[MotionDemandsAtScale]) -> Iterator[result.DemandAtScale]:
    """Yield the statistics over the motions of every demand of every structure, at each scale."""
    for name, own in group_rows_by(points, "member.structure").items():
        for quantity in list_quantities(own):
            for scale, at_scale in sorted(group_rows_by(own, "member.scale").items()):
                numbers = {point.member.motion: point.estimate(quantity) for point in at_scale}
                lost = [point for point in at_scale if not math.isfinite(point.estimate(quantity).value)]
                lacking = Counter(point.estimate(quantity).reason or point.status for point in lost)
                about = name, *split_quantity(quantity), own[0].model, unit_of_demand(quantity[0]), scale
                yield summarize_motions(about, numbers, lacking)


def summarize_motions(
    about: tuple[str, str, int | None, str, str, float], numbers: Mapping[str, Estimate], lacking: Mapping[str, int]
) -> result.DemandAtScale:
    """
    Return mean, fractiles, largest and smallest value of a demand over the motions.

    about: structure, quantity, body, model, unit and scale, the first fields of `DemandAtScale`. numbers: the demand by
    motion. lacking: number of motions without it by reason. Such a motion counts as worse than all others.
    """
    every, values = list(numbers.values()), [number.value for number in numbers.values()]
    is_smallest = about[1] in SMALLEST_IS_WORST
    mean, *shares, largest, smallest = compute_mean_and_fractiles(
        every, (*FRACTILES, 1.0, 0.0), -math.inf if is_smallest else math.inf
    )
    fractiles = [result.DemandFractile(each.value, each.error, share) for share, each in zip(FRACTILES, shares)]
    answered = len(every) - sum(lacking.values())
    known = [number for number in every if math.isfinite(number.value)]
    of_known = compute_mean_and_fractiles(known, (0.0 if is_smallest else 1.0,)) if 0 < len(known) < len(every) else []

    def motion_with_value(number: result.Statistic) -> str:
        """Return the name of the first motion whose demand has this value, "" if none has."""
        return list(numbers)[values.index(number.value)] if number.value in values else ""

    return result.DemandAtScale(
        *about,
        answered=answered,
        mean=mean,
        fractiles=fractiles,
        largest=largest,
        smallest=smallest,
        reasons=dict(lacking),
        largest_motion=motion_with_value(largest),
        smallest_motion=motion_with_value(smallest),
        known=of_known,
        known_motion=motion_with_value(of_known[1]) if of_known else "",
    )


def split_quantity(quantity: Quantity) -> tuple[str, int | None]:
    """Return the name of a demand and its body, None for the isolator."""
    return quantity[0], quantity[1] or None


def make_statistic(number: Estimate) -> result.Statistic:
    """Return an estimate as a statistic: value and error, each None where it is not finite."""
    return result.Statistic(finite_or_none(number.value), finite_or_none(number.error))


def compute_mean_and_fractiles(
    numbers: Sequence[Estimate], shares: Sequence[float], worst: float = math.inf
) -> list[result.Statistic]:
    """
    Return the mean of numbers, then their fractiles at `shares`, each with its error.

    The mean has the value None if a number is NaN. In the fractiles NaN counts as `worst`.
    """
    value, error = (float(np.mean([getattr(each, part) for each in numbers])) for part in ("value", "error"))
    fractiles = [compute_fractile_with_error(numbers, share, worst) for share in shares]
    return [make_statistic(each) for each in (Estimate(value, error), *fractiles)]


def compute_fractile_with_error(numbers: Sequence[Estimate], share: float, worst: float = math.inf) -> Estimate:
    """
    Return a fractile of numbers, in which NaN counts as `worst`, with its error.

    The error is how far the fractile moves if all numbers rise, or all fall, by their errors.
    """
    value = np.array([number.value for number in numbers])
    error = np.array([number.error for number in numbers])
    low, middle, high = (
        fractile(np.where(np.isfinite(value), x, worst), share) for x in (value - error, value, value + error)
    )
    return Estimate(middle, max(high - middle, middle - low)) if math.isfinite(middle) else Estimate(math.nan, math.nan)


def summarize_spectra(points: Sequence[MotionDemandsAtScale]) -> Iterator[result.FloorSpectrumStatistics]:
    """
    Yield the statistics over the motions of the floor spectrum of each body at the largest scale.

    The spectrum of a motion is the larger of those along x and y.
    """
    top = max((point.member.scale for point in points), default=math.nan)
    for name, own in group_rows_by(
        [point for point in points if point.member.scale == top], "member.structure"
    ).items():
        known = [point.spectra for point in own if point.spectra is not None]
        if not known:
            continue
        bodies, _, periods = known[0].acceleration.shape
        nothing = np.full((2, bodies, periods), np.nan)
        values = [
            (p.spectra.acceleration.max(axis=1), p.spectra.error.max(axis=1)) if p.spectra else nothing for p in own
        ]
        for body in range(bodies):
            # Axes of this array: period, motion, then value and error
            columns = np.array(values)[:, :, body].transpose(2, 0, 1).tolist()
            numbers = ([Estimate(*pair) for pair in column] for column in columns)
            mean, *shares, largest = zip(*(compute_mean_and_fractiles(column, (*FRACTILES, 1.0)) for column in numbers))
            yield result.FloorSpectrumStatistics(
                structure=name,
                body=body + 1,
                scale=top,
                damping=known[0].damping,
                period=known[0].period.tolist(),
                mean=mean,
                fractiles=shares,
                largest=largest,
            )


def make_demand_curves(points: EnsemblePoints) -> Iterator[result.DemandCurve]:
    """Yield for each structure, demand, model and motion the demand over the scales."""
    every = [list(points.equations), *map(list, points.compared.values())]
    asked = list_quantities(points.all_points)
    for name in group_rows_by(points.equations, "member.structure"):
        by_model = [[point for point in own if point.member.structure == name] for own in every]
        known = [({*list_quantities(own)}, group_rows_by(own, "member.motion")) for own in by_model]
        for quantity in asked:
            for has, by_motion in known:
                for motion, at in by_motion.items() if quantity in has else ():
                    at = sorted(at, key=lambda point: point.member.scale)
                    numbers = [make_statistic(point.estimate(quantity)) for point in at]
                    yield result.DemandCurve(
                        name,
                        *split_quantity(quantity),
                        model=at[0].model,
                        motion=motion,
                        scales=[point.member.scale for point in at],
                        values=[each.value for each in numbers],
                        errors=[each.error for each in numbers],
                    )


def find_support_extremes(points: EnsemblePoints) -> Iterator[result.SupportExtremes]:
    """
    Yield for each support its smallest and largest force and largest uplift over the motions at the largest scale.

    They are by the equations and statics, and by the spatial model over the motions that it computed.
    """
    top = max((point.member.scale for point in points.equations), default=math.nan)
    for model, own in {"": points.equations, **points.compared}.items():
        for name, at in group_rows_by([each for each in own if each.member.scale == top], "member.structure").items():
            known = [each for each in at if each.forces and each.forces.support_max]
            places = at[0].member.scene.support_places
            if not known or places is None or (model and known[0].forces and known[0].forces.uplift is None):
                continue  # No support forces, or those of statics, which are listed for the exact equations alone
            for number in range(len(places)):
                names = "support_min", "support_max", "uplift"
                small, large, gaps = ([_support_estimate(each, key, number) for each in known] for key in names)
                smallest, low = _find_governing_motion(small, known, -1.0)
                largest, high = _find_governing_motion(large, known, 1.0)
                gap, _ = _find_governing_motion(gaps, known, 1.0)
                x, y = map(float, places[number])
                yield result.SupportExtremes(
                    structure=name,
                    support=number + 1,
                    x=x,
                    y=y,
                    model=known[0].model,
                    motions=sum(math.isfinite(each.value) for each in large),
                    smallest=smallest,
                    smallest_motion=low,
                    largest=largest,
                    largest_motion=high,
                    uplift=gap,
                )


def _support_estimate(point: MotionDemandsAtScale, name: str, number: int) -> Estimate:
    """Return one quantity of a support under one motion. name: support_min, support_max or uplift. number: from 0."""
    values = getattr(point.forces, name)
    return values[number] if values else Estimate(math.nan, math.nan)


def _find_governing_motion(
    numbers: Sequence[Estimate], points: Sequence[MotionDemandsAtScale], sign: float
) -> tuple[result.Statistic, str]:
    """Return the largest number (sign = -1: the smallest) and the motion that has it; NaN does not count."""
    known = [pair for pair in zip(numbers, points) if math.isfinite(pair[0].value)]
    if not known:
        return result.Statistic(None, None), ""
    number, point = max(known, key=lambda pair: sign * pair[0].value)
    return make_statistic(number), point.member.motion
