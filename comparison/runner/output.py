"""
The folders that commands write for the user: reports, tables, figures.

Every such folder holds a manifest of the files that this study wrote there, with a hash of each. A file is the study's
own if it is as the manifest says, and everything else is the user's. Only the study's own files are replaced or
removed, which is looked at when it happens, not before; otherwise the new ones go beside under a new name.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparison.runner.cache import store_beside
from reference.problem import SceneError
from reference.problem.files import (
    NEW,
    OLD,
    TEMPORARY,
    clear_staging,
    dead_staging,
    locked,
    names_after,
    read_file,
    staging,
    write_atomically,
    write_new,
)

if TYPE_CHECKING:
    import xarray as xr

MANIFEST, SCHEMA = "manifest.json", "phase-resonance/manifest"
REPORT = "comparison.run"  # the command whose files make up a report; those of others in the folder stay
MOUNTS = Path("/proc/self/mountinfo")
LARGEST = 2**30  # bytes of a file that may be the study's own
FULL_NAME = 240  # bytes of a name: the names made from it are longer


def on_stderr(line: str) -> None:
    """Say a line where it does not mix with results."""
    print(line, file=sys.stderr)


@dataclass(frozen=True)
class Own:
    """A file of the study: the command that wrote it, and the hashes it may have, two while it is being replaced."""

    command: str
    hashes: tuple[str, ...]


def destination(path: Path, option: str = "--out") -> Path:
    """
    The folder that a path of the command line means, with no symbolic link or ".." left in it.

    Parameters
    ----------
    path : Path
        As it was typed.
    option : str
        Option that it belongs to, for the message.

    Returns
    -------
    Path

    Raises
    ------
    SceneError
        One line, if no folder can be made there, or what is there cannot be replaced.
    """

    def refusal(rule: str) -> SceneError:
        return SceneError("command line", option, str(path), rule)

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
    except RuntimeError:  # of older versions of Python
        raise refusal("is a symbolic link that leads back to itself: give another directory") from None
    except OSError as error:
        raise refusal(f"cannot be used: {error.strerror}: give another directory") from None
    # a path that means what it says stays as it was typed, for the messages
    return path if Path(os.path.abspath(path)) == place and ".." not in path.parts else place


def refuse_foreign_report(out: Path) -> None:
    """Raise SceneError, one line, if a report cannot take the place of what is at `out`, a `destination`."""

    def refusal(rule: str) -> SceneError:
        return SceneError("command line", "--out", str(out), rule)

    place = out.resolve()
    if place.exists():
        if Path.cwd().resolve().is_relative_to(place):
            raise refusal("is the directory you work in: give one inside it")
        if _is_mount_point(place):
            raise refusal("is a mount point, which cannot be replaced: give a directory inside it")
        try:
            foreign_files = foreign(place)
        except OSError as error:
            raise refusal(f"cannot be read: {error.strerror}: give another directory") from None
        if foreign_files and not read_manifest(place):
            raise refusal("exists and is not a report of this study: give another directory, or empty this one")
        if foreign_files:
            raise refusal(f"the report there also holds {foreign_files[0]!r}, which would be lost: move it away")
    refuse_unwritable(out, place.parent)


def refuse_foreign_files(out: Path, names: Sequence[str], option: str = "--out") -> None:
    """
    Refuse a folder where files of the user would be replaced.

    Parameters
    ----------
    out : Path
        A `destination`.
    names : sequence of str
        Files that are to be written.
    option : str
        Option that `out` belongs to, for the message.

    Raises
    ------
    SceneError
        One line.
    """
    manifest = read_manifest(out)
    for name in names if manifest else (MANIFEST, *names):
        if os.path.lexists(out / name) and not _is_own(out / name, manifest.get(name)):
            rule = f"holds {name!r}, which this study did not write: move it away, or give another directory"
            raise SceneError("command line", option, str(out), rule)
    refuse_unwritable(out, out, option)


def refuse_unwritable(out: Path, folder: Path, option: str = "--out") -> None:
    """Raise SceneError, one line, if nothing can be made in `folder`, or where it will be."""
    try:
        existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
        tempfile.TemporaryDirectory(dir=existing, prefix=TEMPORARY).cleanup()
        store_beside(out.absolute()).exists()
    except OSError as error:
        raise SceneError("command line", option, str(out), f"cannot be written: {error.strerror}") from None


@dataclass
class Report:
    """A report that is being written into `folder`, and where it goes."""

    folder: Path
    place: Path


@contextmanager
def atomic_replace(out: Path, say: Callable[[str], None] = on_stderr) -> Iterator[Report]:
    """
    A new directory to write a report into, which takes the place of `out` if the block ends without exception.

    What is at `out` by then is looked at after it was taken away, where nobody finds it any more. If it holds anything
    but the study's own files it comes back, and the report goes beside it, which `say` is told. Files of other commands
    of the study are kept.

    Yields
    ------
    Report
        Its `folder` is to be written into; `place` says after the block where the report is.
    """
    place = out.resolve()
    made = make_parents(place.parent)
    try:
        with staging(place) as staging_folder:
            report = Report(staging_folder / NEW, place)
            yield report
            with locked(place.parent):
                report.place = _put(staging_folder, place, say)
    except BaseException:
        with suppress(OSError):
            for parent in made:
                parent.rmdir()
        raise


def clear_dead(out: Path, say: Callable[[str], None] = on_stderr) -> None:
    """
    Remove what killed runs left beside `out`.

    One that was killed between taking the old report away and putting the new one in its place gets its old one back.
    """
    place = out.resolve()
    for staging_folder in dead_staging(place):
        old = staging_folder / OLD
        with suppress(OSError):
            if old.exists() and not os.path.lexists(place):
                os.rename(old, place)
            elif old.exists():
                _remove_own(old, place, say)
        clear_staging(staging_folder)


def publish(
    folder: Path, files: Mapping[str, bytes], command: str, say: Callable[[str], None] = on_stderr
) -> list[Path]:
    """
    Write files of a command into a folder, which is made if there is none.

    A file of the same name is replaced if the study wrote it. Otherwise the new one gets another name, and `say` is
    told.

    Parameters
    ----------
    folder : Path
    files : mapping of str to bytes
        Contents by name.
    command : str
        Full name of the module of the command, for the manifest.
    say : callable
        Takes a line for people.

    Returns
    -------
    list of Path
        The files written, in the order given.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    with locked(folder.resolve().parent):
        for name, content in files.items():
            file, digest = folder / name, _hash(content)
            manifest = read_manifest(folder)
            ours = manifest.get(name) if _is_own(file, manifest.get(name)) else None
            if ours or not os.path.lexists(file):
                # with the old hash, too, while it is being replaced: whatever ends that, the file remains ours
                _note(folder, manifest | {name: Own(command, (*(ours.hashes if ours else ()), digest))}, say)
            if ours:
                write_atomically(file, content)
            else:
                file = write_new(file, content)
            if file.name != name:
                say(f"{str(folder / name)!r} is not a file of this study and stays: see {file.name!r} beside it")
            _note(folder, manifest | {file.name: Own(command, (digest,))}, say)
            written.append(file)
    return written


def _note(folder: Path, manifest: Mapping[str, Own], say: Callable[[str], None]) -> None:
    """Write the manifest, unless something else has its name."""
    try:
        write_manifest(folder, manifest)
    except FileExistsError:
        say(f"{str(folder / MANIFEST)!r} is not a file of this study and stays: the next run does not know these files")


def netcdf(values: xr.Dataset) -> bytes:
    """
    The content of a netCDF file, made in memory: HDF5 ends the process where it cannot write all of a file.

    Parameters
    ----------
    values : xr.Dataset

    Returns
    -------
    bytes
    """
    return bytes(values.to_netcdf(engine="h5netcdf"))


def made_by(*writers: Callable[[Path], object]) -> dict[str, bytes]:
    """The files that the writers leave in the folder they are given."""
    with tempfile.TemporaryDirectory() as name:
        for write in writers:
            write(Path(name))
        return {file.name: file.read_bytes() for file in sorted(Path(name).iterdir())}


def foreign(folder: Path) -> list[str]:
    """What is in a folder and is not the study's own, as paths below it, sorted. Raises OSError."""
    manifest = read_manifest(folder)
    if not manifest:
        return sorted(os.listdir(folder))
    folders = {str(parent) for name in manifest for parent in Path(name).parents}
    foreign_files = []
    for path, is_folder in _inside(folder):
        name = path.relative_to(folder).as_posix()
        if name != MANIFEST and not (name in folders if is_folder else _is_own(path, manifest.get(name))):
            foreign_files.append(name)
    # of a folder that is not ours the files in it say more
    return sorted(name for name in foreign_files if not any(other.startswith(f"{name}/") for other in foreign_files))


def read_manifest(folder: Path) -> dict[str, Own]:
    """The files that the study wrote into a folder, by their paths below it; empty without a manifest of ours."""
    try:
        data = json.loads(read_file(folder / MANIFEST, LARGEST))
        if data["schema"] != SCHEMA or data["checksum"] != _checksum(data["files"]):
            return {}
        return {name: Own(entry["command"], tuple(entry["sha256"])) for name, entry in data["files"].items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def write_manifest(folder: Path, manifest: Mapping[str, Own]) -> None:
    """
    Say which files of a folder are the study's own. Raises OSError, FileExistsError over a manifest that is not ours.
    """
    if os.path.lexists(folder / MANIFEST) and not read_manifest(folder):
        raise FileExistsError(errno.EEXIST, "not a manifest of this study", str(folder / MANIFEST))
    files = {
        name: {"command": manifest[name].command, "sha256": list(manifest[name].hashes)} for name in sorted(manifest)
    }
    text = json.dumps({"schema": SCHEMA, "files": files, "checksum": _checksum(files)}, indent=1)
    write_atomically(folder / MANIFEST, text.encode())


def _put(staging_folder: Path, place: Path, say: Callable[[str], None]) -> Path:
    """Give the new report its place, or one beside it; the place."""
    new, old = staging_folder / NEW, staging_folder / OLD
    kept: dict[str, Own] = {}
    why = "" if place.is_dir() or not os.path.lexists(place) else "it is no directory"
    try:
        if place.is_dir():
            os.rename(place, old)
    except OSError as error:  # a mount point, or a directory that may not be moved
        why = error.strerror or str(error)
    try:
        if os.path.lexists(old):
            if foreign_files := [place.name] if old.is_symlink() else foreign(old):
                why = f"{foreign_files[0]!r} there is not a file of this study"
                _put_back(old, place)
            else:
                manifest = read_manifest(old)
                kept = {
                    name: manifest[name]
                    for name, _ in _files(old)
                    if name in manifest and manifest[name].command != REPORT
                }
        for name in kept:
            shutil.copy2(old / name, new / name)
        _prune(new)
        mine = {name: Own(REPORT, (_hash(file.read_bytes()),)) for name, file in _files(new) if name not in kept}
        write_manifest(new, kept | mine)
        there = next(name for name in names_after(place) if not (why and name == place) and _renamed_to_free(new, name))
    except BaseException:
        if os.path.lexists(old):
            _put_back(old, place)
        raise
    if os.path.lexists(old):
        _remove_own(old, place, say)
    if there != place:
        say(f"{str(place)!r} stays as it is ({why or 'it appeared meanwhile'}): the report is in {str(there)!r}")
    return there


def _prune(new: Path) -> None:
    """Remove the empty folders of a new report: no file in the manifest would prove that they are the study's own."""
    for folder in reversed([path for path, is_folder in _inside(new) if is_folder]):
        with suppress(OSError):
            folder.rmdir()


def _put_back(old: Path, place: Path) -> Path:
    """Give what was taken away its name again, or the next one that is free; its place."""
    return next(name for name in names_after(place) if _renamed_to_free(old, name))


def _renamed_to_free(new: Path, there: Path) -> bool:
    """Give a directory a name that nothing has; False if something has it."""
    if os.path.lexists(there):
        return False
    try:
        os.rename(new, there)
    except OSError:
        if os.path.lexists(there):  # since a moment ago
            return False
        raise
    return True


def _remove_own(old: Path, place: Path, say: Callable[[str], None]) -> None:
    """Remove a report that was replaced: file by file what is ours; if anything else is in it, it stays beside."""
    manifest = read_manifest(old)
    folders = []
    for path, is_folder in _inside(old):
        if is_folder:
            folders.append(path)
        elif _is_own(path, manifest.get(path.relative_to(old).as_posix())):
            path.unlink()
    for folder in reversed(folders):
        with suppress(OSError):
            folder.rmdir()
    if [entry.name for entry in old.iterdir()] == [MANIFEST] and manifest:
        (old / MANIFEST).unlink()
    with suppress(OSError):
        old.rmdir()
    if old.exists():
        say(f"what was added to {str(place)!r} meanwhile is in {str(_put_back(old, place))!r}")


def _files(folder: Path) -> Iterator[tuple[str, Path]]:
    """The files below a folder, each with its path from there."""
    for path, is_folder in _inside(folder):
        if not is_folder:
            yield path.relative_to(folder).as_posix(), path


def _inside(folder: Path) -> Iterator[tuple[Path, bool]]:
    """All that is below a folder, and whether it is a folder itself, these before what they hold. Raises OSError."""
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        is_folder = entry.is_dir(follow_symlinks=False)
        yield Path(entry.path), is_folder
        if is_folder:
            yield from _inside(Path(entry.path))


def _is_own(file: Path, entry: Own | None) -> bool:
    if entry is None or file.is_symlink() or not file.is_file():
        return False
    try:
        return _hash(read_file(file, LARGEST)) in entry.hashes
    except OSError:
        return False


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _checksum(files: Any) -> str:
    return _hash(json.dumps(files, sort_keys=True).encode())


def _is_mount_point(place: Path) -> bool:
    """Also one that shows a folder of the same file system."""
    if os.path.ismount(place):
        return True
    with suppress(OSError):
        escaped = str(place).replace("\\", "\\134").replace(" ", "\\040").replace("\t", "\\011").replace("\n", "\\012")
        lines = MOUNTS.read_text(encoding="utf-8", errors="replace").splitlines()
        return any(line.split()[4] == escaped for line in lines)
    return False


def make_parents(folder: Path) -> list[Path]:
    """Create what is missing of `folder`; the directories made, deepest first. Raises OSError."""
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    for parent in reversed(missing):
        parent.mkdir(exist_ok=True)
    return missing
