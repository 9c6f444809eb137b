"""Two recorded episodes side by side: where they part, and how to walk them together."""
