"""The paper's tables for any runs, with intervals, paired tests and what they cannot resolve."""
