"""
The default study as a user sees it: its pages, its deadline, its second run. For an idle machine with two processors.

`python tests/benchmarks/first_command.py` prints the events alone.
"""

from itertools import pairwise
from pathlib import Path

import pytest
from first_command import Recording, print_costs, recorded

MOST_OVER = 1.0  # s after a deadline
MOST_REPEATED = 5.0  # s


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("anytime")


@pytest.fixture(scope="module")
def recording(place: Path) -> Recording:
    run = recorded(place)
    print_costs(run)
    return run


@pytest.mark.long
def test_the_first_command_on_a_fresh_copy_ends_with_three_pages(recording: Recording) -> None:
    assert recording.code == 0
    assert [summary["run"]["level"] for _, summary in recording.pages] == [1, 2, 3]


@pytest.mark.long
def test_headlines_move_less_from_level_to_level_than_their_spread(recording: Recording) -> None:
    for (_, coarse), (_, fine) in pairwise(recording.pages):
        for before, after in zip(coarse["scenes"], fine["scenes"]):
            for first, second in zip(before["headlines"], after["headlines"]):
                moved = abs(second["mean"] - first["mean"])
                print(f"{first['scene']} mu_{first['body']}: moved {moved:.1e}, spread {first['spread']:.1e}")
                assert moved <= first["spread"]


@pytest.mark.long
@pytest.mark.usefixtures("recording")
def test_a_repeated_run_takes_a_few_seconds(place: Path) -> None:
    again = recorded(place)
    assert again.code == 0
    assert again.seconds <= MOST_REPEATED


@pytest.mark.long
@pytest.mark.parametrize("seconds", [20.0, 40.0, 80.0])
def test_a_deadline_is_overrun_by_a_second_at_most(seconds: float, tmp_path: Path) -> None:
    run = recorded(tmp_path, "--budget", str(seconds), compiled=True)
    print(f"{run.seconds - seconds:+.1f} s, {len(run.pages)} pages, exit code {run.code}")
    assert run.seconds <= seconds + MOST_OVER
    assert run.code == (0 if run.pages else 3)
