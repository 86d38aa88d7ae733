"""The command line: the options, and the commands other than the study."""
