"""Every model at the extremes of every quantity: `python -m comparison.extremes`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.evidence.extremes.command")
