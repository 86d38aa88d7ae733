"""Every pattern of the project works in proportion to the length of the text that it is held against."""

import inspect
import re
import sys
import time
from collections.abc import Iterator
from importlib import import_module
from pkgutil import walk_packages

import pytest

import comparison
import multibody
import reference

PIECES = (" ", "a", "9", ".", "_", "=", '"', "(", "[", "`", "a.", "a ", "Cause: ")
BEGINNINGS = ("", "UNITS", "ax [", "a=a:a", '"', "9")
LENGTHS = 500, 1_000, 20_000  # letters; a pattern that needs the cube of them never ends at the last
MOMENT = 0.3  # s of processor time; what grows as the square takes more


def patterns() -> Iterator[tuple[str, re.Pattern[str], str]]:
    """The patterns of all modules, each with a method that its module calls."""
    for package in (reference, multibody, comparison):
        for found in walk_packages(package.__path__, f"{package.__name__}."):
            if not found.name.endswith("__main__"):
                import_module(found.name)
    for name, module in sorted(sys.modules.items()):
        if name.split(".")[0] in ("reference", "multibody", "comparison"):
            for constant, value in sorted(vars(module).items()):
                if isinstance(value, re.Pattern):
                    methods = set(re.findall(rf"\b{constant}\.(\w+)\(", inspect.getsource(module)))
                    assert methods, f"{name}.{constant} is not used where it is made"
                    yield from ((f"{name}.{constant}", value, method) for method in sorted(methods))


def slow_text(pattern: re.Pattern[str], method: str) -> str:
    """A text that takes more than a moment, as its beginning and its piece; empty if none is known."""
    apply = getattr(pattern, method)
    for length in LENGTHS:
        for beginning in BEGINNINGS:
            for piece in PIECES:
                text = f"{beginning}{piece * (length // len(piece))}\0"
                begin = time.process_time()
                found = apply("", text) if method == "sub" else apply(text)
                if method == "finditer":
                    list(found)
                if time.process_time() - begin > MOMENT:
                    return f"{beginning!r}, then {length} letters of {piece!r}"
    return ""


def test_no_pattern_takes_more_than_a_moment_on_a_long_text() -> None:
    tried = list(patterns())
    assert len(tried) >= 10
    assert {name: slow for name, pattern, method in tried if (slow := slow_text(pattern, method))} == {}


@pytest.mark.parametrize(
    ("pattern", "method"),
    [(r"(\w+)\s*(?:[\[(]\s*(.*?)\s*[\])])?", "fullmatch"), (r"[0-9]+\.?[0-9]*", "fullmatch")],
)
def test_patterns_that_try_every_division_of_a_text_are_found(pattern: str, method: str) -> None:
    assert slow_text(re.compile(pattern), method)
