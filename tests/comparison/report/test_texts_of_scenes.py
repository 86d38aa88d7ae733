"""Texts of scenes are printed as they are, and numbers as the house writes them."""

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from fake_models import fake_hierarchy
from places import scene_text
from report_texts import page_of
from rich.console import Console
from runs import RUN, Run
from studies import solved

from comparison.registry import EVERYTHING, make_report
from comparison.report.junit import JUnitCase, JUnitSuite, format_junit, format_limits_as_junit
from comparison.report.page import make_page_header_style
from comparison.report.summary_text import render_summary_text
from comparison.runner.progress import make_wide_console, show_progress
from comparison.study.study import Study
from comparison.surfaces.figures.file_names import name_figure_file
from comparison.wording import degrees, mathtext, percent, scientific, signed, significant, symbols
from reference.problem import Scene, load_scene
from reference.support.drawing import escape_for_matplotlib


def test_a_name_with_dots_keeps_them_and_a_long_one_is_cut() -> None:
    assert name_figure_file("a[b=0.02]", "paper") == "a[b=0.02]-paper.png"
    long = [name_figure_file("é" * 150 + end, "body1", "total") for end in "ab"]
    assert len(set(long)) == 2, "two long names are two files"
    assert all(len(name.encode()) <= 255 and name.endswith("-body1-total.png") for name in long)


def test_brackets_in_names_and_titles_are_printed(command: Callable[..., Run], tmp_path: Path) -> None:
    _, rest = scene_text("fig3-I", ("friction = 0.1", "friction = {values = [0.02, 0.04]}")).split("\n", 1)
    (tmp_path / "fam.toml").write_text(f"title = 'a [/b] [bold]c :warning:'\n{rest}", encoding="utf-8")
    scene = str(tmp_path / "fam.toml")
    plan = command(scene, "--plan", "--out", str(tmp_path / "[x] y")).out
    assert ("fam" in plan, "[x] y" in plan) == (True, True)
    assert "fam[friction=0.04]" in command(scene, "--grid", "2").out.split("Relative differences")[1]
    for place in ("fam[friction=0.04].toml", "other/fam.toml"):  # of a scene, and of the family alone
        member = tmp_path / place
        member.parent.mkdir(exist_ok=True)
        member.write_text(scene_text(), encoding="utf-8")
        twice = command(scene, str(member), hierarchy=fake_hierarchy("forbidden"))
        assert (twice.code, twice.err.count("\n")) == (2, 1)
        assert twice.err.startswith(f"{member}: scene = {member.stem!r}: same name as {scene}")


def test_bars_and_consoles_print_brackets(capsys: pytest.CaptureFixture[str]) -> None:
    make_wide_console().print("[red]a[/b] :warning:")
    assert capsys.readouterr().out == "[red]a[/b] :warning:\n"
    console = Console(width=80, force_terminal=True)
    with console.capture() as shown, show_progress(console, 1.0, 1) as display:
        display.advance("x[/b]", "1 of 1 tasks", 1.0)
    assert "x[/b]" in shown.get()


def test_junit_and_summary_are_well_formed_for_any_name() -> None:
    title = "[a](http://b) #1 $x$ &copy; ~~c~~ <b>\n| d"
    valid = load_scene("fig3-I")
    scene = Scene.model_construct(**{**dict(valid), "name": "a\x00\x01\ud800\ufffe<b>", "title": title})
    study = Study((scene,), 2, 1e-3, fake_hierarchy(), selection=EVERYTHING)
    surfaces = solved(study)
    surfaces["mu"].loc[{"model": "spatial", "alpha1": 0.0}] = np.nan
    surfaces["cost"].loc[{"scene": scene.name}] = 2.0 ** np.arange(len(surfaces["model"]))
    results = make_report(study, surfaces, {}, [], RUN, families=[]).results
    assert results.broken
    suites = ElementTree.fromstring(format_limits_as_junit(results).encode())
    assert suites[0].get("name") == "a\ufffd\ufffd\ufffd\ufffd<b>"
    assert float(suites[0].get("time") or "nan") == 2.0 ** len(surfaces["model"]) - 1.0, "of all models"
    text = render_summary_text(results)
    assert r"\[a\](http://b) \#1 \$x\$ \&copy; \~\~c\~\~ \<b\> \| d" in text
    assert "`` run `a` ``" in text
    assert text.count("| 2 of 4 |") == 2, "totals of two bodies, whose status is ok"


def test_a_page_of_records_says_nothing_of_phases(command: Callable[..., Run]) -> None:
    run = command("synthetic-pair")
    page = page_of(run.report)
    top = page[page.index("<h1>") : page.index("</nav")]
    assert "initial phases" not in top
    assert " under the record (synthetic-pair, " in top
    assert "Amplification and motions" in top
    summary = (run.report / "summary.md").read_text(encoding="utf-8")
    assert "1 scene, one value under each recorded motion" in summary
    assert ("48 ×" in summary, "over the phases" in run.out) == (False, False)


NAN = float("nan")


@pytest.mark.parametrize(
    ("write", "value", "written"),
    [
        (symbols, "exact equations, v_reg", "exact equations, v<sub>reg</sub>"),
        (symbols, "k^x_21 Delta", "k<sup>x</sup><sub>21</sub> Δ"),
        (symbols, "F_F = -2 mu lambda_1 sign(lambda_1)", "F<sub>F</sub> = -2 μ λ<sub>1</sub> sign(λ<sub>1</sub>)"),
        (symbols, "dPhi_1/dz_i", "dΦ<sub>1</sub>/dz<sub>i</sub>"),
        (symbols, "the maximum of x < y", "the maximum of x &lt; y"),
        *((percent, *pair) for pair in ((0.123, "12 %"), (0.0123, "1.2 %"), (1e-6, "0.0001 %"))),
        *((percent, *pair) for pair in ((0.996, "100 %"), (1.37, "137 %"), (0.0996, "10 %"), (-0.137, "−14 %"))),
        *((percent, *pair) for pair in ((0.0, "0 %"), (5e-9, "< 0.0001 %"), (-5e-9, "< 0.0001 %"), (NAN, "none"))),
        *((signed, *pair) for pair in ((0.123, "+12 %"), (-0.0123, "−1.2 %"), (0.0, "0 %"), (-5e-9, "< 0.0001 %"))),
        *((scientific, *pair) for pair in ((1.234e-5, "1.2e-05"), (NAN, "none"))),
        *((significant, *pair) for pair in ((0.24849020288, "0.2484902"), (NAN, ""))),
        *((degrees, *pair) for pair in ((3.14159265, "180°"), (NAN, "none"))),
        (mathtext, "exact equations, v_reg", r"exact equations, $v_{\mathrm{reg}}$"),
        (mathtext, "effects on mu_1 over rho", r"effects on $μ_{\mathrm{1}}$ over ρ"),
        (mathtext, "effects on μ_1 over ρ", r"effects on $μ_{\mathrm{1}}$ over ρ"),
        (mathtext, "a $", r"a \$"),
        (escape_for_matplotlib, "5 $ a_b", r"5 \$ a_b"),
    ],
)
def test_names_and_numbers_are_written_as_the_house_writes_them(
    write: Callable[..., str], value: object, written: str
) -> None:
    assert write(value) == written


def test_every_sign_that_could_end_the_style_is_escaped_in_the_header_of_a_page() -> None:
    style = make_page_header_style('Öl: a-b, 2.5 "x"; }\\')
    assert (
        style == '@page { @top-left { content: "Öl: a-b, 2.5 \\22 x\\22 \\3b  \\7d \\5c "; font: 7pt sans-serif; } }\n'
    )
    assert make_page_header_style("") == ""


def test_the_message_of_a_failure_is_its_first_line() -> None:
    cases = [JUnitCase(name="limit", failures=["body 1: too large", "body 2: too large"]), JUnitCase(name="held")]
    suite = JUnitSuite(name="tower", seconds=1.0, timestamp="then", cases=cases)
    [failure] = ElementTree.fromstring(format_junit([suite]).encode()).iter("failure")
    assert failure.get("message") == "body 1: too large"
    assert failure.text == "body 1: too large\nbody 2: too large"
