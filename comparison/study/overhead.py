"""What a run takes beside what it computes, s, recorded on `models.RECORDED_ON`."""

# said wherever a command may have to compile first
COMPILED_ONCE = "On a new installation the reference is compiled first, once: about half a minute of one worker."
START_UP = 5.0  # worker processes start and load the compiled equations
WRITING = 6.0  # the page and its data are written by one process
