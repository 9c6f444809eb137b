"""The shell: answers the core's requests live, from a trace or from a person, and records."""
