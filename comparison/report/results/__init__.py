"""Results of a study as typed data: `Results` is the whole, every other module one part of it."""
