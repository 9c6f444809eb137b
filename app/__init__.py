"""The inspector and the command line."""
