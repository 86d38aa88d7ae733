"""A valid scene file as text, and edits of it."""

GOOD = """title = "two bodies"
duration = 2.0

[isolator]
period = 1.0
friction = 0.1

[[bodies]]
mass = 3.0

[[bodies]]
mass = 1.0
period = [1.5, 1.2]

[excitation]
amplitudes = [[1.0, 0.0], [0.0, 1.0]]
periods = [0.9, 1.1]
decay = [0.3, 0.2]
"""


def edited(change: str) -> str:
    """GOOD with one line changed: "OLD -> NEW", or NEW in place of the line with the same key."""
    old, arrow, new = (part.strip() for part in change.partition("->"))
    if not arrow:
        old, new = next(line for line in GOOD.splitlines() if line.startswith(old.partition("=")[0])), old
    assert GOOD.count(old) == 1, old
    return GOOD.replace(old, new)
