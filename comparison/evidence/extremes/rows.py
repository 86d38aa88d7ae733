"""
Rows of the matrix of extremes: one quantity of the baseline scene at its extreme, for every model.

Scenes are written as in a scene file and read where a cell is solved, so that a wrong one is refused there. They last a
few seconds, during which the platform rests, slides and stops, unless the duration itself is the extreme.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from comparison.evidence.extremes.columns import (
    ALL_MODELS,
    ENGINE_MODELS,
    MAX_WORK,
    PLANAR_MODELS,
    REFERENCE_MODELS,
    REGULARIZED_MODELS,
    SPATIAL_MODELS,
    STATED_ENGINE,
)
from comparison.evidence.extremes.scenes import (
    GRAVITY_LIMIT,
    add_vertical_harmonic,
    change_bodies,
    make_baseline_scene,
    make_horizontal_amplitudes,
    put_on_bars,
    raise_bodies,
)

Phases = tuple[tuple[float, float], ...]  # phase pairs (alpha1, alpha2), rad

USUAL_PHASES: Phases = ((0.3, 1.1), (2.0, 0.7))  # rad, phase pairs at which most extreme cases are computed
# rad, phase pairs that are extreme cases themselves: by symmetry, forces or velocities vanish or coincide
SYMMETRIC_PHASES: Phases = ((0.0, 0.0), (0.0, math.pi), (math.pi / 2, math.pi / 2), (math.pi, math.pi / 2))
# Largest number of Exudyn's steps for a phase pair of long motions or stiff links (translational model only), for which
# MAX_WORK is too small
MAX_WORK_OF_LONG_ROWS = 4e6
MAX_WORK_OF_TOWERS = {10: 1.5e5, 100: 2.5e5, 1000: 1e3}  # largest number of steps for towers, by number of bodies


@dataclass(frozen=True)
class ExtremeCase:
    """One extreme value of one quantity, with the scene that has it and the models that are run with it."""

    group: str  # quantity whose extreme value is tried, in words
    title: str  # extreme value of this quantity, in words
    scene: Mapping[str, Any]  # tables and keys of the scene file
    columns: tuple[str, ...]  # keys of the models that the extreme concerns
    phases: Phases = USUAL_PHASES
    settings: Mapping[str, Any] = field(default_factory=dict)  # override keyword arguments of the models' functions
    invalid: bool = False  # whether the input is against the rules, so that every model must refuse it
    right: tuple[str, ...] = ()  # outcomes that are correct instead of an amplification; empty: not prescribed
    quick: bool = True  # whether the reference equations take less than a second; --reduced leaves other cases out
    max_work: float = MAX_WORK  # largest number of steps that the engine's models may take
    amplification: str = ""  # import path of an amplification function in place of the model's, "" for the model's

    @property
    def name(self) -> str:
        """Return the name of this extreme case: the quantity and its extreme value."""
        return f"{self.group} {self.title}"


def _cases_of_group(
    group: str, scenes: Mapping[Any, Mapping[str, Any]], columns: tuple[str, ...] = ALL_MODELS, **more: Any
) -> list[ExtremeCase]:
    """
    Return an extreme case for each of `scenes`, which are listed by the value of the quantity that is extreme in them.

    group: name of this quantity. more: further fields of the extreme cases.
    """
    titles = [value if isinstance(value, str) else f"{value:g}" for value in scenes]
    return [ExtremeCase(group, title, stated, columns, **more) for title, stated in zip(titles, scenes.values())]


def list_extreme_cases() -> Iterator[ExtremeCase]:
    """Yield every extreme case, in the order of the rows of the matrix."""
    yield from _friction_law_cases()
    yield from _engine_numerics_cases()
    yield from _size_cases()
    yield from _chain_cases()
    yield from _bar_cases()
    yield from _excitation_cases()
    yield from _direction_cases()
    yield from _start_and_support_cases()
    yield from _uneven_cases()
    yield from _tolerance_cases()
    yield from _refused_cases()


def _friction_law_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of the friction coefficient, its velocity dependence and its regularization."""
    yield from _cases_of_group(
        "friction", {friction: make_baseline_scene(friction=friction) for friction in (0.0, 1e-9, 1.0, 10.0)}
    )
    laws = {
        f"{rate:g}, {slow:g} to {fast:g}": make_baseline_scene(friction={"slow": slow, "fast": fast, "rate": rate})
        for rate in (1e-3, 1.0, 1e2, 1e3, 1e4, 1e6, 1e9)
        for slow, fast in ((0.05, 0.1), (0.1, 0.05))
    }
    yield from _cases_of_group("rate of friction, s/m", laws)
    wet = {each: make_baseline_scene(friction=None, lubrication=each) for each in (0.0, 1e-9, 1.0, 1e3)}
    yield from _cases_of_group("lubrication, s/m", wet, ("small", "exact", "translational"))
    for exponent in range(1, 9):
        speed = 10.0**-exponent
        yield ExtremeCase(
            "v_reg, m/s", f"{speed:g}", make_baseline_scene(), REGULARIZED_MODELS, settings={"regularization": speed}
        )
    for cutoff in (1e-1, 1e-4, 1e-12):
        yield ExtremeCase(
            "cutoff v_c, m/s", f"{cutoff:g}", make_baseline_scene(), ("small", "exact"), settings={"cutoff": cutoff}
        )


def _engine_numerics_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of Exudyn's contact stiffness and time step."""
    stiff, step = "contact stiffness, N/m", "step of the engine, s"
    brief = {-6: 0.02, -5: 0.2}  # s, duration of the motion with a time step of 10 to the power of the key
    for group, key, exponents in ((stiff, "contact_stiffness", range(2, 13, 2)), (step, "step", range(-6, 0))):
        for exponent in exponents:
            changed = {key: 10.0**exponent, "tolerance": 1e-2}
            short = make_baseline_scene(duration=brief.get(exponent, 1.0))
            yield ExtremeCase(
                group, f"1e{exponent}", short, ENGINE_MODELS, settings=changed, amplification=STATED_ENGINE
            )


def _size_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of the loading's amplitude, the radius of the sliding surface and the travel limit."""
    group = "amplitude, m/s^2"
    sizes = (1e-9, 1e-6, 1e-3, 5.0, 20.0, 1e3, 1e9)
    yield from _cases_of_group(
        group, {amplitude: make_baseline_scene(amplitudes=make_horizontal_amplitudes(amplitude)) for amplitude in sizes}
    )
    near_rim = make_baseline_scene(amplitudes=make_horizontal_amplitudes(12.0), friction=0.02, duration=20.0)
    yield ExtremeCase(group, "12, friction 0.02, along the rim", near_rim, PLANAR_MODELS, phases=USUAL_PHASES[:1])
    curved = {radius: raise_bodies(make_baseline_scene(radius=radius)) for radius in (1e-3, 3e-2, 30.0, 1e3)}
    flat = {
        "inf": make_baseline_scene(radius=math.inf),
        "inf, upward 5 m/s^2": make_baseline_scene(radius=math.inf, amplitudes=add_vertical_harmonic(5.0)),
        "inf, 1e-06 m/s^2": make_baseline_scene(radius=math.inf, amplitudes=make_horizontal_amplitudes(1e-6)),
    }
    yield from _cases_of_group("rho, m", {**curved, **flat})
    # So strong a loading that the platform slides off its supports
    far_off = make_baseline_scene(radius=math.inf, amplitudes=make_horizontal_amplitudes(1e3))
    yield ExtremeCase("rho, m", "inf, 1000 m/s^2", far_off, PLANAR_MODELS)
    yield from _cases_of_group(
        "travel, m", {travel: make_baseline_scene(travel=travel) for travel in (1e-6, 0.02, 0.24)}
    )


def _chain_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of the number of bodies, their masses, and the periods and damping of the links."""
    # Motions last longer than the 0.5 to 1.6 s that a shock takes to reach the top of the towers.
    for count, link in ((1, 1.0), (2, 1.0), (10, 0.3), (100, 0.03), (1000, 0.01)):
        tower = make_baseline_scene(
            masses=[1.0] * count, link=(link, 0.8 * link), storey=0.3, duration=3.0 if count <= 10 else 2.0
        )
        few, models = (USUAL_PHASES, ALL_MODELS) if count <= 10 else (USUAL_PHASES[:1], PLANAR_MODELS)
        work = MAX_WORK_OF_TOWERS.get(count, MAX_WORK)
        yield ExtremeCase("bodies N", str(count), tower, models, phases=few, quick=count <= 100, max_work=work)
    totals = (1e-6, 1e-3, 1e3, 1e9)
    yield from _cases_of_group(
        "total mass, kg", {total: make_baseline_scene(masses=[0.5 * total, 0.5 * total]) for total in totals}
    )
    group = "platform's share of the mass"
    # If platform / total mass < friction^2 / 4, the equations reach Painleve's paradox; elastic contact jams and opens.
    paradox = ("painleve paradox", "contact lost")
    for share, right in ((1e-6, ()), (1e-3, paradox), (0.999, ()), (0.999999, ())):
        tower = make_baseline_scene(masses=[2.0 * share, 2.0 * (1.0 - share)])
        yield ExtremeCase(group, f"{share:g}", tower, ("exact", "regularised", "translational"), right=right)
        yield ExtremeCase(group, f"{share:g}", tower, ("small", "spatial"))
    yield ExtremeCase(group, "1", make_baseline_scene(masses=[2.0]), ALL_MODELS)
    stiffest = make_baseline_scene(link=(1e-3, 0.8e-3))  # stiff link that vibrates for 3000 of its periods
    yield ExtremeCase("link periods, s", "0.001", stiffest, PLANAR_MODELS, max_work=MAX_WORK_OF_LONG_ROWS)
    yield ExtremeCase("link periods, s", "0.001", stiffest, ("spatial",))
    yield from _cases_of_group(
        "link periods, s", {each: make_baseline_scene(link=(each, 0.8 * each)) for each in (1e-2, 30.0, 1e3)}
    )
    damped: dict[Any, Any] = {zeta: make_baseline_scene(damping=zeta) for zeta in (0.0, 1e-6, 0.05, 1.0, 5.0)}
    damped["0 along x, 20 along y"] = make_baseline_scene(damping=[0.0, 20.0])
    damped["5, link periods 0.01 s"] = make_baseline_scene(damping=5.0, link=(0.01, 0.008))
    yield from _cases_of_group("damping of the links, of critical", damped)


def _bar_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of the bars that carry a body: their stiffness, and its weight over their buckling load."""
    group = "load over the buckling load of bars"
    yield from _cases_of_group(group, {share: put_on_bars(share) for share in (1e-4, 0.01, 0.5, 0.99, 0.999999)})
    yield ExtremeCase(group, "1.000001", put_on_bars(1.000001), ALL_MODELS, invalid=True)
    group = "axial stiffness of the bars, N"
    giving = {
        f"{stiffness:g}, {effect}": put_on_bars(0.3, axial_stiffness=stiffness, spread=0.8, load_effect=effect)
        for stiffness in (1e2, 1e4, 1e8)
        for effect in ("softening", "shortening")
    }
    yield from _cases_of_group(group, giving, SPATIAL_MODELS, max_work=1e5)
    topples = put_on_bars(0.3, axial_stiffness=1.0, spread=0.8)
    topples["bodies"][1]["height"] = 6.0
    yield ExtremeCase(group, "1, under a body 6 m above", topples, SPATIAL_MODELS, invalid=True)


def _excitation_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of the loading: frequencies, decay, duration, vertical amplitude and phases."""
    harmonics = {
        "equal": make_baseline_scene(periods=(0.9, 0.9)),
        "1e-3 Hz": make_baseline_scene(periods=(1e3, 1.1e3), decay=(3e-4, 3e-4)),
        "1e3 Hz": make_baseline_scene(periods=(1e-3, 1.1e-3), duration=0.05),
        "1e-3 Hz and 1e3 Hz": make_baseline_scene(periods=(1e3, 1e-3), duration=0.05),
    }
    yield from _cases_of_group("harmonics", harmonics)
    yield from _cases_of_group(
        "decay, 1/s", {decay: make_baseline_scene(decay=(decay, decay)) for decay in (0.0, 1e3, 1e6)}
    )
    group = "duration, s"
    yield from _cases_of_group(group, {duration: make_baseline_scene(duration=duration) for duration in (1e-3, 0.1)})
    lasting = {duration: make_baseline_scene(duration=duration) for duration in (100.0, 1e4)}
    yield from _cases_of_group(group, lasting, PLANAR_MODELS, phases=USUAL_PHASES[:1], max_work=MAX_WORK_OF_LONG_ROWS)
    group = "vertical loading, m/s^2"
    yield from _cases_of_group(
        group, {upward: make_baseline_scene(amplitudes=add_vertical_harmonic(upward)) for upward in (5.0, 9.8)}
    )
    exactly = make_baseline_scene(amplitudes=add_vertical_harmonic(GRAVITY_LIMIT), decay=(0.0, 0.0), duration=1.0)
    weightless = (0.0, 1.1), (math.pi, 0.7)  # rad, phases at which the contact force is zero for an instant
    # At that instant, both going on with contact and losing contact are right.
    yield ExtremeCase(group, "-g exactly", exactly, PLANAR_MODELS, phases=weightless, right=("contact lost",))
    # The spatial model goes on when a contact opens, so that no outcome is prescribed here.
    yield ExtremeCase(group, "-g exactly", exactly, ("spatial",), phases=weightless)
    yield from _cases_of_group(
        group, {upward: make_baseline_scene(amplitudes=add_vertical_harmonic(upward)) for upward in (15.0, 1e3)}
    )
    yield ExtremeCase(
        "phases", "at symmetric values", make_baseline_scene(duration=2.0), ALL_MODELS, phases=SYMMETRIC_PHASES
    )


def _direction_cases() -> Iterator[ExtremeCase]:
    """Yield extreme directions of the loading: exactly or nearly along one axis, or along one line."""
    lines = {
        "x alone": make_baseline_scene(amplitudes=[[2.0, 1.0], [0.0, 0.0]]),
        "y alone": make_baseline_scene(amplitudes=[[0.0, 0.0], [2.0, 1.0]]),
        "one oblique line (4.7)": make_baseline_scene(amplitudes=[[2.0, 1.0], [1.0, 0.5]], link=(1.5, 1.5)),
    }
    yield from _cases_of_group("direction", lines)
    planar = {
        f"x, and {across:g} m/s^2 across": make_baseline_scene(amplitudes=[[2.0, 1.0], [across, 0.0]])
        for across in (1e-3, 1e-6, 1e-9, 1e-12, 1e-15)
    }
    for still in (([2.0, 0.0], [0.0, 0.0]), ([0.0, 2.0], [0.0, 0.0])):
        planar[f"one harmonic alone, {still[0]}"] = make_baseline_scene(amplitudes=still)
    yield from _cases_of_group("direction", planar, PLANAR_MODELS)


def _start_and_support_cases() -> Iterator[ExtremeCase]:
    """Yield cases whose motion starts at the friction limit, and extremes of the radius of the ring of supports."""
    limit = 0.1 * GRAVITY_LIMIT
    for name, phase in (("turning there", 0.0), ("rising beyond", -math.pi / 3.0), ("falling", math.pi / 3.0)):
        amplitude = limit / math.cos(phase)
        alone = make_baseline_scene(amplitudes=[[amplitude, 0.0], [0.0, 0.0]], decay=(0.0, 0.0), masses=[1.0])
        yield ExtremeCase("start at the friction limit", name, alone, ALL_MODELS, phases=((phase, 0.0),))
    three = {
        ring: make_baseline_scene(amplitudes=make_horizontal_amplitudes(4.0), friction=0.05, supports=3, ring=ring)
        for ring in (1.0, 0.1, 0.01)
    }
    yield from _cases_of_group("three supports, ring in m", three, ("spatial",))


def _uneven_cases() -> Iterator[ExtremeCase]:
    """Yield buildings with offset or turned bodies or uneven supports, which only the spatial model accounts for."""
    # Bodies are moved toward a support by this share of the ring's radius; at 0.5 the opposite support carries nothing.
    for share in (1e-6, 0.1, 0.45, 0.5, 1.0):
        moved, beyond = change_bodies(offset=[share * math.sqrt(0.5)] * 2), share >= 0.5
        work = MAX_WORK if beyond else 1e5
        yield ExtremeCase("offset over the ring", f"{share:g}", moved, SPATIAL_MODELS, invalid=beyond, max_work=work)
    turned = {f"{yaw:.3g}": change_bodies(yaw=yaw) for yaw in (1e-6, 0.25 * math.pi)}
    yield from _cases_of_group("yaw, rad", turned, SPATIAL_MODELS)
    positions = {
        "2 m by 0.02 m": [[1.0, 0.01], [-1.0, 0.01], [-1.0, -0.01], [1.0, -0.01]],
        "one 100 m away": [[-0.5, -0.5], [0.5, -0.5], [0.0, 100.0]],
        "9 in a grid": [[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)],
    }
    group = "positions of supports"
    held = {title: make_baseline_scene(ring=None, supports=places) for title, places in positions.items()}
    yield from _cases_of_group(group, held, SPATIAL_MODELS, max_work=5e4)
    line = make_baseline_scene(ring=None, supports=[[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]])
    yield ExtremeCase(group, "on one line", line, SPATIAL_MODELS, invalid=True)


def _tolerance_cases() -> Iterator[ExtremeCase]:
    """Yield extremes of the relative error that a model is asked for."""
    for columns, tolerances in (
        (REFERENCE_MODELS, (1e-1, 1e-2, 1e-4, 1e-8)),
        (("translational",), (1e-1, 1e-2, 1e-4, 1e-6)),
    ):
        for tolerance in tolerances:
            settings = {"tolerance": tolerance}
            yield ExtremeCase(
                "relative error asked", f"{tolerance:g}", make_baseline_scene(), columns, settings=settings
            )


def _refused_cases() -> Iterator[ExtremeCase]:
    """Yield scenes against the rules, which every model must refuse, and scenes with no or too strong loading."""
    group = "outside the rules"
    wrong = {
        "friction -0.1": make_baseline_scene(friction=-0.1),
        "mass 0": make_baseline_scene(masses=[0.0, 1.0]),
        "duration 0": make_baseline_scene(duration=0.0),
        "travel beyond the radius": make_baseline_scene(radius=0.25, travel=0.3),
        "radius beyond double precision": make_baseline_scene(period=1e200),
        "amplitude not a number": make_baseline_scene(amplitudes=make_horizontal_amplitudes(math.nan)),
    }
    yield from _cases_of_group(group, wrong, ("exact", "translational"), invalid=True)
    for speed in (0.0, -1.0, math.inf):
        yield ExtremeCase(
            group,
            f"v_reg {speed:g} m/s",
            make_baseline_scene(),
            REGULARIZED_MODELS,
            settings={"regularization": speed},
            invalid=True,
        )
    yield ExtremeCase(
        group,
        "no loading",
        make_baseline_scene(amplitudes=make_horizontal_amplitudes(0.0)),
        PLANAR_MODELS,
        right=("no ground motion",),
    )
    overflow = make_baseline_scene(amplitudes=make_horizontal_amplitudes(1e200))
    yield ExtremeCase(group, "loading 1e200 m/s^2", overflow, PLANAR_MODELS, right=("non-finite load",))
