"""Records the cost and accuracy of every model: `python -m comparison.tradeoff.record`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.cli.record")
