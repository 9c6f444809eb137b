"""Seeing, Remembering, Arriving: they ask and interpret, and own no motion.

Each faculty is a generator of questions that is sent outcomes, or a rule that reads them. None
knows the others, the controller or the world.
"""
