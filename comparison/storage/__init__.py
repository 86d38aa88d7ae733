"""What is kept on disk: the cache of results, and the folders that commands write for the user."""
