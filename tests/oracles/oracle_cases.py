"""The cases of `oracle_values.json`: what is asked, in the words of the scene file."""

from dataclasses import dataclass
from typing import Any

from reference.problem import Scene, load_scene

CUTOFFS = (0.0, 1e-2, 1e-3, 1e-4, 1e-5)  # m/s; 0 is the supremum
HORIZONTAL = {"periods": [0.9, 1.1], "decay": [0.3333333333, 0.2727272727]}


@dataclass(frozen=True)
class Case:
    scene: str
    phase: tuple[float, float]
    equations: str
    regularization: float | None = None

    @property
    def name(self) -> str:
        law = "" if self.regularization is None else f"-v{self.regularization:.0e}"
        return f"{self.scene}-{self.phase[0]:g}-{self.phase[1]:g}-{self.equations}{law}"


OWN: dict[str, dict[str, Any]] = {
    "one-body": {
        "isolator": {"period": 1.0, "friction": 0.08},
        "bodies": [{"mass": 2.0}],
        "excitation": {"amplitudes": [[2.0, 0.5], [0.3, 1.5]], **HORIZONTAL},
    },
    "three-vertical": {
        "isolator": {"radius": 0.4, "friction": 0.07},
        "bodies": [{"mass": 2.0}, {"mass": 1.0, "period": [0.5, 0.6]}, {"mass": 0.5, "stiffness": [180.0, 240.0]}],
        "excitation": {"amplitudes": [[1.0, 0.4], [-0.3, 1.2], [1.3, 0.9]], **HORIZONTAL},
    },
    "deep": {  # swings to 0.7 of the radius
        "isolator": {"period": 1.0, "friction": 0.1},
        "bodies": [{"mass": 1.0}, {"mass": 0.5, "period": [0.8, 0.7]}],
        "excitation": {"amplitudes": [[2.8, 1.0], [0.5, 2.8]], "periods": [1.2, 1.4], "decay": [0.25, 0.2]},
    },
    "lubricated-vertical": {
        "isolator": {"radius": 0.3, "lubrication": 0.8},
        "bodies": [{"mass": 1.0}, {"mass": 2.0, "period": [0.7, 0.4]}],
        "excitation": {"amplitudes": [[1.5, 0.5], [0.2, 1.5], [1.0, 1.0]], **HORIZONTAL},
    },
    "five-bodies": {
        "isolator": {"period": 1.2, "friction": 0.05},
        "bodies": [
            {"mass": 3.0},
            {"mass": 1.0, "period": [0.5, 0.6]},
            {"mass": 2.0, "stiffness": [150.0, 90.0]},
            {"mass": 0.5, "period": [0.9, 0.3]},
            {"mass": 1.5, "period": [0.4, 1.1]},
        ],
        "excitation": {"amplitudes": [[1.0, 0.6], [-0.5, 1.2]], **HORIZONTAL},
    },
    "light-platform": {
        "isolator": {"period": 1.0, "friction": 0.1},
        "bodies": [{"mass": 0.05}, {"mass": 1.0, "period": [0.6, 0.5]}],
        "excitation": {"amplitudes": [[1.5, 0.0], [0.4, 1.5]], **HORIZONTAL},
    },
    "one-axis": {
        "isolator": {"period": 1.0, "friction": 0.06},
        "bodies": [{"mass": 1.0}, {"mass": 1.0, "period": [1.5, 1.2]}],
        "excitation": {"amplitudes": [[1.0, 0.9], [0.0, 0.0]], **HORIZONTAL},
    },
    "frictionless": {
        "isolator": {"period": 1.0, "friction": 0.0},
        "bodies": [{"mass": 1.0}, {"mass": 1.0, "period": [1.5, 1.2]}],
        "excitation": {"amplitudes": [[0.6, 0.2], [0.1, 0.6]], **HORIZONTAL},
    },
    # An onset turns the direction of a slide by 200 rad/s, and its acceleration depends on it a hundred times.
    "light": {
        "duration": 3.0,
        "isolator": {"radius": 0.25, "friction": 0.1},
        "bodies": [{"mass": 0.02}, {"mass": 1.98, "period": [1.5, 1.2]}],
        "excitation": {"amplitudes": [[2.0, 0.0], [0.0, 2.0]], **HORIZONTAL},
    },
    # A stiff link pulls the platform aside within a step from rest. Without the turn friction would stop it at once:
    # the first guess hardly moves, and a derivative at its speed forbids the turn. The slide begins at 1.736 s.
    "light-turning": {
        "duration": 2.2,
        "isolator": {"radius": 0.25, "friction": 0.1},
        "bodies": [{"mass": 0.02}, {"mass": 1.98, "period": [0.2, 0.25]}],
        "excitation": {"amplitudes": [[2.0, 0.0], [0.0, 2.0], [2.0, 1.5]], **HORIZONTAL},
    },
    # The platform turns back at 0.44 of the radius, where the tower presses it into the bowl with 1.1 times the weight.
    # With the weight alone the force along the bowl would point uphill, where friction brakes any slide.
    "light-downhill": {
        "duration": 0.8,
        "isolator": {"radius": 0.25, "friction": 0.03},
        "bodies": [{"mass": 0.06}, {"mass": 1.94, "period": [1.5, 1.2]}],
        "excitation": {"amplitudes": [[5.0, 0.0], [0.0, 3.0]], **HORIZONTAL},
    },
}

# behind the name of a scene: friction that depends on the velocity, or on the load; dampers; a stronger record
LAWS = {
    "rising": {"slow": 0.05, "fast": 0.1, "rate": 100.0},
    "falling": {"slow": 0.1, "fast": 0.05, "rate": 100.0},
    "pressed": {"slow": 0.08, "load_exponent": 0.4},
    "eased": {"slow": 0.05, "fast": 0.1, "rate": 100.0, "load_exponent": -0.3, "reference_load": 25.0},
}
CHANGES = {name: {"duration": 6.0, "isolator.friction": law} for name, law in LAWS.items()} | {
    "damped": {"duration": 3.0, "bodies.1.damping": 0.05},
    "unequally": {"duration": 2.0, "bodies.1.damping": [2.0, 0.3]},
    "overdamped": {"duration": 3.0, "bodies.1.damping": 5.0},
    "nonproportional": {"duration": 3.0, "bodies.1.damping": 0.5, "bodies.2.damping": 0.01},
    "strong": {"duration": 2.25, "excitation.scale": 2.0},
}


def scene_of(name: str) -> Scene:
    base, _, change = name.rpartition("-")
    if change in CHANGES:
        return scene_of(base).with_values({"name": name, **CHANGES[change]})
    if name not in OWN:
        return load_scene(name)
    return Scene.model_validate({"title": name, "name": name, "duration": 20.0, **OWN[name]})


BOTH = ("exact", "small")
SET_VALUED = [
    *(Case("fig3-I", p, e) for p in ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (5.1, 3.3)) for e in BOTH),
    *(Case("fig3-II", p, e) for p in ((0.3, 1.1), (2.5, 4.0)) for e in BOTH),
    *(Case("fig4-dry", p, e) for p in ((0.3, 1.1), (1.0, 5.0)) for e in BOTH),
    *(Case("one-body", p, e) for p in ((0.3, 1.1), (3.0, 2.0)) for e in BOTH),
    *(Case("three-vertical", p, e) for p in ((0.3, 1.1), (2.2, 5.2)) for e in BOTH),
    *(Case("deep", p, "exact") for p in ((0.3, 1.1), (1.5, 4.5))),
    *(Case("five-bodies", (0.3, 1.1), e) for e in BOTH),
    *(Case("light-platform", (0.3, 1.1), e) for e in BOTH),
    *(Case("one-axis", (0.3, 1.1), e) for e in BOTH),
    *(
        Case(f"{scene}-rising", (0.3, 1.1), "exact")
        for scene in ("fig3-I", "fig3-II", "one-body", "three-vertical", "deep", "one-axis", "five-bodies")
    ),
    *(
        Case(f"{scene}-falling", (0.3, 1.1), "exact")
        for scene in ("fig3-I", "fig4-dry", "one-body", "three-vertical", "deep", "one-axis")
    ),
    *(Case(f"fig3-I-{law}", (0.3, 1.1), "small") for law in ("rising", "falling")),
    *(Case(f"{scene}-pressed", (0.3, 1.1), "exact") for scene in ("fig3-I", "three-vertical", "deep")),
    Case("light-platform-pressed", (0.3, 1.1), "exact"),
    *(Case(f"{scene}-eased", (0.3, 1.1), "exact") for scene in ("fig4-dry", "three-vertical", "five-bodies")),
    Case("three-vertical-pressed", (2.2, 5.2), "small"),
    # the ground's acceleration falls as the platform stops: the peak is the ground's at the instant of the stop
    *(Case(scene, (0.885, 5.598), "exact") for scene in ("fig3-II", "fig4-dry")),
    # the slip direction turns on while the platform stops: all bodies share the vertical acceleration of that
    Case("fig3-II", (2.0944, 1.7017), "exact"),
    *(Case("fig3-I-damped", (0.3, 1.1), e) for e in BOTH),
    *(Case(scene, (0.3, 1.1), "exact") for scene in ("fig3-I-overdamped", "fig3-II-unequally")),
    Case("three-vertical-nonproportional", (0.3, 1.1), "exact"),
    Case("light", (2.0, 0.7), "exact"),
    Case("light-turning", (5.8, 1.1), "exact"),
    Case("light-downhill", (5.4, 2.4), "exact"),
    *(Case(f"synthetic-{record}-strong", (0.0, 0.0), e) for record in ("pair", "triple") for e in BOTH),
]
SMOOTH = [
    *(Case("fig4-viscous", p, e) for p in ((0.3, 1.1), (2.5, 4.0)) for e in BOTH),
    *(Case("lubricated-vertical", (0.3, 1.1), e) for e in BOTH),
    *(Case("frictionless", (0.3, 1.1), e) for e in BOTH),
    Case("frictionless-damped", (0.3, 1.1), "small"),
    Case("fig4-viscous-damped", (0.3, 1.1), "exact"),
]
REGULARIZED = [
    *(Case("fig3-I", (0.3, 1.1), "exact", v) for v in (1e-2, 1e-3, 1e-4, 1e-6)),
    Case("fig3-I", (0.3, 1.1), "small", 1e-3),
    Case("fig3-I", (2.0, 0.7), "exact", 1e-3),
    Case("fig4-dry", (0.3, 1.1), "small", 1e-2),
    Case("one-body", (0.3, 1.1), "exact", 1e-2),
    Case("three-vertical", (0.3, 1.1), "exact", 1e-2),
    Case("three-vertical", (0.3, 1.1), "small", 1e-3),
    Case("deep", (0.3, 1.1), "exact", 1e-3),
    Case("one-axis", (0.3, 1.1), "exact", 1e-4),
    Case("fig3-I-rising", (0.3, 1.1), "exact", 1e-3),
    Case("fig3-I-falling", (0.3, 1.1), "exact", 1e-3),
    Case("three-vertical-rising", (0.3, 1.1), "small", 1e-2),
    Case("one-axis-falling", (0.3, 1.1), "exact", 1e-2),
    Case("three-vertical-pressed", (0.3, 1.1), "exact", 1e-2),
    Case("fig3-I-eased", (0.3, 1.1), "exact", 1e-3),
    Case("three-vertical-nonproportional", (0.3, 1.1), "exact", 1e-2),
    *(Case(f"synthetic-{record}-strong", (0.0, 0.0), e, 1e-2) for record in ("pair", "triple") for e in BOTH),
]
CASES = [*SET_VALUED, *SMOOTH, *REGULARIZED]
