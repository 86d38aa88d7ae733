"""The surfaces of a study, which are amplifications over the two phases: their differences, statistics and headline."""
