"""Each default of both sides has one name, and docstrings state its value."""

import ast
import inspect
import textwrap
from typing import Any

import pytest

import multibody
import multibody.defaults
import reference
import reference.defaults
from comparison.cli.options import parse_options
from comparison.study.study import STUDY_TOLERANCE
from comparison.testing import assert_consistent

NAMES = {
    "multibody": {
        "regularization": "DEFAULT_V_REG",
        "tolerance": "DEFAULT_TOLERANCE",
        "penetration": "DEFAULT_PENETRATION",
        "newton": "DEFAULT_NEWTON_TOLERANCE",
    },
    "reference": {"tolerance": "DEFAULT_TOLERANCE"},
}
DEFAULTS = {"multibody": multibody.defaults, "reference": reference.defaults}
PUBLIC = [
    (side.__name__, function)
    for side in (multibody, reference)
    for name in side.__all__
    if inspect.isfunction(function := getattr(side, name))
    and function.__module__.startswith(side.__name__)
    and not NAMES[side.__name__].keys().isdisjoint(inspect.signature(function).parameters)
]


@pytest.mark.parametrize(("side", "function"), PUBLIC, ids=lambda each: getattr(each, "__name__", each))
def test_a_default_is_taken_by_its_name_and_stated_with_its_value(side: str, function: Any) -> None:
    wrapped, names, defaults = inspect.unwrap(function), NAMES[side], DEFAULTS[side]
    [definition] = ast.parse(textwrap.dedent(inspect.getsource(wrapped))).body
    assert isinstance(definition, ast.FunctionDef)
    arguments, named = definition.args, 0
    given = [*zip(arguments.args[::-1], arguments.defaults[::-1]), *zip(arguments.kwonlyargs, arguments.kw_defaults)]
    for argument, default in given:
        if (name := names.get(argument.arg)) is None:
            continue
        assert isinstance(default, ast.Name), f"{argument.arg} has a default without a name"
        assert default.id == name
        assert inspect.signature(function).parameters[argument.arg].default == getattr(defaults, name)
        named += 1
    assert named > 0
    text = " ".join((inspect.getdoc(function) or "").split())
    for name in names.values():
        stated = text.split(f" (`{name}`)")[0].rpartition(" ")[2]
        assert f"`{name}`" not in text or stated == f"{getattr(defaults, name):g}"


def test_the_main_functions_state_their_defaults() -> None:
    stating = (
        (multibody.amplification, 2),
        (multibody.levels, 2),
        (multibody.single_run, 2),
        (reference.amplification, 1),
        (reference.trajectory, 1),
    )
    for function, count in stating:
        names = NAMES[function.__module__.partition(".")[0]]
        assert sum(f"(`{name}`)" in (inspect.getdoc(function) or "") for name in names.values()) == count


def test_a_study_asks_of_its_models_what_the_engine_asks_of_itself() -> None:
    assert STUDY_TOLERANCE == multibody.defaults.DEFAULT_TOLERANCE
    assert inspect.signature(assert_consistent).parameters["tolerance"].default == STUDY_TOLERANCE
    assert parse_options(["fig3-I", "--plan"]).tolerance == STUDY_TOLERANCE
