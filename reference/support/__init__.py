"""Tools that all packages share: checks of arguments, errors, files, command endings, builds, drawings, tables."""
