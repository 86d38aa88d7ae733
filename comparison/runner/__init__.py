"""How tasks run: on any executor, cached, resumed, with nothing lost; and the files that commands write."""
