"""The surfaces of a study: differences, statistics, headline."""
