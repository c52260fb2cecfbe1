"""peers.csv, and the table that is printed."""

import csv
import math
import os
import statistics
import tempfile

COLUMNS = ["problem", "unknowns", "solver", "total_seconds", "iterations", "energy", "peak_bytes", "ratio", "repeats",
           "minimum", "maximum", "assembly_seconds", "setup_seconds", "linear_iterations", "energy_error", "size",
           "tolerance", "status", "reason", "ranks", "closed_nodes", "order", "lower_size", "multipliers"]
ENERGY_TOLERANCE = 1e-6  # relative


def rows(options, runs, trouble, known):
    """A row for each solver; what is not known stays empty."""
    epafi = summarised(runs.get("epafi") or [])
    energy = known.energy if known else epafi.get("energy")
    result = []
    for name in options.solvers:
        row = dict.fromkeys(COLUMNS, "")
        row.update(problem=options.problem, solver=name, size=options.size, tolerance=options.tolerance,
                   ranks=options.ranks, order=options.order, lower_size=options.lower_size or options.size,
                   multipliers=options.multipliers)
        if name in trouble:
            row.update(status=trouble[name].status, reason=str(trouble[name]), repeats=len(runs[name]))
        else:
            row.update(summarised(runs[name]))
            row.update(judged(row["energy"], energy, math.inf if name.startswith("calculix") else ENERGY_TOLERANCE))
            if epafi and "epafi" not in trouble:
                row["ratio"] = row["total_seconds"] / epafi["total_seconds"]
        result.append(row)
    return result


def summarised(runs):
    """Medians of the times; the rest is the same in all runs but for the memory, whose greatest counts."""
    if not runs:
        return {}
    total = [run["total_seconds"] for run in runs]
    result = {name: statistics.median(run[name] for run in runs)
              for name in ("assembly_seconds", "setup_seconds") if name in runs[0]}
    result.update({name: runs[-1].get(name, "")
                   for name in ("unknowns", "iterations", "linear_iterations", "energy", "closed_nodes")})
    result.update(total_seconds=statistics.median(total), minimum=min(total), maximum=max(total), repeats=len(runs),
                  peak_bytes=max(run["peak_bytes"] for run in runs))
    return result


def judged(energy, reference, tolerance):
    """Elements of another kind have another energy: their tolerance is infinite."""
    if reference is None:
        return {"status": "unchecked", "reason": "no energy to compare with"}
    error = abs(energy - reference) / abs(reference)
    if math.isfinite(error) and error <= tolerance:
        return {"energy_error": error, "status": "ok"}
    return {"energy_error": error, "status": "inaccurate",
            "reason": f"the energy is off by {error:.1e} relative, more than {tolerance:g}"}


def write(file, content):
    """The whole file or none."""
    handle, part = tempfile.mkstemp(prefix=".peers-", suffix=".csv", dir=file.parent)
    try:
        with open(handle, "w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(content)
        os.chmod(part, 0o644)
        os.replace(part, file)
    except BaseException:
        os.unlink(part)
        raise


def text(options, content, known):
    cores = "one rank, one thread" if options.ranks == 1 else f"{options.ranks} ranks (CHOLMOD: threads)"
    below = f" over {options.lower_size}" if options.lower_size else ""
    side = ", mortars on the upper" if options.multipliers == "upper" else ""
    lines = ["", f"{options.problem} {options.family.TITLE} = {options.size}{below}{side}, order {options.order}, tolerance {options.tolerance:g}: medians of "
                 f"{options.repeats}, {cores}", ""]
    cells = [["solver", "seconds", "least", "greatest", "x epafi", "iterations", "memory", "energy", "off by"]]
    cells += [printed(row) for row in content]
    widths = [max(len(line[k]) for line in cells) for k in range(len(cells[0]))]
    for line in cells:
        lines.append("  ".join(cell.ljust(width) if k == 0 else cell.rjust(width)
                               for k, (cell, width) in enumerate(zip(line, widths))).rstrip())
    lines.append("")
    lines += [f"{row['solver']} {row['status']}: {row['reason']}" for row in content if row["reason"]]
    lines.append("Energies are compared with " + ("test/reference/membranes.csv." if known else
                 "epafi's, because test/reference/membranes.csv has none for this size."))
    lines.append(options.family.NOTE)
    return "\n".join(lines)


def printed(row):
    if row["total_seconds"] == "":
        return [row["solver"], row["status"], *[""] * 7]
    inner = f" ({row['linear_iterations']} CG)" if row["solver"].endswith(("_hypre", "_gamg")) else ""
    return [row["solver"], *(f"{row[name]:.3f}" for name in ("total_seconds", "minimum", "maximum")),
            "" if row["ratio"] == "" else f"{row['ratio']:.2f}", f"{row['iterations']}{inner}",
            f"{row['peak_bytes'] / 1e6:.0f} MB", f"{row['energy']:.12g}",
            "" if row["energy_error"] == "" else f"{row['energy_error']:.0e}"]
