"""The sides whose motions stand beside numbers from elsewhere, by their names in files."""

EQUATIONS, SMOOTHED, ENGINE = "equations", "smoothed", "engine"  # smoothed: with the engine's friction law
