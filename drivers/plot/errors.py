"""The one error that a user sees."""


class PlotError(Exception):
    """One sentence: what is wrong with which file, and what to do."""
