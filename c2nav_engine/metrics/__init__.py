"""Navigation metrics; pure, and closed to the agent."""
