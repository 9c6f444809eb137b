"""A set of cases as a folder that can be read, printed, and opened on another machine."""
