"""What this machine made goes into the user's cache, never into the installed package or to where others may write."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from reference.support import build_cache as module
from reference.support.build_cache import build_folder, user_cache

ROOT = Path(__file__).parents[3]


@pytest.fixture
def fresh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A place for temporary files and a home of its own."""
    monkeypatch.setattr(module, "user_cache", user_cache.__wrapped__)
    monkeypatch.setattr(module.tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    return tmp_path


@pytest.mark.skipif(sys.platform != "linux", reason="the place depends on the system")
def test_on_linux_the_cache_is_below_xdg_cache_home(fresh: Path) -> None:
    assert module.user_cache() == fresh / "xdg" / "phase-resonance"
    assert (fresh / "xdg" / "phase-resonance").is_dir()


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no owners of files")
@pytest.mark.parametrize("planted", ["nothing", "writable by others", "link", "of another user"])
def test_without_a_home_a_private_directory_takes_its_place_and_none_of_others(
    monkeypatch: pytest.MonkeyPatch, fresh: Path, planted: str
) -> None:
    """The user's cache cannot be made: a file is in its place."""
    (fresh / "file").touch()
    monkeypatch.setattr(module.platformdirs, "user_cache_path", lambda *name, **rest: fresh / "file" / "below")
    folder = module.user_cache()
    assert folder == fresh / f"phase-resonance-{os.getuid()}"
    assert folder.stat().st_mode & 0o777 == 0o700
    if planted == "writable by others":
        folder.chmod(0o777)
    elif planted == "link":
        folder.rename(fresh / "elsewhere").chmod(0o700)
        folder.symlink_to(fresh / "elsewhere")
    elif planted == "of another user":
        other = os.getuid() + 1
        monkeypatch.setattr(module.os, "getuid", lambda: other)
        folder.rename(fresh / f"phase-resonance-{other}")
    assert module.user_cache() == (folder if planted == "nothing" else None), "the same in every process"


def test_a_source_in_a_folder_below_has_builds_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "below").mkdir()
    folders = set()
    for source, text in (("one.py", "1"), ("below/two.py", "2"), ("below/two.py", "3")):
        (tmp_path / source).write_text(text)
        folders.add(build_folder(tmp_path))
    assert len(folders) == 3


def test_a_first_call_says_once_that_it_compiles(tmp_path: Path) -> None:
    program = (
        "from reference.support.build_cache import cache_on_disk\n"
        "slow, fast = (cache_on_disk(__file__, slow=slow)(lambda x: x + 1) for slow in (True, False))\n"
        "print(slow(1), slow(2), fast(1))\n"
    )
    (tmp_path / "program.py").write_text(program, encoding="utf-8")
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(ROOT)}
    ran = subprocess.run(
        [sys.executable, "program.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert (ran.stdout, ran.stderr) == ("2 3 2\n", "compiling the reference, once; about 20 s\n")
