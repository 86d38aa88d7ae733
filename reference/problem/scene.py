"""The scene: the question asked of both sides, read from TOML, validated, in SI units."""

from __future__ import annotations

import hashlib
import math
import tomllib
import unicodedata
from collections.abc import Mapping
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, Tag, ValidationError, model_validator

from reference.problem.ranges import MAX_CYCLES, SCENE
from reference.problem.record_files import GRAVITY as GRAVITY
from reference.problem.recorded import EXAMPLES, with_samples
from reference.problem.scene_error import EXCITATIONS, MisfitError, SceneError, first_error, unknown_key

MAX_BODIES = 10_000
MAX_SUPPORT_DEFLECTION = 0.1  # of the radius: what supports may give way by under the weight
DERIVED_ROUNDING = 1e-12  # relative, of a value that follows from others
MAX_NESTING = 10  # tables and lists within one another in a scene file
USE_WITH_VALUES = "values are not validated by model_copy: use Scene.with_values({'isolator.friction': 0.1})"


def within(key: str) -> AfterValidator:
    """The rule that a number lies within the range of `key` in `ranges.SCENE`."""
    allowed = SCENE[key]

    def check(value: float) -> float:
        if value not in allowed:
            raise ValueError(allowed.rule)
        return value

    return AfterValidator(check)


def _without_control_characters(text: str) -> str:
    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in text):
        raise ValueError("must have no control characters")
    return text


Text = Annotated[str, AfterValidator(_without_control_characters)]
Positive = Annotated[float, Field(gt=0.0)]
NonNegative = Annotated[float, Field(ge=0.0)]
LinkPeriods = Annotated[list[Annotated[Positive, within("bodies.period")]], Field(min_length=2, max_length=2)]
LinkStiffness = Annotated[list[Annotated[Positive, within("bodies.stiffness")]], Field(min_length=2, max_length=2)]
Size = Annotated[list[Annotated[Positive, within("bodies.size")]], Field(min_length=3, max_length=3)]
Row = Annotated[list[Annotated[float, within("excitation.amplitudes")]], Field(min_length=2, max_length=2)]
Periods = Annotated[list[Annotated[Positive, within("excitation.periods")]], Field(min_length=2, max_length=2)]
Decay = Annotated[list[Annotated[NonNegative, within("excitation.decay")]], Field(min_length=2, max_length=2)]


class Table(BaseModel):
    """One table of the file: unknown keys, wrong types and numbers outside their range are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy without changes. Raises ValueError with `update`, which pydantic would not validate."""
        if update:
            raise ValueError(USE_WITH_VALUES)
        return super().model_copy(deep=deep)


def exactly_one(table: BaseModel, first: str, second: str) -> None:
    present = [key for key in (first, second) if getattr(table, key) is not None]
    if len(present) != 1:
        raise ValueError(f"give exactly one of {first} and {second}, not {len(present)} of them")


class Isolator(Table):
    """Spherical gravity-friction isolator. Exactly one of period and radius, one of friction and lubrication."""

    period: Annotated[Positive, within("isolator.period")] | None = None  # s, of one mass alone on the isolator, T_c
    radius: Annotated[Positive, within("isolator.radius")] | None = None  # m, rho = R - r
    friction: Annotated[NonNegative, within("isolator.friction")] | None = None  # dry friction coefficient, mu of (2.5)
    lubrication: Annotated[NonNegative, within("isolator.lubrication")] | None = None  # s/m, f_c of (3.14)
    supports: Annotated[int, Field(ge=3, le=int(SCENE["isolator.supports"].highest))] | None = None  # K, spatial model
    ring: Annotated[Positive, within("isolator.ring")] | None = None  # m, circle of supports, spatial model
    sphere_radius: Annotated[Positive, within("isolator.sphere_radius")] | None = None  # m, r
    support_stiffness: Annotated[Positive, within("isolator.support_stiffness")] | None = None  # N/m, vertical, each

    @model_validator(mode="after")
    def _alternatives(self) -> Isolator:
        exactly_one(self, "period", "radius")
        exactly_one(self, "friction", "lubrication")
        return self


class Body(Table):
    """One rigid body; the first is the platform, every other one is linked to the body before it."""

    mass: Annotated[Positive, within("bodies.mass")]  # kg
    period: LinkPeriods | None = None  # s, 2 pi sqrt(m / k) in x and y, of the link to the body below
    stiffness: LinkStiffness | None = None  # N/m, k^x and k^y of that link
    height: Annotated[NonNegative, within("bodies.height")] | None = None  # m above the depression centers, spatial
    size: Size | None = None  # m, box


class Excitation(Table):
    """Two-frequency damped ground acceleration (5.2)-(5.4): rows x, y and optionally z, columns the harmonics."""

    amplitudes: Annotated[list[Row], Field(min_length=2, max_length=3)]  # m/s^2, a_ki
    periods: Periods  # s, T_i of the harmonics
    decay: Decay  # 1/s, lambda_i


class Record(Table):
    """Recorded ground acceleration in place of the two frequencies: its files, and the samples read from them."""

    record: Text | dict[str, Text]  # a CSV file, or .AT2 files by direction, as written in the scene
    scale: Positive = 1.0  # factor of every acceleration
    samples: list[Annotated[list[float], Field(min_length=4, max_length=4)]]  # s and m/s^2 along x, y, z, unscaled

    @property
    def files(self) -> str:
        """The files as they are called in texts."""
        named = self.record.values() if isinstance(self.record, dict) else [self.record]
        return ", ".join(Path(name).name for name in named)


def _kind(excitation: Any) -> str:
    """Which of the two an excitation is meant to be."""
    recorded = "record" in excitation if isinstance(excitation, dict) else isinstance(excitation, Record)
    return EXCITATIONS[int(recorded)]


class Limits(Table):
    """Limits of the relative difference of two models over the phases, for every body."""

    median: Positive | None = None  # of mu_i
    maximum: Positive | None = None  # of mu_i
    ratio: Positive | None = None  # largest difference in units of the two error estimates together

    def stated(self) -> dict[str, float]:
        """The limits that are present, by key."""
        limits = {"median": self.median, "maximum": self.maximum, "ratio": self.ratio}
        return {key: limit for key, limit in limits.items() if limit is not None}


class Acceptance(Limits):
    """Limits for `--check`. The keys of `Limits` given here are those of `like_for_like`."""

    total: Limits | None = None  # the paper's printed equations against the most complete model
    translational: Limits | None = None  # the same against the engine in which no body turns
    like_for_like: Limits | None = None  # exact equations against that engine, same friction law
    closure: Positive | None = None  # largest |sum of the steps of the models - total| relative to mu_i, per body
    failed: Annotated[int, Field(ge=0)] | None = None  # points without an answer, of all models; 0 beside other limits

    @model_validator(mode="after")
    def _once(self) -> Acceptance:
        if twice := sorted(self.stated().keys() & (self.like_for_like or Limits()).stated().keys()):
            raise ValueError(f"give {twice[0]} here or in like_for_like, which mean the same, not in both")
        return self

    def differences(self) -> list[tuple[str, str, str, float]]:
        """Key as written, pair of models, measure and limit of every difference that is limited."""
        tables = (
            ("", "like-for-like", self),
            ("like_for_like.", "like-for-like", self.like_for_like),
            ("translational.", "translational", self.translational),
            ("total.", "total", self.total),
        )
        return [
            (f"{start}{key}", pair, key, limit)
            for start, pair, limits in tables
            if limits is not None
            for key, limit in limits.stated().items()
        ]

    @property
    def failures(self) -> int | None:
        """Points without an answer that are allowed: none where only other limits are given; None without any limit."""
        return 0 if self.failed is None and (self.differences() or self.closure is not None) else self.failed


class Scene(Table):
    """A validated scene. Arrays are SI; body index 0 is the platform, axis index 0 is x."""

    title: Text
    duration: Annotated[Positive, within("duration")]  # s
    isolator: Isolator
    bodies: Annotated[list[Body], Field(min_length=1, max_length=MAX_BODIES)]
    excitation: Annotated[
        Annotated[Excitation, Tag(EXCITATIONS[0])] | Annotated[Record, Tag(EXCITATIONS[1])], Discriminator(_kind)
    ]
    acceptance: Acceptance = Acceptance()
    name: Text = "scene"  # file stem or built-in name; set by load_scene

    @model_validator(mode="after")
    def _links(self) -> Scene:
        platform, *others = self.bodies
        for key in ("period", "stiffness"):
            if (value := getattr(platform, key)) is not None:
                raise MisfitError(f"bodies.0.{key}", value, "the platform has no link below: remove this key")
        for number, body in enumerate(others, start=1):
            try:
                exactly_one(body, "period", "stiffness")
            except ValueError as error:
                raise MisfitError(f"bodies.{number}", body.model_dump(exclude_none=True), str(error)) from None
        self._check_derived()
        if isinstance(self.excitation, Record) and not np.isfinite(self.record).all():
            raise MisfitError("excitation.scale", self.excitation.scale, "must leave every sample finite")
        return self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.model_dump() == other.model_dump()

    def _check_derived(self) -> None:
        """What follows from several values must be within its range as well."""
        derived = {
            "isolator: radius in m": (self.radius, SCENE["isolator.radius"]),
            "bodies: total mass in kg": (self.total_mass, SCENE["bodies.mass"]),
        }
        with np.errstate(over="ignore", divide="ignore"):
            periods = 2.0 * np.pi * np.sqrt(self.masses[1:, None] / self.stiffness)
        for (i, axis), k in np.ndenumerate(self.stiffness):
            derived[f"bodies.{i + 1}: k^{'xy'[axis]} in N/m"] = float(k), SCENE["bodies.stiffness"]
            derived[f"bodies.{i + 1}: period along {'xy'[axis]} in s"] = float(periods[i, axis]), SCENE["bodies.period"]
        for key, (value, allowed) in derived.items():
            if not allowed.lowest * (1.0 - DERIVED_ROUNDING) <= value <= allowed.highest * (1.0 + DERIVED_ROUNDING):
                raise MisfitError(key, value, allowed.rule)
        shortest = 2.0 * math.pi * math.sqrt(self.radius / GRAVITY)
        if isinstance(self.excitation, Excitation):
            shortest = min(shortest, *self.excitation.periods)
        if self.duration > MAX_CYCLES * shortest:
            rule = f"must be at most {MAX_CYCLES:g} periods of {shortest:.4g} s, the shortest of loading and pendulum"
            raise MisfitError("duration", self.duration, rule)

        bearings = self.isolator.support_stiffness
        if bearings is not None:
            share = self.total_mass * GRAVITY / ((self.isolator.supports or 1) * bearings * self.radius)
            if not share <= MAX_SUPPORT_DEFLECTION:
                limit = f"must be at most {MAX_SUPPORT_DEFLECTION:g}"
                rule = f"gives way by {share:.3g} of the radius under the weight: {limit}"
                raise MisfitError("isolator.support_stiffness", bearings, rule)

    def with_values(self, values: Mapping[str, Any]) -> Scene:
        """
        The same scene with other values, validated like a scene file.

        Parameters
        ----------
        values : mapping of str to object
            New values by dotted key as in the scene file, ``"isolator.friction"`` or ``"bodies.1.height"`` (the first
            body is 0), or whole tables, ``"bodies"``. None leaves an optional key out. ``"name"`` may be given, too.

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
        data = self.model_dump(exclude_none=True)
        for key, value in values.items():
            _put(self.name, data, str(key), value)
        try:
            return Scene.model_validate(data)
        except ValidationError as error:
            raise first_error(self.name, error, KEYS) from None

    @property
    def radius(self) -> float:
        """rho = R - r in m; from the period of one mass alone, rho = g T_c^2 / (4 pi^2) (section 5)."""
        if self.isolator.radius is not None:
            return self.isolator.radius
        assert self.isolator.period is not None
        pace = self.isolator.period / (2.0 * math.pi)
        return GRAVITY * pace * pace  # a product overflows to inf, which validation refuses; a power raises

    @cached_property
    def masses(self) -> NDArray[np.float64]:
        """Masses m_i, (N,), kg."""
        return np.array([body.mass for body in self.bodies])

    @property
    def total_mass(self) -> float:
        """m_sum of (3.2), kg: the contact carries every body."""
        return sum(self.masses.tolist())  # inf without a warning where it overflows

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        """Link stiffness k_{i+1,i} in x and y, (N-1, 2), N/m; row i links body i and body i + 1."""
        rows = [
            body.stiffness
            if body.stiffness is not None
            else [body.mass * (2.0 * math.pi / period) * (2.0 * math.pi / period) for period in body.period or ()]
            for body in self.bodies[1:]
        ]
        return np.array(rows, dtype=float).reshape(-1, 2)

    @property
    def lubricated(self) -> bool:
        """True for mu = f_c |v| (3.14), False for dry friction."""
        return self.isolator.lubrication is not None

    @property
    def friction_coefficient(self) -> float:
        """Dry friction coefficient mu, or f_c in s/m when the contact is lubricated."""
        value = self.isolator.lubrication if self.lubricated else self.isolator.friction
        assert value is not None
        return value

    @property
    def recorded(self) -> bool:
        """Whether a recorded motion takes the place of the two frequencies: then there are no phases."""
        return isinstance(self.excitation, Record)

    @cached_property
    def amplitudes(self) -> NDArray[np.float64]:
        """
        Amplitude matrix a_ki of (5.4), (3, 2), m/s^2, rows x, y, z; zero vertical row if none is given.

        Raises ValueError for a record, which has none: to call its loading zero would be a wrong answer.
        """
        if not isinstance(self.excitation, Excitation):
            raise ValueError(f"{self.name}: a recorded motion has no amplitudes, periods, decay or phases")
        matrix = np.zeros((3, 2))
        matrix[: len(self.excitation.amplitudes)] = self.excitation.amplitudes
        return matrix

    @cached_property
    def record(self) -> NDArray[np.float64]:
        """
        Knots of a recorded motion, (K, 4): s from 0 on, and xi'', eta'', zeta'', m/s^2, scaled; (0, 4) without one.

        A last sample that is not zero is followed by a knot at zero, as far behind it as the sample before.
        """
        if not isinstance(self.excitation, Record):
            return np.zeros((0, 4))
        knots = np.array(self.excitation.samples)
        with np.errstate(over="ignore"):  # refused by validation
            knots[:, 1:] *= self.excitation.scale
        if knots[-1, 1:].any():
            knots = np.vstack([knots, [2.0 * knots[-1, 0] - knots[-2, 0], 0.0, 0.0, 0.0]])
        return knots

    def with_amplitude(self, amplitude: float) -> Scene:
        """
        The same scene, its loading scaled so that the largest entry of the amplitude matrix, or the largest sample of a
        record along any axis, is `amplitude`, m/s^2.
        """
        samples = self.record[:, 1:] if self.recorded else self.amplitudes
        largest = float(np.abs(samples).max())
        if not (isinstance(amplitude, int | float) and 0.0 < amplitude <= SCENE["excitation.amplitudes"].highest):
            raise SceneError(self.name, "amplitude", amplitude, "must be finite and greater than 0 m/s^2")
        if largest == 0.0:
            key = "record" if self.recorded else "amplitudes"
            raise SceneError(self.name, f"excitation.{key}", 0.0, "all entries are 0: nothing to scale")
        if isinstance(self.excitation, Record):
            return self.with_values({"excitation.scale": self.excitation.scale * (amplitude / largest)})
        return self.with_values({"excitation.amplitudes": (self.amplitudes / largest) * amplitude})

    def digest(self) -> str:
        """Hash of everything that enters a result, for stores of results and for provenance."""
        content = self.model_dump_json(
            exclude={"title": True, "name": True, "acceptance": True, "excitation": {"record": True}},
            exclude_none=True,  # a key that is not given changes no result
        )
        return hashlib.sha256(content.encode()).hexdigest()[:16]


KEYS: dict[str, tuple[str, ...]] = {
    "": tuple(Scene.model_fields),
    "isolator": tuple(Isolator.model_fields),
    "bodies": tuple(Body.model_fields),
    "acceptance": tuple(Acceptance.model_fields),
    **{f"acceptance.{pair}": tuple(Limits.model_fields) for pair in ("like_for_like", "total", "translational")},
    "excitation": (*Excitation.model_fields, "record", "scale"),
    f"excitation.{EXCITATIONS[0]}": tuple(Excitation.model_fields),
    f"excitation.{EXCITATIONS[1]}": ("record", "scale"),
}
"""Keys of every table by its name, with the kind of the excitation where that is known."""


def _put(scene: str, data: dict[str, Any], key: str, value: Any) -> None:
    """Set one value by its dotted key in the tables of a scene, or leave the key out. Raises SceneError."""
    parts = key.split(".")
    if key == "excitation.record":
        raise SceneError(scene, key, value, "the files of a record are read by load_scene: write a scene file")
    place: Any = data
    for depth, part in enumerate(parts):
        last = depth == len(parts) - 1
        if isinstance(place, list):
            if not (part.isascii() and part.isdecimal() and len(part) < 9 and int(part) < len(place)):
                rule = f"{'.'.join(parts[:depth])} has the indices 0 to {len(place) - 1}"
                raise SceneError(scene, key, value, rule)
            index: Any = int(part)
        else:
            table = ".".join(name for name in parts[:depth] if not name.isdecimal())
            if not (isinstance(place, dict) and part in KEYS.get(table, ()) and (last or part in place)):
                raise unknown_key(scene, ".".join(parts[: depth + 1]), value, KEYS.get(table, ()))
            index = part
        if not last:
            place = place[index]
        elif value is not None:
            place[index] = value.tolist() if isinstance(value, np.ndarray | np.generic) else value
        elif isinstance(place, dict):
            place.pop(index, None)
        else:
            raise SceneError(scene, key, value, "must be a number")


def builtin_scenes() -> list[str]:
    """Names of the paper's own cases, in the order of its figures."""
    folder = resources.files("reference.problem") / "scenes"
    return sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml"))


def example_scenes() -> list[str]:
    """Names of the scenes with a recorded motion that are shipped as examples."""
    return sorted(entry.name.removesuffix(".toml") for entry in EXAMPLES.iterdir() if entry.name.endswith(".toml"))


def load_scene(source: str | Path, amplitude: float | None = None) -> Scene:
    """
    Read a scene: a built-in name (`builtin_scenes()`, `example_scenes()`) or a path to a TOML file.

    `amplitude`, m/s^2, scales the amplitude matrix, or the record, so that its largest entry has this value.
    Raises SceneError (file, key, value, rule) when anything in it is wrong.
    """
    scene = parse_scene(scene_text(source), str(source))
    return scene if amplitude is None else scene.with_amplitude(amplitude)


def scene_text(source: str | Path) -> bytes:
    """What is written in a built-in scene or a file. Raises SceneError if there is none."""
    label = str(source)
    if label in example_scenes():
        return (EXAMPLES / f"{label}.toml").read_bytes()
    if label in builtin_scenes():
        return (resources.files("reference.problem") / "scenes" / f"{label}.toml").read_bytes()
    try:
        return Path(source).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: no path at all, such as one with a null byte
        reason = getattr(error, "strerror", None) or error
        rule = f"{reason}; give a TOML file or one of {', '.join(builtin_scenes() + example_scenes())}"
        raise SceneError(label, "scene", label, rule) from None


def parse_scene(text: bytes, label: str) -> Scene:
    """The scene written in `text` (TOML, UTF-8); `label` names it in errors. Raises SceneError."""
    return validated_scene(scene_tables(text, label), label, Path(label).stem)


def scene_tables(text: bytes, label: str) -> dict[str, Any]:
    """The tables of a scene file, not validated. Raises SceneError if they cannot be read."""
    try:
        data: dict[str, Any] = tomllib.loads(text.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise SceneError(label, "file", str(error), "must be valid TOML in UTF-8") from None
    if _deeper(data, MAX_NESTING):
        raise SceneError(label, "file", label, f"must have at most {MAX_NESTING} tables and lists within one another")
    if "name" in data:
        raise SceneError(label, "name", data["name"], "unknown key; the scene is named after its file")
    return data


def validated_scene(data: dict[str, Any], label: str, name: str) -> Scene:
    """The scene of these tables under this name, its record read; `label` names it in errors. Raises SceneError."""
    try:
        return Scene.model_validate({**with_samples(data, label), "name": name})
    except ValidationError as error:
        raise first_error(label, error, KEYS) from None


def _deeper(data: Any, levels: int) -> bool:
    """Whether tables and lists are nested in more than so many levels."""
    inner = data.values() if isinstance(data, dict) else data if isinstance(data, list) else ()
    return any(levels == 0 or _deeper(part, levels - 1) for part in inner if isinstance(part, dict | list))
