"""The manifest of a folder: the files in it that are the study's own, with a hash of each."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from reference.support.files import read_file

MANIFEST, SCHEMA = "manifest.json", "phase-resonance/manifest"
LARGEST = 2**30  # bytes of a file that may be the study's own


@dataclass(frozen=True)
class Own:
    """A file of the study: the command that wrote it, and the hashes it may have, two while it is being replaced."""

    command: str
    hashes: tuple[str, ...]


def list_foreign_files(folder: Path) -> list[str]:
    """Return what is in a folder and is not the study's own, as paths below it, sorted. Raises OSError."""
    manifest = read_manifest(folder)
    if not manifest:
        return sorted(os.listdir(folder))
    folders = {str(parent) for name in manifest for parent in Path(name).parents}
    foreign_files = []
    for path, is_folder in walk_folder(folder):
        name = path.relative_to(folder).as_posix()
        if name != MANIFEST and not (name in folders if is_folder else is_own(path, manifest.get(name))):
            foreign_files.append(name)
    # the files in a folder that is not ours say more than its name
    return sorted(name for name in foreign_files if not any(other.startswith(f"{name}/") for other in foreign_files))


def read_manifest(folder: Path) -> dict[str, Own]:
    """The files that the study wrote into a folder, by their paths below it; empty without a manifest of ours."""
    try:
        data = json.loads(read_file(folder / MANIFEST, LARGEST))
        if data["schema"] != SCHEMA:
            return {}
        files = {name: Own(entry["command"], tuple(entry["sha256"])) for name, entry in data["files"].items()}
        return {name: own for name, own in files.items() if ".." not in Path(name).parts and name[:1] != "/"}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def manifest_json(manifest: Mapping[str, Own]) -> bytes:
    """The list of a report's files as it is stored."""
    files = {
        name: {"command": manifest[name].command, "sha256": list(manifest[name].hashes)} for name in sorted(manifest)
    }
    return json.dumps({"schema": SCHEMA, "files": files}, indent=1).encode()


def walk_folder(folder: Path) -> Iterator[tuple[Path, bool]]:
    """
    Return all that is below a folder, and whether it is a folder itself, these before what they hold.

    Raises OSError.
    """
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        is_folder = entry.is_dir(follow_symlinks=False)
        yield Path(entry.path), is_folder
        if is_folder:
            yield from walk_folder(Path(entry.path))


def is_own(file: Path, entry: Own | None) -> bool:
    if entry is None or file.is_symlink() or not file.is_file():
        return False
    try:
        return hash_of(read_file(file, LARGEST)) in entry.hashes
    except OSError:
        return False


def hash_of(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
