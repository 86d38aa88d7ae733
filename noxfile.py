"""The tasks of the project, each in an environment of its own: `nox -l` lists them, `nox -s NAME` runs one."""

from __future__ import annotations

import shutil
from pathlib import Path

import nox

nox.needs_version = ">=2024.10.9"
nox.options.default_venv_backend = "uv|virtualenv"
nox.options.sessions = ["lint", "test"]

PYTHONS = ["3.11", "3.12", "3.13", "3.14"]
CORE = (  # short tests of every part, for versions of the dependencies
    "tests/reference/test_closed_form_motions.py",
    "tests/multibody/test_single_run.py",
    "tests/comparison/report/test_report_files.py",
)


@nox.session
def lint(session: nox.Session) -> None:
    """Style, types, layers of imports, spelling, schemas."""
    session.install("-e", ".[test]")
    session.run("ruff", "check")
    session.run("ruff", "format", "--check")
    session.run("mypy")
    session.run("lint-imports")
    session.run("codespell")
    for schema, files in {
        "github-workflows": sorted(Path(".github/workflows").glob("*.yml")),
        "github-issue-forms": [file for file in Path(".github/ISSUE_TEMPLATE").glob("*.yml") if file.stem != "config"],
        "citation-file-format": [Path("CITATION.cff")],
    }.items():
        session.run("check-jsonschema", "--builtin-schema", f"vendor.{schema}", *map(str, files))


@nox.session(python=PYTHONS)
def test(session: nox.Session) -> None:
    """The tests of the gate."""
    session.install(".[test]")
    session.run("python", "-m", "pytest", "-n", "auto", "--dist", "loadfile", *session.posargs)


@nox.session
def long(session: nox.Session) -> None:
    """The tests of more than five seconds."""
    session.install(".[test]")
    session.run("python", "-m", "pytest", "-m", "long", "-n", "2", "--dist", "load", "--durations=30", *session.posargs)


@nox.session
def mistakes(session: nox.Session) -> None:
    """The mistakes of tests/mistakes, planted one at a time: the tests named there see each."""
    session.install("-e", ".[test]")
    session.run("python", "tests/mistakes/plant.py", *session.posargs)


@nox.session
def mutants(session: nox.Session) -> None:
    """Small changes of functions `-- "comparison.surfaces.model_difference*"`: mutmut lists what no test sees."""
    session.install(".[test]", "mutmut>=3.8")
    session.run("mutmut", "run", *session.posargs)
    session.run("mutmut", "results")


@nox.session
def bench(session: nox.Session) -> None:
    """The benchmarks, one after the other."""
    session.install(".[test]")
    options = ["-m", "long or not long", "-s", "--benchmark-enable"]
    session.run("python", "-m", "pytest", "tests/benchmarks", *options, *session.posargs)


@nox.session(python=PYTHONS, venv_backend="uv")
def lowest(session: nox.Session) -> None:
    """The core with the lowest versions that are allowed: deprecations in these are no failures."""
    session.install("--resolution", "lowest-direct", ".[test]")
    session.run("python", "-m", "pytest", "-W", "default", *CORE, *session.posargs)


@nox.session
def package(session: nox.Session) -> None:
    """Source archive and wheel, and a study by the wheel alone."""
    session.install("build", "twine")
    place = Path(session.create_tmp()).resolve()
    output = place / "dist"
    shutil.rmtree(output, ignore_errors=True)
    session.run("python", "-m", "build", "--outdir", str(output))
    session.run("twine", "check", "--strict", *map(str, sorted(output.iterdir())))
    empty = place / "empty"
    shutil.rmtree(empty, ignore_errors=True)
    session.run("python", "-m", "venv", str(empty))
    scripts = empty / ("Scripts" if (empty / "Scripts").is_dir() else "bin")
    (wheel,) = output.glob("*.whl")
    session.run(str(scripts / "python"), "-m", "pip", "install", "--quiet", str(wheel), external=True)
    script = str(scripts / "phase-resonance")
    with session.chdir(place):
        session.run(script, "--version", external=True)
        session.run(script, "run", "fig4-viscous", "--grid", "2", "--only", "surfaces,budget", external=True)


@nox.session
def docs(session: nox.Session) -> None:
    """The documentation as pages, in build/docs."""
    session.install("-e", ".[docs]")
    session.run("sphinx-build", "-W", "--keep-going", "docs", "build/docs", *session.posargs)
