"""Turning points: which single answer would have led to success?

Three things, kept apart: the regret of every committed answer (no query), the last decision from
which a noiseless observer still succeeds (privileged), and the answers whose change alone, with
the same ranker going on, turns the episode into a success (beside an unchanged control).
"""
