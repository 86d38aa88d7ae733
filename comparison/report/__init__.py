"""The report: page, figures, summaries."""
