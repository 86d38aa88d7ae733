"""
Folders that commands write for the user: reports, tables, figures.

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

from comparison.runner.manifest import (
    MANIFEST,
    OwnedFile,
    format_manifest,
    hash_content,
    is_own_file,
    list_foreign_files,
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

REPORT_COMMAND = "comparison.run"  # command that writes reports: a new report replaces only files of this command
PAGE_FILE = "index.html"  # name of the main page of a report
MAX_NAME_BYTES = 240  # longest name of a report's folder, bytes; names made from it are longer and must be possible


def print_on_stderr(line: str) -> None:
    """Print a line on standard error, apart from the results on standard output."""
    print(line, file=sys.stderr)


def resolve_destination(path: Path, option: str = "--out") -> Path:
    """Return the folder at a path, free of symbolic links and "..". Raises SceneError if it cannot be a folder."""
    refusal = partial(SceneError, "command line", option, str(path))
    if path.name == ".." and set(path.parts) != {".."}:
        raise refusal("ends in '..': give the directory by its name")
    try:
        place = path.resolve()
        str(place).encode()
        if place.is_symlink():  # a link that leads back to itself: older versions of Python raise RuntimeError for it
            raise RuntimeError
        if len(place.name.encode()) > MAX_NAME_BYTES:
            raise refusal(f"has a name of more than {MAX_NAME_BYTES} bytes: give a shorter one")
        if place.exists() and not place.is_dir():
            raise refusal("is a file: give a directory")
        if not place.name:
            raise refusal("is the root directory: give a directory inside it")
        parent = next(parent for parent in place.parents if parent.exists())
        if not parent.is_dir():
            raise refusal("cannot be written: Not a directory")
    except UnicodeError:
        raise refusal("is not text in UTF-8: give a path that is") from None
    except RuntimeError:
        raise refusal("is a symbolic link that leads back to itself: give another directory") from None
    except OSError as error:
        raise refusal(f"cannot be used: {error.strerror}: give another directory") from None
    # Keep the path as it was typed, for messages, unless it has links or "..", or no name (".") to derive others from.
    return path if path.name and Path(os.path.abspath(path)) == place and ".." not in path.parts else place


def refuse_foreign_report(out: Path) -> None:
    """Raise SceneError if the folder `out` has anything that a new report must not replace."""
    refusal = partial(SceneError, "command line", "--out", str(out))
    place = out.resolve()
    refuse_other_page(out, REPORT_COMMAND)
    if place.exists():
        if Path.cwd().resolve().is_relative_to(place):
            verb = "is" if Path.cwd().resolve() == place else "holds"
            raise refusal(f"{verb} the directory you work in: give one inside it")
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
    """Raise SceneError if the folder `out` has files of these names that the study did not write."""
    manifest = read_manifest(out)
    for name in names if manifest else (MANIFEST, *names):
        if os.path.lexists(out / name) and not is_own_file(out / name, manifest.get(name)):
            rule = f"holds {name!r}, which this study did not write: move it away, or give another directory"
            raise SceneError("command line", "--out", str(out), rule)
    refuse_unwritable(out, out)


def refuse_other_page(out: Path, command: str) -> None:
    """Raise SceneError if index.html in the folder `out` is another command's page: each needs a folder of its own."""
    page = read_manifest(out).get(PAGE_FILE)
    if page is not None and page.command != command:
        name = page.command.rpartition(".")[2]
        rule = f"holds the page of `{name}`, of this building or another: give a directory of its own"
        raise SceneError("command line", "--out", str(out), rule)


def refuse_unwritable(out: Path, folder: Path, option: str = "--out") -> None:
    """Raise SceneError if no file can be written in `folder`, or in its nearest existing parent."""
    try:
        existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
        tempfile.TemporaryDirectory(dir=existing, prefix=TEMPORARY_PREFIX).cleanup()
    except OSError as error:
        raise SceneError("command line", option, str(out), f"cannot be written: {error.strerror}") from None


@dataclass
class StagedReport:
    """A report that is being written."""

    folder: Path  # temporary folder into which it is written
    place: Path  # folder to which it moves


@contextmanager
def replace_report(out: Path) -> Iterator[StagedReport]:
    """
    Yield a temporary folder for a report; if the block ends without exception its files move to `out`, each whole.

    Files of the old report are replaced or removed, and files of other commands are kept. If `out` by then has files
    that the study did not write, all of it stays, the report gets a new name, and a line on standard error says so.
    After the block, `place` of the report is where it is.
    """
    place = out.resolve()
    made = make_parents(place.parent)
    try:
        with staging_directory(place) as staging_folder:
            report = StagedReport(staging_folder / NEW_FILES_FOLDER, place)
            yield report
            # Move the files in a separate thread, so that Ctrl-C does not interrupt the move.
            with hold_lock(place.parent), ThreadPoolExecutor(1) as mover:
                report.place = mover.submit(_install_report, report.folder, place).result()
    except BaseException:
        with suppress(OSError):
            for parent in made:
                parent.rmdir()
        raise


def remove_abandoned_reports(out: Path) -> None:
    """Remove the unfinished reports that killed runs left next to `out`."""
    for staging_folder in find_abandoned_staging(out.resolve()):
        clear_staging(staging_folder)


def publish_files(folder: Path, files: Mapping[str, bytes], command: str) -> list[Path]:
    """Write files into a folder, under another name if a foreign file has theirs; return the paths. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    with hold_lock(folder.resolve().parent):
        for name, content in files.items():
            file, digest, manifest = folder / name, hash_content(content), read_manifest(folder)
            ours = is_own_file(file, manifest.get(name))
            # List the file in the manifest before writing it, so that it counts as the study's if writing stops early.
            if ours or not os.path.lexists(file):
                _write_manifest(
                    folder, manifest | {name: _make_transition_entry(manifest.get(name), OwnedFile(command, (digest,)))}
                )
            if ours:
                write_atomically(file, content)
            else:
                file = write_new(file, content)
            if file.name != name:
                print_on_stderr(
                    f"{str(folder / name)!r} is not a file of this study and stays: see {file.name!r} next to it"
                )
                _write_manifest(folder, manifest | {file.name: OwnedFile(command, (digest,))})
            written.append(file)
    return written


def _make_transition_entry(old: OwnedFile | None, new: OwnedFile) -> OwnedFile:
    """Return the manifest entry of a file during its replacement, when its content may be the old or the new one."""
    return OwnedFile(new.command, (*(old.hashes[-1:] if old else ()), *new.hashes))


def _write_manifest(folder: Path, manifest: Mapping[str, OwnedFile]) -> None:
    """Write the manifest into a folder, unless another file there has its name."""
    if os.path.lexists(folder / MANIFEST) and not read_manifest(folder):
        print_on_stderr(
            f"{str(folder / MANIFEST)!r} is not a file of this study and stays: the next run does not know these files"
        )
    else:
        write_atomically(folder / MANIFEST, format_manifest(manifest))


def encode_netcdf(values: xr.Dataset) -> bytes:
    """Return the bytes of a netCDF file; made in memory, as the HDF5 library ends the process if a disk is full."""
    return bytes(values.to_netcdf(engine="h5netcdf"))


def _install_report(new: Path, place: Path) -> Path:
    """Move the files of a new report to its place, or next to it if that is taken; return where they are."""
    mine = {
        path.relative_to(new).as_posix(): OwnedFile(REPORT_COMMAND, (hash_content(path.read_bytes()),))
        for path, is_folder in walk_folder(new)
        if not is_folder
    }
    why = _find_obstacle(place)
    there = next(name for name in iterate_names(place) if not os.path.lexists(name)) if why else place
    there.mkdir(exist_ok=True)
    old = read_manifest(there)
    kept = {name: own for name, own in old.items() if own.command != REPORT_COMMAND and name not in mine}
    for name in old.keys() - kept.keys() - mine.keys():
        if is_own_file(there / name, old[name]):
            (there / name).unlink()
        with suppress(OSError):
            (there / name).parent.rmdir()
    # Move the manifest first: if the move is interrupted, every file is then known as written by the study.
    replaced = {name: _make_transition_entry(old.get(name), own) for name, own in mine.items()}
    (new / MANIFEST).write_bytes(format_manifest(kept | replaced))
    for name in (MANIFEST, *mine):
        (there / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(new / name, there / name)
    if why:
        print_on_stderr(f"{str(place)!r} stays as it is ({why}): the report is in {str(there)!r}")
    return there


def _find_obstacle(place: Path) -> str:
    """Return in words why a report cannot be moved to its place; "" if it can."""
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
    """Create the missing parents of `folder`; return the directories made, deepest first. Raises OSError."""
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    for parent in reversed(missing):
        parent.mkdir(exist_ok=True)
    return missing
