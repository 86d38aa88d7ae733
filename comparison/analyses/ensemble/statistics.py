"""Statistics of demands over the motions, the curves of the motions, and extremes of the single supports."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from comparison.analyses.ensemble import result
from comparison.analyses.ensemble.analysis import Point, Points
from comparison.analyses.ensemble.members import group_by
from comparison.analyses.ensemble.quantities import DEMANDS, FRACTILES, SMALLEST, Quantity, unit_of_demand
from comparison.json_file import finite_or_none
from reference.measures import Estimate
from reference.measures.distribution import fractile

MEDIAN = FRACTILES.index(0.5)


def quantities(points: Sequence[Point]) -> list[Quantity]:
    """The demands that any point has, in the order of `DEMANDS`."""
    order = {name: place for place, name in enumerate(DEMANDS)}
    names = {quantity for point in points for quantity in point.values}
    return sorted(names, key=lambda quantity: (order[quantity[0]], quantity[1]))


def stripes(points: Points) -> Iterator[result.Stripe]:
    """Statistics of every demand at every scale: by the equations, and by a model that computed every motion."""
    yield from _stripes_of_points(points.equations)
    motions = {(name, scale): len(own) for (name, scale), own in _by_scale(points.equations).items()}
    for own in points.compared.values():
        whole = [each for key, each in _by_scale(own).items() if len(each) == motions[key] > 1]
        yield from _stripes_of_points([point for each in whole for point in each])


def _by_scale(points: Sequence[Point]) -> dict[tuple[str, float], list[Point]]:
    groups: dict[tuple[str, float], list[Point]] = {}
    for point in points:
        groups.setdefault((point.member.structure, point.member.scale), []).append(point)
    return groups


def _stripes_of_points(points: Sequence[Point]) -> Iterator[result.Stripe]:
    """A motion without an answer counts as worse than all others."""
    for name, own in group_by(points, "member.structure").items():
        for quantity in quantities(own):
            for scale, at_scale in sorted(group_by(own, "member.scale").items()):
                numbers = {point.member.motion: point.estimate(quantity) for point in at_scale}
                lost = [point for point in at_scale if not math.isfinite(point.estimate(quantity).value)]
                lacking = Counter(point.estimate(quantity).reason or point.status for point in lost)
                about = name, *name_points(quantity), own[0].model, unit_of_demand(quantity[0]), scale
                yield summarize_motions(about, numbers, lacking)


def summarize_motions(
    about: tuple[str, str, int | None, str, str, float], numbers: Mapping[str, Estimate], lacking: Mapping[str, int]
) -> result.Stripe:
    """
    Statistics of a demand over the motions.

    about: first fields of a stripe. numbers: by motion. lacking: why motions have none, and how many each.
    """
    every, values = list(numbers.values()), [number.value for number in numbers.values()]
    is_smallest = about[1] in SMALLEST
    mean, *shares, largest, smallest = statistics(every, (*FRACTILES, 1.0, 0.0), -math.inf if is_smallest else math.inf)
    fractiles = [result.DemandFractile(each.value, each.error, share) for share, each in zip(FRACTILES, shares)]
    answered = len(every) - sum(lacking.values())
    known = [number for number in every if math.isfinite(number.value)]
    of_known = statistics(known, (0.0 if is_smallest else 1.0,)) if 0 < len(known) < len(every) else []

    def motion_of(number: result.Statistic) -> str:
        return list(numbers)[values.index(number.value)] if number.value in values else ""

    motions = motion_of(largest), motion_of(smallest), of_known, motion_of(of_known[1]) if of_known else ""
    return result.Stripe(*about, answered, mean, fractiles, largest, smallest, dict(lacking), *motions)


def name_points(quantity: Quantity) -> tuple[str, int | None]:
    """Name of a demand, and its body, None for the isolator."""
    return quantity[0], quantity[1] or None


def statistic(number: Estimate) -> result.Statistic:
    """A number with its error; None where it is not known."""
    return result.Statistic(finite_or_none(number.value), finite_or_none(number.error))


def statistics(numbers: Sequence[Estimate], shares: Sequence[float], worst: float = math.inf) -> list[result.Statistic]:
    """Mean of numbers with errors, which has no value unless all are known, and their fractiles."""
    value, error = (float(np.mean([getattr(each, part) for each in numbers])) for part in ("value", "error"))
    fractiles = [uncertain_fractile(numbers, share, worst) for share in shares]
    return [statistic(each) for each in (Estimate(value, error), *fractiles)]


def uncertain_fractile(numbers: Sequence[Estimate], share: float, worst: float = math.inf) -> Estimate:
    """Fractile of numbers; NaN ones count as `worst`. Its error is the largest change within the errors."""
    value = np.array([number.value for number in numbers])
    error = np.array([number.error for number in numbers])
    low, middle, high = (
        fractile(np.where(np.isfinite(value), x, worst), share) for x in (value - error, value, value + error)
    )
    return Estimate(middle, max(high - middle, middle - low)) if math.isfinite(middle) else Estimate(math.nan, math.nan)


def spectrum_bands(points: Sequence[Point]) -> Iterator[result.Spectrum]:
    """Floor spectra of every body of every structure at the largest scale, over all motions; the larger of x and y."""
    top = max((point.member.scale for point in points), default=math.nan)
    for name, own in group_by([point for point in points if point.member.scale == top], "member.structure").items():
        known = [point.spectra for point in own if point.spectra is not None]
        if not known:
            continue
        bodies, _, periods = known[0].acceleration.shape
        nothing = np.full((2, bodies, periods), np.nan)
        values = [
            (p.spectra.acceleration.max(axis=1), p.spectra.error.max(axis=1)) if p.spectra else nothing for p in own
        ]
        for body in range(bodies):
            columns = np.array(values)[:, :, body].transpose(2, 0, 1).tolist()  # by period, motion, value and error
            numbers = ([Estimate(*pair) for pair in column] for column in columns)
            mean, *shares, largest = zip(*(statistics(column, (*FRACTILES, 1.0)) for column in numbers))
            about = name, body + 1, top, known[0].damping, known[0].period.tolist()
            yield result.Spectrum(*about, mean, shares, largest)


def curves(points: Points) -> Iterator[result.DemandCurve]:
    """Every demand of every motion over its scales, by structure, demand, model and motion."""
    every = [list(points.equations), *map(list, points.compared.values())]
    asked = quantities(points.all_points)
    for name in group_by(points.equations, "member.structure"):
        by_model = [[point for point in own if point.member.structure == name] for own in every]
        known = [({*quantities(own)}, group_by(own, "member.motion")) for own in by_model]
        for quantity in asked:
            for has, by_motion in known:
                for motion, at in by_motion.items() if quantity in has else ():
                    at = sorted(at, key=lambda point: point.member.scale)
                    numbers = [statistic(point.estimate(quantity)) for point in at]
                    values, errors = [each.value for each in numbers], [each.error for each in numbers]
                    scales = [point.member.scale for point in at]
                    yield result.DemandCurve(name, *name_points(quantity), at[0].model, motion, scales, values, errors)


def support_extremes(points: Points) -> Iterator[result.SupportExtremes]:
    """
    Smallest and largest force of every support at the largest scale, with the motions.

    By the equations and statics over all motions, and by the spatial model over its motions.
    """
    top = max((point.member.scale for point in points.equations), default=math.nan)
    for model, own in {"": points.equations, **points.compared}.items():
        for name, at in group_by([each for each in own if each.member.scale == top], "member.structure").items():
            known = [each for each in at if each.forces and each.forces.support_max]
            places = at[0].member.scene.support_places
            if not known or places is None or (model and known[0].forces and known[0].forces.uplift is None):
                continue  # a third model has no supports of its own, and statics stand there already
            for number in range(len(places)):
                names = "support_min", "support_max", "uplift"
                small, large, gaps = ([_of_support(each, key, number) for each in known] for key in names)
                smallest, low = _extreme(small, known, -1.0)
                largest, high = _extreme(large, known, 1.0)
                gap, _ = _extreme(gaps, known, 1.0)
                x, y = map(float, places[number])
                count = sum(math.isfinite(each.value) for each in large)
                about = name, number + 1, x, y, known[0].model, count
                yield result.SupportExtremes(*about, smallest, low, largest, high, gap)


def _of_support(point: Point, name: str, number: int) -> Estimate:
    values = getattr(point.forces, name)
    return values[number] if values else Estimate(math.nan, math.nan)


def _extreme(numbers: Sequence[Estimate], points: Sequence[Point], sign: float) -> tuple[result.Statistic, str]:
    """The largest of the known numbers, or the smallest by a negative sign, and its motion."""
    known = [pair for pair in zip(numbers, points) if math.isfinite(pair[0].value)]
    if not known:
        return result.Statistic(None, None), ""
    number, point = max(known, key=lambda pair: sign * pair[0].value)
    return statistic(number), point.member.motion
