"""The register of planted mistakes: what is wrong in one place of a package, and which tests see it."""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = tuple(sorted(path.stem.removeprefix("in_") for path in Path(__file__).parent.glob("in_*.py")))


@dataclass(frozen=True)
class Mistake:
    """`wrong` in place of `right`, which stands once in `file`; `equivalent` says why no test can see it."""

    file: str
    right: str
    wrong: str
    breaks: str
    seen_by: tuple[str, ...] = ()
    equivalent: str = ""


def mistakes_in(package: str) -> tuple[Mistake, ...]:
    """The mistakes of one package, from the list MISTAKES of in_PACKAGE.py."""
    return tuple(import_module(f"in_{package}").MISTAKES)
