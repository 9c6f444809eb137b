"""What can be said of a recorded episode by rule: how it ended, and twelve tags."""
