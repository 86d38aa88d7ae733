"""Files that somebody else may have written: regular ones of a stated size are read, others are one line at once."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from chains import refusal, scene_file

from reference.problem import SceneError, load_family, load_scene
from reference.support.files import (
    MARK_FILE,
    NEW_FILES_FOLDER,
    TEMPORARY_PREFIX,
    find_abandoned_staging,
    read_file,
    staging_directory,
    write_atomically,
    write_new,
)

SECRET = "xK7-of-somebody-else"
RECORDS = {"a.csv": '"a.csv"', "a.AT2": '{x = "a.AT2"}', "suite/a.csv": '{suite = "suite", motion = 1}'}
NONE: dict[str, tuple[Callable[[Path], object], str]] = {
    "pipe": (lambda path: os.mkfifo(path), "not a regular file"),
    "device": (lambda path: path.symlink_to("/dev/zero"), "not a regular file"),
    "large": (lambda path: (path.touch(), os.truncate(path, 2**40)), "larger than "),
    "folder": (Path.mkdir, "Is a directory"),
}
pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no such files")


@pytest.mark.parametrize(("make", "rule"), NONE.values(), ids=NONE.keys())
def test_a_scene_and_its_record_are_regular_files_of_a_stated_size(
    tmp_path: Path, make: Callable[[Path], object], rule: str
) -> None:
    make(tmp_path / "none.toml")
    for load in (load_scene, load_family):
        assert rule in refusal(load, tmp_path / "none.toml", kind=SceneError).rule
    (tmp_path / "suite").mkdir()
    for name, record in RECORDS.items():
        make(tmp_path / name)
        said = refusal(load_scene, scene_file(tmp_path, f"record = {record}"), kind=SceneError)
        ignored = make is Path.mkdir and name.startswith("suite/")  # a folder within a suite is no record
        assert ("has no CSV or .AT2 files" if ignored else rule) in said.rule
        assert said.key.startswith("excitation.record") or (said.key == "motion" and name.startswith("suite/"))


def test_a_file_that_is_no_scene_is_not_quoted(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").symlink_to(tmp_path / "key")
    for text in (f'[registry]\ntoken = "{SECRET}"\n', f"{SECRET}\n", f"token: {SECRET}\n"):
        (tmp_path / "key").write_text(text, encoding="utf-8")
        said = refusal(load_scene, tmp_path / "mine.toml", kind=SceneError)
        assert (said.key, SECRET in str(said)) == ("file", False)


def test_a_name_that_is_taken_stays_what_it_was_also_without_hard_links(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_link(part: Path, place: Path) -> None:
        raise PermissionError

    (tmp_path / "run.gif").write_bytes(b"own")
    assert write_new(tmp_path / "run.gif", b"linked").name == "run-2.gif"
    monkeypatch.setattr(os, "link", no_link)
    assert write_new(tmp_path / "run.gif", b"moved").name == "run-3.gif"
    found = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert found == {"run.gif": b"own", "run-2.gif": b"linked", "run-3.gif": b"moved"}


def test_a_folder_of_somebody_else_is_no_staging_directory(tmp_path: Path) -> None:
    place = tmp_path / "out"
    for name, other in (("none", None), ("other", "out-2"), ("left", "out")):
        folder = tmp_path / f"{TEMPORARY_PREFIX}{name}"
        folder.mkdir()
        if other is not None:
            (folder / MARK_FILE).write_text(
                f'{{"what": "staging directory of phase-resonance", "name": "{folder.name}", "for": "{other}"}}'
            )
    assert [folder.name for folder in find_abandoned_staging(place)] == [f"{TEMPORARY_PREFIX}left"]


@pytest.mark.skipif(os.name == "nt", reason="this system has no such permissions")
@pytest.mark.parametrize("mask", [0o022, 0o027, 0o077])
def test_a_file_may_be_read_by_whom_the_user_lets_read(tmp_path: Path, mask: int) -> None:
    before = os.umask(mask)
    try:
        write_atomically(tmp_path / "report.html", b"page")
        write_new(tmp_path / "run.gif", b"film")
    finally:
        os.umask(before)
    assert {file.stat().st_mode & 0o777 for file in tmp_path.iterdir()} == {0o666 & ~mask}


def test_what_somebody_puts_into_a_staging_directory_stays(tmp_path: Path) -> None:
    for theirs in (False, True):
        with staging_directory(tmp_path / "out") as folder:
            (folder / NEW_FILES_FOLDER / "ours.csv").write_bytes(b"ours")
            if theirs:
                (folder / "theirs.csv").write_bytes(b"theirs")
        assert folder.exists() == theirs
    assert [file.relative_to(tmp_path).parts[1:] for file in tmp_path.rglob("*.csv")] == [("theirs.csv",)]


def test_a_file_is_read_up_to_the_largest_size_and_a_link_followed(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(10 * b"x")
    (tmp_path / "link").symlink_to(tmp_path / "file")
    assert read_file(tmp_path / "link", 10) == 10 * b"x"
    with pytest.raises(OSError, match="larger than"):
        read_file(tmp_path / "file", 9)
    if Path("/proc/self/status").exists():  # a file whose size the system does not state
        assert read_file("/proc/self/status", 2**20).startswith(b"Name:")
        with pytest.raises(OSError, match="larger than"):
            read_file("/proc/self/status", 16)
