"""Run, cases and report pages."""
