"""The inspector on viser: the one place that imports it."""
