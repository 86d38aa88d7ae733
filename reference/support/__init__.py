"""Tools that all packages share: checks of arguments, errors, files, how commands end, builds, drawings, tables."""
