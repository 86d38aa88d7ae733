"""summary.md: the sentences, the limits and the two tables that a pull request should show."""

import re

import jinja2

from comparison.report.results import VALIDATED, Results
from comparison.wording import degrees, percent, signed

MARKS = re.compile(r"[\\|<>*_`\[\]#~$&!]")


def summary_text(results: Results) -> str:
    """GitHub's Markdown."""
    used = {key for scene in results.scenes for key in scene.models}
    models = [model for model in results.models[1:] if model.key in used]
    loader = jinja2.PackageLoader("comparison.report", "templates")
    environment = jinja2.Environment(loader=loader, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters.update(code=_as_code, plain=_as_plain_text, degrees=degrees, percent=percent, signed=signed)
    text = environment.get_template("summary.md.j2").render(results=results, models=models, validated=VALIDATED)
    return f"{text}\n"


def _as_code(text: str) -> str:
    """A text as code, between more backticks than stand in it anywhere."""
    fence = "`" * (1 + max((len(ticks) for ticks in re.findall("`+", text)), default=0))
    space = " " if "`" in text else ""
    return f"{fence}{space}{text}{space}{fence}"


def _as_plain_text(text: str) -> str:
    """A text on one line in which nothing is read as Markdown, HTML or a formula."""
    shown = "".join(letter if letter.isprintable() else " " for letter in text)
    return MARKS.sub(r"\\\g<0>", shown)
