"""
The rows of the matrix of extremes: one quantity of a plain scene driven to its extreme, for every model.

Scenes are written as in a scene file and read where a cell is solved, so that a wrong one is refused there. They last a
few seconds, during which the platform rests, slides and stops, unless the duration itself is the extreme.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from comparison.evidence.extremes.columns import (
    ALL,
    MAX_WORK,
    PLANAR,
    REFERENCE,
    SPATIAL,
    STATED,
    WITH_ENGINE,
    WITH_V_REG,
)
from comparison.evidence.extremes.scenes import (
    GRAVITY_LIMIT,
    amplitudes_along,
    amplitudes_upward,
    change_bodies,
    put_on_bars,
    raise_bodies,
    scene,
)

Phases = tuple[tuple[float, float], ...]

PHASES: Phases = ((0.3, 1.1), (2.0, 0.7))  # rad
SYMMETRIC: Phases = ((0.0, 0.0), (0.0, math.pi), (math.pi / 2, math.pi / 2), (math.pi, math.pi / 2))
# steps of the engine for a phase pair where nothing but their number would stop the translational model, whose steps
# cost least, and for one of a tower by its number of bodies, whose steps cost more
MUCH_WORK = 4e6
TOWER_WORK = {10: 1.5e5, 100: 2.5e5, 1000: 1e3}


@dataclass(frozen=True)
class ExtremeCase:
    """An extreme."""

    group: str  # the quantity
    title: str  # its value
    scene: Mapping[str, Any]  # as in a scene file
    columns: tuple[str, ...]  # keys of the models it concerns
    phases: Phases = PHASES
    settings: Mapping[str, Any] = field(default_factory=dict)  # settings of the models, in place of the column's
    invalid: bool = False  # the rules of the input refuse it
    right: tuple[str, ...] = ()  # outcomes that may stand in place of an answer, where they are known; any if empty
    quick: bool = True  # takes the equations less than a second
    max_work: float = MAX_WORK  # steps that the engine's models may take
    amplification: str = ""  # function in place of the column's

    @property
    def name(self) -> str:
        """Quantity and value."""
        return f"{self.group} {self.title}"


def _cases_of_group(
    group: str, scenes: Mapping[Any, Mapping[str, Any]], columns: tuple[str, ...] = ALL, **more: Any
) -> list[ExtremeCase]:
    titles = [value if isinstance(value, str) else f"{value:g}" for value in scenes]
    return [ExtremeCase(group, title, stated, columns, **more) for title, stated in zip(titles, scenes.values())]


def extreme_cases() -> Iterator[ExtremeCase]:
    """Every extreme, in the order of the matrix."""
    yield from _friction_laws()
    yield from _engine_numerics_cases()
    yield from _size_cases()
    yield from _chain_cases()
    yield from _bar_cases()
    yield from _excitation_cases()
    yield from _direction_cases()
    yield from _start_and_support_cases()
    yield from _uneven_cases()
    yield from _tolerance_cases()
    yield from _outside_the_rules()


def _friction_laws() -> Iterator[ExtremeCase]:
    yield from _cases_of_group("friction", {friction: scene(friction=friction) for friction in (0.0, 1e-9, 1.0, 10.0)})
    laws = {
        f"{rate:g}, {slow:g} to {fast:g}": scene(friction={"slow": slow, "fast": fast, "rate": rate})
        for rate in (1e-3, 1.0, 1e2, 1e3, 1e4, 1e6, 1e9)
        for slow, fast in ((0.05, 0.1), (0.1, 0.05))
    }
    yield from _cases_of_group("rate of friction, s/m", laws)
    wet = {each: scene(friction=None, lubrication=each) for each in (0.0, 1e-9, 1.0, 1e3)}
    yield from _cases_of_group("lubrication, s/m", wet, ("small", "exact", "translational"))
    for exponent in range(1, 9):
        speed = 10.0**-exponent
        yield ExtremeCase("v_reg, m/s", f"{speed:g}", scene(), WITH_V_REG, settings={"regularization": speed})
    for cutoff in (1e-1, 1e-4, 1e-12):
        yield ExtremeCase("cutoff v_c, m/s", f"{cutoff:g}", scene(), ("small", "exact"), settings={"cutoff": cutoff})


def _engine_numerics_cases() -> Iterator[ExtremeCase]:
    stiff, step = "contact stiffness, N/m", "step of the engine, s"
    brief = {-6: 0.02, -5: 0.2}  # s of motion at a small step
    for group, key, exponents in ((stiff, "contact_stiffness", range(2, 13, 2)), (step, "step", range(-6, 0))):
        for exponent in exponents:
            changed = {key: 10.0**exponent, "tolerance": 1e-2}
            short = scene(duration=brief.get(exponent, 1.0))
            yield ExtremeCase(group, f"1e{exponent}", short, WITH_ENGINE, settings=changed, amplification=STATED)


def _size_cases() -> Iterator[ExtremeCase]:
    group = "amplitude, m/s^2"
    sizes = (1e-9, 1e-6, 1e-3, 5.0, 20.0, 1e3, 1e9)
    yield from _cases_of_group(group, {amplitude: scene(amplitudes=amplitudes_along(amplitude)) for amplitude in sizes})
    near_rim = scene(amplitudes=amplitudes_along(12.0), friction=0.02, duration=20.0)
    yield ExtremeCase(group, "12, friction 0.02, along the rim", near_rim, PLANAR, phases=PHASES[:1])
    curved = {radius: raise_bodies(scene(radius=radius)) for radius in (1e-3, 3e-2, 30.0, 1e3)}
    flat = {
        "inf": scene(radius=math.inf),
        "inf, upward 5 m/s^2": scene(radius=math.inf, amplitudes=amplitudes_upward(5.0)),
        "inf, 1e-06 m/s^2": scene(radius=math.inf, amplitudes=amplitudes_along(1e-6)),
    }
    yield from _cases_of_group("rho, m", {**curved, **flat})
    far_off = scene(radius=math.inf, amplitudes=amplitudes_along(1e3))  # the platform leaves its supports
    yield ExtremeCase("rho, m", "inf, 1000 m/s^2", far_off, PLANAR)
    yield from _cases_of_group("travel, m", {travel: scene(travel=travel) for travel in (1e-6, 0.02, 0.24)})


def _chain_cases() -> Iterator[ExtremeCase]:
    # a shock takes to the top of the towers 0.5 to 1.6 s
    for count, link in ((1, 1.0), (2, 1.0), (10, 0.3), (100, 0.03), (1000, 0.01)):
        tower = scene(masses=[1.0] * count, link=(link, 0.8 * link), storey=0.3, duration=3.0 if count <= 10 else 2.0)
        few, models = (PHASES, ALL) if count <= 10 else (PHASES[:1], PLANAR)
        work = TOWER_WORK.get(count, MAX_WORK)
        yield ExtremeCase("bodies N", str(count), tower, models, phases=few, quick=count <= 100, max_work=work)
    totals = (1e-6, 1e-3, 1e3, 1e9)
    yield from _cases_of_group("total mass, kg", {total: scene(masses=[0.5 * total, 0.5 * total]) for total in totals})
    group = "platform's share of the mass"
    # below mu^2 / 4 the equations come to Painleve's paradox; a contact that gives way jams and opens
    paradox = ("painleve paradox", "contact lost")
    for share, right in ((1e-6, ()), (1e-3, paradox), (0.999, ()), (0.999999, ())):
        tower = scene(masses=[2.0 * share, 2.0 * (1.0 - share)])
        yield ExtremeCase(group, f"{share:g}", tower, ("exact", "regularised", "translational"), right=right)
        yield ExtremeCase(group, f"{share:g}", tower, ("small", "spatial"))
    yield ExtremeCase(group, "1", scene(masses=[2.0]), ALL)
    stiffest = scene(link=(1e-3, 0.8e-3))  # swings for 3000 of its periods
    yield ExtremeCase("link periods, s", "0.001", stiffest, PLANAR, max_work=MUCH_WORK)
    yield ExtremeCase("link periods, s", "0.001", stiffest, ("spatial",))
    yield from _cases_of_group("link periods, s", {each: scene(link=(each, 0.8 * each)) for each in (1e-2, 30.0, 1e3)})
    damped: dict[Any, Any] = {zeta: scene(damping=zeta) for zeta in (0.0, 1e-6, 0.05, 1.0, 5.0)}
    damped["0 along x, 2 along y"] = scene(damping=[0.0, 20.0])
    damped["5, link periods 0.01 s"] = scene(damping=5.0, link=(0.01, 0.008))
    yield from _cases_of_group("damping of the links, of critical", damped)


def _bar_cases() -> Iterator[ExtremeCase]:
    """Bars under the weight of a mass of 1 kg, whose sway buckling load is stated in weights of that mass."""
    group = "load over the buckling load of bars"
    yield from _cases_of_group(group, {share: put_on_bars(share) for share in (1e-4, 0.01, 0.5, 0.99, 0.999999)})
    yield ExtremeCase(group, "1.000001", put_on_bars(1.000001), ALL, invalid=True)
    group = "axial stiffness of the bars, N"
    giving = {
        f"{stiffness:g}, {effect}": put_on_bars(0.3, axial_stiffness=stiffness, spread=0.8, load_effect=effect)
        for stiffness in (1e2, 1e4, 1e8)
        for effect in ("softening", "shortening")
    }
    yield from _cases_of_group(group, giving, SPATIAL, max_work=1e5)
    topples = put_on_bars(0.3, axial_stiffness=1.0, spread=0.8)
    topples["bodies"][1]["height"] = 6.0
    yield ExtremeCase(group, "1, under a body 6 m above", topples, SPATIAL, invalid=True)


def _excitation_cases() -> Iterator[ExtremeCase]:
    harmonics = {
        "equal": scene(periods=(0.9, 0.9)),
        "1e-3 Hz": scene(periods=(1e3, 1.1e3), decay=(3e-4, 3e-4)),
        "1e3 Hz": scene(periods=(1e-3, 1.1e-3), duration=0.05),
        "1e-3 Hz and 1e3 Hz": scene(periods=(1e3, 1e-3), duration=0.05),
    }
    yield from _cases_of_group("harmonics", harmonics)
    yield from _cases_of_group("decay, 1/s", {decay: scene(decay=(decay, decay)) for decay in (0.0, 1e3, 1e6)})
    group = "duration, s"
    yield from _cases_of_group(group, {duration: scene(duration=duration) for duration in (1e-3, 0.1)})
    lasting = {duration: scene(duration=duration) for duration in (100.0, 1e4)}
    yield from _cases_of_group(group, lasting, PLANAR, phases=PHASES[:1], max_work=MUCH_WORK)
    group = "vertical loading, m/s^2"
    yield from _cases_of_group(group, {upward: scene(amplitudes=amplitudes_upward(upward)) for upward in (5.0, 9.8)})
    exactly = scene(amplitudes=amplitudes_upward(GRAVITY_LIMIT), decay=(0.0, 0.0), duration=1.0)
    weightless = (0.0, 1.1), (math.pi, 0.7)  # for one instant: whether the contact has opened then is a matter of words
    yield ExtremeCase(group, "-g exactly", exactly, PLANAR, phases=weightless, right=("contact lost",))
    # the spatial model goes on when a contact opens: it may have an answer, or none, but no refusal
    yield ExtremeCase(group, "-g exactly", exactly, ("spatial",), phases=weightless)
    yield from _cases_of_group(group, {upward: scene(amplitudes=amplitudes_upward(upward)) for upward in (15.0, 1e3)})
    yield ExtremeCase("phases", "at symmetric values", scene(duration=2.0), ALL, phases=SYMMETRIC)


def _direction_cases() -> Iterator[ExtremeCase]:
    lines = {
        "x alone": scene(amplitudes=[[2.0, 1.0], [0.0, 0.0]]),
        "y alone": scene(amplitudes=[[0.0, 0.0], [2.0, 1.0]]),
        "one oblique line (4.7)": scene(amplitudes=[[2.0, 1.0], [1.0, 0.5]], link=(1.5, 1.5)),
    }
    yield from _cases_of_group("direction", lines)
    planar = {
        f"x, and {across:g} m/s^2 across": scene(amplitudes=[[2.0, 1.0], [across, 0.0]])
        for across in (1e-3, 1e-6, 1e-9, 1e-12, 1e-15)
    }
    for still in (([2.0, 0.0], [0.0, 0.0]), ([0.0, 2.0], [0.0, 0.0])):
        planar[f"one harmonic alone, {still[0]}"] = scene(amplitudes=still)
    yield from _cases_of_group("direction", planar, PLANAR)


def _start_and_support_cases() -> Iterator[ExtremeCase]:
    limit = 0.1 * GRAVITY_LIMIT
    for name, phase in (("falling", 0.0), ("rising", -math.pi / 3.0), ("beyond at once", math.pi / 3.0)):
        amplitude = limit / math.cos(phase)
        alone = scene(amplitudes=[[amplitude, 0.0], [0.0, 0.0]], decay=(0.0, 0.0), masses=[1.0])
        yield ExtremeCase("start at the friction limit", name, alone, ALL, phases=((phase, 0.0),))
    three = {
        ring: scene(amplitudes=amplitudes_along(4.0), friction=0.05, supports=3, ring=ring) for ring in (1.0, 0.1, 0.01)
    }
    yield from _cases_of_group("three supports, ring in m", three, ("spatial",))


def _uneven_cases() -> Iterator[ExtremeCase]:
    """Uneven buildings: the equations and translation do not read what makes them so."""
    for share in (1e-6, 0.1, 0.45, 0.5, 1.0):  # shares of the ring, to a support: at 0.5 its opposite carries nothing
        moved, beyond = change_bodies(offset=[share * math.sqrt(0.5)] * 2), share >= 0.5
        work = MAX_WORK if beyond else 1e5
        yield ExtremeCase("offset over the ring", f"{share:g}", moved, SPATIAL, invalid=beyond, max_work=work)
    turned = {f"{yaw:.3g}": change_bodies(yaw=yaw) for yaw in (1e-6, 0.25 * math.pi)}
    yield from _cases_of_group("yaw, rad", turned, SPATIAL)
    positions = {
        "2 m by 0.02 m": [[1.0, 0.01], [-1.0, 0.01], [-1.0, -0.01], [1.0, -0.01]],
        "one 100 m away": [[-0.5, -0.5], [0.5, -0.5], [0.0, 100.0]],
        "9 in a grid": [[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)],
    }
    group = "positions of supports"
    held = {title: scene(ring=None, supports=places) for title, places in positions.items()}
    yield from _cases_of_group(group, held, SPATIAL, max_work=5e4)
    line = scene(ring=None, supports=[[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]])
    yield ExtremeCase(group, "on one line", line, SPATIAL, invalid=True)


def _tolerance_cases() -> Iterator[ExtremeCase]:
    for columns, tolerances in ((REFERENCE, (1e-1, 1e-2, 1e-4, 1e-8)), (("translational",), (1e-1, 1e-2, 1e-4, 1e-6))):
        for tolerance in tolerances:
            settings = {"tolerance": tolerance}
            yield ExtremeCase("relative error asked", f"{tolerance:g}", scene(), columns, settings=settings)


def _outside_the_rules() -> Iterator[ExtremeCase]:
    group = "outside the rules"
    wrong = {
        "friction -0.1": scene(friction=-0.1),
        "mass 0": scene(masses=[0.0, 1.0]),
        "duration 0": scene(duration=0.0),
        "travel beyond the radius": scene(radius=0.25, travel=0.3),
        "radius beyond double precision": scene(period=1e200),
        "amplitude not a number": scene(amplitudes=amplitudes_along(math.nan)),
    }
    yield from _cases_of_group(group, wrong, ("exact", "translational"), invalid=True)
    for speed in (0.0, -1.0, math.inf):
        yield ExtremeCase(
            group, f"v_reg {speed:g} m/s", scene(), WITH_V_REG, settings={"regularization": speed}, invalid=True
        )
    yield ExtremeCase(group, "no loading", scene(amplitudes=amplitudes_along(0.0)), PLANAR, right=("no ground motion",))
    overflow = scene(amplitudes=amplitudes_along(1e200))
    yield ExtremeCase(group, "loading 1e200 m/s^2", overflow, PLANAR, right=("non-finite load",))
