"""The gate on demands for users: what it lets pass, what it reports, and what it refuses."""

from pathlib import Path
from typing import Any

import pytest
from chains import refusal
from known_analyses import with_engine_off_by

import reference
from comparison.testing import assert_consistent, assert_demands


@pytest.fixture(scope="module")
def moved() -> float:
    """Largest displacement of the isolator in the scene of the gate, m."""
    motion = reference.trajectory(reference.load_scene("synthetic-pair"), (0.0, 0.0))
    return reference.demands(motion).displacement.value


def failure(source: str | Path = "synthetic-pair", **limits: Any) -> list[str]:
    """The lines of the gate that fails."""
    with pytest.raises(AssertionError) as failed:
        assert_demands(source, **limits)
    return str(failed.value).splitlines()


def test_a_demand_within_its_limit_passes_and_one_beyond_it_fails_by_its_excess(moved: float) -> None:
    assert_demands("synthetic-pair", displacement=1.01 * moved)
    count, line = failure(displacement=moved / 1.25)
    assert count == "1 demand: 0 met, 1 not met, 0 not compared"
    assert line.endswith(f"{1e3 * moved:.4g} mm (synthetic-pair.csv), allowed {800 * moved:.4g} mm: not met (by +25 %)")
    assert "(by +25 %)" in failure(displacement=moved / 1.25, statistic="mean")[-1]


def test_accelerations_and_residuals_are_limited_too() -> None:
    assert_demands("synthetic-pair", acceleration=1e3, residual=10.0)
    count, first, second = failure(acceleration=0.1, residual=0.0)
    assert count == "2 demands: 0 met, 2 not met, 0 not compared"
    assert "floor acceleration, as integrated" in first + second
    assert "residual displacement" in first + second


def test_a_limit_on_what_the_engine_alone_has_asks_for_its_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    monkeypatch.setattr("comparison.analyses.ensemble.gate.choose_motions", lambda _, which: asked.append(which) or [])
    for count, name in enumerate(("uplift", "support_displacement"), start=1):
        assert "not compared (no model that was computed has it" in failure(**{name: 1.0})[-1]
        assert asked == [None] * count


def test_limits_of_the_call_take_the_place_of_those_in_the_file(tmp_path: Path, moved: float) -> None:
    text = (Path(reference.__file__).parent / "records/examples/synthetic-pair.toml").read_text()
    record = Path(reference.__file__).parent / "records/examples/synthetic-pair.csv"
    file = tmp_path / "pair.toml"
    limits = f"[acceptance.demands]\ndisplacement = {0.9 * moved}\n"
    file.write_text(text.replace('"synthetic-pair.csv"', f'"{record}"') + limits)
    assert "not met" in failure(file)[-1]
    assert_demands(file, displacement=1.1 * moved)
    count, *_ = failure(file, bounds=(0.5, 1.0))
    assert count.startswith("2 demands: "), "a family has the limit at every scene"


def test_a_family_is_compared_scene_by_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with_engine_off_by(monkeypatch, 1.01)
    text = (Path(reference.__file__).parent / "problem/scenes/fig3-I.toml").read_text()
    (tmp_path / "both.toml").write_text(text.replace("friction = 0.1", "friction = {values = [0.1, 0.2]}"))
    with pytest.raises(AssertionError) as failed:
        assert_consistent(tmp_path / "both.toml", like_for_like=1e-3, grid=2)
    scenes = [line.partition(",")[0] for line in str(failed.value).splitlines()]
    assert scenes == ["both[friction=0.1]"] * 2 + ["both[friction=0.2]"] * 2


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (
            {},
            "no limit: give displacement, support_displacement, drift_ratio, uplift, base_shear, support_force_max, "
            "acceleration, residual or stored",
        ),
        ({"statistic": "mean"}, "no limit"),
        ({"displacement": -1.0}, "displacement = -1.0: must be"),
        ({"displacement": 1.0, "statistic": "median"}, "statistic = 'median': must be one of largest, mean"),
        ({"stored": "nowhere"}, "stored: 'nowhere' has no summary.json"),
        ({"displacement": 1.0, "within": -1.0}, "within = -1.0: must be"),
    ],
)
def test_a_wrong_argument_is_one_line(asked: dict[str, Any], line: str) -> None:
    assert line in str(refusal(assert_demands, "synthetic-pair", **asked))


def test_a_scene_without_a_record_is_refused() -> None:
    assert "an ensemble needs recorded motions" in str(refusal(assert_demands, "fig3-I", displacement=1.0))
