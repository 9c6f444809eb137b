"""viser's own page of a scene at rest, for files that open without a server."""
