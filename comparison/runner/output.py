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

REPORT_COMMAND = "comparison.run"  # command whose files make up a report; the files of others in the folder stay
PAGE_FILE = "index.html"  # name of the main page in a folder of results
MAX_NAME_BYTES = 240  # largest number of bytes of the report's folder name: names made from it are longer


def print_on_stderr(line: str) -> None:
    """Print a line on standard error, where it does not mix with results."""
    print(line, file=sys.stderr)


def resolve_destination(path: Path, option: str = "--out") -> Path:
    """Return the folder that a path means, without symbolic links and "..". Raises SceneError if none can be made."""
    refusal = partial(SceneError, "command line", option, str(path))
    if path.name == ".." and set(path.parts) != {".."}:
        raise refusal("ends in '..': give the directory by its name")
    try:
        place = path.resolve()
        str(place).encode()
        if place.is_symlink():  # Older versions of Python raise for such a link in resolve().
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
    except RuntimeError:  # Older versions of Python raise it for a loop of links.
        raise refusal("is a symbolic link that leads back to itself: give another directory") from None
    except OSError as error:
        raise refusal(f"cannot be used: {error.strerror}: give another directory") from None
    # A path without links stays as it was typed, for the messages; "." has no name from which to name the store.
    return path if path.name and Path(os.path.abspath(path)) == place and ".." not in path.parts else place


def refuse_foreign_report(out: Path) -> None:
    """Raise SceneError, one line, if a report cannot replace what is at `out`, a destination."""
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
    """Raise SceneError, one line, if files of these names in `out`, a destination, would replace the user's own."""
    manifest = read_manifest(out)
    for name in names if manifest else (MANIFEST, *names):
        if os.path.lexists(out / name) and not is_own_file(out / name, manifest.get(name)):
            rule = f"holds {name!r}, which this study did not write: move it away, or give another directory"
            raise SceneError("command line", "--out", str(out), rule)
    refuse_unwritable(out, out)


def refuse_other_page(out: Path, command: str) -> None:
    """Raise SceneError, one line, if the page in `out` is another command's: two answers need two folders."""
    page = read_manifest(out).get(PAGE_FILE)
    if page is not None and page.command != command:
        name = page.command.rpartition(".")[2]
        rule = f"holds the page of `{name}`, of this building or another: give a directory of its own"
        raise SceneError("command line", "--out", str(out), rule)


def refuse_unwritable(out: Path, folder: Path, option: str = "--out") -> None:
    """Raise SceneError, one line, if nothing can be written in `folder`, or where it will be made."""
    try:
        existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
        tempfile.TemporaryDirectory(dir=existing, prefix=TEMPORARY_PREFIX).cleanup()
    except OSError as error:
        raise SceneError("command line", option, str(out), f"cannot be written: {error.strerror}") from None


@dataclass
class StagedReport:
    """A report that is being written into `folder`, and its final place."""

    folder: Path
    place: Path


@contextmanager
def replace_report(out: Path) -> Iterator[StagedReport]:
    """
    Yield a new folder for a report; if the block ends without exception its files move to `out`, each whole.

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
            # In a thread of its own the move is not interrupted by what interrupts this thread.
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
    """Write a command's files into a folder; a foreign file of that name stays, with a line. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    with hold_lock(folder.resolve().parent):
        for name, content in files.items():
            file, digest, manifest = folder / name, hash_content(content), read_manifest(folder)
            ours = is_own_file(file, manifest.get(name))
            # The manifest names the file before it is written, so that it is the study's even after an interruption.
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
    """Return the manifest entry of a file that has its old or its new content while it is being replaced."""
    return OwnedFile(new.command, (*(old.hashes[-1:] if old else ()), *new.hashes))


def _write_manifest(folder: Path, manifest: Mapping[str, OwnedFile]) -> None:
    """Write the manifest, unless something else has its name."""
    if os.path.lexists(folder / MANIFEST) and not read_manifest(folder):
        print_on_stderr(
            f"{str(folder / MANIFEST)!r} is not a file of this study and stays: the next run does not know these files"
        )
    else:
        write_atomically(folder / MANIFEST, format_manifest(manifest))


def encode_netcdf(values: xr.Dataset) -> bytes:
    """Return the content of a netCDF file, made in memory: HDF5 ends the process if a disk takes only a part."""
    return bytes(values.to_netcdf(engine="h5netcdf"))


def _install_report(new: Path, place: Path) -> Path:
    """Move the files of a new report to its place, or next to it; return where they are."""
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
    # The manifest moves first: if the move is interrupted, every file is known as the study's own.
    replaced = {name: _make_transition_entry(old.get(name), own) for name, own in mine.items()}
    (new / MANIFEST).write_bytes(format_manifest(kept | replaced))
    for name in (MANIFEST, *mine):
        (there / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(new / name, there / name)
    if why:
        print_on_stderr(f"{str(place)!r} stays as it is ({why}): the report is in {str(there)!r}")
    return there


def _find_obstacle(place: Path) -> str:
    """Return what keeps a report from its place, in words; "" if nothing does."""
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
