"""docs/claims.md says what docs/claims.json records, and that is what the command finds."""

import json
import re

import claims_page
import pytest

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
RECORD = json.loads(claims_page.RECORD.read_text(encoding="utf-8"))
PAGE = (claims_page.FOLDER / "claims.md").read_text(encoding="utf-8")


def test_the_page_is_what_its_record_says() -> None:
    assert claims_page.render_page(RECORD) == PAGE
    for reading in claims_page.READINGS:
        assert (claims_page.FOLDER / f"claims-{reading.name.replace(' ', '-')}.png").stat().st_size > 50_000


def test_the_record_is_what_the_command_finds() -> None:
    """Verdicts and words are the same, numbers to what other processors round."""
    kept, found = claims_page.TABLE.validate_python(RECORD["table"]), claims_page.compute_table()
    assert (found.grid, found.counts) == (kept.grid, kept.counts)
    assert found.counts == RECORD["table"]["counts"]
    assert claims_page.numbers_met(found) == RECORD["met_by_grid"][str(found.grid)]
    assert len(found.statements) == 16
    for new, old in zip(found.statements, kept.statements, strict=True):
        assert (new.figure, new.says, new.rule, new.cannot) == (old.figure, old.says, old.rule, old.cannot)
        for reading in claims_page.READINGS:
            mine, recorded = new.verdicts[reading.name], old.verdicts[reading.name]
            assert (mine.verdict, NUMBER.sub("0", mine.reason)) == (recorded.verdict, NUMBER.sub("0", recorded.reason))
            numbers = [list(map(float, NUMBER.findall(verdict.reason))) for verdict in (mine, recorded)]
            assert numbers[0] == pytest.approx(numbers[1], rel=0.01, abs=0.11), new.says


def test_numbers_that_depend_on_the_grid_are_said_to() -> None:
    same = {"as integrated": 7, "literal supremum": 8}
    line = claims_page.grids_line({"16": same, "24": same, "32": same})
    assert line == "As many statements are met on 16, 24 and 32 phases per axis."
    line = claims_page.grids_line({"16": {"as integrated": 6, "literal supremum": 8}, "24": same})
    assert line.endswith(
        "depend on the phases per axis: 6 as integrated and 8 literal supremum on 16, "
        "7 as integrated and 8 literal supremum on 24."
    )


def test_the_search_is_said_to_be_a_selection_with_one_number_of_readings() -> None:
    search = RECORD["search"]
    counts = {int(met): count for met, count in search["readings_by_statements_met"].items()}
    assert (sum(counts.values()), max(counts)) == (search["readings"], search["best"]) == (96, 12)
    every = sorted(met for met, count in counts.items() for _ in range(count))
    assert (every[47] + every[48]) / 2 == search["median"]
    assert "2353" not in PAGE
    assert "selected by the number that they meet: that is no evidence" in PAGE
