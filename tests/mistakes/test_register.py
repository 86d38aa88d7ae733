"""The register follows the source: every mistake can be planted, and every test that should see it exists."""

import ast
from functools import cache

import pytest
from register import PACKAGES, ROOT, Mistake, mistakes_in

ALL = {f"{package} {n}": m for package in PACKAGES for n, m in enumerate(mistakes_in(package), 1)}


@cache
def _tests_of(file: str) -> set[str]:
    return {n.name for n in ast.walk(ast.parse((ROOT / file).read_text())) if isinstance(n, ast.FunctionDef)}


@pytest.mark.parametrize("mistake", ALL.values(), ids=ALL)
def test_a_planted_mistake_follows_the_source(mistake: Mistake) -> None:
    text = (ROOT / mistake.file).read_text(encoding="utf-8")
    assert text.count(mistake.right) == 1
    assert mistake.wrong != mistake.right
    assert mistake.breaks.endswith(".")
    assert bool(mistake.seen_by) != bool(mistake.equivalent)
    for test in mistake.seen_by:
        file, *names = test.partition("[")[0].split("::")
        assert set(names) <= _tests_of(file), test
    if mistake.file.endswith(".py"):  # what does not compile falls by any test that imports it
        compile(text.replace(mistake.right, mistake.wrong), mistake.file, "exec")


def test_no_mistake_is_planted_twice() -> None:
    places = [(mistake.file, mistake.right, mistake.wrong) for mistake in ALL.values()]
    assert len(places) == len(set(places))
