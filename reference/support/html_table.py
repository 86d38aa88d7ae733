"""Small tables of HTML for notebooks, which show them in place of the text for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape


def text_of_number(value: float, count: int) -> str:
    """Return a number as text with `count` significant digits; "none" if it is not finite."""
    return f"{value:.{count}g}" if math.isfinite(value) else "none"


def html_table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return an HTML table as text, from its caption, the headings of its columns, and the cells of its rows."""
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    body = "".join(f"<tr>{''.join(f'<td>{escape(str(cell))}</td>' for cell in row)}</tr>" for row in rows)
    return f"<p>{escape(caption.strip('<>'))}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
