"""The study: both sides over a grid of initial phases, their differences, and the report."""
