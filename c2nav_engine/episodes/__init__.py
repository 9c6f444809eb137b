"""R2R-CE episodes, embodiment profiles and the built-in hundred."""
