"""How far the paper's assumptions hold: `python -m comparison.assumptions`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.analyses.assumptions.command")
