"""Manifest of a folder: the files in it that the study wrote, with a hash of each."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from reference.support.files import read_file

MANIFEST = "manifest.json"  # name of the file that lists the files which the study wrote into its folder
SCHEMA = "phase-resonance/manifest"  # text by which such a list is known
MAX_FILE_BYTES = 2**30  # size in bytes above which a file is not read and counts as not written by the study


@dataclass(frozen=True)
class OwnedFile:
    """
    File that the study wrote.

    command: the command that wrote it. hashes: hash of its content; while it is being replaced, of old and new content.
    """

    command: str
    hashes: tuple[str, ...]


def list_foreign_files(folder: Path) -> list[str]:
    """Return the paths in a folder of files that the study did not write, sorted. Raises OSError."""
    manifest = read_manifest(folder)
    if not manifest:
        return sorted(os.listdir(folder))
    folders = {str(parent) for name in manifest for parent in Path(name).parents}
    foreign_files = []
    for path, is_folder in walk_folder(folder):
        name = path.relative_to(folder).as_posix()
        if name != MANIFEST and not (name in folders if is_folder else is_own_file(path, manifest.get(name))):
            foreign_files.append(name)
    # Leave out folders whose files are listed themselves.
    return sorted(name for name in foreign_files if not any(other.startswith(f"{name}/") for other in foreign_files))


def read_manifest(folder: Path) -> dict[str, OwnedFile]:
    """Return the files that the study wrote into a folder, by path; empty if it has no manifest of the study."""
    try:
        data = json.loads(read_file(folder / MANIFEST, MAX_FILE_BYTES))
        if data["schema"] != SCHEMA:
            return {}
        files = {name: OwnedFile(entry["command"], tuple(entry["sha256"])) for name, entry in data["files"].items()}
        return {name: own for name, own in files.items() if ".." not in Path(name).parts and name[:1] != "/"}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def format_manifest(manifest: Mapping[str, OwnedFile]) -> bytes:
    """Return the manifest (list of written files) as the bytes of its JSON file."""
    files = {
        name: {"command": manifest[name].command, "sha256": list(manifest[name].hashes)} for name in sorted(manifest)
    }
    return json.dumps({"schema": SCHEMA, "files": files}, indent=1).encode()


def walk_folder(folder: Path) -> Iterator[tuple[Path, bool]]:
    """
    Yield every path below a folder, with True if it is a folder; a folder comes before its content.

    Raises OSError.
    """
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        is_folder = entry.is_dir(follow_symlinks=False)
        yield Path(entry.path), is_folder
        if is_folder:
            yield from walk_folder(Path(entry.path))


def is_own_file(file: Path, entry: OwnedFile | None) -> bool:
    """Return whether a file has the content that the study wrote; entry: its line of the manifest, None without."""
    if entry is None or file.is_symlink() or not file.is_file():
        return False
    try:
        return hash_content(read_file(file, MAX_FILE_BYTES)) in entry.hashes
    except OSError:
        return False


def hash_content(content: bytes) -> str:
    """Return the SHA-256 hash of a file's content, in hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()
