"""What epafi-plot draws, one picture a module."""
