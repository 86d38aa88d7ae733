"""What is said of keys of other programs, and of several mistakes in one file."""

import pytest
from chains import refusal

from reference.problem import SceneError, load_scene

TOP = 'title = "x"\nduration = 5.0\n'
BODY = "[[bodies]]\nmass = 1000.0\n"
LOADING = "[excitation]\namplitudes = [[1.0, 1.0], [0.0, 0.0]]\nperiods = [1.0, 2.0]\ndecay = [0.1, 0.1]\n"
YIELDING_HINT, ONE_SURFACE_HINT = "friction that yields before it slides is a table", "one sliding surface is modeled"
NO_DAMPER_HINT = "the isolator has no damper but its friction"


def said_of(folder, isolator="radius = 2.0\nfriction = 0.05\n", body="", loading=LOADING):
    (folder / "mine.toml").write_text(f"{TOP}[isolator]\n{isolator}{BODY}{body}{loading}")
    return refusal(load_scene, folder / "mine.toml", kind=SceneError)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        *(
            (f"{key} = 1e7", YIELDING_HINT)
            for key in ("initial_stiffness", "k_init", "kInit", "uy", "yield_displacement", "k1")
        ),
        *((f"{key} = 0.02", NO_DAMPER_HINT) for key in ("damping", "damping_ratio", "zeta")),
        *((f"{key} = 2.0", "write radius, the effective radius") for key in ("effective_radius", "R_eff", "Reff")),
        *((f"{key} = 2.0", ONE_SURFACE_HINT) for key in ("radius_1", "R1", "mu2", "L1")),
        *((f"{key} = true", ONE_SURFACE_HINT) for key in ("double", "triple")),
        ("mu = 0.1", "write friction, without unit"),
        ("stiffness = 1e6", "follows from radius, friction and the weight"),
        ("displacement_capacity = 0.3", "write travel, m"),
        ("bearings = 12", "did you mean supports?"),
        ("frictoin = 0.1", "did you mean friction?"),
        ("colour = 1", "the keys here are period, radius, friction"),
    ],
)
def test_a_key_of_another_program_is_answered_by_its_meaning(tmp_path, line, said):
    error = said_of(tmp_path, f"radius = 2.0\nfriction = 0.05\n{line}\n")
    assert error.key == f"isolator.{line.split(' ')[0]}"
    assert error.rule.startswith(f"unknown key; {said}")


@pytest.mark.parametrize("line", ["radius = [0.5, 2.0]\nfriction = 0.05", "radius = 2.0\nfriction = [0.05, 0.1]"])
def test_lists_of_surfaces_are_answered_by_what_is_modeled(tmp_path, line):
    error = said_of(tmp_path, f"{line}\n")
    assert error.rule.startswith(f"must be a number: {ONE_SURFACE_HINT}")
    assert "sum of their effective radii" in error.rule


def test_a_hint_has_the_meaning_of_the_key_and_not_only_its_letters(tmp_path):
    assert "did you mean damping" not in said_of(tmp_path, body="duration = 0.05\n").rule
    assert "write damping, as a ratio of critical" in said_of(tmp_path, body="damping_ratio = 0.05\n").rule
    superstructure = "write [superstructure] damping = 0.05"
    assert superstructure in said_of(tmp_path, loading=f"{LOADING}[superstructure]\ndamping_ratio = 0.05\n").rule
    assert superstructure in said_of(tmp_path, body="modal_damping = 0.05\n").rule
    assert said_of(tmp_path, body='name = "roof"\n').rule == "unknown key; write floor, its name"
    assert "write mass, kg" in said_of(tmp_path, body="weight = 0.05\n").rule
    assert (
        "support_"
        not in said_of(tmp_path, "radius = 2.0\nfriction = 0.05\nfilm_stiffness = 1.0\n").rule.split(";")[1][:40]
    )
    for key in ("step", "dt", "unit"):
        recorded = f'[excitation]\nrecord = "a.acc"\n{key} = 1\n'
        assert 'record = {file = "a.acc", step = 0.01, unit = "g"}' in str(said_of(tmp_path, loading=recorded))


def test_all_mistakes_of_a_file_come_in_one_message_in_its_order(tmp_path):
    error = said_of(
        tmp_path,
        'radus = 2.0\nfriction = "a"\n',
        "[[bodies]]\nmass = -1.0\nperid = [1.0, 1.0]\n",
        '[excitation]\nrecord = "gone.csv"\n',
    )
    keys = ["isolator.radus", "isolator.friction", "bodies.1.mass", "bodies.1.perid", "excitation.record"]
    assert [one.key for one in (error, *error.others)] == keys
    line = str(error)
    assert "\n" not in line
    places = [line.index(f"{key} = ") for key in keys]
    assert places == sorted(places)
    assert line.count("; also ") == 4
    assert "No such file or directory" in line


def test_mistakes_follow_the_file_and_not_the_schema(tmp_path):
    text = f"{LOADING.replace('decay', 'decya')}[isolator]\nfriction = 0.1\nraduis = 1.0\n{BODY}colour = 1\n"
    (tmp_path / "mine.toml").write_text(TOP + text)
    error = refusal(load_scene, tmp_path / "mine.toml", kind=SceneError)
    assert [one.key for one in (error, *error.others)] == ["excitation.decya", "isolator.raduis", "bodies.0.colour"]


def test_a_missing_loading_is_named(tmp_path):
    error = said_of(tmp_path, loading="")
    assert (error.key, error.value, error.others) == ("excitation", None, ())
    assert error.rule == (
        'the table [excitation] is missing: give amplitudes, periods and decay, or record = "motion.csv"; '
        "phase-resonance ensemble --suite brings it along"
    )
    assert ": excitation: the table [excitation] is missing" in str(error), "no value is shown where there is none"
