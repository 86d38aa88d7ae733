"""A feature is one folder and its line in the registry: one is added to a copy of the package, each other deleted."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import pytest
from places import HELPERS, ROOT
from report_texts import page_of, summary_of

REGISTRY = "comparison/registry.py"
FOLDER = {
    "__init__.py": "",
    "feature.py": '''
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section
from comparison.result_types import Number


def ratios(findings, scenes):
    """The largest mu_2 over mu_1 of each model."""
    mu = findings.surfaces["mu"].isel(scene=0)
    return (mu.sel(body=2) / mu.sel(body=1)).max(["alpha1", "alpha2"]).values.tolist()


RATIO = ResultField("ratio", list[Number], "ratio of two factors", compute=ratios)
FEATURE = Feature(
    "ratio",
    (RATIO,),
    section=Section("Ratio of the factors"),
    figures=lambda report: {"ratio.txt": str(len(RATIO.read_from(report.results))).encode()},
)
''',
    "section.html.j2": '{% for ratio in results.ratio %}<p class="ratio">{{ ratio }}</p>{% endfor %}',
}
SETS = 6
# one process loads all that names no feature; children of it load the rest without some
CHILDREN = """
import importlib, os, re, sys, traceback
import dask.array, distributed, h5netcdf  # a dataset looks for them
import comparison.report.building, comparison.report.writing, comparison.runner.runner, comparison.surfaces.completion
from pathlib import Path
from runs import RUN

assert not [name for name in sys.modules if re.match(r"comparison\\.(analyses|evidence|registry)", name)]

def load_without(copy, keys):
    comparison.__path__.insert(0, str(copy))
    import reference
    from comparison.cli import start
    start.PACKAGE_FOLDER = copy
    commands = start.list_commands
    from comparison.run import main
    from comparison import registry
    from comparison.report.writing import write_report
    from comparison.study.study import Study
    from comparison.surfaces.surfaces import label_surfaces
    assert Path(registry.__file__).parent == copy
    for command in commands().values():
        importlib.import_module(command.module)
    assert not keys & {*commands()}
    os.chdir(copy)
    assert main(["fig3-I", "--grid", "2", "--plan"]) == 0
    study = Study((reference.load_scene("fig3-I"),), 2, 1e-3, selection=registry.EVERYTHING)
    surfaces = label_surfaces(study, [], [])
    for name, value in {"mu": 2.0, "error": 1e-9, "status": "ok"}.items():
        surfaces[name][:] = value
    report = registry.make_report(study, surfaces, {}, [], RUN, families=())
    place = copy / "report"
    place.mkdir()
    write_report(place, report)
    assert not keys & {feature.key for feature in registry.FEATURES}
    assert not keys & {*registry.EVERYTHING.names}
    pages = (place / "index.html").read_text() + (place / "verification.html").read_text()
    assert not [key for key in keys if f'id="{key}"' in pages]

for copy in map(Path, sys.argv[1:]):
    child = os.fork()
    if child == 0:
        try:
            load_without(copy, {*copy.parent.name.split(",")})
        except BaseException:
            print(f"without {copy.parent.name}:", traceback.format_exc(), file=sys.stderr, flush=True)
            os._exit(1)
        os._exit(0)
    if os.waitpid(child, 0)[1]:
        sys.exit(1)
"""


def folders() -> list[str]:
    """The folders that the registry names."""
    return re.findall(r'_feature\("([\w.]+)"\)', (ROOT / REGISTRY).read_text(encoding="utf-8"))


def copy_package(place: Path) -> Path:
    """Return the registry of a copy of the package in a folder that exists, beside the packages that it needs."""
    for name in ("reference", "multibody"):
        (place / name).symlink_to(ROOT / name)
    shutil.copytree(ROOT / "comparison", place / "comparison")  # with what is compiled of it
    return place / REGISTRY


def replace_once(file: Path, old: str, new: str) -> None:
    """Replace a text that stands once in a file."""
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_every_folder_is_a_feature_or_a_command_with_a_report_of_its_own() -> None:
    rooms = [folder for room in ("analyses", "evidence") for folder in (ROOT / "comparison" / room).glob("*/")]
    rooms = [room for room in rooms if (room / "feature.py").exists() or not (room / "page.py").exists()]
    assert sorted(folders()) == sorted(f"{each.parent.name}.{each.name}" for each in rooms if each.name[0] != "_")


def one_by_one(names: list[str]) -> list[list[str]]:
    return [[name] for name in names]


def in_sets(names: list[str]) -> list[list[str]]:
    """Few sets, each feature in half of them; of any two features one of the sets has the first and not the second."""
    places = dict(zip(names, combinations(range(SETS), SETS // 2), strict=False))
    assert places.keys() == {*names}, "one set more"
    return [[name for name in names if number in places[name]] for number in range(SETS)]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="children of a process that has loaded the packages")
@pytest.mark.parametrize("chosen", [in_sets, pytest.param(one_by_one, marks=pytest.mark.long)])
def test_each_feature_can_be_deleted(chosen: Callable[[list[str]], list[list[str]]], tmp_path: Path) -> None:
    """Without their folders and lines the commands, the plan and a report do without them, and no other needs them."""
    copies = []
    for deleted in chosen(folders()):
        keys = [folder.split(".")[1] for folder in deleted]
        copies.append(tmp_path / ",".join(keys) / "comparison")
        for name in ("analyses", "evidence"):
            shutil.copytree(ROOT / "comparison" / name, copies[-1] / name)
        shutil.copy(ROOT / REGISTRY, copies[-1])
        for folder in deleted:
            replace_once(copies[-1] / "registry.py", f'    _load_feature("{folder}"),\n', "")
            shutil.rmtree(copies[-1].joinpath(*folder.split(".")))
        others = "".join(file.read_text(encoding="utf-8") for file in copies[-1].rglob("*.j2"))
        assert not [key for key in keys if f'"{key}/' in others], "no template reads another feature's"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (HELPERS, ROOT)))}
    run = subprocess.run(
        [sys.executable, "-P", "-c", CHILDREN, *map(str, copies)],
        cwd=tmp_path,
        env={**environment, "PYTHONDONTWRITEBYTECODE": "1"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr


@pytest.mark.long
def test_a_folder_and_its_line_are_a_feature(tmp_path: Path) -> None:
    """A copy of the package has the feature `ratio` besides: in file, page and figures."""
    registry, report = copy_package(tmp_path), tmp_path / "report"
    folder = tmp_path / "comparison" / "evidence" / "ratio"
    folder.mkdir()
    for name, text in FOLDER.items():
        (folder / name).write_text(text, encoding="utf-8")
    claims = '    _load_feature("evidence.claims"),\n'
    replace_once(registry, claims, f'{claims}    _load_feature("evidence.ratio"),\n')
    command = [sys.executable, "-P", "-m", "comparison.run", "fig3-I", "--grid", "2", "--only", "surfaces,ratio"]
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    subprocess.run([*command, "--out", str(report)], cwd=tmp_path, env=environment, check=True)
    summary = summary_of(report)
    count = len(summary["models"])
    assert (len(summary["ratio"]), page_of(report).count('<p class="ratio">')) == (count, count)
    assert (report / "figures" / "ratio.txt").read_text() == str(count)
    assert '"ratio"' in (report / "summary.schema.json").read_text(encoding="utf-8")
