"""
Benchmark cases: published numbers, the scenes that state their problems, and how a motion is read for them.

Only facts are taken from the sources: parameters and numbers. A closed form was evaluated again and gives the printed
digits.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from comparison.evidence.benchmarks import readings
from comparison.evidence.benchmarks.table import PublishedNumber
from comparison.result_types import Array
from reference.problem import GRAVITY, Scene, SceneError, Trajectory, load_scene
from reference.problem.readings import DEFAULT_V_REG
from reference.records.formats import read_csv_samples
from reference.records.samples import MAX_FILE_BYTES, RecordError
from reference.support.files import read_file

SCENES = resources.files("comparison.evidence.benchmarks") / "scenes"  # folder of the scene files
INCH = 0.0254  # m in an inch
BLOCK_WEIGHT = 10.0  # N, weight of the blocks in code_aster's benchmarks
RAMP_EFFECT = 2e-7  # m, change of displacement because the pulse falls to zero within 1 ms, Newmark's at once


@dataclass(frozen=True)
class MotionReading:
    """Rule to read the numbers of a benchmark from a motion: `factor` times `function(motion, **arguments)`."""

    function: Callable[..., float | Sequence[float] | Array]
    arguments: Mapping[str, Any] = field(default_factory=dict)
    factor: float = 1.0  # factor from SI unit to published unit

    def read(self, motion: Trajectory) -> list[float]:
        """Read the numbers from a motion and return them in the units of the published numbers."""
        values = np.atleast_1d(self.function(motion, **self.arguments))
        return [self.factor * float(value) for value in values]


@dataclass(frozen=True)
class BenchmarkCase:
    """
    One benchmark: published numbers, scene, and how its motion is read.

    source: where the numbers are published. evidence: for what it is evidence. reading: gives a value for each of
    `published`. phases: rad. start: m, where the bodies are released from rest; at the equilibrium if empty.
    regularization: m/s, v_reg of the engine, and of the equations that are compared with it. difference: what the
    source models and this project does not, or the other way round; empty where the models are the same.
    """

    title: str
    source: str
    evidence: str
    published: Sequence[PublishedNumber]
    reading: MotionReading
    scene: Scene
    phases: tuple[float, float] = (0.0, 0.0)
    start: Sequence[tuple[float, float]] = ()
    regularization: float = 1e-4
    difference: str = ""


def load_shipped_scene(name: str, values: Mapping[str, Any] | None = None) -> Scene:
    """Return a scene file shipped with the benchmarks, by name, as a scene; `values` replace some of its values."""
    return load_scene(Path(str(SCENES / f"{name}.toml"))).with_values({"name": name, **(values or {})})


def list_cases() -> list[BenchmarkCase]:
    """Return the benchmarks whose inputs are shipped with the package."""
    return [
        *_wear_power_cases(),
        _release_case(),
        _coulomb_damping_case(),
        _den_hartog_case(),
        _harmonic_block_case(),
        _pulse_case(),
        *_linear_cases(),
    ]


def _wear_power_cases() -> list[BenchmarkCase]:
    """Return benchmarks of the mean wear power (contact force times sliding speed) of a shaken block (SDND104)."""
    # m/s^2, amplitude of the shaking; W, published power; half of its last digit
    numbers = ((15.0, 15.2671, 5e-5), (1.5, 0.409062, 5e-7), (1.01, 2.26164e-4, 5e-10), (0.99, 0.0, 0.0))
    kinds = ("always sliding", "sticking and sliding", "just sliding", "held")
    return [
        BenchmarkCase(
            title=f"code_aster SDND104, A = {amplitude:g} m/s²: {kind}",
            source="code_aster, test SDND104 (V5.01.104): closed form; its integrators are within 5e-4, 5e-3 at 1.01",
            evidence="path length of stick and slip under harmonic shaking",
            published=[PublishedNumber(quantity="mean wear power", unit="W", published=power, uncertainty=digits)],
            # The contact force, which is the weight, times the path that the block slides, over the time of 8 s
            reading=MotionReading(
                readings.compute_path_length, arguments={"begin": 4.0, "end": 12.0}, factor=BLOCK_WEIGHT / 8.0
            ),
            scene=load_shipped_scene("sdnd104", {"excitation.scale": amplitude, "name": f"sdnd104-{amplitude:g}"}),
            phases=(-0.5 * math.pi, 0.0),
        )
        for (amplitude, power, digits), kind in zip(numbers, kinds)
    ]


def _release_case() -> BenchmarkCase:
    """Return the benchmark of a mass on a spring with dry friction, released from rest (code_aster SDND100)."""
    return BenchmarkCase(
        title="code_aster SDND100: release with friction",
        source="code_aster, test SDND100 (V5.01.100): closed form",
        evidence="turning points, and rest at the end",
        published=[
            PublishedNumber(quantity=f"turning point {number}", unit="mm", published=place, uncertainty=0.0)
            for number, place in enumerate((-0.65, 0.45, -0.25, 0.05), start=1)
        ],
        reading=MotionReading(readings.find_turning_points, factor=1e3),
        scene=load_shipped_scene("sdnd100"),
        start=((0.85e-3, 0.0),),
        regularization=1e-7,
    )


def _coulomb_damping_case() -> BenchmarkCase:
    """Return the benchmark of a free vibration with Coulomb damping (ANSYS VM73), scaled in time."""
    # Factor by which the scene is slower: the published natural frequency, of 30 lb/in and 10 lb, over 0.1 rad/s
    stretch = math.sqrt(30.0 * 386.0 / 10.0) * 10.0
    times = (0.09, 0.102, 0.183)
    return BenchmarkCase(
        title="ANSYS VM73: free vibration with Coulomb damping",
        source="ANSYS Verification Manual, VM73, after Tse, Morse and Hinkle, Mechanical Vibrations: closed form",
        evidence="the motion between stops, at given instants",
        published=[
            PublishedNumber(quantity=f"place at {time:g} s", unit="in", published=value, uncertainty=5e-6)
            for time, value in zip(times, (0.87208, 0.83132, -0.74874))
        ],
        reading=MotionReading(
            readings.interpolate_positions,
            arguments={"times": [stretch * time for time in times]},
            factor=1.0 / INCH,
        ),
        scene=load_shipped_scene("vm73"),
        start=((-INCH, 0.0),),
        regularization=1e-7,
    )


def _den_hartog_case() -> BenchmarkCase:
    """Return the benchmark of Den Hartog's forced oscillator with dry friction, off its resonance."""
    scene = load_shipped_scene("den-hartog")
    unit = 1e-3 * scene.radius / GRAVITY  # m, static displacement under the force; published numbers are multiples
    return BenchmarkCase(
        title="Den Hartog: forced oscillation with friction",
        source="J. P. Den Hartog, Forced vibrations with combined Coulomb and viscous friction, 1931: closed form",
        evidence="steady sliding oscillation beside resonance",
        published=[
            PublishedNumber(quantity="amplitude over static one", unit="", published=1.535602, uncertainty=5e-7)
        ],
        reading=MotionReading(  # in the last of six periods
            readings.compute_half_range, arguments={"begin": scene.duration * 5.0 / 6.0}, factor=1.0 / unit
        ),
        scene=scene,
        # The motion starts at a turning point of the steady oscillation, whose phase and amplitude the closed form has.
        phases=(0.18581959993316782, 0.0),
        start=((1.5356018092808652 * unit, 0.0),),
        regularization=1e-7,
    )


def _harmonic_block_case() -> BenchmarkCase:
    """Return the benchmark of a rigid block that slides on a harmonically shaken plane (Westermo and Udwadia)."""
    share = 1.0 / 2.5  # friction force per mass, divided by the amplitude of the ground acceleration
    amplitude = math.sqrt(1.0 - (0.5 * math.pi * share) ** 2)
    return BenchmarkCase(
        title="Rigid block on a harmonically shaken plane",
        source="B. Westermo and F. Udwadia, Earthquake Engineering and Structural Dynamics 11, 1983: closed form",
        evidence="steady sliding on a plane, reached from rest",
        published=[
            PublishedNumber(
                quantity="amplitude over ground's", unit="", published=round(amplitude, 6), uncertainty=5e-7
            )
        ],
        # The displacement of the ground has an amplitude of 2.5 m/s^2 / (2 pi rad/s)^2.
        reading=MotionReading(
            readings.compute_half_range, arguments={"begin": 11.0}, factor=(2.0 * math.pi) ** 2 / 2.5
        ),
        scene=load_shipped_scene("harmonic"),
        phases=(-0.5 * math.pi, 0.0),
    )


def _pulse_case() -> BenchmarkCase:
    """Return the benchmark of Newmark's sliding block under a rectangular acceleration pulse."""
    return BenchmarkCase(
        title="Newmark's block under a rectangular pulse",
        source="N. M. Newmark, Géotechnique 15, 1965: V² / (2 N g) (1 - N / A)",
        evidence="residual displacement after a pulse; a recorded motion",
        published=[PublishedNumber(quantity="displacement", unit="m", published=0.75, uncertainty=RAMP_EFFECT)],
        reading=MotionReading(readings.interpolate_positions, arguments={"times": [3.0]}),
        scene=load_shipped_scene("newmark"),
    )


def _linear_cases() -> list[BenchmarkCase]:
    """Return the benchmarks of natural periods of two structures, and of the period of a pendulum at large swing."""
    stories = (2.0, 0.6852, 0.4346, 0.3383, 0.2966)
    return [
        BenchmarkCase(
            title="Chopra: one-story frame on isolators",
            source="A. K. Chopra, Dynamics of Structures, base-isolated one-story building: natural periods",
            evidence="stiffness of the isolator, mass and link",
            published=[
                PublishedNumber(quantity="isolation period", unit="s", published=2.0242, uncertainty=5e-5),
                PublishedNumber(quantity="structural period", unit="s", published=0.2500, uncertainty=5e-5),
            ],
            reading=MotionReading(readings.compute_natural_periods),
            scene=load_shipped_scene("frame"),
            start=((1e-4, 0.0), (0.0, 0.0)),
        ),
        BenchmarkCase(
            title="Chopra: uniform five-story shear building",
            source="A. K. Chopra, Dynamics of Structures, uniform five-story shear building: natural periods",
            evidence="chain of links above a platform that friction holds",
            published=[
                PublishedNumber(quantity=f"natural period {number}", unit="s", published=period, uncertainty=5e-5)
                for number, period in enumerate(stories, start=1)
            ],
            reading=MotionReading(readings.compute_natural_periods),
            scene=load_shipped_scene("stories"),
            start=(*((0.0, 0.0),) * 5, (1e-4, 0.0)),
            regularization=DEFAULT_V_REG,
        ),
        BenchmarkCase(
            title="Pendulum released at 60°",
            source="M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, table 17.1: K(sin² 30°)",
            evidence="exact geometry of the sphere at large displacement",
            published=[
                PublishedNumber(quantity="period over small one's", unit="", published=1.073182, uncertainty=5e-7)
            ],
            reading=MotionReading(readings.compute_mean_period, factor=math.sqrt(GRAVITY) / (2.0 * math.pi)),
            scene=load_shipped_scene("pendulum"),
            start=((math.sin(math.pi / 3.0), 0.0),),
        ),
    ]


MASTODON_OPTION = "--mastodon"  # option that names the file with MASTODON's input motion
# Rule for the file that MASTODON_OPTION names, as error messages state it
MASTODON_RULE = "must be the CSV file with the input of MASTODON's friction pendulum test: time [s], ax, ay, az"
READING_ERROR = 3.0  # mm, error of displacements read from the published force-displacement loops (MASTODON)
MASTODON_RADIUS = 2.2352  # m, radius of the friction pendulum in MASTODON's test
MASTODON_WEIGHT = 6285710.0  # N, weight on the friction pendulum in MASTODON's test
MASTODON_DURATION = 8.0  # s, computed part of the 50 s of motion; later displacements are smaller
# MASTODON input motion: number of samples, and time step, s (that after the first sample may differ)
MASTODON_SAMPLES, MASTODON_STEP = 5002, 0.01
MASTODON_PEAKS = (8.950749, 6.770387, 1.692597)  # m/s^2, peaks of the MASTODON input motion along x, y, z
INPUT_TOLERANCE = 1e-3  # largest relative deviation of a file's time step and peaks from those of the MASTODON input
# mm, published displacements: smallest and largest along x, then along y
MASTODON_EXTREMES = -432.0, 330.0, -197.0, 152.0
# Friction of the MASTODON benchmark: it falls with pressure and temperature and grows with the slip velocity
MASTODON_FRICTION = {
    "slow": 0.03 * 0.789 / 0.79,  # MASTODON's temperature factor 0.789 (0.7^(0.02 T) + 0.4), T in °C; here 0.79 (...)
    "fast": 0.06 * 0.789 / 0.79,
    "rate": 100.0,
    "load_exponent": -0.357,  # power of the pressure p: slope of ln 0.7^(0.02 (p - 50)) over ln p at p = 50 MPa
    "heating": {"contact_radius": 0.2, "conductivity": 18.0, "diffusivity": 4.4e-6},
}


def load_mastodon_case(path: Path) -> BenchmarkCase:
    """Return the MASTODON benchmark with its input motion from a CSV file (time, ax, ay, az). Raises SceneError."""
    try:
        samples = read_csv_samples(read_file(path, MAX_FILE_BYTES).decode("utf-8-sig"))
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "must be text in UTF-8"
        raise SceneError("command line", MASTODON_OPTION, str(path), f"{reason}; {MASTODON_RULE}") from None
    except RecordError as error:
        raise SceneError("command line", MASTODON_OPTION, str(path), str(error)) from None
    _refuse_other_input(path, samples)
    scene = Scene.model_validate(
        {
            "title": "MASTODON: friction pendulum under three-directional shaking",
            "name": "mastodon",
            "duration": MASTODON_DURATION,
            "isolator": {"radius": MASTODON_RADIUS, "friction": MASTODON_FRICTION},
            "bodies": [{"mass": MASTODON_WEIGHT / GRAVITY}],
            "excitation": {"record": {"time": samples[:, 0], "acceleration": samples[:, 1:]}},
        }
    )
    names = ("smallest along x", "largest along x", "smallest along y", "largest along y")
    return BenchmarkCase(
        title="MASTODON and OpenSees: friction pendulum under three-directional shaking",
        source="idaholab/mastodon, test fp_isolator_seismic_PTV and its manual: displacements read from the published "
        "loops of both programs",
        evidence="a recorded motion in three directions with friction that depends on velocity, pressure and heat",
        published=[
            PublishedNumber(quantity=name, unit="mm", published=value, uncertainty=READING_ERROR)
            for name, value in zip(names, MASTODON_EXTREMES)
        ],
        reading=MotionReading(readings.find_position_ranges, factor=1e3),
        scene=scene,
        regularization=DEFAULT_V_REG,
        difference="their bearing is elastic up to 1 mm, and its restoring force N y / sqrt(R² - y²) lies between "
        "those of the exact and the small equations. The small equations give -429 to 329 and -199 to 151 mm",
    )


def _refuse_other_input(path: Path, samples: Array) -> None:
    """Raise SceneError unless the samples are the input of MASTODON's test, for which the numbers are published."""
    if not samples[:, 1:].any(axis=0).all():
        rule = "must have accelerations along x, y and z: columns ax, ay and az"
        raise SceneError("command line", MASTODON_OPTION, str(path), rule)

    def words(count: int, step: float, peaks: Sequence[float] | Array) -> str:
        """Return number of samples, step and peaks of an input motion in words."""
        return f"{count} samples every {step:.4g} s with peaks of " + ", ".join(f"{peak:.4g}" for peak in peaks)

    step, peaks = float(np.median(np.diff(samples[:, 0]))), np.abs(samples[:, 1:]).max(axis=0)
    if len(samples) != MASTODON_SAMPLES or not np.allclose(
        [step, *peaks], [MASTODON_STEP, *MASTODON_PEAKS], rtol=INPUT_TOLERANCE, atol=0.0
    ):
        rule = (
            "must be the input of MASTODON's test fp_isolator_seismic_PTV, "
            f"{words(MASTODON_SAMPLES, MASTODON_STEP, MASTODON_PEAKS)} m/s^2; it has {words(len(samples), step, peaks)}"
        )
        raise SceneError("command line", MASTODON_OPTION, str(path), rule)
