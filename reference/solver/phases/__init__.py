"""The phases of a run: rest, sliding, motion under a smooth friction law, stopping."""
