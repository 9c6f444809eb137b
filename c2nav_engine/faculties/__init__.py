"""Seeing, Remembering, Arriving: they ask and interpret, and own no motion."""
