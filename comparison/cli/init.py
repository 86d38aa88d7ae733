"""
`phase-resonance init DIRECTORY` writes a study to start from: scene, script, gate, continuous integration.

The directory appears whole or not at all, and never in the place of what somebody else wrote.
"""

import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from importlib.resources import files
from pathlib import Path

from comparison.cli.arguments import command, report_write_errors
from comparison.cli.requirement import make_requirement_line
from comparison.runner.output import make_parents, refuse_unwritable, resolve_destination
from reference.problem import SceneError
from reference.support.command import OneLineParser
from reference.support.files import NEW_FILES_FOLDER, staging_directory

DIRECTORY_ARGUMENT = "DIRECTORY"  # name of the command's argument in its help and its error messages
FILES_OF_TEMPLATE = {  # by path in a new study: template file to copy
    ".github/workflows/study.yml": "github.yml",
    ".gitignore": "gitignore",
    ".gitlab-ci.yml": "gitlab.yml",
    "README.md": "README.md",
    "building.toml": "building.toml",
    "requirements.txt": "requirements.txt",
    "study.py": "study.py",
    "test_building.py": "test_building.py",
}


@command
def main(argv: Sequence[str]) -> int:
    """Write a directory with a study to start from; return 0, 2 if it cannot be used, 3 if writing failed."""
    parser = OneLineParser("phase-resonance init", "A directory with a study to start from.")
    parser.add_argument(
        "directory", metavar=DIRECTORY_ARGUMENT, type=Path, help="a new one, or one that holds nothing but .git"
    )
    place = _find_free_directory(parser.parse_args(argv).directory)
    with report_write_errors(place, DIRECTORY_ARGUMENT):
        write_directory(place, make_study_files(place.resolve().name))
    print(f"{place}: a study to start from; README.md in it says how: change building.toml, then python study.py")
    if " @ file:" in make_requirement_line():
        print(
            "requirements.txt names a folder of this machine: continuous integration elsewhere needs another line there"
        )
    return 0


def make_study_files(name: str) -> dict[str, bytes]:
    """Return the contents of the files of a new study named `name`, by path in its directory."""
    folder = files("comparison.cli") / "study_template"
    texts = {file: (folder / source).read_text(encoding="utf-8") for file, source in FILES_OF_TEMPLATE.items()}
    source = make_requirement_line()
    return {
        file: text.replace("@NAME@", name).replace("@REQUIREMENT@", source).encode() for file, text in texts.items()
    }


def write_directory(place: Path, contents: Mapping[str, bytes]) -> None:
    """Write files (`contents`: bytes by path) into a new or empty directory, either all or none. Raises OSError."""
    inside = place.is_dir()  # Do not replace an existing directory: it may be the user's current one.
    made = make_parents(place.parent)
    try:
        with staging_directory(place / NEW_FILES_FOLDER if inside else place) as staging_folder:
            new = staging_folder / NEW_FILES_FOLDER
            for name, content in contents.items():
                (new / name).parent.mkdir(parents=True, exist_ok=True)
                (new / name).write_bytes(content)
            if inside:
                _move_entries(new, place)
            else:
                os.rename(new, place)
    except BaseException:
        for parent in made:
            with suppress(OSError):
                parent.rmdir()
        raise


def _move_entries(source: Path, target: Path) -> None:
    """Move all entries of a directory into another one on the same disk, or none of them. Raises OSError."""
    moved: list[Path] = []
    try:
        for entry in sorted(source.iterdir()):
            if os.path.lexists(target / entry.name):
                raise FileExistsError(f"{entry.name} appeared meanwhile")
            os.rename(entry, target / entry.name)
            moved.append(entry)
    except BaseException:
        for entry in moved:
            os.rename(target / entry.name, entry)
        raise


def _find_free_directory(path: Path) -> Path:
    """Return the directory for a new study. Raises SceneError if it cannot be made or is not empty."""
    refusal = partial(SceneError, "command line", DIRECTORY_ARGUMENT, str(path))
    if not str(path).isprintable():
        raise refusal("must be a name of printable characters")
    place = resolve_destination(path, DIRECTORY_ARGUMENT)
    try:
        taken = sorted({*os.listdir(place)} - {".git"}) if place.exists() else []
    except OSError as error:
        raise refusal(f"cannot be read: {error.strerror}") from None
    if taken:
        raise refusal(f"holds {taken[0]!r}: give a new directory, or one that is empty")
    refuse_unwritable(place, place, DIRECTORY_ARGUMENT)
    return place
