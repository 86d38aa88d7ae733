"""
The folders that commands write for the user: reports, tables, figures.

Every such folder holds a manifest of the files that this study wrote there, with a hash of each. A file is the study's
own if it is as the manifest says, and everything else is the user's. Only the study's own files are replaced or
removed; where something else is in the way the new ones go to a new name next to it.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from comparison.runner.cache import locate_store
from comparison.runner.manifest import (
    MANIFEST,
    Own,
    hash_of,
    is_own,
    list_foreign_files,
    manifest_json,
    read_manifest,
    walk_folder,
)
from reference.problem import SceneError
from reference.support.files import (
    NEW_FILES_FOLDER,
    TEMPORARY_PREFIX,
    clear_staging,
    find_abandoned_staging,
    hold_lock,
    iterate_names,
    staging_directory,
    write_atomically,
    write_new,
)

if TYPE_CHECKING:
    import xarray as xr

REPORT = "comparison.run"  # the command whose files make up a report; those of others in the folder stay
PAGE = "index.html"
FULL_NAME = 240  # bytes of a name: the names made from it are longer


def on_stderr(line: str) -> None:
    """Say a line where it does not mix with results."""
    print(line, file=sys.stderr)


def resolve_destination(path: Path, option: str = "--out") -> Path:
    """The folder that a path means, without symbolic links and "..". Raises SceneError where none can be made."""
    refusal = partial(SceneError, "command line", option, str(path))
    if path.name == ".." and set(path.parts) != {".."}:
        raise refusal("ends in '..': give the directory by its name")
    try:
        place = path.resolve()
        str(place).encode()
        if place.is_symlink():  # no older version of Python gets this far
            raise RuntimeError
        if len(place.name.encode()) > FULL_NAME:
            raise refusal(f"has a name of more than {FULL_NAME} bytes: give a shorter one")
        if place.exists() and not place.is_dir():
            raise refusal("is a file: give a directory")
        if not place.name:
            raise refusal("is the root directory: give a directory inside it")
        parent = next(parent for parent in place.parents if parent.exists())
        if not parent.is_dir():
            raise refusal("cannot be written: Not a directory")
    except UnicodeError:
        raise refusal("is not text in UTF-8: give a path that is") from None
    except RuntimeError:  # raised by older versions of Python
        raise refusal("is a symbolic link that leads back to itself: give another directory") from None
    except OSError as error:
        raise refusal(f"cannot be used: {error.strerror}: give another directory") from None
    # a path that means what it says stays as it was typed, for the messages; "." has no name for the store
    return path if path.name and Path(os.path.abspath(path)) == place and ".." not in path.parts else place


def refuse_foreign_report(out: Path) -> None:
    """Raise SceneError, one line, if a report cannot take the place of what is at `out`, a destination."""
    refusal = partial(SceneError, "command line", "--out", str(out))
    place = out.resolve()
    refuse_other_page(out, REPORT)
    if place.exists():
        if Path.cwd().resolve().is_relative_to(place):
            raise refusal("is the directory you work in: give one inside it")
        if os.path.ismount(place):
            raise refusal("is a mount point, which cannot be replaced: give a directory inside it")
        try:
            foreign_files = list_foreign_files(place)
        except OSError as error:
            raise refusal(f"cannot be read: {error.strerror}: give another directory") from None
        if foreign_files and not read_manifest(place):
            raise refusal("exists and is not a report of this study: give another directory, or empty this one")
        if foreign_files:
            raise refusal(f"the report there also holds {foreign_files[0]!r}, which would be lost: move it away")
    refuse_unwritable(out, place.parent)


def refuse_foreign_files(out: Path, names: Sequence[str]) -> None:
    """Raise SceneError, one line, if files of these names in `out`, a destination, would replace ones of the user."""
    manifest = read_manifest(out)
    for name in names if manifest else (MANIFEST, *names):
        if os.path.lexists(out / name) and not is_own(out / name, manifest.get(name)):
            rule = f"holds {name!r}, which this study did not write: move it away, or give another directory"
            raise SceneError("command line", "--out", str(out), rule)
    refuse_unwritable(out, out)


def refuse_other_page(out: Path, command: str) -> None:
    """Raise SceneError, one line, if the page in `out` is that of another command: two answers need two folders."""
    page = read_manifest(out).get(PAGE)
    if page is not None and page.command != command:
        name = page.command.rpartition(".")[2]
        rule = f"holds the page of `{name}`, of this building or another: give a directory of its own"
        raise SceneError("command line", "--out", str(out), rule)


def refuse_unwritable(out: Path, folder: Path, option: str = "--out") -> None:
    """Raise SceneError, one line, if nothing can be made in `folder`, or where it will be."""
    try:
        existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
        tempfile.TemporaryDirectory(dir=existing, prefix=TEMPORARY_PREFIX).cleanup()
        locate_store(out.absolute()).exists()
    except OSError as error:
        raise SceneError("command line", option, str(out), f"cannot be written: {error.strerror}") from None


@dataclass
class StagedReport:
    """A report that is being written into `folder`, and where it goes."""

    folder: Path
    place: Path


@contextmanager
def replace_report(out: Path) -> Iterator[StagedReport]:
    """
    A new folder to write a report into; if the block ends without exception its files go to `out`, each whole.

    What the report there has no more is removed, and files of other commands are kept. If anything but the study's own
    files is there by then all of it stays and the report goes to a new name, which a line on standard error says. After
    the block `place` of the report is where it is.
    """
    place = out.resolve()
    made = make_parents(place.parent)
    try:
        with staging_directory(place) as staging_folder:
            report = StagedReport(staging_folder / NEW_FILES_FOLDER, place)
            yield report
            # a thread of its own: what interrupts this one interrupts no move
            with hold_lock(place.parent), ThreadPoolExecutor(1) as mover:
                report.place = mover.submit(_install_report, report.folder, place).result()
    except BaseException:
        with suppress(OSError):
            for parent in made:
                parent.rmdir()
        raise


def clear_dead(out: Path) -> None:
    """Remove the unfinished reports that killed runs left next to `out`."""
    for staging_folder in find_abandoned_staging(out.resolve()):
        clear_staging(staging_folder)


def publish_files(folder: Path, files: Mapping[str, bytes], command: str) -> list[Path]:
    """Write files of a command into a folder; one that is not the study's stays, and is said. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    with hold_lock(folder.resolve().parent):
        for name, content in files.items():
            file, digest, manifest = folder / name, hash_of(content), read_manifest(folder)
            ours = is_own(file, manifest.get(name))
            if ours or not os.path.lexists(file):  # noted before: whatever ends the writing, the file remains ours
                _write_manifest(folder, manifest | {name: _old_or_new(manifest.get(name), Own(command, (digest,)))})
            if ours:
                write_atomically(file, content)
            else:
                file = write_new(file, content)
            if file.name != name:
                on_stderr(f"{str(folder / name)!r} is not a file of this study and stays: see {file.name!r} next to it")
                _write_manifest(folder, manifest | {file.name: Own(command, (digest,))})
            written.append(file)
    return written


def _old_or_new(old: Own | None, new: Own) -> Own:
    """A file that is as it was, or as it will be."""
    return Own(new.command, (*(old.hashes[-1:] if old else ()), *new.hashes))


def _write_manifest(folder: Path, manifest: Mapping[str, Own]) -> None:
    """Write the manifest, unless something else has its name."""
    if os.path.lexists(folder / MANIFEST) and not read_manifest(folder):
        on_stderr(
            f"{str(folder / MANIFEST)!r} is not a file of this study and stays: the next run does not know these files"
        )
    else:
        write_atomically(folder / MANIFEST, manifest_json(manifest))


def netcdf_content(values: xr.Dataset) -> bytes:
    """The content of a netCDF file, made in memory: HDF5 ends the process where it cannot write all of a file."""
    return bytes(values.to_netcdf(engine="h5netcdf"))


def _install_report(new: Path, place: Path) -> Path:
    """Move the files of a new report to their place, or next to it; return the place."""
    mine = {
        path.relative_to(new).as_posix(): Own(REPORT, (hash_of(path.read_bytes()),))
        for path, is_folder in walk_folder(new)
        if not is_folder
    }
    why = _find_obstacle(place)
    there = next(name for name in iterate_names(place) if not os.path.lexists(name)) if why else place
    there.mkdir(exist_ok=True)
    old = read_manifest(there)
    kept = {name: own for name, own in old.items() if own.command != REPORT and name not in mine}
    for name in old.keys() - kept.keys() - mine.keys():
        if is_own(there / name, old[name]):
            (there / name).unlink()
        with suppress(OSError):
            (there / name).parent.rmdir()
    # The manifest moves first: if the moving is interrupted, every file is known as the study's own
    replaced = {name: _old_or_new(old.get(name), own) for name, own in mine.items()}
    (new / MANIFEST).write_bytes(manifest_json(kept | replaced))
    for name in (MANIFEST, *mine):
        (there / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(new / name, there / name)
    if why:
        on_stderr(f"{str(place)!r} stays as it is ({why}): the report is in {str(there)!r}")
    return there


def _find_obstacle(place: Path) -> str:
    """Return what keeps a report from its place, in words; empty if nothing does."""
    if not os.path.lexists(place):
        return ""
    if place.is_symlink() or not place.is_dir():
        return "it is no directory"
    try:
        found = list_foreign_files(place)
    except OSError as error:
        return error.strerror or str(error)
    return f"{found[0]!r} there is not a file of this study" if found else ""


def make_parents(folder: Path) -> list[Path]:
    """Create what is missing of `folder`; the directories made, deepest first. Raises OSError."""
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    for parent in reversed(missing):
        parent.mkdir(exist_ok=True)
    return missing
