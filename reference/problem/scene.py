"""The scene: the question asked of both sides, validated, in SI units."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from copy import deepcopy
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag, ValidationError, model_validator

from reference.problem.acceptance import Acceptance, DemandLimits, Limits
from reference.problem.analyses import Analyses
from reference.problem.bar_links import BarLink, bar_links, stands_upright
from reference.problem.beam_column import buckling_load
from reference.problem.chain_modes import solve_chain_modes
from reference.problem.changed_values import name_change, name_with_changes, put_value, value_at
from reference.problem.friction import DryFriction, Heating, VelocityFriction, law_of_friction
from reference.problem.keys import NONE, REQUIRED, Positive, Table, Text, key, range_of, require_exactly_one
from reference.problem.measured import Measured
from reference.problem.ranges import MAX_CYCLES
from reference.problem.supports import are_on_one_line, ring_positions, static_shares
from reference.problem.tables import LINKS, Bars, Body, Excitation, Isolator, Record, Superstructure, kind_of_excitation
from reference.problem.validation import EXCITATION_FORMS, FRICTION_FORMS, first_scene_error
from reference.records.loading import load_record_samples
from reference.records.samples import subtract_zero_line
from reference.support.arguments import Range, as_float, quote, require_type
from reference.support.constants import GRAVITY
from reference.support.html_table import html_table
from reference.support.scene_error import MisfitError, SceneError

MAX_BODIES = 10_000  # largest number of bodies in a scene
MIN_STATIC_SHARE = 1e-9  # load of a support at rest, as a fraction of the weight, below which it counts as none
MAX_SUPPORT_DEFLECTION = 0.1  # largest accepted deflection of supports under the weight, over the pendulum radius
DERIVED_ROUNDING = 1e-12  # relative rounding error that is allowed when a computed value is checked against its range


class Scene(Table):
    """
    Isolated structure and its ground motion, validated, in SI units; body index 0 is the platform, axis index 0 is x.

    Parameters
    ----------
    **tables
        The keys of a scene file (docs/scene.md) and `name`. `Scene.model_validate(dict)` takes the same as one dict.
        Arrays and tuples may stand for lists. A record may be given as arrays:
        ``"excitation": {"record": {"time": time, "acceleration": acceleration}}`` with `time` (K,), s, and
        `acceleration` (K,) along x, (K, 2) along x and y, or (K, 3), m/s^2.

    Raises
    ------
    pydantic.ValidationError
        For anything that a scene may not hold. `load_scene` and `with_values` raise `SceneError` in its place.

    Notes
    -----
    Scenes with equal values are equal and have equal hashes; they may be keys of a dict. A scene never changes:
    `with_values` makes another one.

    Examples
    --------
    >>> scene = Scene.model_validate({
    ...     "title": "one body",
    ...     "duration": 10.0,
    ...     "isolator": {"radius": 0.25, "friction": 0.1},
    ...     "bodies": [{"mass": 1.0}],
    ...     "excitation": {"amplitudes": [[1.0, 0.0], [0.0, 1.0]], "periods": [0.9, 1.1], "decay": [0.3, 0.3]},
    ... })
    >>> scene.total_mass
    1.0
    """

    title: Text = key("title of the scene in the report and in figures", models=NONE, default=REQUIRED)
    duration: Positive = key(
        "time from the start of the motion to its end; with a record, left out, that of the record",
        Range(1e-6, 1e9, "s"),
        default=REQUIRED,
    )
    isolator: Isolator
    bodies: Annotated[list[Body], Field(min_length=1, max_length=MAX_BODIES)]
    superstructure: Superstructure | None = None
    excitation: Annotated[
        Annotated[Excitation, Tag(EXCITATION_FORMS[0])] | Annotated[Record, Tag(EXCITATION_FORMS[1])],
        Discriminator(kind_of_excitation),
    ]
    acceptance: Acceptance = Acceptance()
    analyses: Analyses = Analyses()
    measured: Annotated[list[Measured], Field(min_length=1)] | None = None
    name: Text = "scene"  # file stem or built-in name; set by load_scene, no key of a scene file

    @model_validator(mode="before")
    @classmethod
    def _read_record(cls, data: Any) -> Any:
        """Read the samples of a record that is given by name or as arrays; `load_scene` has read those of its file."""
        table = data.get("excitation") if isinstance(data, dict) else None
        if not isinstance(table, dict) or "record" not in table or "samples" in table:
            return data
        try:
            return load_record_samples(data, "")
        except SceneError as error:
            raise MisfitError(error.key, error.value, error.rule) from None

    @model_validator(mode="after")
    def _check_all_tables(self) -> Scene:
        """Check the rules that concern several tables of the scene together."""
        self._check_links()
        self._check_bars()
        self._check_superstructure()
        self._check_derived()
        self._check_duration()
        self._check_isolator()
        self._check_supports()
        self._check_measured()
        self._check_upright()
        if not np.isfinite(self.record if isinstance(self.excitation, Record) else self.amplitudes).all():
            raise MisfitError("excitation.scale", self.excitation.scale, "must leave every acceleration finite")
        return self

    def _check_links(self) -> None:
        """Check that every body but the platform has one link to the body below."""
        platform, *others = self.bodies
        for name in (*LINKS, "damping"):
            if (value := getattr(platform, name)) is not None:
                raise MisfitError(f"bodies.0.{name}", value, "the platform has no link below: remove this key")
        for number, body in enumerate(others, start=1):
            try:
                require_exactly_one(body, *LINKS)
            except ValueError as error:
                raise MisfitError(f"bodies.{number}", body.model_dump(exclude_none=True), str(error)) from None

    def _check_bars(self) -> None:
        """Check that bars softened by the weight do not buckle under it."""
        for number, (body, load) in enumerate(zip(self.bodies[1:], self.loads_above), start=1):
            if body.bars is None or body.bars.load_effect is None:
                continue
            each, limit = load / body.bars.count, buckling_load(body.bars.bending_stiffness, body.bars.length)
            if not (each < limit and body.bars.factors(load).sway > 0.0):
                rule = (
                    f"must be below pi^2 E J / l^2 = {limit:.6g} N, at which clamped bars buckle sideways: "
                    "take more, stiffer or shorter bars"
                )
                raise MisfitError(f"bodies.{number}.bars: weight on each bar in N", each, rule)

    def _check_superstructure(self) -> None:
        """Check that the damping of the superstructure has links to act on, and that no body states its own damping."""
        ratio, (_, *others) = self._first_mode_ratio, self.bodies
        if ratio is None:
            return
        if not others:
            raise MisfitError("superstructure.damping", ratio, "no body stands on the platform: remove this key")
        for number, body in enumerate(others, start=1):
            if body.damping is not None:
                rule = f"superstructure.damping = {ratio:g} damps all links: remove one of the two keys"
                raise MisfitError(f"bodies.{number}.damping", body.damping, rule)

    def _check_derived(self) -> None:
        """Check that values computed from several keys are within their ranges."""
        for name, (value, span) in self._derive_values().items():
            lowest, highest = span.lowest * (1.0 - DERIVED_ROUNDING), span.highest * (1.0 + DERIVED_ROUNDING)
            if not (lowest <= value <= highest or value in span):
                raise MisfitError(name, value, span.rule)

    def _derive_values(self) -> dict[str, tuple[float, Range]]:
        """Return values computed from several keys: for each name, as an error shows it, the value and its range."""
        derived = {
            "isolator: radius in m": (self.radius, range_of(Isolator, "radius")),
            "bodies: total mass in kg": (self.total_mass, range_of(Body, "mass")),
        }
        law = self.dry_friction
        if law.exponent != 0.0:
            derived["isolator.friction: under the weight"] = law.slow, range_of(VelocityFriction, "slow")
        if law.elastic:
            for name, value in (("initial_stiffness", law.stiffness), ("yield_displacement", self.yield_displacement)):
                derived[f"isolator.friction: {name}"] = value, range_of(VelocityFriction, name)
        with np.errstate(over="ignore", divide="ignore"):
            periods = 2.0 * np.pi * np.sqrt(self.masses[1:, None] / self.stiffness)
        allowed = {name: range_of(Body, name) for name in ("stiffness", "period", "damping")}
        for (i, axis), k in np.ndenumerate(self.stiffness):
            link, along = f"bodies.{i + 1}: ", "xy"[axis]
            ratio = float(self.damping[i, axis] / (2.0 * np.sqrt(k * self.masses[i + 1])))
            derived[f"{link}k^{along} in N/m"] = float(k), allowed["stiffness"]
            derived[f"{link}period along {along} in s"] = float(periods[i, axis]), allowed["period"]
            derived[f"{link}damping ratio along {along}"] = ratio, allowed["damping"]
        return derived

    def _check_duration(self) -> None:
        """Check that the motion has no more periods than a run can follow."""
        shortest = 2.0 * math.pi * math.sqrt(self.radius / GRAVITY)
        if isinstance(self.excitation, Excitation):
            shortest = min(shortest, *self.excitation.periods)
        if self.duration > MAX_CYCLES * shortest:
            rule = f"must be at most {MAX_CYCLES:g} periods of {shortest:.4g} s, the shortest of loading and pendulum"
            raise MisfitError("duration", self.duration, rule)

    def _check_isolator(self) -> None:
        """Check that the travel and the deflection of the supports under the weight are small enough for the radius."""
        travel, bearings = self.isolator.travel, self.isolator.support_stiffness
        if travel is not None and not travel < self.radius:
            raise MisfitError("isolator.travel", travel, f"must be below the radius, rho = {self.radius:.6g} m")
        if bearings is not None:
            share = self.total_mass * GRAVITY / ((self.isolator.support_count or 1) * bearings * self.radius)
            if not share <= MAX_SUPPORT_DEFLECTION:
                limit = f"must be at most {MAX_SUPPORT_DEFLECTION:g}"
                rule = f"gives way by {share:.3g} of the radius under the weight: {limit}"
                raise MisfitError("isolator.support_stiffness", bearings, rule)

    def _check_supports(self) -> None:
        """Check that the supports span an area, and that each carries a part of the weight at rest."""
        supports, ring, places = self.isolator.supports, self.isolator.ring, self.support_places
        if isinstance(supports, list) and ring is not None:
            raise MisfitError("isolator.ring", ring, "supports at stated positions are on no ring: remove this key")
        if places is None or not (isinstance(supports, list) or self.offsets.any()):
            return
        if len(np.unique(places, axis=0)) < len(places):
            raise MisfitError("isolator.supports", supports, "two supports are at the same place: remove one of them")
        if are_on_one_line(places):
            raise MisfitError("isolator.supports", supports, "the supports are on one line: move one of them off it")
        shares = static_shares(places, self.center_of_mass)
        if not shares.min() > MIN_STATIC_SHARE:
            place = ", ".join(f"{along:.4g}" for along in places[shares.argmin()])
            rule = f"the support at [{place}] would carry nothing at rest: reduce the offsets or move the supports"
            raise MisfitError("bodies: center of mass of all [x, y] in m", self.center_of_mass.tolist(), rule)

    def _check_measured(self) -> None:
        """Check that each measured peak belongs to a body of the scene, and states phases if the scene has them."""
        phased = isinstance(self.excitation, Excitation)
        for number, peak in enumerate(self.measured or ()):
            if peak.body is not None and peak.body > len(self.bodies):
                rule = f"the scene has {len(self.bodies)} bodies, the platform is 1"
                raise MisfitError(f"measured.{number}.body", peak.body, rule)
            if phased == (peak.phases is None):
                rule = (
                    "give the phases of the test, [alpha1, alpha2]" if phased else "a record has no phases: remove it"
                )
                raise MisfitError(f"measured.{number}.phases", peak.phases, rule)

    def _check_upright(self) -> None:
        """Check that flexible bars hold the bodies upright."""
        giving = [n for n, body in enumerate(self.bodies) if body.bars is not None and body.bars.axial_stiffness]
        heights = [body.height for body in self.bodies if body.height is not None]
        if not giving or len(heights) < len(self.bodies):
            return
        if not stands_upright(self.bar_links, heights, self.loads_above, self.stiffness):
            stated = self.bodies[giving[0]].bars
            rule = "the bodies topple under their weight: take stiffer bars, a larger spread or lower bodies"
            raise MisfitError(f"bodies.{giving[0]}.bars", stated and stated.model_dump(exclude_none=True), rule)

    def __repr__(self) -> str:
        """Return name, bodies, mass, radius, kind of loading and duration in one line."""
        kind = "record" if isinstance(self.excitation, Record) else "two-frequency motion"
        bodies = f"{len(self.bodies)} bod{'y' if len(self.bodies) == 1 else 'ies'}, {self.total_mass:.4g} kg"
        return f"<Scene {self.name}: {bodies}, radius {self.radius:.4g} m, {kind}, {self.duration:g} s>"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """Return a table of masses, stiffness and damping for notebooks."""
        links = [*zip(self.stiffness, self.damping)]
        columns = [["", ""], *([", ".join(f"{value:.4g}" for value in pair) for pair in link] for link in links)]
        rows = [(n, f"{mass:.4g}", *cells) for n, (mass, cells) in enumerate(zip(self.masses, columns), 1)]
        heads = "body", "mass, kg", "stiffness of the link below, x, y, N/m", "its damping, x, y, N s/m"
        largest = f"{self.friction_coefficient:g}"
        law = f"lubrication {largest} s/m" if self.lubricated else f"friction coefficient at most {largest}"
        return html_table(f"{repr(self).strip('<>')}: {self.title}; {law}", heads, rows)

    def with_values(self, values: Mapping[str, Any]) -> Scene:
        """
        Return the scene with other values, validated like a scene file.

        Parameters
        ----------
        values : mapping of str to object
            New values by dotted key as in the scene file, ``"isolator.friction"`` or ``"bodies.1.height"`` (the first
            body is 0), or whole tables, ``"bodies"``. None leaves an optional key out. Without a ``"name"`` the name
            shows what is changed, ``fig3-I[friction=0.12]``, as in a family.
            ``"excitation.record"`` takes arrays, too, as in `Scene`, and files relative to the working directory; the
            duration stays.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            For an unknown key, with the nearest valid ones, and for every value that a scene file may not hold.

        Examples
        --------
        >>> scene = load_scene("fig3-I")
        >>> lubricated = {"isolator.friction": None, "isolator.lubrication": 0.5}
        >>> scene.with_values({**lubricated, "bodies.1.height": 0.4}).friction_coefficient
        0.5
        """
        if not isinstance(values, Mapping):
            rule = "must be a table of values by key, as {'isolator.friction': 0.1}"
            raise TypeError(f"values = {quote(values)}: {rule}")
        data = self.model_dump(exclude_none=True)
        changes = []
        for name, value in values.items():
            before = value_at(data, str(name))
            # a copy: another given key inside this table must not change the caller's table
            own = deepcopy(value) if isinstance(value, dict | list) else value
            put_value(self.name, data, str(name), own, KEYS)
            changes.append(name_change(str(name), before, own))
        if "name" not in values:
            data["name"] = name_with_changes(self.name, changes)
        try:
            return Scene.model_validate(data)
        except ValidationError as error:
            raise first_scene_error(self.name, error, KEYS) from None

    @property
    def radius(self) -> float:
        """Pendulum length rho = R - r, m: as stated, or g T_c^2 / (4 pi^2) for a period T_c; inf for a flat slider."""
        if self.isolator.radius is not None:
            return self.isolator.radius
        assert self.isolator.period is not None
        pace = self.isolator.period / (2.0 * math.pi)
        return GRAVITY * pace * pace  # a product overflows to inf, which validation refuses; pace**2 would raise

    @property
    def flat(self) -> bool:
        """True if the platform slides on a plane: a bearing without restoring force, rho = inf."""
        return math.isinf(self.radius)

    @property
    def displacement_limit(self) -> float:
        """Horizontal displacement of the platform at which a motion ends, m: the travel, or rho without a travel."""
        return self.radius if self.isolator.travel is None else self.isolator.travel

    @cached_property
    def masses(self) -> NDArray[np.float64]:
        """Masses m_i, (N,), kg."""
        return np.array([body.mass for body in self.bodies])

    @property
    def total_mass(self) -> float:
        """Total mass m_sum of (3.2), kg, which the contact carries."""
        return sum(self.masses.tolist())  # a sum of Python floats becomes inf without a warning where it overflows

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        """Stiffness k_{i+1,i} of the links along x and y, (N-1, 2), N/m; row i: link between bodies i and i + 1."""
        rows = [_link_stiffness(body, load) for body, load in zip(self.bodies[1:], self.loads_above)]
        return np.array(rows, dtype=float).reshape(-1, 2)

    @property
    def loads_above(self) -> list[float]:
        """Weight that each link carries at rest, (N-1,), N."""
        above = np.cumsum(self.masses[:0:-1])[::-1]
        return [GRAVITY * float(mass) for mass in above]

    @property
    def bar_links(self) -> list[BarLink | None]:
        """Stiffness of each link that is made of flexible bars, lowest link first; None for a link of another kind."""
        return bar_links(self.bodies, self.loads_above, self.support_radius)

    @cached_property
    def damping(self) -> NDArray[np.float64]:
        """Damping c_{i+1,i} of the links along x and y, (N-1, 2), N s/m; row i: link between bodies i and i + 1."""
        if (ratio := self._first_mode_ratio) is not None:
            # damping equal to beta times stiffness has the modal damping ratios beta omega / 2
            first = [solve_chain_modes(self.masses[1:], links, 1)[0][0] for links in self.stiffness.T]
            proportional: NDArray[np.float64] = 2.0 * ratio / np.array(first) * self.stiffness
            return proportional
        rows = [
            body.damping if isinstance(body.damping, list) else 2.0 * (body.damping or 0.0) * np.sqrt(link * body.mass)
            for body, link in zip(self.bodies[1:], self.stiffness)
        ]
        return np.array(rows, dtype=float).reshape(-1, 2)

    @property
    def _first_mode_ratio(self) -> float | None:
        """Damping ratio of the first fixed-base mode as the scene states it; None if it states none."""
        return None if self.superstructure is None else self.superstructure.damping

    @property
    def support_places(self) -> NDArray[np.float64] | None:
        """Horizontal coordinates of the supports, (K, 2), m, from the vertical axis of the links; None without any."""
        supports, ring = self.isolator.supports, self.isolator.ring
        if isinstance(supports, list):
            return np.array(supports)
        if supports is None or ring is None:
            return None
        return ring_positions(supports, ring)

    @property
    def support_radius(self) -> float | None:
        """Radius of the ring, or root mean square distance of the supports from the axis, m; None without any."""
        if isinstance(self.isolator.supports, list):
            return math.sqrt(np.square(self.isolator.supports).sum(axis=1).mean())
        return None if self.isolator.supports is None else self.isolator.ring

    @cached_property
    def offsets(self) -> NDArray[np.float64]:
        """Horizontal coordinates of the bodies' centers of mass from the vertical axis of the links, (N, 2), m."""
        return np.array([body.offset or (0.0, 0.0) for body in self.bodies], dtype=float)

    @cached_property
    def yaws(self) -> NDArray[np.float64]:
        """Yaw angles of the bodies, which are boxes, and of the links below them, (N,), rad."""
        return np.array([body.yaw or 0.0 for body in self.bodies])

    @property
    def center_of_mass(self) -> NDArray[np.float64]:
        """Horizontal coordinates of the common center of mass from the vertical axis of the links, (2,), m."""
        place: NDArray[np.float64] = self.masses / self.total_mass @ self.offsets
        return place

    @property
    def lubricated(self) -> bool:
        """True if the friction coefficient is f_c times the slip speed (3.14), False for dry friction."""
        return self.isolator.lubrication is not None

    @property
    def friction_coefficient(self) -> float:
        """
        Dry friction coefficient mu under the weight, at the speed where it is largest; if lubricated, f_c in s/m.
        """
        if self.isolator.lubrication is not None:
            return self.isolator.lubrication
        return self.dry_friction.largest

    @cached_property
    def dry_friction(self) -> DryFriction:
        """Law of the dry friction coefficient over slip speed and load; its coefficient is 0 in a lubricated scene."""
        sliders = 1 if self.support_places is None else len(self.support_places)
        return law_of_friction(self.isolator.friction, self.total_mass * GRAVITY, sliders)

    @property
    def yield_displacement(self) -> float:
        """Elastic displacement after which friction slides under the weight, m; 0 for rigid friction."""
        return self.friction_coefficient * self.total_mass * GRAVITY / self.dry_friction.stiffness

    def require_rigid_friction(self, user: str) -> None:
        """Raise SceneError if friction is elastic before it slides; user: part of the program that needs it rigid."""
        table = self.isolator.friction
        if isinstance(table, VelocityFriction) and self.dry_friction.elastic:
            name = "initial_stiffness" if table.yield_displacement is None else "yield_displacement"
            rule = f"{user} has friction that is rigid before it slides: remove this key"
            raise SceneError(self.name, f"isolator.friction.{name}", getattr(table, name), rule)

    def with_yield_displacement(self, way: float) -> Scene:
        """Return the scene, under the same name, with friction that is elastic up to a displacement `way`, m."""
        friction = self.isolator.friction
        if not isinstance(friction, VelocityFriction) or (way == 0.0 and not self.dry_friction.elastic):
            return self if way == 0.0 else self._with_friction({"slow": friction, "yield_displacement": way})
        stated = friction.model_dump(exclude_none=True, exclude={"initial_stiffness", "yield_displacement"})
        if way > 0.0:
            return self._with_friction({**stated, "yield_displacement": way})
        return self._with_friction(stated if len(stated) > 1 else friction.slow)

    def _with_friction(self, friction: object) -> Scene:
        """Return the scene with another friction, under the same name."""
        return self.with_values({"isolator.friction": friction, "name": self.name})

    @property
    def has_dry_friction(self) -> bool:
        """True for dry friction, not zero, that is rigid before it slides: only this can bring a motion to rest."""
        return not self.lubricated and self.friction_coefficient != 0.0 and not self.dry_friction.elastic

    @property
    def recorded(self) -> bool:
        """True if a recorded motion takes the place of the two frequencies, so that there are no phases."""
        return isinstance(self.excitation, Record)

    @cached_property
    def amplitudes(self) -> NDArray[np.float64]:
        """
        Amplitude matrix a_ki of (5.4), scaled, (3, 2), m/s^2, rows x, y, z; zero vertical row if none is given.

        Raises ValueError for a record, which has none: to call its loading zero would be a wrong answer.
        """
        if not isinstance(self.excitation, Excitation):
            raise ValueError(f"{self.name}: a recorded motion has no amplitudes, periods, decay or phases")
        matrix = np.zeros((3, 2))
        matrix[: len(self.excitation.amplitudes)] = self.excitation.amplitudes
        with np.errstate(over="ignore"):  # validation refuses infinite amplitudes
            return matrix * (1.0 if self.excitation.scale is None else self.excitation.scale)

    @cached_property
    def record(self) -> NDArray[np.float64]:
        """
        Samples of a record with its scale and zero line, (K, 4); (0, 4) if there is no record.

        Columns are time from 0 on, s, and accelerations along x, y and z, m/s^2. If the last sample is not zero, a zero
        sample follows it after one more step.
        """
        if not isinstance(self.excitation, Record):
            return np.zeros((0, 4))
        knots = np.array(self.excitation.samples)
        if self.excitation.detrend is not None:
            subtract_zero_line(knots, self.excitation.detrend)
        with np.errstate(over="ignore"):  # validation refuses infinite accelerations
            knots[:, 1:] *= self.excitation.scale
        if knots[-1, 1:].any():
            knots = np.vstack([knots, [2.0 * knots[-1, 0] - knots[-2, 0], 0.0, 0.0, 0.0]])
        return knots

    @property
    def largest_acceleration(self) -> float:
        """Largest entry of the amplitude matrix, or largest sample of a record along any axis, m/s^2."""
        return float(np.abs(self.record[:, 1:] if self.recorded else self.amplitudes).max())

    def with_amplitude(self, amplitude: float) -> Scene:
        """
        Return the scene with its loading scaled to an amplitude, m/s^2.

        Parameters
        ----------
        amplitude : float, m/s^2
            The largest entry of the amplitude matrix, or the largest sample of a record along any axis, becomes this.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            For an amplitude outside its range, or a loading that is zero throughout.
        """
        values = self.loading_values(amplitude)
        return self.with_values(
            {**values, "name": name_with_changes(self.name, [f"amplitude={as_float(amplitude):.12g}"])}
        )

    def loading_values(self, amplitude: float) -> dict[str, Any]:
        """
        Return the values for `with_values` that scale the loading to an amplitude, m/s^2. Raises as `with_amplitude`.
        """
        largest, stated = self.largest_acceleration, amplitude
        amplitude = as_float(stated)
        if not 0.0 < amplitude <= range_of(Excitation, "amplitudes").highest:
            raise SceneError(self.name, "amplitude", stated, "must be finite and greater than 0 m/s^2")
        if largest == 0.0:
            key = "record" if self.recorded else "amplitudes"
            raise SceneError(self.name, f"excitation.{key}", 0.0, "all entries are 0: nothing to scale")
        if self.excitation.scale is not None:
            return {"excitation.scale": self.excitation.scale * (amplitude / largest)}
        return {"excitation.amplitudes": (self.amplitudes / largest) * amplitude}

    @property
    def has_unloaded_bars(self) -> bool:
        """True if a link is stated by bars, and the scene neglects that the weight above softens them."""
        return any(body.bars is not None and body.bars.load_effect is None for body in self.bodies)

    def softened(self) -> Scene:
        """
        Return the scene with every link of bars softened by the weight that it carries.

        `stiffness` and `period` state a link under load: such links stay.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            If bars buckle under the weight.

        Examples
        --------
        >>> bars = {"count": 4, "bending_stiffness": 2.0, "length": 1.0}
        >>> scene = load_scene("fig3-I").with_values({"bodies.1.period": None, "bodies.1.bars": bars})
        >>> scene.stiffness[0].tolist(), scene.softened().stiffness[0].round(2).tolist()
        ([96.0, 96.0], [84.21, 84.21])
        """
        unloaded = [n for n, body in enumerate(self.bodies) if body.bars is not None and body.bars.load_effect is None]
        values = {f"bodies.{number}.bars.load_effect": "softening" for number in unloaded}
        return self.with_values({**values, "name": name_with_changes(self.name, ["softened"] * bool(unloaded))})

    def digest(self) -> str:
        """Return the hash of everything that affects a result, for stored results and for provenance."""
        return self._digest

    @cached_property
    def _digest(self) -> str:
        """Sixteen hexadecimal digits that change with every key of the scene on which results depend."""
        content = self.model_dump_json(
            exclude=dict.fromkeys(("title", "name", "acceptance", "analyses", "measured"), True)
            | {"excitation": {"record": True, "origin": True}, "bodies": {"__all__": {"floor": True}}},
            exclude_none=True,  # a key that is not given changes no result
        )
        return hashlib.sha256(content.encode()).hexdigest()[:16]


# Decorator of functions of a Scene: TypeError if the first argument is anything else
require_scene = require_type(Scene, 'must be a Scene, as reference.load_scene("fig3-I") returns')
"""Decorator of functions whose first argument is a scene."""


def _link_stiffness(body: Body, load: float) -> list[float]:
    """Return the stiffness in x and y, N/m, of the link below a body that carries `load`, N."""
    if body.stiffness is not None:
        return body.stiffness
    if body.bars is not None:
        return [body.bars.stiffness * body.bars.factors(load).sway] * 2
    return [body.mass * (2.0 * math.pi / period) * (2.0 * math.pi / period) for period in body.period or ()]


KEYS: dict[str, tuple[str, ...]] = {  # valid keys of a scene, by dotted name of their table
    "": tuple(Scene.model_fields),
    "isolator": tuple(Isolator.model_fields),
    "isolator.friction": tuple(VelocityFriction.model_fields),
    f"isolator.friction.{FRICTION_FORMS[1]}": tuple(VelocityFriction.model_fields),
    "isolator.friction.heating": tuple(Heating.model_fields),
    f"isolator.friction.{FRICTION_FORMS[1]}.heating": tuple(Heating.model_fields),
    "bodies": tuple(Body.model_fields),
    "bodies.bars": tuple(Bars.model_fields),
    "superstructure": tuple(Superstructure.model_fields),
    "acceptance": tuple(Acceptance.model_fields),
    "analyses": tuple(Analyses.model_fields),
    "measured": tuple(Measured.model_fields),
    "acceptance.demands": tuple(DemandLimits.model_fields),
    **{f"acceptance.{pair}": tuple(Limits.model_fields) for pair in ("like_for_like", "total", "translational", "*")},
    "excitation": (*Excitation.model_fields, "record", "detrend"),
    f"excitation.{EXCITATION_FORMS[0]}": tuple(Excitation.model_fields),
    f"excitation.{EXCITATION_FORMS[1]}": ("record", "scale", "detrend"),
}
"""Keys of every table by its name, with the kind of the excitation where that is known."""
