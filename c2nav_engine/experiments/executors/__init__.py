"""Where tasks run: this machine, a Ray cluster, Slurm. One protocol, one kit that tests it."""
