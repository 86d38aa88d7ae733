"""
Numbers that pages state in sentences: the words about each, and its value as recorded.

Whatever the words match on any page must be the value, so that one thing has one number.
"""

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import evidence_table

from comparison.evidence.sides import EQUATIONS
from comparison.evidence.validation.frame import Setup
from comparison.evidence.validation.table import load_record
from comparison.verdicts import NOT_MET


class Stated(NamedTuple):
    """One number: what it is, words with the number as their group, its value, pages on which it must stand."""

    what: str
    words: str
    value: str
    pages: tuple[str, ...]


def numbers_of(stated: Stated, texts: Mapping[Path, str]) -> list[tuple[Path, str]]:
    """Every number that pages state for one thing."""
    return [(page, number) for page, text in texts.items() for number in re.findall(stated.words, text)]


STORE = json.loads(evidence_table.STORE.read_text(encoding="utf-8"))
FACTS = "\n".join((*load_record().inputs, *load_record().facts))
CLOSED_FORMS = ("free_coulomb_decay", "swing_down", "conical_pendulum_turns", "den_hartog", "circles_over")
CONTACT = ("the_weight_presses", "held_platform", "sliding_stops", "planar_sliding", "conical_pendulum_keeps")
SETUP = Setup()
DAMPING = SETUP.damping / (2.0 * math.sqrt(SETUP.stiffness * SETUP.mass))


def _largest(names: tuple[str, ...]) -> float:
    return max(found["value"] for test, found in STORE.items() if any(name in test for name in names))


def _short(value: float, digits: int) -> str:
    """A number with its exponent, without its zeros: 6e-9."""
    return re.sub(r"e-0", "e-", f"{value:.{digits}e}")


def _in_facts(pattern: str) -> str:
    found = re.search(pattern, FACTS)
    assert found, pattern
    return found[1]


(_mastodon,) = (each for each in evidence_table.published().benchmarks if each.name == "mastodon")
_off = sum(row.numbers[EQUATIONS].verdict == NOT_MET for row in _mastodon.rows)
_multibody = (evidence_table.DOCS / "records/multibody.md").read_text(encoding="utf-8")
_like_for_like = re.search(r"\| fig3-II, 1e-3, 256 \|[^|]*\|[^|]*\| ([\d.e-]+),", _multibody)
assert _like_for_like

RATIOS = re.findall(r"frame, \d+ g: the friction ratio of this run alone is ([\d.]+);", FACTS)
assert sorted(RATIOS) == RATIOS, "they rise with the load"

STATED = (
    Stated(
        "closed forms of the equations",
        r"SciPy, event by event \| ([\d.e-]+);",
        _short(_largest(CLOSED_FORMS), 0),
        ("README.md",),
    ),
    Stated(
        "closed forms of the engine",
        r"second order in its step \| ([\d.e-]+);",
        _short(_largest(CONTACT), 1),
        ("README.md",),
    ),
    Stated(
        "order of the engine",
        r"2\.00 ± ([\d.]+)",
        f"{_largest(('without_stops_is_of_second_order',)):.2g}",
        ("README.md",),
    ),
    Stated(
        "loops of a bearing",
        r"(?:loops agree|forces) within ([\d.]+) %",
        f"{100.0 * _largest(('loops_of_a_bearing',)):.1g}",
        ("README.md", "docs/reference.md"),
    ),
    Stated(
        "displacements of MASTODON",
        r"(\d of \d) displacements not met",
        f"{_off} of {len(_mastodon.rows)}",
        ("README.md",),
    ),
    Stated(
        "like for like, fig3-II",
        r"256 random phases of `fig3-I` and of `fig3-II` \| ([\d.e-]+),",
        _like_for_like[1],
        ("README.md",),
    ),
    Stated(
        "damping of the frame", r"damper C, ([\d.]+) % of critical", f"{100.0 * DAMPING:.2g}", ("docs/validation.md",)
    ),
    Stated(
        "second harmonic of the base",
        r"second harmonic of ([\d.]+) % of the first",
        _in_facts(r"measured one, ([\d.]+) % of the first"),
        ("docs/validation.md",),
    ),
    Stated(
        "lopsided motion of the frame",
        r"at 350 g the measured plate is above its middle for (\d+) %",
        _in_facts(r"frame, 350 g: .*above its middle for (\d+) %"),
        ("docs/validation.md",),
    ),
    Stated(
        "friction ratios of the runs",
        r"rises with the load, contrary to Coulomb's law: ([\d., ]+)\.\n",
        ", ".join(RATIOS),
        ("docs/validation.md",),
    ),
    Stated(
        "runs of the fit",
        r"fitted to the runs with (\d+ and \d+ g)",
        " and ".join(re.findall(r"motion of the run with (\d+)", FACTS)) + " g",
        ("docs/validation.md",),
    ),
)
