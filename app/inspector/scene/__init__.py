"""The 3-D layers, one file each."""
