"""Error against compute time, for every model and every numerical parameter."""
