"""
Directions as the names of files and columns spell them, in one table.

East and along are x, north and across are y, up is z. Two azimuths are x and y in the order of their angles.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

HORIZONTAL, VERTICAL = "xy", "z"  # axes of horizontal directions, and of the vertical one
SPELLINGS = {  # words that name a direction, by axis
    "x": ("H1", "E", "W", "EW", "E-W", "WE", "EAST", "L", "LN", "LONG", "L1", "FN", "X", "HN1", "BH1", "HH1"),
    "y": ("H2", "N", "S", "NS", "N-S", "SN", "NORTH", "T", "TR", "TRAN", "TRANS", "T1", "FP", "Y", "HN2", "BH2", "HH2"),
    "z": ("V", "UP", "UD", "U-D", "U", "DN", "DOWN", "DWN", "VER", "VERT", "VERTICAL", "Z", "HN3", "BH3", "HH3"),
}
CHANNEL_BANDS = ("BH", "BN", "EH", "EN", "HG", "HH", "HL", "HN")  # SEED channel codes that precede E, N, Z
AXIS_OF = {word: axis for axis, words in SPELLINGS.items() for word in words}  # axis that each word names
AXIS_OF |= {f"{band}{end}": axis for band in CHANNEL_BANDS for end, axis in zip("ENZ", "xyz")}
MAX_WORD_LETTERS = max(map(len, AXIS_OF))  # letters of the longest word for a direction
WORD_INSIDE_NAME = re.compile(  # channel code between separators inside the name of a file
    rf"(?P<base>.+[._-])(?P<word>(?:{'|'.join(CHANNEL_BANDS)})[ENZ123])(?P<rest>[._-].+)", re.IGNORECASE
)
WORD_AS_SUFFIX = re.compile(r"(?P<word>EW|NS|UD)(?P<rest>[12]?)", re.IGNORECASE)  # direction as suffix of a file
# Degrees: two azimuths this far apart count as horizontal components at a right angle; few instruments are farther off
RIGHT_ANGLE_RANGE = 75.0, 105.0
KNOWN_SPELLINGS = (  # examples of spellings of directions, for an error
    "H1 H2 V, azimuths as 090, E N Z, EW NS UD, L T V, LN TR, L1 T1, FN FP, UP DWN, HNE HNN HNZ, N18E S72E, X Y Z"
)


@dataclass(frozen=True)
class Direction:
    """A direction as the name of a file or column spells it."""

    word: str
    axis: str  # "x", "y" or "z"; "" for an azimuth, whose axis depends on the other component
    azimuth: float | None = None  # degrees from north to east; None for a direction that is no azimuth


def parse_direction(word: str) -> Direction | None:
    """Return the direction that a word names; None for any other word."""
    upper = word.upper()
    if upper in AXIS_OF:
        return Direction(word, AXIS_OF[upper])
    if re.fullmatch(r"[0-3][0-9]{2}", upper) and int(upper) <= 360:
        return Direction(word, "", azimuth=float(upper))
    quadrant = re.fullmatch(r"([NS])([0-9]{1,2})([EW])", upper)
    if quadrant is None or int(quadrant[2]) > 90:
        return None
    north, angle, east = quadrant[1] == "N", float(quadrant[2]), quadrant[3] == "E"
    # N18E is 18 degrees, S72E 180 - 72 degrees from north to east
    turned = angle if north == east else -angle
    return Direction(word, "", azimuth=(turned if north else 180.0 + turned) % 360.0)


def axis_of_word(word: str) -> str:
    """Return the axis of a direction such as NS; "" for an azimuth and for any other word."""
    direction = parse_direction(word)
    return "" if direction is None else direction.axis


def split_name(stem: str, suffix: str = "") -> list[tuple[str, Direction]]:
    """
    Return every way to split a file's name into the name of a motion and a direction, the most likely one first.

    stem, suffix: of the file's name. The direction may be its end, a channel code inside it, or its suffix.
    """
    found = []
    for length in range(min(MAX_WORD_LETTERS, len(stem) - 1), 0, -1):  # a longer word is tried first: DWN before N
        direction, base = parse_direction(stem[-length:]), stem[:-length].rstrip("-_. ")
        if direction is not None and base:
            found.append((base, direction))
    if (inside := WORD_INSIDE_NAME.fullmatch(stem)) and (direction := parse_direction(inside["word"])):
        found.append((inside["base"].rstrip("-_. ") + inside["rest"], direction))
    if (ending := WORD_AS_SUFFIX.fullmatch(suffix.lstrip("."))) and (direction := parse_direction(ending["word"])):
        found.insert(0, (f"{stem}{'-' if ending['rest'] else ''}{ending['rest']}", direction))
    return found


def assign_axes(directions: Sequence[Direction]) -> Mapping[str, int] | None:
    """
    Return for x, y and z the index of the direction that is this axis; None where the names do not determine it.

    The directions must be two horizontal ones and at most one vertical one. Of two azimuths the smaller one is x.
    """
    level = [number for number, one in enumerate(directions) if one.axis != VERTICAL]
    upright = [number for number, one in enumerate(directions) if one.axis == VERTICAL]
    if len(level) != 2 or len(upright) > 1:
        return None
    first, second = sorted(level, key=lambda number: (directions[number].axis, directions[number].word.upper()))
    one, other = directions[first], directions[second]
    if one.azimuth is not None and other.azimuth is not None:
        apart = abs(one.azimuth - other.azimuth) % 180.0
        if not RIGHT_ANGLE_RANGE[0] <= apart <= RIGHT_ANGLE_RANGE[1]:
            return None
        first, second = sorted(level, key=lambda number: (directions[number].azimuth, directions[number].word))
    elif one.axis == other.axis:
        return None
    elif "" in (one.axis, other.axis):  # one is an azimuth, the other a word
        first, second = sorted(level, key=lambda number: directions[number].word.upper())
    return dict(zip("xyz", (first, second, *upright)))
