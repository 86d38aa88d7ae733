"""Pairing of the components of motions by what the names of their files have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from reference.records.directions import KNOWN_SPELLINGS, Direction, assign_axes, split_name
from reference.records.motion_lists import COLUMNS, FILE_NAME, Motion
from reference.support.arguments import name_some, quote

MAX_NAMED = 20  # largest number of files that an error message names


class SuiteError(ValueError):
    """Error for an invalid suite of ground motions, or for a motion that a suite does not have."""

    def __init__(self, key: str, rule: str) -> None:
        """Set the key of the scene's `record` whose entry is wrong, and the rule that this entry breaks."""
        super().__init__(f"{key}: {rule}")
        self.key, self.rule = key, rule


def _group_files(files: Sequence[Path]) -> dict[str, dict[Path, tuple[str, Direction]]]:
    """
    Return groups of files whose names differ in the direction alone, by the name without it in upper case.

    A group maps each file to its name without the direction, and to the direction. A file may be in several groups.
    """
    groups: dict[str, dict[Path, tuple[str, Direction]]] = {}
    for file in files:
        for base, direction in split_name(file.stem, file.suffix):
            groups.setdefault(base.upper(), {}).setdefault(file, (base, direction))
    return groups


def pair_files(files: Sequence[Path]) -> list[Motion]:
    """Return the motions whose components the files hold, paired by name. Raises SuiteError if a file has no pair."""
    # As a name may be split in several ways, the largest groups are tried first, and among these the shortest names.
    groups, left, motions = _group_files(files), set(files), []
    for base in sorted(groups, key=lambda base: (-len(groups[base]), len(base))):
        members = [file for file in groups[base] if file in left]
        axes = assign_axes([groups[base][file][1] for file in members])
        if axes is not None:
            paired = {axis: members[number] for axis, number in axes.items()}
            motions.append(Motion(groups[base][paired["x"]][0], paired))
            left -= set(members)
    if left:
        raise SuiteError("suite", _word_unpaired_files([file for file in files if file in left], groups))
    return sorted(motions, key=lambda motion: min(motion.files.values()))


def find_motion(file: Path, files: Sequence[Path]) -> Motion:
    """Return the motion that a file belongs to: all files of its group are its components, or this file alone is."""
    for members in _group_files(files).values():
        if file in members and (axes := assign_axes([one for _, one in members.values()])) is not None:
            return Motion(members[file][0], {axis: [*members][number] for axis, number in axes.items()})
    return Motion(file.stem, {"x": file})


def _word_unpaired_files(files: Sequence[Path], groups: Mapping[str, Mapping[Path, tuple[str, Direction]]]) -> str:
    """Return the error message that lists the files left without a pair, and why. groups: from `_group_files`."""
    by_base: dict[str, list[Path]] = {}  # files by the name without direction of their largest group
    for file in files:
        bases = [base.upper() for base, _ in split_name(file.stem, file.suffix)]
        largest = max(bases, key=lambda base: (len(groups[base]), -len(base)), default="")
        by_base.setdefault(largest, []).append(file)
    said: list[str] = []
    incomplete: dict[str, list[str]] = {}  # names of motions by the components that were found
    for base, alone in by_base.items():
        directions = [groups[base][file][1] for file in alone] if base else []
        angles = [f"{one.azimuth:g}" for one in directions if one.azimuth is not None]
        upright = sum(one.axis == "z" for one in directions)
        if not base:
            said.append(f"{_list_names([file.name for file in alone])}: no direction at the end of the name")
        elif len(angles) == len(directions) >= 2:
            numbers = f"numbers {', '.join(angles[:3])}"
            said.append(f"{_list_names([file.name for file in alone])}: {numbers} are no azimuths across each other")
        else:
            found = f"{len(directions) - upright} horizontal and {upright} vertical"
            incomplete.setdefault(found, []).append(groups[base][alone[0]][0])
    for found, names in incomplete.items():
        said.append(
            f"{_list_names(names)} {'has' if len(names) == 1 else 'have'} {found} components: must have 2, and 0 or 1"
        )
    return (
        f"{'; '.join(said[:MAX_NAMED])}{f'; and {len(said) - MAX_NAMED} more' if len(said) > MAX_NAMED else ''}. "
        f"Tried {KNOWN_SPELLINGS}. Complete the motions, list them in {FILE_NAME} ({', '.join(COLUMNS)}), "
        "or take every file as a motion along x: components = 1"
    )


def _list_names(names: Sequence[str]) -> str:
    """Return text that lists names in quotes, at most MAX_NAMED of them."""
    return name_some([quote(name) for name in names], MAX_NAMED)


def find_vertical_components(files: Sequence[Path]) -> set[Path]:
    """Return the files that hold the vertical component of a motion whose other components are among the files too."""
    groups = _group_files(files).values()
    return {file for members in groups if len(members) > 1 for file, (_, one) in members.items() if one.axis == "z"}
