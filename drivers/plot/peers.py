"""Error over time of one problem of drivers/compare/peers, by several programs on several meshes, from their peers.csv."""

import numpy

from . import style, table

PROBLEM = "held_blocks"
TITLE = "held blocks, beside other programs"
COLUMNS = ["problem", "solver", "order", "size", "energy", "total_seconds", "status"]
# Label, colour, marker.
SOLVERS = {"epafi": ("Epafi", style.BLUE, "D"), "snesvi_cholmod": ("SNESVI + CHOLMOD", style.BLACK, "X"),
           "snesvi_hypre": ("SNESVI + hypre", style.GREY, "X"), "snesvi_gamg": ("SNESVI + GAMG", style.PURPLE, "X"),
           "calculix": ("CalculiX", style.VERMILLION, "h"), "calculix_tetrahedra": ("CalculiX, tetrahedra", style.ORANGE, "^")}


def read(directory):
    """Rows of the problem in all peers.csv of DIRECTORY's folders; none if they do not tell the limit of its energy."""
    rows = []
    for file in sorted(directory.glob("*/peers.csv")):
        found = table.read(file)
        if not table.has(found, COLUMNS):
            continue
        for name in ("order", "size", "energy", "total_seconds"):
            table.numbers(file, found, name)
        rows += [row for row in found if row["problem"] == PROBLEM and row["energy"] and row["solver"] in SOLVERS]
    return rows if limit(rows) is not None else []


def limit(rows):
    """Aitken's of Epafi's energies on its finest three meshes of order 2, each with half the size of the one before; None if there
    are none."""
    energies = {int(row["size"]): float(row["energy"]) for row in rows if row["solver"] == "epafi" and int(row["order"]) == 2}
    for n in sorted(energies, reverse=True):
        if n % 4 == 0 and n // 2 in energies and n // 4 in energies:
            coarse, between, fine = energies[n // 4], energies[n // 2], energies[n]
            if coarse > between > fine and coarse - between > between - fine:
                return fine - (between - fine)**2 / (coarse - 2 * between + fine)
    return None


def error(row, exact):
    """Relative, in the energy norm: the energy is half its square."""
    return numpy.sqrt(max(0.0, 1 - float(row["energy"]) / exact))


def draw(axes, rows):
    """Curves; entries for the legend."""
    exact, entries = limit(rows), []
    for solver, (label, colour, marker) in SOLVERS.items():
        for order, line in ((1, ":"), (2, "-")):
            found = sorted((row for row in rows if row["solver"] == solver and int(row["order"]) == order),
                           key=lambda row: float(row["size"]))
            if not found:
                continue
            axes.plot([float(row["total_seconds"]) for row in found], [error(row, exact) for row in found], color=colour, marker=marker,
                      linestyle=line, linewidth=1.1, markersize=6, markerfacecolor=colour if order == 2 else "none")
            entries.append((f"{label}, order {order}", colour, marker, line))
    axes.set_title(TITLE)
    return entries
