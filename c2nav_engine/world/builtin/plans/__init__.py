"""The built-in houses as drawn, one a file."""
