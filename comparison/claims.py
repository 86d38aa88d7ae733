"""The paper's statements in both readings of (5.1): `python -m comparison.claims`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.evidence.claims.command")
