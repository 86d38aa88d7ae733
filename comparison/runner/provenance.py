"""What made a report: command, versions, machine, commit."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

from reference.problem.version import __version__

PACKAGES = ("exudyn", "numba", "numpy", "scipy", "xarray", "h5netcdf", "matplotlib")


def provenance() -> dict[str, str]:
    """Versions, machine and commit, in the order a report shows them."""
    return {
        "phase-resonance": __version__,
        "commit": _commit(),
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
        "exudyn module": import_module("multibody.models.engine").MODULE,
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "processor": _processor(),
        "processors": str(os.cpu_count()),
    }


def _commit() -> str:
    """Commit of the checkout this package runs from; says so if it has changes, or if there is no checkout."""
    folder = Path(__file__).resolve().parents[2]
    try:
        if Path(git(folder, "rev-parse", "--show-toplevel")).resolve() != folder:
            return "installed, not a checkout"
        changed = git(folder, "status", "--porcelain", "--untracked-files=no")
        return git(folder, "rev-parse", "HEAD") + (" with uncommitted changes" if changed else "")
    except (OSError, subprocess.CalledProcessError):
        return "installed, not a checkout"


def git(folder: Path, *arguments: str) -> str:
    """What git says about a folder. Raises OSError or CalledProcessError."""
    done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
