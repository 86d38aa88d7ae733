"""Numbers published elsewhere, by the equations and by the engine."""
