"""Errors for an invalid scene: one line with file, key, value and the rule that the value breaks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from reference.support.arguments import quote

MAX_LETTERS = 300  # largest number of letters of a path or key that an error message shows
MAX_ERRORS = 50  # largest number of errors of one file that a message lists; it only counts the others
# Smallest similarity (difflib) of an unknown key to a valid one for "did you mean ...?": other words share less
MIN_SPELLING_SIMILARITY = 0.7
# First words of the rule in an error about a missing key, a missing table and an unknown key
IS_REQUIRED, IS_MISSING, IS_UNKNOWN = "this key is required", "the table [", "unknown key; "
# What error messages tell users to write in place of keys that they know from other programs
YIELDING_HINT = (
    "friction that yields before it slides is a table: write friction = {slow = 0.05, initial_stiffness = 1e7}, N/m, "
    "or yield_displacement = 0.001, m"
)
ONE_SURFACE_HINT = (
    "one sliding surface is modeled: write radius and friction as one number each; two equal surfaces are one of the "
    "sum of their effective radii, a triple pendulum is not modeled (docs/guide/building.md)"
)
NO_DAMPER_HINT = (
    "the isolator has no damper but its friction: remove this key, or write lubrication in place of friction; "
    "damping belongs to a body, for the link below it"
)
EFFECTIVE_RADIUS_HINT = "write radius, the effective radius rho = R - r of the one sliding surface, m"
DERIVED_KEY_HINT = "follows from radius, friction and the weight: remove this key"
HINTS = {  # what to write in place of keys of other programs, by key or "table.key", reduced to letters and digits
    **dict.fromkeys(("bearings", "isolators"), "did you mean supports?"),
    **dict.fromkeys(("initialstiffness", "kinit", "kinitial", "k1", "k0", "elasticstiffness"), YIELDING_HINT),
    **dict.fromkeys(("uy", "dy", "yielddisplacement", "sheardisplacement", "preyieldstiffness"), YIELDING_HINT),
    **dict.fromkeys(("triple", "double", "surfaces", "radii", "r1", "r2", "l1", "l2", "mu1", "mu2"), ONE_SURFACE_HINT),
    **dict.fromkeys(
        ("radius1", "radius2", "friction1", "friction2", "doublependulum", "triplependulum"), ONE_SURFACE_HINT
    ),
    **dict.fromkeys(("isolator.damping", "isolator.dampingratio", "isolator.zeta", "isolator.c"), NO_DAMPER_HINT),
    **dict.fromkeys(
        ("effectiveradius", "reff", "radiusofcurvature", "curvature", "effectivelength", "leff"), EFFECTIVE_RADIUS_HINT
    ),
    **dict.fromkeys(("isolator.stiffness", "keff", "effectivestiffness", "k2", "effectivedamping"), DERIVED_KEY_HINT),
    **dict.fromkeys(("isolator.mu", "frictioncoefficient", "coefficientoffriction"), "write friction, without unit"),
    **dict.fromkeys(("displacementcapacity", "dmax", "umax", "maxdisplacement"), "write travel, m"),
    **dict.fromkeys(("bodies.dampingratio", "bodies.zeta", "bodies.xi"), "write damping, as a ratio of critical"),
    **dict.fromkeys(
        ("dampingratio", "modaldamping", "superstructuredamping", "structuraldamping", "rayleigh"),
        "write [superstructure] damping = 0.05, the ratio of critical of the first fixed-base mode",
    ),
    **dict.fromkeys(("bodies.name", "bodies.label", "bodies.title", "bodies.level"), "write floor, its name"),
    "bodies.weight": "write mass, kg: the weight in N over 9.81",
    **dict.fromkeys(("excitation.file", "excitation.accelerogram", "excitation.csv"), 'write record = "motion.csv"'),
    **dict.fromkeys(("excitation.factor", "excitation.scalefactor", "excitation.pga"), "write scale, a factor"),
    **dict.fromkeys(
        ("excitation.step", "excitation.dt", "excitation.unit", "excitation.units", "excitation.skip"),
        'write record = {file = "a.acc", step = 0.01, unit = "g"}',
    ),
}


class SceneError(ValueError):
    """
    Error for a scene that cannot be used; `str(error)` is one line: file, key, value, rule, and further errors.

    Parameters
    ----------
    file : str
        Scene file or name.
    key : str
        Dotted key, as "isolator.friction".
    value : object
        Value that the scene has there.
    rule : str
        What the value must be, or what to try.
    others : sequence of SceneError
        Further errors in the same file.
    """

    def __init__(self, file: str, key: str, value: Any, rule: str, others: Sequence[SceneError] = ()) -> None:
        """Set file, key, value and rule of the error, and the other errors in the same file."""
        self.file, self.key, self.value, self.rule, self.others = file, key, value, rule, tuple(others)
        shown = (self, *self.others[: MAX_ERRORS - 1])
        said = "; also ".join(
            f"{'' if error.file == file else f'{one_line(error.file)}: '}{error._sentence}" for error in shown
        )
        more = len(self.others) + 1 - MAX_ERRORS
        super().__init__(f"{one_line(file)}: {said}{f'; and {more} more' if more > 0 else ''}")

    @property
    def _sentence(self) -> str:
        """Return key, value and rule of the error as one sentence, without the file."""
        absent = self.value is None and self.rule.startswith((IS_REQUIRED, IS_MISSING))
        value = "" if absent else f" = {quote(self.value)}"
        return f"{one_line(self.key)}{value}: {printable(self.rule)}"

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, str, Any, str, Sequence[SceneError]]]:
        """Return the class and its arguments, from which pickle makes the error again in another process."""
        # Worker processes send their errors to the main process by pickle
        return SceneError, (self.file, self.key, self.value, self.rule, self.others)


class MisfitError(ValueError):
    """Error for scene values that are each valid but contradict each other; it becomes a SceneError with the file."""

    def __init__(self, key: str, value: Any, rule: str) -> None:
        """Set the key that the message names, its value, and the rule that the values break together."""
        self.key, self.value, self.rule = key, value, rule
        super().__init__(f"{key}: {rule}")


def one_line(text: str) -> str:
    """Return a text that fits in one line: cut to MAX_LETTERS letters, and escaped if it has control characters."""
    if len(text) > MAX_LETTERS:
        text = f"{text[: MAX_LETTERS - 3]}..."
    return text if text.isprintable() else repr(text)


def printable(text: str) -> str:
    """Return a text with all control characters replaced, so that a terminal cannot take them as commands."""
    return "".join(letter if letter.isprintable() else "\ufffd" for letter in text)


def keys_of_table(table: str, keys: Mapping[str, Sequence[str]]) -> Sequence[str]:
    """Return the valid keys of a table from `keys` by table, where "parent.*" stands for tables of any name in it."""
    return keys.get(table) or keys.get(f"{table.rpartition('.')[0]}.*", ())


def unknown_key(file: str, key: str, value: Any, valid: Sequence[str]) -> SceneError:
    """Return the error for an unknown key ("table.key") that proposes what to write, or the most similar valid keys."""
    *table, last = [part for part in key.split(".") if not part.isdecimal()] or [""]
    letters = "".join(filter(str.isalnum, last[:MAX_LETTERS].lower()))
    if hint := HINTS.get(f"{'.'.join(table)}.{letters}", HINTS.get(letters)):
        return SceneError(file, key, value, f"{IS_UNKNOWN}{hint}")
    nearest = get_close_matches(last[:MAX_LETTERS].lower(), valid, n=2, cutoff=MIN_SPELLING_SIMILARITY)
    suggestion = f"did you mean {' or '.join(nearest)}?" if nearest else f"the keys here are {', '.join(valid)}"
    return SceneError(file, key, value, f"{IS_UNKNOWN}{suggestion}")
