"""Every public name says what it takes and gives, and its examples run."""

import doctest
import inspect
from enum import Enum
from types import ModuleType
from typing import Any

import pytest

import multibody
import reference
import reference.problem

PACKAGES = (reference, reference.problem, multibody)
CONSTANTS = {"ADVICE", "GRAVITY", "MAX_WORK"}  # explained in the docstring of their package
NAMES = [
    pytest.param(package, name, id=f"{package.__name__}.{name}")
    for package in PACKAGES
    for name in package.__all__
    if name not in CONSTANTS
]


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.__name__)
def test_a_package_lists_its_names_and_its_examples_run(package: ModuleType) -> None:
    text = inspect.getdoc(package) or ""
    assert 0 < text.index("Functions\n---------") < text.index("Classes\n-------")
    listed = text.replace(",", " ").split()
    assert [name for name in package.__all__ if name not in listed] == []
    assert set(package.__all__) <= set(dir(package))
    for test in doctest.DocTestFinder(recurse=False).find(package, package.__name__):
        assert doctest.DocTestRunner().run(test).failed == 0


@pytest.mark.parametrize(("package", "name"), NAMES)
def test_a_public_name_explains_its_arguments_and_its_examples_run(package: ModuleType, name: str) -> None:
    public: Any = getattr(package, name)
    text = inspect.getdoc(public) or ""
    assert text, f"{name} has no docstring"
    if inspect.isfunction(public):
        parameters = inspect.signature(public).parameters
        if parameters:
            assert "Parameters\n----------" in text
            section = text.split("Parameters\n----------")[1].split("\n\n")[0]
            missing = [argument for argument in parameters if argument not in section]
            assert missing == [], f"{name} does not explain {missing}"
        assert "Returns\n-------" in text
        assert "Examples\n--------" in text
    elif not issubclass(public, Enum):
        assert "Attributes\n----------" in text or "Parameters\n----------" in text
        missing = [field for field in getattr(public, "__dataclass_fields__", ()) if field not in text]
        assert missing == [], f"{name} does not explain {missing}"
    imported = {known: getattr(reference.problem, known) for known in reference.problem.__all__}
    for test in doctest.DocTestFinder().find(public, name, globs=imported):
        result = doctest.DocTestRunner().run(test)
        assert result.failed == 0, f"{test.name}: {result.failed} of {result.attempted} examples fail"
