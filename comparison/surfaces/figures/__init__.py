"""The figures of the report, and those that the commands write."""
