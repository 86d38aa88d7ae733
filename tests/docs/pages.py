"""
The pages of the documentation and their blocks of code.

A comment in front of a block says how the tests run it:

- no comment: as it stands, in the order of the page, all blocks of a page in one folder and one Python session;
- `<!-- test: long -->`: only by `pytest -m long`;
- `<!-- test: with WORDS -->`: with these words added to the command, for example `--plan` or `--grid 2`;
- `<!-- test: not run: REASON -->`: its syntax alone is checked.

`long, with WORDS` combines the two. A block that begins with `# NAME.SUFFIX` is that file and is written into the
folder. A `text` block after Python is what it prints.
"""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("reference", "multibody", "comparison")
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / name / "README.md" for name in PACKAGES)])
FENCE = re.compile(r"(?:^<!-- test: ([^>]*?) -->\n)?^```([a-z]*)\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
DIRECTIVE = re.compile(r"^(`{3,})\{.*?^\1$", flags=re.MULTILINE | re.DOTALL)  # of sphinx, such as a table of contents


@dataclass(frozen=True)
class Block:
    """One block of code of a page."""

    page: Path
    line: int
    language: str
    source: str
    comment: str  # how it is tested; "" as it stands

    @property
    def name(self) -> str:
        return f"{self.page.relative_to(ROOT)}:{self.line}"

    @property
    def long(self) -> bool:
        return self.comment.startswith("long")

    @property
    def skipped(self) -> bool:
        return self.comment.startswith("not run: ")

    @property
    def words(self) -> list[str]:
        """Words that the test adds to its command."""
        return self.comment.split("with ", 1)[1].split() if "with " in self.comment and not self.skipped else []


def blocks(page: Path) -> list[Block]:
    """All blocks of a page, in their order."""
    text = DIRECTIVE.sub(lambda match: "\n" * match[0].count("\n"), page.read_text(encoding="utf-8"))
    return [
        Block(page, text.count("\n", 0, match.start(2)) + 1, match[2], match[3], match[1] or "")
        for match in FENCE.finditer(text)
    ]
