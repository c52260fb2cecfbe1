"""Reads the CSV files that Epafi's programs write."""

import csv

import numpy

from .errors import PlotError


def read(file):
    """Rows as dictionaries."""
    try:
        with open(file, newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise PlotError(f"'{file}' cannot be read as a CSV table: {getattr(error, 'strerror', None) or error}.") from error
    if not rows:
        raise PlotError(f"'{file}' holds no rows; there is nothing to draw.")
    return rows


def has(rows, columns):
    return all(column in rows[0] for column in columns)


def numbers(file, rows, column):
    """A column as numbers; empty entries become NaN."""
    result = []
    for line, row in enumerate(rows, start=2):
        text = (row.get(column) or "").strip()
        try:
            result.append(float(text) if text else numpy.nan)
        except ValueError:
            raise PlotError(f"'{file}', line {line}, column {column}: '{text}' is no number.") from None
    return numpy.array(result)
