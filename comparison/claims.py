"""The paper's claims against readings of it: `python -m comparison.claims`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.analyses.claims.command")
