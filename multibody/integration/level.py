"""
Levels of accuracy: from one level to the next everything that the answer depends on becomes more accurate at once.

The step and the change of the slip velocity in one step fall by two. The compliance of the contact and the tolerance
of Newton's iteration fall by four. The contact follows a change of the force that it must carry within
sqrt(penetration) units of time. At a stop that force changes within the time in which regularized friction relaxes,
share * v_reg / f with the platform's share of the mass and the friction coefficient f. A slower contact would apply the
friction limit of an earlier instant. Then its error at the corner of the law is in proportion to x / (1 + x), where
x = sqrt(penetration) / relaxation: the response of a first-order lag to an exponential.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from multibody.defaults import DEFAULT_TOLERANCE, DEFAULT_V_REG
from multibody.integration.constant_step import silence_engine
from multibody.integration.time_scales import largest_step, list_brief_motions, shortest_period
from multibody.models.assembly import assemble
from multibody.models.supports import MIN_WARPING_COMPLIANCE
from multibody.models.system import EngineModel
from reference.problem import GRAVITY, Scene
from reference.problem.ranges import TOLERANCE_RANGE
from reference.problem.scene import require_scene
from reference.support.arguments import Range, check_number, quote

# Admissible numbers of a level that a caller states.
LEVEL_RANGE = Range(1e-100, 1e6)

# Largest number of levels of accuracy that a phase pair goes through.
MAX_LEVELS = 8

# Smallest tolerance at which a recorded loading has an extra coarse level before level 0 (docs/records/multibody.md).
MIN_LOOSE_TOLERANCE = 1e-2

# Relative error of a peak that accuracy level 0 typically has: a closer agreement of two levels counts as accidental.
ERROR_FLOOR_OF_LEVEL_0 = 8e-4

# Largest relative change of the slip velocity in one step at accuracy level 0: a step with a larger change is divided.
MAX_SLIP_CHANGE = 0.14

# Largest penetration of the contact under the weight at accuracy level 0, as a share of the pendulum radius rho.
MAX_PENETRATION = 1e-6

# Largest response time of the contact at accuracy level 0, over the relaxation time of friction: longer only where
# rounding needs a softer contact. At smaller ratios each level halves the contact's error (measured).
MAX_CONTACT_LAG = 0.3

# Largest response time of the contact at level 0, times the largest angular frequency of the motion. A slower contact
# would vibrate with stiff links on the slope of the sphere, and its damper would end this vibration at every level.
# Where bodies rotate, the moment of the links also presses the supports, so that the time is shorter.
MAX_CONTACT_RESPONSE_TIME = 0.25
MAX_CONTACT_RESPONSE_TIME_OF_ROCKING = 0.04  # response time * angular frequency at most, if bodies rotate

# Largest response time of the contact as a share of the duration, where the contact force changes: a slower contact has
# not followed the change when the motion ends, and a run on a softer contact would not show that error.
MAX_CONTACT_RESPONSE_TIME_OVER_DURATION = 0.05

# Largest ratio of the change of contact force, in weights, to the peak, in units of g, at which a contact may be too
# slow to follow: a vertical acceleration a_z that it misses would change a horizontal peak a to sqrt(a^2 + a_z^2) only.
MAX_NEGLIGIBLE_FORCE_CHANGE = 0.03

# Relative tolerance of the forces in Newton's iteration at level 0. No level has one below MIN_NEWTON_TOLERANCE,
# which is the rounding of the residuals.
NEWTON_TOLERANCE = 1e-5
MIN_NEWTON_TOLERANCE = 1e-12  # smallest relative tolerance of the forces in Newton's iteration at any level

# Factor on Newton's tolerance where friction yields: a wrong force of a spring at its limit makes a contact slip.
NEWTON_TOLERANCE_RATIO_OF_SPRINGS = 1e-3

# Largest squared step / penetration at which Newton's tolerance is not reduced: the tolerance is relative to the
# first residual of a step, which is the error of the predicted position times the contact stiffness.
MAX_SQUARED_STEP_OVER_PENETRATION = 1e3

# Largest share of the tolerance that rounding of the forces may take for a peak of at least MIN_PEAK.
MAX_ROUNDING_SHARE = 0.25
MIN_PEAK = 0.2  # in units of g; for a smaller peak acceleration rounding may exceed MAX_ROUNDING_SHARE of the tolerance

# Largest tolerance in the bound on the rounding error of contact forces: a looser one permits no larger error, since it
# may grow a hundredfold at a stop.
MAX_TOLERANCE_FOR_ROUNDING = 1e-3

# A loading below WEAK_LOADING, in units of g, hardly changes the contact force. Rounding is then compared with the
# loading, not with MIN_PEAK, and a contact may be so soft that the weight presses it in by MAX_WEAK_PENETRATION rho.
WEAK_LOADING = 1e-4
MAX_WEAK_PENETRATION = 4e-4  # largest penetration under the weight at a weak loading, as a share of rho

# Smallest peak, in units of g, by which the penetration is divided, so that it stays finite.
MIN_PEAK_AS_DIVISOR = 1e-300

# Displacement of a real bearing out of the plane of all (warping) under its share of the weight, over pendulum radius.
# Results hold for it if a support opens. Else it is up to COMPLIANCE_OF_CLOSED_SUPPORTS: warping carries little load.
PHYSICAL_WARPING_COMPLIANCE = 4e-4
COMPLIANCE_OF_CLOSED_SUPPORTS = 1e4  # largest compliance against warping if all supports are closed, in pendulum radii

# Ratio of the penetrations, and so of the contact compliances, of two successive levels.
COMPLIANCE_RATIO = 4.0

# Ratio of a scan's steps and of its Newton tolerance to those of its level; a scan looks ahead for large values.
SCAN_RATIO, SCAN_NEWTON_RATIO = 4.0, 10.0

# Ratio of successive step sizes: the largest step is divided by powers of it. A level allows at least MIN_DIVISIONS
# divisions, and as many as MIN_STEP_AT_STOP needs.
STEP_RATIO = 4
MIN_DIVISIONS = 7  # smallest number of divisions of the largest step by STEP_RATIO that a level allows
MIN_STEP_AT_STOP = 0.05  # smallest step at a stop, as a share of that allowed by the change of the slip velocity


@dataclass(frozen=True)
class Level:
    """
    Step, contact and tolerances of one level of accuracy, in units of total mass, pendulum radius rho, sqrt(rho / g).

    A level with another step or contact is made by `dataclasses.replace`.

    Attributes
    ----------
    step : float
        The largest step, in units of time.
    slip_change : float
        Largest relative change of the slip velocity in one step.
    penetration : float
        Penetration of the contact under the weight, in units of rho: the inverse of its stiffness.
    newton : float
        Relative tolerance of the forces in Newton's iteration.
    rounding_moment : float
        Rounding of a contact force times the penetration, in weights times rho.
    max_divisions : int
        Largest number of divisions of the largest step by `STEP_RATIO`.
    error_floor : float
        Relative error that the level typically has: closer agreement counts as accidental.
    warping_compliance : float
        Compliance of the supports against warping under the weight, in units of rho.
    decays : tuple of (float, float)
        For every brief motion that decays faster than the largest step resolves: its end, and the largest step before.
    strength : float
        Strength of a weak loading, in units of g; one for any other. The residual is compared with it.
    load : float
        The loading, in units of g; zero for bodies that turn on a sphere. What accelerates the bodies may be a small
        difference of it and of other forces, which Newton's iteration solves to its tolerance.
    flat : bool
        Whether the platform lies on a plane, where friction alone accelerates it.
    softest : float
        Largest penetration with which the contact follows a change of its force within the motion.
    force_change : float
        Bound of the change of the contact force within the motion, in weights.
    slide_end : float
        Slip speed at which a slide ends where friction yields, in units of velocity: in place of v_reg, which follows.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import multibody, reference
    >>> level = multibody.levels(reference.load_scene("fig3-I"))[1]
    >>> coarse = replace(level, step=4.0 * level.step)
    """

    step: float
    slip_change: float
    penetration: float
    newton: float
    rounding_moment: float
    max_divisions: int
    error_floor: float
    warping_compliance: float
    decays: tuple[tuple[float, float], ...] = ()
    strength: float = 1.0
    load: float = 0.0
    flat: bool = False
    softest: float = math.inf
    force_change: float = 0.0
    slide_end: float = 0.0

    @property
    def rounding(self) -> float:
        """Rounding error of a contact force, in weights."""
        return self.rounding_moment / self.penetration

    @property
    def residual(self) -> float:
        """Absolute tolerance of the residual in Newton's iteration, in weights."""
        return max(1e-3 * self.newton * self.strength, self.rounding)

    @property
    def precedes_level_0(self) -> bool:
        """True for the extra coarse level before level 0, which recorded loadings have at a loose tolerance."""
        return self.error_floor > ERROR_FLOOR_OF_LEVEL_0

    def coarsen(self) -> Level:
        """Return the level with the same contact and `SCAN_RATIO` times the step, to search later motion for peaks."""
        return replace(
            self,
            step=SCAN_RATIO * self.step,
            slip_change=SCAN_RATIO * self.slip_change,
            newton=SCAN_NEWTON_RATIO * self.newton,
            decays=tuple((until, SCAN_RATIO * step) for until, step in self.decays),
        )

    def min_divisions(self, time: float) -> int:
        """Return how often the largest step must be divided at `time` to resolve motions that soon decay."""
        if not self.decays:
            return 0
        allowed = min((step for until, step in self.decays if time < until), default=self.step)
        return min(math.ceil(math.log(self.step / allowed, STEP_RATIO) - 1e-9), self.max_divisions)


@require_scene
def levels(
    scene: Scene,
    model: str = "translational",
    tolerance: float = DEFAULT_TOLERANCE,
    regularization: float | None = DEFAULT_V_REG,
) -> list[Level]:
    """
    List the levels of accuracy that `amplification` goes through for a scene.

    Parameters
    ----------
    scene : Scene
    model : {"translational", "spatial"}
    tolerance : float
        Relative error asked of amplifications; 0.001 (`DEFAULT_TOLERANCE`) if not given. A looser one permits a softer
        contact at the first levels.
    regularization : float or None
        v_reg, m/s, as in `amplification`; 0.001 (`DEFAULT_V_REG`) if not given.

    Returns
    -------
    list of Level
        The coarsest first. The answer at a tolerance of 1e-3 usually is that of the second.

    Raises
    ------
    ValueError
        For wrong arguments, as in `amplification`.

    Examples
    --------
    >>> import multibody, reference
    >>> len(multibody.levels(reference.load_scene("fig3-I")))
    8
    """
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    with silence_engine():
        return plan_levels(scene, assemble(scene, model, regularization), tolerance)


def check_levels(levels: Any) -> list[Level]:
    """Return a caller's levels. Raises ValueError, one line, if they are none, or have numbers that no run can take."""
    given = levels if isinstance(levels, (list, tuple)) else []
    if not given or not all(isinstance(level, Level) for level in given):
        raise ValueError(f"levels = {quote(levels)}: must be levels of accuracy, as multibody.levels lists them")
    for level in given:
        for name in ("step", "slip_change", "penetration", "newton"):
            check_number(f"levels: {name}", getattr(level, name), LEVEL_RANGE)
    return [*given]


def plan_levels(scene: Scene, model: EngineModel, tolerance: float) -> list[Level]:
    """Return all levels of accuracy of a model for a relative error of `tolerance`."""
    # Step and change of the slip velocity follow from the level's number alone. The penetration falls by
    # COMPLIANCE_RATIO from level to level until it reaches its lower bound. Further levels share it, so that they do
    # not show the error of the contact's compliance, for which `refine` adds a run on a softer contact.
    period = shortest_period(scene, model)
    step = largest_step(period, model)
    # a platform that can rotate would tilt on soft contacts, so that its contact stays stiff under a weak loading
    strength = 1.0 if model.allows_liftoff else loading_strength(scene)
    followed = MAX_CONTACT_RESPONSE_TIME_OVER_DURATION * scene.duration / model.units.time
    force_change = bound_contact_force_change(scene, model)
    slowest = followed if force_change == math.inf else 1.0
    softest, stiffest = _bound_penetration(model, tolerance, strength, period, slowest)
    stiffenings = math.floor(math.log(softest / stiffest, COMPLIANCE_RATIO) + 1e-9)
    first = -1 if scene.recorded and tolerance >= MIN_LOOSE_TOLERANCE else 0
    numbers = range(first, first + MAX_LEVELS)
    penetrations = [softest / COMPLIANCE_RATIO ** min(level, stiffenings) for level in numbers]
    brief = list_brief_motions(scene, model, step)
    smallest = min([MIN_STEP_AT_STOP * MAX_SLIP_CHANGE * model.relaxation, *(needed for _, needed in brief)])
    max_divisions = MIN_DIVISIONS
    if smallest < step:
        max_divisions = max(MIN_DIVISIONS, math.ceil(math.log(step / smallest, STEP_RATIO)))
    precision, slide_end = 1.0, 0.0
    if model.springs is not None:
        precision, slide_end = NEWTON_TOLERANCE_RATIO_OF_SPRINGS, model.springs.slide_end
    return [
        Level(
            step=step / 2.0**level,
            slip_change=MAX_SLIP_CHANGE / 2.0**level,
            penetration=penetration,
            newton=precision * newton_tolerance(level, step / 2.0**level, penetration),
            rounding_moment=model.rounding,
            max_divisions=max_divisions,
            error_floor=ERROR_FLOOR_OF_LEVEL_0 / 4.0**level,
            warping_compliance=MIN_WARPING_COMPLIANCE,
            decays=tuple((until, needed / 2.0**level) for until, needed in brief),
            strength=strength,
            load=2.0 * scene.largest_acceleration / GRAVITY if scene.flat or not model.allows_liftoff else 0.0,
            flat=scene.flat,
            softest=followed**2,
            force_change=force_change,
            slide_end=slide_end / 2.0**level,
        )
        for level, penetration in zip(numbers, penetrations)
    ]


def _bound_penetration(
    model: EngineModel, tolerance: float, strength: float, period: float, slowest: float
) -> tuple[float, float]:
    """
    Return the penetrations under the weight, in units of length, of the softest and of the stiffest contact to be used.

    strength: as in `Level`. period: shortest period of the motion. slowest: longest response time of the contact, which
    is the square root of its penetration.
    """
    # A softer contact than the softest would lag behind friction at a stop, take part in the motion of stiff links, or
    # not settle under a force before the end. In a stiffer contact than the stiffest the rounding error of a position,
    # over the penetration, would be an error of the force above a share of the tolerance. Under a weak loading that
    # error is compared with the loading, and the contact may be softer.
    peak, most = (MIN_PEAK, MAX_PENETRATION) if strength == 1.0 else (strength, MAX_WEAK_PENETRATION)
    most = min(most, COMPLIANCE_RATIO * slowest**2)
    rounding = MAX_ROUNDING_SHARE * peak * min(tolerance, MAX_TOLERANCE_FOR_ROUNDING)
    stiffest = min(model.rounding / rounding, most / COMPLIANCE_RATIO)
    share = MAX_CONTACT_RESPONSE_TIME_OF_ROCKING if model.allows_liftoff else MAX_CONTACT_RESPONSE_TIME
    slowest = min(MAX_CONTACT_LAG * model.relaxation, share * period / (2.0 * math.pi), slowest)
    return max(min(slowest**2, MAX_PENETRATION), stiffest), stiffest


def newton_tolerance(number: int, step: float, penetration: float) -> float:
    """Return the relative tolerance of Newton's iteration at level `number`."""
    stiff = min(1.0, MAX_SQUARED_STEP_OVER_PENETRATION * penetration / step**2)
    return max(NEWTON_TOLERANCE / 4.0**number * stiff, MIN_NEWTON_TOLERANCE)


def soften_for_small_peaks(level: Level, smallest: float, tolerance: float) -> Level:
    """Return the level with a softer contact and a smaller residual if the `smallest` peak, in units of g, needs it."""
    if smallest >= WEAK_LOADING:
        return level
    wanted = level.rounding_moment / (MAX_ROUNDING_SHARE * tolerance * max(smallest, MIN_PEAK_AS_DIVISOR))
    follows = level.force_change > MAX_NEGLIGIBLE_FORCE_CHANGE * smallest
    softest = min(MAX_WEAK_PENETRATION / COMPLIANCE_RATIO, level.softest if follows else math.inf)
    penetration = max(level.penetration, min(wanted, softest))
    return replace(level, penetration=penetration, strength=min(level.strength, smallest))


def bound_contact_force_change(scene: Scene, model: EngineModel) -> float:
    """Return a bound, in weights, on the change of contact force in a motion from rest; inf with vertical loading."""
    if model.ground.accelerates(2):
        return math.inf
    # From rest no body is faster than `speed`, the largest acceleration of two harmonics along two axes times the
    # duration. On the sphere the contact force then changes by v^2, centripetal, and by at most v^2 / 2 on the slope.
    speed = 2.0 * math.sqrt(2.0) * scene.largest_acceleration / GRAVITY * scene.duration / model.units.time
    return 1.5 * speed**2


def loading_strength(scene: Scene) -> float:
    """Return the largest acceleration of a weak loading along any axis, in units of g; 1 for any other loading."""
    strength = scene.largest_acceleration / GRAVITY
    return strength if 0.0 < strength < WEAK_LOADING else 1.0
