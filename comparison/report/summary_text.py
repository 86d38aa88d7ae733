"""Text of summary.md: the sentences, the limits and the two tables that a pull request should show."""

import re

import jinja2

from comparison.report.results import VALIDATED, Results
from comparison.wording import degrees, percent, signed

MARKDOWN_MARKS = re.compile(r"[\\|<>*_`\[\]#~$&!]")  # characters of GitHub's Markdown that a text must escape


def render_summary_text(results: Results) -> str:
    """Return the text of summary.md in GitHub's Markdown."""
    used = {key for scene in results.scenes for key in scene.models}
    models = [model for model in results.models[1:] if model.key in used]
    loader = jinja2.PackageLoader("comparison.report", "templates")
    environment = jinja2.Environment(loader=loader, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters.update(
        code=_format_as_code, plain=_escape_markdown, degrees=degrees, percent=percent, signed=signed
    )
    text = environment.get_template("summary.md.j2").render(results=results, models=models, validated=VALIDATED)
    return f"{text}\n"


def _format_as_code(text: str) -> str:
    """Return a text as Markdown code, enclosed in more backticks than stand in a row within it."""
    fence = "`" * (1 + max((len(ticks) for ticks in re.findall("`+", text)), default=0))
    space = " " if "`" in text else ""
    return f"{fence}{space}{text}{space}{fence}"


def _escape_markdown(text: str) -> str:
    """Return a text on one line, escaped so that GitHub reads nothing in it as Markdown, HTML or a formula."""
    shown = "".join(letter if letter.isprintable() else " " for letter in text)
    return MARKDOWN_MARKS.sub(r"\\\g<0>", shown)
