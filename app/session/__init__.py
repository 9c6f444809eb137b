"""What is open and where one stands: state, commands, the one worker; no viser."""
