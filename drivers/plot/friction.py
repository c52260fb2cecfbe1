"""Friction beside closed forms: tractions along a contact from friction_traction.csv, and force over displacement of steps from
friction_loop.csv and friction_joint.csv."""

import matplotlib.pyplot as pyplot
import numpy

from . import style, table

TRACTION = ["source", "x", "pressure", "shear", "bound"]
LOOP = ["source", "step", "displacement", "force"]


def tractions(file, rows):
    """Pressure above, friction and its bound below; lines are the closed form, marks what is computed."""
    x, pressure, shear, bound = (table.numbers(file, rows, name) for name in TRACTION[1:])
    computed = numpy.array([row["source"] == "computed" for row in rows])
    picture, (above, below) = pyplot.subplots(2, 1, sharex=True, figsize=(8.2, 6.6), gridspec_kw=dict(hspace=0.1))
    for axes, values, name in ((above, pressure, "pressure"), (below, shear, "friction")):
        axes.plot(x[~computed], values[~computed], color=style.BLACK, linewidth=1.3, label="closed form")
        axes.plot(x[computed], values[computed], "o", color=style.VERMILLION, markersize=4, clip_on=False, label="computed")
        axes.set_ylabel(f"{name} [MPa]")
    below.plot(x[~computed], bound[~computed], color=style.GREY, linewidth=1.2, linestyle="--", zorder=1,
               label="μ times the pressure")
    for axes in (above, below):
        axes.set_ylim(bottom=0)
        axes.legend(loc="upper right")
    below.set_xlabel("place along the contact x [mm]")
    above.set_title("Cattaneo and Mindlin: pressure and friction")
    picture.align_ylabels([above, below])
    return picture


def loop(file, rows):
    """Force over displacement, with the step's name at the turns."""
    force, displacement = table.numbers(file, rows, "force"), table.numbers(file, rows, "displacement")
    computed = numpy.array([row["source"] == "computed" for row in rows])
    names = [row["step"] for row in rows if row["source"] == "computed"]
    picture, axes = pyplot.subplots(figsize=(8.2, 5.4))
    axes.axhline(0, color=style.GREY, linewidth=0.8)
    axes.axvline(0, color=style.GREY, linewidth=0.8)
    if not computed.all():
        axes.plot(displacement[~computed], force[~computed], color=style.BLACK, linewidth=1.3, label="closed form of a thin strip")
    u, f = displacement[computed], force[computed]
    axes.plot(u, f, "o-" if computed.all() else "o", color=style.VERMILLION, markersize=6, clip_on=False,
              label="computed, a mark each load step")
    turns = [0] + [k for k in range(1, len(u) - 1) if (u[k + 1] - u[k]) * (u[k] - u[k - 1]) < 0]
    for number, k in enumerate(turns):
        if any(abs(u[k] - u[j]) < 0.02 * numpy.ptp(u) and abs(f[k] - f[j]) < 0.02 * numpy.ptp(f) for j in turns[:number]):
            continue  # there is a name already
        offset, side = ((-8, 8), "right") if u[k] >= u.max() else ((8, -16), "left")
        axes.annotate(names[k], (u[k], f[k]), offset, textcoords="offset points", ha=side, fontsize=10)
    axes.margins(y=0.12)
    axes.set_xlabel("displacement of the pulled end [mm]")
    axes.set_ylabel("force of friction [N/mm]" if file.stem == "friction_loop" else "force that pulls [N]")
    axes.legend(loc="upper left")
    axes.set_title(("Clamped strap" if file.stem == "friction_loop" else "Bolted joint") + ": force over displacement")
    return picture
