"""Sentences for the page and the terminal of an ensemble, each worded by one function from the result."""

from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path

from comparison.analyses.ensemble.quantities import display_unit, unit_of_check, word_value
from comparison.analyses.ensemble.result import EnsembleResult, LimitVerdict, Structure, SupportExtremes, TargetSpectrum
from comparison.analyses.ensemble.rows import (
    MAIN_TABLE_COLUMNS,
    label_structures,
    locate_demand,
    name_floor,
    peak_in_g,
    statistics_of_column,
    summarize_demand,
    word_bound,
)
from comparison.study.models import EXACT
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET, count_verdicts, word_excess
from comparison.wording import percent
from reference.plausibility import implausible_drift
from reference.problem import Outcome
from reference.support.arguments import name_some

TRAVEL_REACHED = Outcome.TRAVEL_REACHED.value  # outcome of a motion that ends at the isolator's limit of travel
MAX_LISTED_MOTIONS = 12  # largest number of motions that a sentence lists by name
MAX_LISTED_IN_SENTENCE = 3  # largest number of motions that the main result lists by name
DIGITS = 12  # number of characters shown of a SHA-256 digest
DEFINITIONS = (  # definitions of the demands, shown with their table
    "Displacement, drift, story shear, base shear and overturning moment are resultants of x and y, acceleration is "
    "that of x, y and z, the largest over time; floor spectra are the larger of x and y. Displacement is that of the "
    "middle of the platform; support displacement is the largest of a support, which turns with the platform, by the "
    "spatial engine alone and under its motions: the bearing needs that travel.",
    "The exact equations have bodies in translation, the platform on the whole sphere; the small equations are the "
    "same for displacements that are small beside the radius. Neither has torsion, whatever the offsets of the masses: "
    "drift and acceleration of a floor are those of its center of mass, and less than at the edge of a floor that "
    "turns. The spatial engine turns the bodies; its drifts and accelerations are those of the centers of mass, too.",
    "Accelerations have two readings. “As integrated” is the largest value at rest or while the isolator slides faster "
    "than 1 mm/s: what any time integration and the engine give, and the one to design equipment by. The “literal "
    "supremum” adds the limits at the instants in which the isolator stops; no integration reaches them, and they are "
    "too short to move equipment. All models are compared as integrated.",
    "± is the numerical error of a number, not the scatter over the motions: the fractiles show that. Mean and largest "
    "value have it, where it exceeds 0.005 % of the number; summary.json has those of the fractiles.",
    "16 %, 50 % and 84 % are fractiles over all motions (Hazen). A motion without a value, as one that reaches the rim "
    "or the travel, counts as worse than all others: a fractile is then no better than the true one, and none where it "
    "falls on such a motion. “(of 21)” behind a mean: of the 21 motions that have a value. “≥” before a number: at "
    "least that, the worst of the motions that have a value; a displacement is at least the travel under a motion that "
    "reaches it. “≤” is the same of a smallest force. A fractile beyond the outermost motions is left out (–), as 16 % "
    "of three. The column “largest” has the smallest value of a smallest force.",
    "Floor acceleration, drift and drift ratio are of every motion the largest over the floors, with the "
    "platform, or over the stories; statistics are of these, and “where” is the place of the largest of all. The "
    "tables over the height, and a limit on a mean, take each floor or story by itself.",
    "The envelope is in every column the worst of the bounds, named below the number or, of all columns, beside the "
    "word; motion and place are those of its largest value.",
    "All supports carry the same dead load, but for eccentric masses. Support forces by the equations are statics: "
    "normal force, overturning moment and displaced weight on equally stiff supports under a stiff platform, negative "
    "where a support would lift off; “The building as read” says what the displaced weight is. Those of the spatial "
    "engine are its contact forces.",
    "The overturning moment is that of the forces of inertia about the sliding contact, or about the floor below.",
    "Effective period and damping are those of a bilinear loop (ASCE/SEI 7, chapter 17) with the friction at high "
    "speed. Damping of the links acts in the superstructure; friction has no part in the modal damping.",
    "The residual displacement is where the platform comes to rest under Coulomb friction.",
)


VERTICAL_MOTION = "Vertical ground motion, except where the record has z."  # printed with the number of motions with z
NOT_MODELED = (  # what no model has; docs/guide/building.md explains each, beginning with the same words
    "Sliding surfaces of unequal friction in one bearing: double pendulums whose surfaces differ, and triple "
    "pendulums.",
    "Bearings whose depression is below and whose slider is fixed to the building: there the displaced weight loads "
    "the foundation.",
    "Unequal dead loads of the supports other than those that follow from the places of supports and centers of mass.",
    "Bearings of different kind, radius or friction under one platform.",
    "Accidental eccentricity: state it by `offset` at the bodies, in a file for each sign.",
    VERTICAL_MOTION,
    "A damper beside the bearings: `lubrication` in place of `friction` is a viscous one.",
    "Scaling by RotD100 as codes ask for it: `--target` fits the geometric mean of x and y.",
)


def list_not_modeled(ensemble: EnsembleResult) -> list[str]:
    """Return the sentences on what no model has. That on vertical motion counts the motions that have it."""
    if not ensemble.suite or not all(each.components for each in ensemble.suite):
        return list(NOT_MODELED)
    count = sum(any(one.axis == "z" for one in each.components) for each in ensemble.suite)
    known = f"{VERTICAL_MOTION[:-1]}: {count or 'none'} of {word_motion_count(len(ensemble.suite))} here."
    return [known if line == VERTICAL_MOTION else line for line in NOT_MODELED]


def say_of_all(ensemble: EnsembleResult, word: Callable[[Structure], str]) -> list[str]:
    """Return the sentence that `word` makes for each structure, after its label, or only one if all are the same."""
    said = {each.name: word(each) for each in ensemble.structures}
    if len({*said.values()}) == 1:
        return list(filter(None, said.values()))[:1]
    return [f"{word_bound(ensemble, name, '{}: ')}{line}" for name, line in said.items() if line]


def word_heading(ensemble: EnsembleResult) -> str:
    """Return the heading of the page: titles of the buildings, number of motions, and the largest scale if it tells."""
    titles = ", ".join(dict.fromkeys(each.title for each in ensemble.structures))
    at = f", scale {ensemble.largest_scale:g}" if len(ensemble.scales) > 1 or ensemble.largest_scale != 1.0 else ""
    return f"{titles}: {word_motion_count(ensemble.motions)}{at}"


def word_motion_count(count: int) -> str:
    """Return the number of motions with its noun: "1 motion", "7 motions"."""
    return f"{count} motion{'' if count == 1 else 's'}"


def answer_sentence(ensemble: EnsembleResult) -> str:
    """
    Return the main result in words.

    It has the verdicts on limits, the motions without a value, mean and largest displacement and base shear of the
    structure where they are worst, and the outcomes.
    """
    said = []
    for quantity, words in (("displacement", "isolator displacement"), ("base_shear", "base shear")):
        found, unknown = [], []
        for structure in ensemble.structures:
            stripe = ensemble.find_demand(structure.name, quantity)
            if stripe is not None and stripe.largest.value is not None:
                per = structure.weight if quantity == "base_shear" else 1.0
                found.append((stripe.largest.value / per, structure, stripe))
            elif stripe is not None:
                unknown.append(structure)
        reached = _travel_reached_sentence(ensemble) if quantity == "displacement" else ""
        if not found:
            said += [f"{words}: {reached}"] if reached else []
            continue
        most, structure, stripe = max(found, key=lambda each: each[0])
        unit, factor = display_unit(quantity, structure.weight)
        mean, largest = (word_value(each.value, None, factor) for each in (stripe.mean, stripe.largest))
        bound = word_bound(ensemble, structure.name, "{} alone, " if unknown else "{}, ")
        travel = structure.building.travel if structure.building else None
        share = f" = {percent(most / travel)} of the travel" if quantity == "displacement" and travel else ""
        where = f"{bound}{stripe.largest_motion}"
        reached = f"{reached}; " if reached else ""
        said.append(f"{words}: {reached}mean {mean} {unit}, largest {largest} {unit}{share} ({where})")
    named = label_structures(ensemble)
    lost = {each.name: list_motions_without_displacement(ensemble, each) for each in ensemble.structures}
    texts = {
        name: ", ".join(motions) if len(motions) <= MAX_LISTED_IN_SENTENCE else word_motion_count(len(motions))
        for name, motions in lost.items()
    }
    bounds = [f"{text} ({named[name]})" for name, text in texts.items() if lost[name]]
    lacking = f"No value under {'; '.join(bounds)}. " if bounds else ""
    if not any("mean" in each for each in said):
        said.append("no demand is known of all motions")
    text = "; ".join(said)
    verdicts = f"{limits} " if (limits := limits_sentence(ensemble)) else ""
    return f"{verdicts}{lacking}{text[:1].upper()}{text[1:]}. {outcomes_sentence(ensemble)}"


def limits_sentence(ensemble: EnsembleResult) -> str:
    """Return a sentence on how many limits are met, which are not, and which are not compared; "" without limits."""
    if not ensemble.limits:
        return ""
    counts = count_verdicts(each.verdict for each in ensemble.limits)
    what = "limits" if all(each.key.startswith("acceptance.") for each in ensemble.limits) else "demands"
    said = f"{counts[MET]} of {len(ensemble.limits)} {what} met, {counts[NOT_COMPARED]} not compared"
    broken, open_ones = (_list_limits(ensemble, verdict) for verdict in (NOT_MET, NOT_COMPARED))
    lacking = f". Not compared: {open_ones}" if open_ones else ""
    before = "Provisional, before the engine: " if ensemble.engine.pending else ""
    return f"{before}{said}, {counts[NOT_MET]} not met{': ' * bool(broken)}{broken}{lacking}."


def _list_limits(ensemble: EnsembleResult, verdict: str) -> str:
    """Return in words the limits with this verdict, with the structures and excesses; "" if no limit has it."""
    found: dict[str, list[str]] = {}
    for each in ensemble.limits:
        if each.verdict == verdict:
            bound = each.bound if len(ensemble.structures) > 1 else ""
            found.setdefault(each.what, []).append(" ".join(filter(None, [bound, _word_excess(each)])))
    named = [f"{what} ({', '.join(dict.fromkeys(own))})" if any(own) else what for what, own in found.items()]
    more = f" and {len(named) - MAX_LISTED_MOTIONS} more" if len(named) > MAX_LISTED_MOTIONS else ""
    return "; ".join(named[:MAX_LISTED_MOTIONS]) + more


def _word_excess(limit: LimitVerdict) -> str:
    """Return in words by how much a demand exceeds its limit; "" if the verdict is not "not met"."""
    if limit.verdict != NOT_MET or limit.found is None or limit.stated is None:
        return ""
    unit, factor = unit_of_check(limit.unit)
    return word_excess(factor * (limit.found - limit.stated), factor * limit.stated, unit, limit.is_least)


def pending_sentence(ensemble: EnsembleResult) -> str:
    """Return a note that the engine still computes its motions while this is written; "" once it has finished."""
    if not (pending := ensemble.engine.pending):
        return ""
    count = word_motion_count(pending)
    return f"Provisional: written while the engine computes {count}. The page is written again with their numbers."


def _travel_reached_sentence(ensemble: EnsembleResult) -> str:
    """Return in words which structures reach the limit of travel of the isolator; "" if none does."""
    named = label_structures(ensemble)
    found: dict[float, list[str]] = {}
    for structure in ensemble.structures:
        stripe, building = ensemble.find_demand(structure.name, "displacement"), structure.building
        if stripe is not None and building is not None and building.travel and TRAVEL_REACHED in stripe.reasons:
            found.setdefault(building.travel, []).append(named[structure.name])

    def bounds_of(bounds: list[str]) -> str:
        """Return labels of structures in parentheses; "" if the ensemble has a single structure."""
        return f" ({', '.join(bounds)})" if len(ensemble.structures) > 1 else ""

    return "; ".join(
        f"at least the travel, {word_value(travel, None, 1e3)} mm{bounds_of(bounds)}"
        for travel, bounds in found.items()
    )


def word_plan_sizes(structure: Structure) -> str:
    """Return the plan sizes of the bodies from the platform up, m; one size where all are equal."""
    sizes = structure.building.sizes if structure.building else ()
    read = ["not stated" if size is None else f"{size[0]:.4g} × {size[1]:.4g}" for size in sizes]
    return f"{read[0]}, all" if len({*read}) == 1 < len(read) else "; ".join(read)


def travel_sentence(ensemble: EnsembleResult) -> str:
    """Return in words which motions reach the limit of travel at the largest scale, and when; "" if none does."""
    bounds = []
    for structure in ensemble.structures:
        ended = [
            f"{each.motion}{'' if each.instant is None else f' at {each.instant:.4g} s'}"
            for each in ensemble.ended
            if (each.structure, each.scale, each.status) == (structure.name, ensemble.largest_scale, TRAVEL_REACHED)
        ]
        if ended:
            bounds.append(f"{name_some(ended, MAX_LISTED_MOTIONS)}{word_bound(ensemble, structure.name, ' ({})')}")
    if not bounds:
        return ""
    rule = "No demand has a value there. A run without `travel` gives the displacement that is needed."
    return f"The travel is reached under {'; '.join(bounds)}. {rule}"


def list_motions_without_displacement(ensemble: EnsembleResult, structure: Structure) -> list[str]:
    """Return the motions for which a structure has no displacement at the largest scale."""
    known = ensemble.values_at_largest_scale(structure.name, "displacement", None, EXACT.key)
    return [motion for motion, each in known.items() if each.value is None]


def outcomes_sentence(ensemble: EnsembleResult) -> str:
    """Return in words how many motions the equations completed and how the others ended."""
    ended = ", ".join(f"{count} {name}" for name, count in ensemble.outcomes.items())
    return f"Outcomes by the equations: {ended}."


def target_sentence(target: TargetSpectrum) -> str:
    """Return a sentence on how the motions are scaled to the target spectrum, and over which periods."""
    between = f"from {target.low:.3g} to {target.high:.3g} s, in the logarithm, at 5 % damping"
    return f"Scale 1 is that of the target spectrum: least squares over periods {between}."


def isolator_sentence(structure: Structure) -> str:
    """Return a sentence on the equivalent linear isolator of a structure; "" without one."""
    if (at := structure.isolator) is None:
        return ""
    return (
        f"Effective isolator of design codes at the {at.statistic} displacement, {1e3 * at.displacement:.4g} mm, and "
        f"friction {at.friction:.3g}: period {at.period:.3g} s, damping {percent(at.damping)}, re-centering ratio "
        f"{at.restoring:.3g}."
    )


def restoring_sentence(ensemble: EnsembleResult) -> str:
    """Return in words what the re-centering ratio is, and which structures have one below 1; "" without an isolator."""
    ratios = {each.name: each.isolator.restoring for each in ensemble.structures if each.isolator}
    named = label_structures(ensemble)
    below = [named[name] for name, ratio in ratios.items() if ratio < 1.0]
    stays = "" if len(ensemble.structures) == 1 else f" ({', '.join(below)})"
    said = "The re-centering ratio is the restoring force over the friction force at that displacement."
    return (said + (f" It is below 1{stays}: the platform may stay there." if below else "")) * bool(ratios)


def supremum_sentence(places: Collection[str], differing: Collection[str]) -> str:
    """
    Return a sentence on the floors where the literal supremum is the acceleration as integrated; "" if at none.

    places: all floors. differing: those where the two differ.
    """
    if len(differing) == len(places):
        return ""
    where = "At the floors that are left out" if differing else "At every floor"
    return f"{where} the literal supremum is the acceleration as integrated, to all digits of the table above."


def below_contact_sentence(structure: Structure) -> str:
    """Return a warning if the platform is below the sliding contact, as if `height` were misunderstood; else ""."""
    building = structure.building
    if building is None or not building.heights or building.heights[0] >= 0.0:
        return ""
    return (
        f"The center of mass of the {name_floor(structure, 1)} is {-building.heights[0]:.3g} m below the sliding "
        "contact: `height` counts from the centers of the depressions, which lie R = radius + sphere_radius below it."
    )


def engine_sentences(ensemble: EnsembleResult) -> list[str]:
    """Return sentences on which motions the engine computed for each structure, and for which reasons."""
    engine, said = ensemble.engine, []
    for structure in ensemble.structures:
        own = [each for each in engine.motions if each.structure == structure.name]
        if not own:
            continue
        each_motion = [
            f"{each.motion} ({', '.join(each.reasons)}{_word_status(each.statuses.get(engine.model, ''))})"
            for each in own[:MAX_LISTED_MOTIONS]
        ]
        more = f" and {len(own) - MAX_LISTED_MOTIONS} more" if len(own) > MAX_LISTED_MOTIONS else ""
        bound = word_bound(ensemble, structure.name, ", {}")
        said.append(f"The {engine.model} engine computed{bound}: {'; '.join(each_motion)}{more}.")
    if said:
        said.append(f"The engine was asked for largest accelerations to {percent(engine.tolerance)}.")
    return said


def _word_status(status: str) -> str:
    """Return the outcome of a motion as a clause to append; "" if it is ok."""
    return "" if status in ("ok", "") else f"; {status}"


def support_sentences(ensemble: EnsembleResult) -> list[str]:
    """Return a sentence for each model on the largest and smallest support force and the largest uplift."""
    said = []
    for model in dict.fromkeys(each.model for each in ensemble.supports):
        rows = [each for each in ensemble.supports if each.model == model]
        by = "By the equations and statics" if model == EXACT.key else f"By the {model} engine"
        parts = list(_support_parts(ensemble, rows))
        if not parts:
            continue  # No motion has a force of a support by this model.
        counts = {label_structures(ensemble)[each.structure]: word_support_motions(ensemble, each) for each in rows}
        of = ", ".join(f"{count} of the {bound}" for bound, count in counts.items())
        of = next(iter(counts.values())) if len({*counts.values()}) == 1 else of
        of += " of each bound" if len({*counts.values()}) == 1 < len(counts) else ""
        lacking = model == EXACT.key and any(each.motions < ensemble.motions for each in rows)
        unknown = " The worst may be under a motion without a value." if lacking else ""
        said.append(f"{by}, {of}: {'; '.join(parts)}.{unknown}")
    return said


def word_support_motions(ensemble: EnsembleResult, supports: SupportExtremes) -> str:
    """Return in words over how many motions the extremes of a support are taken, such as "5 of 7 motions"."""
    some = f"{supports.motions} of " if supports.motions < ensemble.motions else ""
    return f"{some}{word_motion_count(ensemble.motions)}"


def displaced_weight_sentence(structure: Structure) -> str:
    """
    Return sentences on the displaced weight, that is the weight off the middle of the bearings; "" without supports.

    They say which part of the bearing moves with the platform, and with which moment the weight loads the supports.
    """
    building = structure.building
    if building is None or not building.supports:
        return ""
    if building.radius is None:
        return "The platform slides on fixed supports: the displaced weight W × (displacement + drift) loads them."
    sphere = building.sphere_radius or 0.0
    return (
        "Fixed spheres below, depressions in the platform’s underside: the weight W moves with the platform by the "
        "displacement, and the contact points on the spheres move the other way by r / ρ of it. The displaced weight, "
        "a moment of W × (R / ρ × displacement + drift) about the contact points, loads the supports: ρ = "
        f"{building.radius:.4g} m, r = {sphere:.4g} m, R = ρ + r = {building.radius + sphere:.4g} m, "
        f"R / ρ = {1.0 + sphere / building.radius:.4g}."
    )


def damping_sentence(structure: Structure) -> str:
    """Return a sentence on damping in proportion to the stiffness, if the modal ratios show it; else ""."""
    building = structure.building
    if building is None:
        return ""
    # Stiffness-proportional damping has ratios in proportion to the frequency: ratio times period is equal in all
    # modes.
    products = [
        [ratio * period for ratio, period in zip(*axis)]
        for axis in zip(building.modal_damping, building.fixed_base_period)
        if any(axis[0])
    ]
    if not products or any(max(axis) - min(axis) > 1e-6 * max(axis) for axis in products):
        return ""
    first = " along x, ".join(ratios := dict.fromkeys(percent(axis[0]) for axis in building.modal_damping if axis))
    first += " along y" * (len(ratios) > 1)
    return (
        f"Damping is in proportion to the stiffness of the links, c = 2 ζ k / ω₁ with ζ = {first} in the first mode "
        "above a fixed base; a higher mode has a ratio in proportion to its frequency."
    )


def _support_parts(ensemble: EnsembleResult, rows: Sequence[SupportExtremes]) -> Iterator[str]:
    """Yield phrases on the largest and smallest support force and the largest uplift, with support and motion."""
    for name, sign in (("largest", 1.0), ("smallest", -1.0), ("uplift", 1.0)):
        known = [row for row in rows if getattr(row, name).value is not None]
        if not known:
            continue
        row = max(known, key=lambda row: sign * getattr(row, name).value)
        value, error = getattr(row, name).value, getattr(row, name).error
        if name == "uplift":
            place = f" at support {row.support}{word_bound(ensemble, row.structure, ' ({})')}" if value else ""
            yield f"largest uplift {word_value(value, None, 1e3)} mm{place}"
            continue
        bound = word_bound(ensemble, row.structure, ", {}")
        place = f"support {row.support} at [{row.x:.3g}, {row.y:.3g}] m"
        yield f"{name} force {word_value(value, error, 1e-3)} kN, {place} ({getattr(row, f'{name}_motion')}{bound})"


def drift_warning(ensemble: EnsembleResult, structure: Structure) -> str:
    """Return a warning of an implausible drift with its story and motion; "" for any other drift."""
    found = []
    for row in ensemble.list_demands_of_bodies(structure.name, "drift_ratio"):
        told = summarize_demand(structure, row)
        place = f"{locate_demand(structure, row.quantity, row.body)} under {told.motion}"
        found.append((told.numbers[-1].value or 0.0, place))
    return f"Warning: {line}" if found and (line := implausible_drift(*max(found))) else ""


def missing_sentences(ensemble: EnsembleResult, structure: Structure) -> list[str]:
    """
    Return sentences on which motions lack which demands at the largest scale, and why.

    Motions that reach the travel have a sentence of their own, `travel_sentence`.
    """
    stripes = {
        shown.name: found
        for shown in MAIN_TABLE_COLUMNS
        if (found := statistics_of_column(ensemble, shown, ensemble.largest_scale, structure)) is not None
    }
    ended = list_motions_without_displacement(ensemble, structure)
    lacking: dict[tuple[str, int], list[str]] = {}
    for name, stripe in stripes.items():
        for reason in stripe.reasons.items():
            lacking.setdefault(reason, []).append(name)
    lines = []
    for (why, count), names in lacking.items():
        every = len(names) == len(stripes)
        if every and why == TRAVEL_REACHED:
            continue  # named by `travel_sentence`: they reach the limit of travel
        which = (
            f" ({', '.join(ended[:MAX_LISTED_MOTIONS])}{' and more' * (len(ended) > MAX_LISTED_MOTIONS)})"
            if every
            else ""
        )
        what = "every demand" if every else ", ".join(names)
        lines.append(f"Without a value for {word_motion_count(count)}{which}: {what} ({why}).")
    return lines


def all_missing_sentences(ensemble: EnsembleResult) -> list[str]:
    """Return the sentences of `missing_sentences` for every structure, each after the label of the structure."""
    return [
        f"{word_bound(ensemble, each.name, '{}: ')}{line}"
        for each in ensemble.structures
        for line in missing_sentences(ensemble, each)
    ]


def digest_sentence(ensemble: EnsembleResult) -> str:
    """Return a sentence with the SHA-256 digests of scene files and samples, their first digits; "" without any."""
    scenes = [f"{Path(source).name} {digest[:DIGITS]}" for source, digest in ensemble.run.get("scenes", {}).items()]
    motions = [f"{each.motion} {each.digest[:DIGITS]}" for each in ensemble.suite if each.digest]
    said = [f"scene files: {', '.join(scenes)}"] * bool(scenes)
    said += [f"samples of the motions with their factors: {', '.join(motions)}"] * bool(motions)
    return f"SHA-256, its first {DIGITS} digits, of {'; of '.join(said)}." if said else ""


def ground_sentence(ensemble: EnsembleResult) -> str:
    """Return a sentence on the ranges of peak ground acceleration and duration of the motions."""
    peaks, lengths = [each.peak for each in ensemble.suite], [each.duration for each in ensemble.suite]
    if not peaks:
        return ""
    return (
        f"Peaks from {peak_in_g(min(peaks))} to {peak_in_g(max(peaks))}, resultant of x and y, with the factors; "
        f"{_word_range('duration', min(lengths), max(lengths))}."
    )


def _word_range(what: str, low: float, high: float) -> str:
    """Return the range of a duration in words, s; a single value if both ends print alike. what: its name."""
    ends = f"{low:.3g}", f"{high:.3g}"
    return f"{what} {ends[0]} s" if ends[0] == ends[1] else f"{what}s from {ends[0]} to {ends[1]} s"
