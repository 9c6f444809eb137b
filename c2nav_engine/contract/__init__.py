"""The ordinal interface contract: questions, presentations, answers; nonmetric throughout."""
