"""The scene: the question asked of both sides, read from TOML, validated, in SI units."""

from __future__ import annotations

import hashlib
import math
import tomllib
from collections.abc import Mapping
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, ValidationError, model_validator

from reference.problem.record_files import GRAVITY as GRAVITY
from reference.problem.recorded import EXAMPLES, with_samples
from reference.problem.scene_error import EXCITATIONS, MisfitError, SceneError, UnknownKeyError, first_fault

SOFTEST = 0.1  # of the radius: what supports may give way by under the weight
Positive = Annotated[float, Field(gt=0.0)]
NonNegative = Annotated[float, Field(ge=0.0)]
PerAxis = Annotated[list[Positive], Field(min_length=2, max_length=2)]
PerHarmonic = Annotated[list[float], Field(min_length=2, max_length=2)]


UNWRITTEN = ("name", "samples")  # fields that no scene file holds


class Table(BaseModel):
    """One table of the file: unknown keys, wrong types and non-finite numbers are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: Any) -> Any:
        """Refuse an unknown key with the nearest valid ones. Raises UnknownKeyError."""
        for key in data if isinstance(data, dict) else ():
            if key not in cls.model_fields:
                raise UnknownKeyError(str(key), data[key], [name for name in cls.model_fields if name not in UNWRITTEN])
        return data


def exactly_one(table: BaseModel, first: str, second: str) -> None:
    given = [key for key in (first, second) if getattr(table, key) is not None]
    if len(given) != 1:
        raise ValueError(f"give exactly one of {first} and {second}, not {len(given)} of them")


class Isolator(Table):
    """Spherical gravity-friction isolator. Exactly one of period and radius, one of friction and lubrication."""

    period: Positive | None = None  # s, of one mass alone on the isolator, T_c
    radius: Positive | None = None  # m, rho = R - r
    friction: NonNegative | None = None  # dry friction coefficient, mu of (2.5)
    lubrication: NonNegative | None = None  # s/m, f_c of (3.14)
    supports: Annotated[int, Field(ge=3)] | None = None  # K, spatial model
    ring: Positive | None = None  # m, radius of the circle of supports, spatial model
    sphere_radius: Positive | None = None  # m, r
    support_stiffness: Positive | None = None  # N/m, vertical, of one support; without it supports are rigid

    @model_validator(mode="after")
    def _alternatives(self) -> Isolator:
        exactly_one(self, "period", "radius")
        exactly_one(self, "friction", "lubrication")
        return self


class Body(Table):
    """One rigid body; the first is the platform, every other one is linked to the body before it."""

    mass: Positive  # kg
    period: PerAxis | None = None  # s, 2 pi sqrt(m / k) in x and y, of the link to the body below
    stiffness: PerAxis | None = None  # N/m, k^x and k^y of that link
    height: NonNegative | None = None  # m above the plane of the depression centres, spatial model
    size: Annotated[list[Positive], Field(min_length=3, max_length=3)] | None = None  # m, box


class Excitation(Table):
    """Two-frequency damped ground acceleration (5.2)-(5.4): rows x, y and optionally z, columns the harmonics."""

    amplitudes: Annotated[list[PerHarmonic], Field(min_length=2, max_length=3)]  # m/s^2, a_ki
    periods: PerAxis  # s, T_i of the harmonics
    decay: Annotated[list[NonNegative], Field(min_length=2, max_length=2)]  # 1/s, lambda_i


class Record(Table):
    """Recorded ground acceleration in place of the two frequencies: its files, and the samples read from them."""

    record: str | dict[str, str]  # a CSV file, or .AT2 files by direction, as written in the scene
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
        """The limits that are given, by key."""
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

    title: str
    duration: Positive  # s
    isolator: Isolator
    bodies: Annotated[list[Body], Field(min_length=1)]
    excitation: Annotated[
        Annotated[Excitation, Tag(EXCITATIONS[0])] | Annotated[Record, Tag(EXCITATIONS[1])], Discriminator(_kind)
    ]
    acceptance: Acceptance = Acceptance()
    name: str = "scene"  # file stem or built-in name; set by load_scene

    @model_validator(mode="after")
    def _links(self) -> Scene:
        platform, *others = self.bodies
        for key in ("period", "stiffness"):
            if (value := getattr(platform, key)) is not None:
                raise MisfitError(f"bodies.0.{key}", value, "the platform has no link below: remove this key")
        for number, body in enumerate(others, start=1):
            try:
                exactly_one(body, "period", "stiffness")
            except ValueError as fault:
                raise MisfitError(f"bodies.{number}", body.model_dump(exclude_none=True), str(fault)) from None
        derived = {"isolator: radius in m": self.radius, "bodies: total mass in kg": self.total_mass}
        derived |= {
            f"bodies.{i + 1}: k^{'xy'[axis]} in N/m": float(k) for (i, axis), k in np.ndenumerate(self.stiffness)
        }
        for key, value in derived.items():
            if not (math.isfinite(value) and value > 0.0):
                raise MisfitError(key, value, "must be finite and positive in double precision")
        bearings = self.isolator.support_stiffness
        if bearings is not None:
            share = self.total_mass * GRAVITY / ((self.isolator.supports or 1) * bearings * self.radius)
            if not share <= SOFTEST:
                rule = f"gives way by {share:.3g} of the radius under the weight: must be at most {SOFTEST:g}"
                raise MisfitError("isolator.support_stiffness", bearings, rule)
        if isinstance(self.excitation, Record) and not np.isfinite(self.record).all():
            raise MisfitError("excitation.scale", self.excitation.scale, "must leave every sample finite")
        return self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.model_dump() == other.model_dump()

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Scene:
        """A copy with some keys changed, not validated; what follows from them (masses, ...) is computed anew."""
        copy = super().model_copy(update=update, deep=deep)
        for name, member in vars(Scene).items():
            if isinstance(member, cached_property):
                copy.__dict__.pop(name, None)
        return copy

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
        if not (math.isfinite(amplitude) and amplitude > 0.0):
            raise SceneError(self.name, "amplitude", amplitude, "must be finite and greater than 0 m/s^2")
        if largest == 0.0:
            key = "record" if self.recorded else "amplitudes"
            raise SceneError(self.name, f"excitation.{key}", 0.0, "all entries are 0: nothing to scale")
        data = self.model_dump(exclude_none=True)
        if self.recorded:
            data["excitation"]["scale"] *= amplitude / largest
        else:
            data["excitation"]["amplitudes"] = ((self.amplitudes / largest) * amplitude).tolist()
        return Scene.model_validate(data)

    def digest(self) -> str:
        """Hash of everything that enters a result, for stores of results and for provenance."""
        content = self.model_dump_json(
            exclude={"title": True, "name": True, "acceptance": True, "excitation": {"record": True}}
        )
        return hashlib.sha256(content.encode()).hexdigest()[:16]


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
    except (OSError, ValueError) as fault:  # ValueError: no path at all, such as one with a null byte
        reason = getattr(fault, "strerror", None) or fault
        rule = f"{reason}; give a TOML file or one of {', '.join(builtin_scenes() + example_scenes())}"
        raise SceneError(label, "scene", label, rule) from None


def parse_scene(text: bytes, label: str) -> Scene:
    """The scene written in `text` (TOML, UTF-8); `label` names it in errors. Raises SceneError."""
    return validated_scene(scene_tables(text, label), label, Path(label).stem)


def scene_tables(text: bytes, label: str) -> dict[str, Any]:
    """The tables of a scene file, not validated. Raises SceneError if they cannot be read."""
    try:
        data: dict[str, Any] = tomllib.loads(text.decode())
    except (ValueError, RecursionError) as fault:
        raise SceneError(label, "file", str(fault), "must be valid TOML in UTF-8") from None
    if "name" in data:
        raise SceneError(label, "name", data["name"], "unknown key; the scene is named after its file")
    return data


def validated_scene(data: dict[str, Any], label: str, name: str) -> Scene:
    """The scene of these tables under this name, its record read; `label` names it in errors. Raises SceneError."""
    try:
        return Scene.model_validate({**with_samples(data, label), "name": name})
    except ValidationError as fault:
        raise first_fault(label, fault) from None
