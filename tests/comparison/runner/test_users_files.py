"""What the study did not write is never deleted, replaced or run: it stays, and the study's own files go beside it."""

import errno
import hashlib
import io
import os
import signal
from collections.abc import Callable
from contextlib import redirect_stderr, suppress
from pathlib import Path

import pytest
from fake_models import fake_hierarchy
from known_results import FOUND
from report_texts import page_of, summary_of
from runs import SMALL, Run

from comparison.cli import reports
from comparison.evidence.extremes import command as extremes
from comparison.report import page
from comparison.runner import output
from comparison.runner.cache import Cache, CacheKey, locate_store
from comparison.runner.manifest import (
    MANIFEST,
    OwnedFile,
    format_manifest,
    is_own_file,
    list_foreign_files,
    read_manifest,
)
from comparison.runner.output import (
    publish_files,
    refuse_foreign_files,
    remove_abandoned_reports,
    replace_report,
    resolve_destination,
)
from reference.support.files import TEMPORARY_PREFIX, write_atomically

TABLES = ["extremes.json", "extremes.png"]


def put(folder: Path, *names: str, content: str = "new") -> tuple[Path, list[str]]:
    """A report of these files; where it went, and what was said."""
    with redirect_stderr(io.StringIO()) as said, replace_report(folder) as report:
        for name in names or ("index.html",):
            (report.folder / name).parent.mkdir(exist_ok=True)
            (report.folder / name).write_text(content, encoding="utf-8")
    return report.place, said.getvalue().splitlines()


def mine(file: Path) -> Path:
    """A file of the user."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("years of work", encoding="utf-8")
    return file


def is_mine(file: Path) -> bool:
    return file.read_text(encoding="utf-8") == "years of work"


@pytest.mark.parametrize(
    ("name", "finished"),
    [("thesis.txt", False), (MANIFEST, False), ("figures/for-paper/fig.svg", True), ("index.html", True)],
)
def test_what_appears_in_out_meanwhile_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, finished: bool
) -> None:
    if finished:
        put(tmp_path / "report", "index.html", "figures/ours.png")
    with replace_report(tmp_path / "report") as report:
        (report.folder / "index.html").write_text("new", encoding="utf-8")
        mine(tmp_path / "report" / name)
    assert is_mine(tmp_path / "report" / name)
    assert report.place == tmp_path / "report-2"
    assert page_of(tmp_path / "report-2") == "new"
    assert list_foreign_files(tmp_path / "report-2") == []
    (line,) = capsys.readouterr().err.splitlines()
    assert repr(name) in line
    assert "report-2" in line
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["report", "report-2"]


def test_a_study_says_where_its_report_went_instead(
    command: Callable[..., Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = reports.make_report

    def meanwhile(*arguments: object, **options: object) -> object:
        mine(tmp_path / "report" / "thesis.txt")
        return write(*arguments, **options)

    monkeypatch.setattr(reports, "make_report", meanwhile)
    run = command(*SMALL)
    assert (run.code, run.err.count("\n"), is_mine(tmp_path / "report" / "thesis.txt")) == (0, 1, True)
    assert "'thesis.txt' there is not a file of this study" in run.err
    assert str(tmp_path / "report-2" / "index.html") in run.out.replace("\n", "")


@pytest.mark.parametrize("name", ["figures/for-paper/fig.svg", "old-tradeoff.nc/x", "empty/"])
def test_a_file_of_the_user_in_a_report_is_refused_at_the_start(
    command: Callable[..., Run], tmp_path: Path, name: str
) -> None:
    put(tmp_path / "report", "figures/ours.png")
    file = tmp_path / "report" / name
    file.mkdir() if name.endswith("/") else mine(file)
    run = command(*SMALL, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.err.count("\n")) == (2, 1)
    assert "which would be lost: move it away" in run.err
    assert file.exists()


def test_a_file_or_link_in_place_of_the_report_stays(tmp_path: Path) -> None:
    with replace_report(tmp_path / "report"):
        mine(tmp_path / "report")
    assert is_mine(tmp_path / "report")
    with replace_report(tmp_path / "other") as report:
        (tmp_path / "other").symlink_to(tmp_path / "report-2")
    assert (tmp_path / "other").is_symlink()
    assert report.place == tmp_path / "other-2"


def test_a_file_added_while_the_report_is_moved_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    put(tmp_path / "report", "index.html", "figures/old.png", content="old")
    move = os.replace

    def late(source: Path, target: Path) -> None:
        move(source, target)
        if target.name == "index.html":
            mine(tmp_path / "report" / "figures" / "late.txt")

    monkeypatch.setattr(os, "replace", late)
    place, said = put(tmp_path / "report")
    assert (place, said) == (tmp_path / "report", [])
    assert page_of(place) == "new"
    assert [entry.name for entry in (place / "figures").iterdir()] == ["late.txt"]


@pytest.mark.parametrize("moves", range(4))
def test_a_report_half_moved_is_still_the_studys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moves: int) -> None:
    put(tmp_path / "report", "index.html", "figures/old.png", content="old")
    publish_files(tmp_path / "tables", {"extremes.json": b"old"}, "comparison.extremes")
    move = os.replace
    for most, ends in (
        (moves, lambda: publish_files(tmp_path / "tables", dict.fromkeys(TABLES, b"new"), "comparison.extremes")),
        (max(moves, 1), lambda: put(tmp_path / "report", "index.html", "summary.json")),  # 0 is no move of the report
    ):
        done: list[Path] = []

        def moved(source: Path, target: Path, done: list[Path] = done, most: int = most) -> None:
            if len(done) == most:
                raise KeyboardInterrupt
            done.append(target)
            move(source, target)

        with monkeypatch.context() as patch, suppress(KeyboardInterrupt):
            patch.setattr(os, "replace", moved)
            ends()
    refuse_foreign_files(tmp_path / "tables", TABLES)
    assert list_foreign_files(tmp_path / "report") == []
    assert page_of(tmp_path / "report") in ("old", "new"), "each file is whole"
    put(tmp_path / "report", "index.html", content="newer")
    assert {entry.name for entry in tmp_path.iterdir()} == {"report", "tables"}
    assert sorted(entry.name for entry in (tmp_path / "report").iterdir()) == ["index.html", MANIFEST]


def test_a_manifest_that_was_tampered_with_proves_nothing(tmp_path: Path) -> None:
    put(tmp_path / "report")
    thesis = mine(tmp_path / "thesis.txt")
    own = OwnedFile("comparison.run", (hashlib.sha256(thesis.read_bytes()).hexdigest(),))
    tampered = format_manifest(read_manifest(tmp_path / "report") | {"../thesis.txt": own})
    (tmp_path / "report" / MANIFEST).write_bytes(tampered)
    assert put(tmp_path / "report")[0] == tmp_path / "report"
    assert is_mine(thesis)


def test_a_folder_of_24_letters_in_the_store_is_never_trimmed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    needed, old = (CacheKey(f'"{name}"', "0" * 64, "batch") for name in ("needed", "old"))
    cache = Cache(tmp_path / "e.tiles")
    cache.put(old, 1.5)
    photos = tmp_path / "e.tiles" / "my-photos-of-summer-2024"
    files = [mine(photos / "a.jpg"), mine(photos / "b.batch"), mine(tmp_path / "e.tiles" / old.group / "c.batch")]
    (tmp_path / "e.tiles" / "link").symlink_to(photos)
    monkeypatch.setattr("comparison.runner.cache.MAX_CACHE_BYTES", 0)
    cache.trim([needed])
    assert all(map(is_mine, files))
    assert not (tmp_path / "e.tiles" / old.name).exists(), "what is the study's own is"


EXTREMES = ["--rows", "amplitude", "--models", "small", "--jobs", "1"]


def test_extremes_replace_no_file_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(extremes, "judge_matrix", lambda *rest: pytest.fail("it was computed"))
    for name in ("extremes.json", MANIFEST):
        file = mine(tmp_path / "before" / name)
        assert extremes.main([*EXTREMES, "--out", str(file.parent)]) == 2
        assert f"holds {name!r}, which this study did not write" in capsys.readouterr().err
        assert is_mine(file)
        file.unlink()
    files = [tmp_path / "meanwhile" / name for name in ("extremes.json", "extremes.part")]
    monkeypatch.setattr(extremes, "judge_matrix", lambda *rest: [*map(mine, files)] and FOUND)
    extremes.main([*EXTREMES, "--out", str(tmp_path / "meanwhile")])
    assert all(map(is_mine, files))
    assert "extremes-2.json" in {entry.name for entry in (tmp_path / "meanwhile").iterdir()}
    assert capsys.readouterr().err.count("not a file of this study") == 1


def test_files_of_other_commands_in_the_report_are_kept(tmp_path: Path) -> None:
    put(tmp_path / "report")
    with replace_report(tmp_path / "report") as report:
        (report.folder / "index.html").write_text("newer", encoding="utf-8")
        publish_files(tmp_path / "report", {"extremes.json": b"{}"}, "comparison.extremes")
    assert report.place == tmp_path / "report"
    assert (tmp_path / "report" / "extremes.json").read_bytes() == b"{}"
    assert list_foreign_files(tmp_path / "report") == []


PLACES = {  # others are refused by phase-resonance init, too
    "..": ("a/b/..", "ends in '..'"),
    "245 letters": ("x" * 245, "has a name of more than 240 bytes"),
    "a link that leads back": ("loop", "leads back to itself"),
    "a link with another's store beside what it means": (
        "link",
        "next to it is not a store of results of this study, it holds 'mine.txt'",
    ),
    "a store that is a link": ("linked-store", "next to it is not the folder that keeps results"),
    "a file": ("page.html", "is a file: give a directory"),
    "a mount point": ("mount", "is a mount point, which cannot be replaced"),
    "files of others": ("elsewhere.tiles", "is not a report of this study: give another directory, or empty this one"),
    "the directory of the work": ("here", "is the directory you work in"),
    "one above it": ("", "holds the directory you work in"),
}


@pytest.mark.parametrize(("name", "rule"), PLACES.values(), ids=PLACES.keys())
def test_an_odd_place_is_refused_at_the_start_in_one_line(
    command: Callable[..., Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, rule: str
) -> None:
    for name_of_folder in ("mount", "here", "elsewhere"):
        (tmp_path / name_of_folder).mkdir()
    monkeypatch.chdir(tmp_path / "here")
    mine(tmp_path / "page.html")
    mine(tmp_path / "elsewhere.tiles" / "mine.txt")
    for link, target in (("loop", "loop"), ("link", "elsewhere"), ("linked-store.tiles", "elsewhere")):
        (tmp_path / link).symlink_to(tmp_path / target)
    ismount = os.path.ismount
    monkeypatch.setattr(os.path, "ismount", lambda path: Path(path).name == "mount" or ismount(path))
    before = sorted(str(path) for path in tmp_path.rglob("*"))
    run = command(*SMALL, "--out", f"{tmp_path}/{name}", hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.err.count("\n")) == (2, 1)
    assert rule in run.err
    assert sorted(str(path) for path in tmp_path.rglob("*")) == before


def test_a_second_run_replaces_the_first_also_behind_a_link(command: Callable[..., Run], tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "report")
    for tolerance in (1e-3, 2e-3):
        assert command(*SMALL, "--tolerance", f"{tolerance}", "--out", str(tmp_path / "link")).code == 0
        assert summary_of(tmp_path / "report")["tolerance"] == tolerance
        files = {path for path in (tmp_path / "report").rglob("*") if path.is_file()}
        assert {tmp_path / "report" / name for name in (MANIFEST, *read_manifest(tmp_path / "report"))} == files
    assert (tmp_path / "link").is_symlink()
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["link", "report", "report.tiles"]


@pytest.mark.parametrize(
    ("error", "code"), [(OSError(errno.ENOSPC, "No space left on device"), 3), (KeyboardInterrupt(), 130)]
)
def test_a_report_that_cannot_be_finished_leaves_the_old_one(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int
) -> None:
    first = command(*SMALL)
    before = {entry: entry.read_bytes() for entry in first.report.rglob("*") if entry.is_file()}

    def breaks(*rest: object) -> str:
        raise error  # the surfaces, the summary and the figures are written by then

    monkeypatch.setattr(page, "collect_page_data", breaks)
    run = command(*SMALL, "--tolerance", "2e-3")
    assert (run.code, run.err.count("\n")) == (code, 1)
    assert {entry: entry.read_bytes() for entry in first.report.rglob("*") if entry.is_file()} == before
    assert sorted(entry.name for entry in first.report.parent.iterdir()) == ["report", "report.tiles"]


def test_nothing_is_left_of_a_first_report_that_fails(tmp_path: Path) -> None:
    with suppress(ZeroDivisionError), replace_report(tmp_path / "a" / "b" / "report") as report:
        mine(report.folder / "index.html")
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kill -9")
def test_what_a_killed_run_left_is_cleared_of_a_living_one_not(tmp_path: Path) -> None:
    alike = [".report-x", f"{TEMPORARY_PREFIX}holiday"]
    for name in alike:
        mine(tmp_path / name / "old" / "photo.jpg")
        (tmp_path / name / "staging.json").write_text("{}", encoding="utf-8")
    begun, begins = os.pipe()
    child = os.fork()
    if child == 0:
        with replace_report(tmp_path / "report") as report:
            mine(report.folder / "index.html")
            os.write(begins, b"x")
            signal.pause()
    os.read(begun, 1)
    remove_abandoned_reports(tmp_path / "report")
    assert len(list(tmp_path.iterdir())) == 3, "it lives"
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    assert len(list(tmp_path.iterdir())) == 3
    remove_abandoned_reports(tmp_path / "report")
    assert sorted(entry.name for entry in tmp_path.iterdir()) == sorted(alike)
    assert all(is_mine(tmp_path / name / "old" / "photo.jpg") for name in alike)


def test_the_working_directory_has_a_store_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert locate_store(resolve_destination(Path("."))) == tmp_path.resolve().with_name(f"{tmp_path.name}.tiles")


def test_a_command_names_the_files_that_it_wrote(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A table of the user's has the name of one of them."""
    (tmp_path / "a.csv").write_bytes(b"mine")
    written = publish_files(tmp_path, {"a.csv": b"one", "b.csv": b"two"}, "run")
    assert [(file.read_bytes(), file.parent) for file in written] == [(b"one", tmp_path), (b"two", tmp_path)]
    assert (tmp_path / "a.csv").read_bytes() == b"mine"
    assert f"stays: see {written[0].name!r} next to it" in capsys.readouterr().err
    own = read_manifest(tmp_path)
    assert all(is_own_file(file, own.get(file.name)) for file in written)
    assert not is_own_file(tmp_path / "a.csv", own.get("a.csv"))


def test_a_file_whose_third_replacement_was_interrupted_is_still_the_study_s(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for content in (b"one", b"two"):
        publish_files(tmp_path, {"a.csv": content}, "run")

    def interrupted(file: Path, content: bytes) -> None:
        if file.name != MANIFEST:
            raise KeyboardInterrupt
        write_atomically(file, content)

    monkeypatch.setattr(output, "write_atomically", interrupted)
    with pytest.raises(KeyboardInterrupt):
        publish_files(tmp_path, {"a.csv": b"three"}, "run")
    monkeypatch.undo()
    assert (tmp_path / "a.csv").read_bytes() == b"two"
    assert publish_files(tmp_path, {"a.csv": b"four"}, "run") == [tmp_path / "a.csv"]
    assert (tmp_path / "a.csv").read_bytes() == b"four"
