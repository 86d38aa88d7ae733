"""A wrong argument of a public function is one line that names it and says what to pass."""

import inspect
import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest

import multibody
import reference
import reference.problem
from reference.problem import SceneError
from reference.support.arguments import quote

SCENE = reference.load_scene("fig3-I")
FUNCTIONS = [
    (function, inspect.signature(function).parameters, f"{package.__name__}.{name}")
    for package in (reference, reference.problem, multibody)
    for name in package.__all__
    if inspect.isfunction(function := getattr(package, name))
]
OF_OBJECTS = [
    pytest.param(function, kind, id=name)
    for function, parameters, name in FUNCTIONS
    if parameters and (kind := next(iter(parameters.values())).annotation) in ("Scene", "Trajectory")
]


@pytest.mark.parametrize(("function", "kind"), OF_OBJECTS)
@pytest.mark.parametrize("wrong", ["fig3-I", None, 3, SCENE.model_dump(), np.zeros((2, 3)), type(SCENE)])
def test_a_wrong_object_is_one_line_that_says_what_to_pass(
    function: Callable[..., Any], kind: str, wrong: object
) -> None:
    assert len(OF_OBJECTS) > 20
    first, *others = inspect.signature(function).parameters.values()
    required = {each.name: (0.0, 0.0) for each in others if each.default is each.empty}
    for words, named in (([wrong, *required.values()], {}), ([], {first.name: wrong, **required})):
        with pytest.raises(TypeError, match=rf"^{first.name} = .*: must be a {kind}, as reference\.") as failure:
            function(*words, **named)
        assert "\n" not in str(failure.value)
    with pytest.raises(TypeError, match=f"missing .* positional argument.*{first.name}"):
        function()


LEVEL = multibody.levels(SCENE)[0]
SHORT, START = SCENE.with_values({"isolator.travel": 0.1}), reference.State(np.full((2, 2), 0.08), np.zeros((2, 2)))
TOO_FAR = "initial: the platform must start within isolator.travel = 0.1 m"
LOOP: list[Any] = []
LOOP.append(LOOP)


class Endless:
    """A sequence that claims more entries than memory holds."""

    def __len__(self) -> int:
        return 10**9

    def __getitem__(self, place: int) -> float:
        raise AssertionError("it was read")


class Unshowable:
    """An object that raises when it is shown or taken as an array."""

    def __repr__(self) -> str:
        raise RuntimeError("no text")

    __array__ = __repr__


MASKED = np.ma.masked_array([0.0, 1.0], mask=[True, False])
WRONG: dict[str, tuple[Callable[[], Any], str]] = {
    "max_work as text": (lambda: multibody.refusal(SCENE, max_work="1"), "max_work = '1': must be finite and positive"),
    "penetration": (
        lambda: multibody.single_run(SCENE, (0.0, 0.0), step=1e-3, penetration=0.2),
        "penetration = 0.2: must be finite and positive, from 1e-14 to 0.1 of rho",
    ),
    "iteration": (
        lambda: multibody.single_run(SCENE, (0.0, 0.0), step=1e-3, newton=2.0),
        "newton = 2.0: must be finite and positive, from 1e-14 to 1",
    ),
    "residual": (
        lambda: multibody.single_run(SCENE, (0.0, 0.0), step=1e-3, residual=True),
        "residual = True: must be finite, from 0 to 1 of the weight",
    ),
    "iteration over contacts": (
        lambda: multibody.single_run(SCENE, (0.0, 0.0), step=1e-3, discontinuous=-1.0),
        "discontinuous = -1.0: must be finite and positive, from 1e-14 to 1",
    ),
    "no levels": (
        lambda: multibody.amplification(SCENE, (0.0, 0.0), levels=[]),
        "levels = []: must be levels of accuracy, as multibody.levels lists them",
    ),
    "no level": (lambda: multibody.single_run(SCENE, (0.0, 0.0), level=3), "levels = [3]: must be levels of accuracy"),
    "one level of two": (lambda: multibody.amplification(SCENE, (0.0, 0.0), levels=[LEVEL, 1]), "levels = [Level("),
    **{
        f"level of no {key}": (
            lambda key=key: multibody.single_run(SCENE, (0.0, 0.0), level=replace(LEVEL, **{key: 0.0})),
            f"levels: {key} = 0.0: must be finite and positive",
        )
        for key in ("step", "slip_change", "penetration", "newton")
    },
    "phase": (
        lambda: reference.amplification(SCENE, (0.0, -2e6)),
        "phases: -2e+06: must be finite, from -1e+06 to 1e+06 rad: reduce it modulo 2 pi",
    ),
    "grid as text": (lambda: reference.phase_grid("x"), "points = 'x': must be a whole number from 1 to 10000"),
    "no phase": (lambda: reference.phase_grid(0), "points = 0: must be a whole number"),
    "grid as bool": (lambda: reference.phase_grid(True), "points = True: must be a whole number"),
    "amplitude as bool": (lambda: SCENE.with_amplitude(True), "fig3-I: amplitude = True: must be finite and greater"),
    "amplitude as text": (lambda: SCENE.with_amplitude("1"), "fig3-I: amplitude = '1': must be finite and greater"),
    "truths as phases": (lambda: reference.trajectory(SCENE, (True, False)), "phases = (True, False): must be numbers"),
    "complex phases": (lambda: reference.trajectory(SCENE, (0.5, 1j)), "phases = (0.5, 1j): must be numbers"),
    "masked phase": (
        lambda: reference.problem.ground_acceleration(SCENE, [np.ma.masked, 1.0], [0.0]),
        "phases: has masked entries: must be (2,)",
    ),
    "masked time": (lambda: reference.problem.ground_velocity(SCENE, (0.0, 0.0), MASKED), "time: has masked entries"),
    "time as text": (
        lambda: reference.problem.ground_displacement(SCENE, (0.0, 0.0), "x"),
        "time = 'x': must be numbers: must be instants (T,), s",
    ),
    "start of the equations": (lambda: reference.trajectory(SHORT, (0.0, 0.0), initial=START), TOO_FAR),
    "start of the engine": (lambda: multibody.trajectory(SHORT, (0.0, 0.0), initial=START), TOO_FAR),
    "start of a single run": (lambda: multibody.single_run(SHORT, (0.0, 0.0), step=1e-3, initial=START), TOO_FAR),
    "phases in themselves": (lambda: reference.trajectory(SCENE, LOOP), "phases = [[...]]: must be numbers"),
    "phases without end": (
        lambda: reference.trajectory(SCENE, Endless()),
        "phases: takes more memory than there is: must be",
    ),
    "phases that are no array": (lambda: reference.trajectory(SCENE, Unshowable()), "phases = <Unshowable>: must be"),
    "equations that cannot be shown": (
        lambda: reference.trajectory(SCENE, (0.0, 0.0), equations=Unshowable()),
        "equations = <Unshowable>: must be one",
    ),
    "displacement in a table": (
        lambda: reference.effective_isolator(SCENE, {"a": 1}),
        "displacement = {'a': 1}: must be numbers: must be length",
    ),
    "masked grid": (
        lambda: reference.phase_distribution(np.ma.masked_array(np.ones((2, 2)), [[1, 0], [0, 0]]), np.zeros((2, 2))),
        "mu: has masked entries",
    ),
}


@pytest.mark.parametrize(("call", "line"), WRONG.values(), ids=WRONG.keys())
def test_a_wrong_value_is_one_line_with_the_rule(call: Callable[[], Any], line: str) -> None:
    with pytest.raises(ValueError, match=f"^{re.escape(line)}") as failure:
        call()
    assert "\n" not in str(failure.value)


RANGES = {  # a number below, one above, and the range in words
    "tolerance": (1e-11, 0.2, "1e-10 to 0.1"),
    "max_work": (0.5, 2e12, "1 to 1e+12 steps"),
    "regularization": (1e-13, 2e6, "1e-12 to 1e+06 m/s"),
    "cutoff": (1e-16, 1e7, "1e-15 to 1e+06 m/s"),
}


@pytest.mark.parametrize("name", RANGES)
def test_a_number_beyond_its_range_is_refused_by_every_function_that_takes_it(name: str) -> None:
    calls = [
        (function, words) for function, words, _ in FUNCTIONS if next(iter(words), "") == "scene" and name in words
    ]
    assert calls
    *beyond, allowed = RANGES[name]
    for (function, words), value in product(calls, beyond):
        required = [(0.0, 0.0) for word in [*words.values()][1:] if word.default is word.empty]
        line = re.escape(f"{name} = {value}: must be finite and positive, from {allowed}")
        with pytest.raises(ValueError, match=f"^{line}$"):
            function(SCENE, *required, **{name: value}, **({"step": 1e-3} if "level" in words else {}))


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda: SCENE.with_values([1.0]), "values = [1.0]: must be a table of values by key"),
        (lambda: reference.sensitivity(SCENE, "duration", len), "keys = 'duration': must be a list of keys"),
        (lambda: reference.sensitivity(SCENE, [3], len), "keys = [3]: must be a list of keys"),
        (
            lambda: reference.problem.load_family("fig3-I").to_xarray(["x"]),
            "results = ['x']: must be what amplification",
        ),
    ],
)
def test_an_object_of_another_kind_is_one_line(call: Callable[[], Any], line: str) -> None:
    with pytest.raises(TypeError, match=f"^{re.escape(line)}"):
        call()


def test_an_error_quotes_and_lists_no_more_than_it_says() -> None:
    assert quote("x" * 200) == f"'{'x' * 76}..."
    said = str(SceneError("a", "k", 1, "r", [SceneError("b", "j", n, "s") for n in range(52)]))
    assert said.startswith("a: k = 1: r; also b: j = 0: s; also b: j = 1: s; ")
    assert said.endswith("b: j = 48: s; and 3 more")


def test_numbers_of_other_kinds_are_numbers() -> None:
    assert SCENE.with_amplitude(Fraction(1, 2)) == SCENE.with_amplitude(0.5) == SCENE.with_amplitude(np.float32(0.5))
    np.testing.assert_array_equal(reference.phase_grid(np.int64(2)), reference.phase_grid(2))
    at_once = reference.problem.ground_acceleration(SCENE, (0.3, 1.1), 0.5)
    np.testing.assert_array_equal(at_once, reference.problem.ground_acceleration(SCENE, (0.3, 1.1), [0.5])[0])


@pytest.mark.parametrize("load", [reference.load_scene, reference.problem.load_family])
@pytest.mark.parametrize("wrong", [3, None, SCENE])
def test_what_is_no_path_of_a_scene_is_one_line(load: Callable[..., Any], wrong: object) -> None:
    with pytest.raises(TypeError, match=r"^source = .*: must be the name of a built-in scene or the path of a scene"):
        load(wrong)
