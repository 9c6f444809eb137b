"""Words and pictures in, an outcome out; the only network code."""
