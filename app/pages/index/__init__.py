"""Every episode of every run under a folder, as rows that can be filtered, sorted and kept."""
