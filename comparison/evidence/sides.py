"""The sides whose motions are compared with numbers from elsewhere, by their names in files."""

EQUATIONS, SMOOTHED, ENGINE = "equations", "smoothed", "engine"  # smoothed: with the engine's friction law
