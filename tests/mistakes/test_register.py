"""The register follows the source: every mistake can be planted, and every test that should see it exists."""

import ast
from functools import cache

from register import PACKAGES, ROOT, Mistake, mistakes_in

ALL = {f"{package} {n}": m for package in PACKAGES for n, m in enumerate(mistakes_in(package), 1)}


@cache
def _tests_of(file: str) -> set[str]:
    return {n.name for n in ast.walk(ast.parse((ROOT / file).read_text())) if isinstance(n, ast.FunctionDef)}


def _find_fault(mistake: Mistake) -> str:
    """Return what keeps a mistake from being planted or seen, an empty text if nothing does."""
    text = (ROOT / mistake.file).read_text(encoding="utf-8")
    if text.count(mistake.right) != 1:
        return f"stands {text.count(mistake.right)} times in {mistake.file}: {mistake.right}"
    if mistake.wrong == mistake.right or not mistake.breaks.endswith("."):
        return f"changes nothing, or does not say what it breaks: {mistake.breaks}"
    if bool(mistake.seen_by) == bool(mistake.equivalent):
        return "is neither seen by a test nor equivalent, or both"
    for test in mistake.seen_by:
        file, *names = test.partition("[")[0].split("::")
        if not set(names) <= _tests_of(file):
            return f"no test {test}"
    if mistake.file.endswith(".py"):  # what does not compile falls by any test that imports it
        try:
            compile(text.replace(mistake.right, mistake.wrong), mistake.file, "exec")
        except SyntaxError as error:
            return f"does not compile: {error}"
    return ""


def test_every_planted_mistake_follows_the_source() -> None:
    assert {name: fault for name, mistake in ALL.items() if (fault := _find_fault(mistake))} == {}


def test_no_mistake_is_planted_twice() -> None:
    planted = {}
    for name, mistake in ALL.items():
        text = (ROOT / mistake.file).read_text(encoding="utf-8").replace(mistake.right, mistake.wrong)
        planted.setdefault((mistake.file, text), []).append(name)
    assert [names for names in planted.values() if len(names) > 1] == []
