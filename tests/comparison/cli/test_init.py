"""`phase-resonance init` writes a study that runs, whole or not at all, and never over what is there."""

import errno
import json
import os
import re
import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from known_analyses import with_engine_off_by
from places import ROOT

import multibody
import reference
from comparison.cli import requirement as source
from comparison.cli.init import FILES_OF_TEMPLATE, main, make_study_files


@pytest.fixture
def study(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """A new study, as the command writes it."""
    place = tmp_path / "my-study"
    assert main([str(place)]) == 0
    capsys.readouterr()
    return place


def contents(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_it_writes_every_file_of_the_template(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert contents(study) == set(FILES_OF_TEMPLATE)
    template = ROOT / "comparison" / "cli" / "study_template"
    assert sorted(file.name for file in template.iterdir() if file.is_file()) == sorted(FILES_OF_TEMPLATE.values())
    assert (study / "README.md").read_text(encoding="utf-8").startswith("# my-study\n")
    assert [name for name, content in make_study_files("x").items() if b"@NAME@" in content or b"@REQ" in content] == []
    for name in (".github/workflows/study.yml", ".gitlab-ci.yml"):
        text = (study / name).read_text(encoding="utf-8")
        for command in ("python -m pytest", "phase-resonance run building.toml --grid 8 --check"):
            assert f"- {command}\n" in text.replace("run: ", ""), name
    assert "junit: report/junit.xml\n" in text
    limits = reference.load_scene(study / "building.toml").acceptance
    assert (limits.median, limits.maximum, limits.failed) == (1e-4, 2e-3, 0)
    here = study.parent / "new-repository"
    (here / ".git").mkdir(parents=True)
    before = here.stat().st_ino
    monkeypatch.chdir(here)
    assert (main(["."]), contents(here), here.stat().st_ino) == (0, set(FILES_OF_TEMPLATE), before), (
        "the same directory"
    )


COMMIT = "0123456789abcdef0123456789abcdef01234567"
VCS = {"vcs": "git", "commit_id": COMMIT, "requested_revision": "main"}
REPOSITORY = {"url": "https://me:word@host.org/a.git", "vcs_info": VCS}
FOLDER = {"url": "file:///no/such/folder", "dir_info": {}}


@pytest.mark.parametrize(
    ("recorded", "origin", "address"),
    [  # what pip has recorded, and whether the commit of a checkout is there for others
        ({}, "", f"=={reference.__version__}"),
        (REPOSITORY, "", f" @ git+https://host.org/a.git@{COMMIT}"),
        ({"url": "https://host.org/a.whl", "archive_info": {}}, "", " @ https://host.org/a.whl"),
        (FOLDER, "", " @ file:///no/such/folder"),
        (FOLDER, "https://me:word@host.org/a/b.git", f" @ git+https://host.org/a/b.git@{COMMIT}"),
        (FOLDER, "git@host.org:a/b.git", f" @ git+ssh://git@host.org/a/b.git@{COMMIT}"),
        (FOLDER, "ssh://git:word@host.org/a/b.git", f" @ git+ssh://git@host.org/a/b.git@{COMMIT}"),
        (FOLDER, "/srv/a/b.git", " @ file:///no/such/folder"),
        (None, "git@host.org:a/b.git", f" @ git+ssh://git@host.org/a/b.git@{COMMIT}"),
    ],
)
def test_the_requirement_is_where_others_find_the_project(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, recorded: dict[str, Any] | None, origin: str, address: str
) -> None:
    contained = ["branch", "--remotes", "--contains", COMMIT]  # in a branch that others can fetch
    said = {"rev-parse": COMMIT, "branch": "origin/main" if origin else "", "remote": origin}
    asked: list[list[str]] = []

    def ask_git(folder: Path, *words: str) -> str:
        asked.append([*words])
        return said[words[0]]

    monkeypatch.setattr(source, "ask_git", ask_git)
    text = json.dumps(recorded) if recorded else None  # nothing is recorded of an index or a folder on the path
    monkeypatch.setattr(source, "distribution", lambda name: SimpleNamespace(read_text=lambda file: text))
    monkeypatch.setattr(source, "CHECKOUT_FOLDER", tmp_path)
    if recorded is None:  # not installed: it runs from a checkout
        (tmp_path / "pyproject.toml").touch()
    assert source.make_requirement_line() == f"phase-resonance{address}"
    assert [words for words in asked if words[0] == "branch"] in ([], [contained])
    assert f"\nphase-resonance{address}\n".encode() in make_study_files("x")["requirements.txt"]


def test_the_script_prints_the_numbers_of_the_worst_phases(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["study.py", "--grid", "4"])
    runpy.run_path(str(study / "study.py"), run_name="__main__")
    first, *bodies, pair, one, two, three, demands, drifts = capsys.readouterr().out.splitlines()
    assert first == "Building on a friction pendulum: 16 phase pairs, status ok"
    scene, phases = reference.load_scene(study / "building.toml"), reference.phase_grid(4)
    mu = reference.amplification(scene, phases).mu
    assert bodies == [f"  body {k + 1}: mu from {mu[:, k].min():.3f} to {mu[:, k].max():.3f}" for k in range(3)]
    worst = phases[mu[:, 2].argmax()]
    assert pair == f"phases {worst.round(3).tolist()} rad, like for like:"
    sides = [side.amplification(scene, worst, regularization=1e-3) for side in (reference, multibody)]
    for body, line in enumerate((one, two, three)):
        equations, engine = (f"{side.mu[body]:.4f} ± {side.error[body]:.1g}" for side in sides)
        assert line == f"  body {body + 1}: equations {equations}, engine {engine}"
    motion = reference.trajectory(scene, worst)
    force = (scene.masses[:, None] * motion.absolute_acceleration[:, :, :2]).sum(axis=1)  # horizontal, N
    shear, displacement = (np.linalg.norm(part, axis=1).max() for part in (force, motion.position[:, 0, :2]))
    relative = np.linalg.norm(np.diff(motion.position[:, :, :2], axis=1), axis=2).max(axis=0)
    for line, form, values in (
        (demands, r"  displacement (\S+) m, base shear (\S+) kN", [displacement, 1e-3 * shear]),
        (drifts, r"  drifts (\S+), (\S+) mm", 1e3 * relative),
    ):
        assert (found := re.fullmatch(form, line)), line
        assert [*map(float, found.groups())] == pytest.approx(values, rel=0.02)


def test_the_gate_passes_and_fails_where_a_side_is_off(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gate = runpy.run_path(str(study / "test_building.py"))["test_the_equations_and_the_engine_agree"]
    gate()
    with_engine_off_by(monkeypatch, 1.0015)
    with pytest.raises(AssertionError, match=r"building, body 1: like_for_like: median .* 0\.0015, allowed 0\.001;"):
        gate()


@pytest.mark.parametrize(
    ("schema", "name"), [("github-workflows", ".github/workflows/study.yml"), ("gitlab-ci", ".gitlab-ci.yml")]
)
def test_its_workflows_follow_their_schema(study: Path, schema: str, name: str) -> None:
    check = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", str(study / name)]
    run = subprocess.run(check, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


REFUSED: dict[str, tuple[Callable[[Path], Path], str]] = {
    "something in it": (lambda file: file.parent, "holds 'thesis.txt': give a new directory, or one that is empty"),
    "below a file": (lambda file: file / "study", "cannot be written: Not a directory"),
    "a line break": (lambda file: file.with_name("my\nstudy"), "must be a name of printable characters"),
    "the root": (lambda file: Path("/"), "is the root directory: give a directory inside it"),
    "too long a name": (lambda file: file.with_name("x" * 241), "has a name of more than 240 bytes: give a shorter"),
    "no such place": (lambda file: Path("/proc/no/such"), "cannot be written: "),
}


@pytest.mark.parametrize(("place", "rule"), REFUSED.values(), ids=REFUSED.keys())
def test_a_directory_that_cannot_be_taken_stays_as_it_was(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], place: Callable[[Path], Path], rule: str
) -> None:
    (tmp_path / "thesis.txt").write_text("years of work", encoding="utf-8")
    assert main([str(place(tmp_path / "thesis.txt"))]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith("command line: DIRECTORY = ")
    assert rule in err
    assert contents(tmp_path) == {"thesis.txt"}


@pytest.mark.parametrize(
    ("exists", "function", "full_at"),
    [(False, Path.write_bytes, "requirements.txt"), (False, os.rename, "study"), (True, os.rename, "study.py")],
)
def test_a_full_disk_leaves_nothing_behind(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    exists: bool,
    function: Callable[..., object],
    full_at: str,
) -> None:
    place = tmp_path / "of" / "mine" / "study"
    if exists:
        place.mkdir(parents=True)
    before = sorted(tmp_path.rglob("*"))

    def until_full(source: Path, target: Path | bytes) -> object:
        if Path(target if isinstance(target, Path) else source).name == full_at:
            raise OSError(errno.ENOSPC, "No space left on device")
        return function(source, target)

    monkeypatch.setattr(os if function is os.rename else Path, function.__name__, until_full)
    assert main([str(place)]) == 3
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert err.startswith(f"command line: DIRECTORY = '{place}': could not be written: ")
    assert "No space left on device" in err
    assert sorted(tmp_path.rglob("*")) == before
