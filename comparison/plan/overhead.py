"""What a run takes beside what it computes, s, recorded on `ladder.RECORDED_ON`."""

START_UP = 5.0  # worker processes start and load the compiled equations
WRITING = 6.0  # the page and its data are written by one process
