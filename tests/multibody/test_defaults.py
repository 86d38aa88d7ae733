"""Each default of the engine's functions has one name, and docstrings state its value."""

import ast
import inspect
import textwrap
from typing import Any

import pytest

import multibody
from multibody import defaults

NAMES = {
    "regularization": "DEFAULT_V_REG",
    "tolerance": "DEFAULT_TOLERANCE",
    "penetration": "DEFAULT_PENETRATION",
    "newton": "DEFAULT_NEWTON_TOLERANCE",
}
PUBLIC = [
    function
    for name in multibody.__all__
    if inspect.isfunction(function := getattr(multibody, name)) and function.__module__.startswith("multibody")
]


@pytest.mark.parametrize("function", PUBLIC, ids=lambda function: function.__name__)
def test_a_default_is_taken_by_its_name_and_stated_with_its_value(function: Any) -> None:
    wrapped = inspect.unwrap(function)
    [definition] = ast.parse(textwrap.dedent(inspect.getsource(wrapped))).body
    assert isinstance(definition, ast.FunctionDef)
    arguments, named = definition.args, 0
    given = [*zip(arguments.args[::-1], arguments.defaults[::-1]), *zip(arguments.kwonlyargs, arguments.kw_defaults)]
    for argument, default in given:
        if (name := NAMES.get(argument.arg)) is None:
            continue
        assert isinstance(default, ast.Name), f"{argument.arg} has a default without a name"
        assert default.id == name
        assert inspect.signature(function).parameters[argument.arg].default == getattr(defaults, name)
        named += 1
    assert named > 0
    text = " ".join((inspect.getdoc(function) or "").split())
    for name in NAMES.values():
        stated = text.split(f" (`{name}`)")[0].rpartition(" ")[2]
        assert f"`{name}`" not in text or stated == f"{getattr(defaults, name):g}"


def test_the_main_functions_state_their_defaults() -> None:
    for function, names in ((multibody.amplification, 2), (multibody.levels, 2), (multibody.single_run, 2)):
        assert sum(f"(`{name}`)" in (inspect.getdoc(function) or "") for name in NAMES.values()) == names
