"""Error against compute time: `python -m comparison.tradeoff`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.evidence.tradeoff.command")
