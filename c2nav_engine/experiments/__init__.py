"""Variants × episodes × rankers: specs, ledger, executors, observers, statistics, reports."""
