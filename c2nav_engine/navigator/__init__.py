"""The closed loop as a generator: requests, replies, state, config, variants."""
