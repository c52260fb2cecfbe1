"""What happens along a contact line: gap, multiplier, active set."""

import matplotlib.pyplot as pyplot
import numpy

from . import style


def spans(arclength, active):
    """Intervals of the closed nodes, each reaching half way to its open neighbours."""
    middles = (arclength[:-1] + arclength[1:]) / 2
    left = numpy.concatenate([arclength[:1], middles])
    right = numpy.concatenate([middles, arclength[-1:]])
    changes = numpy.diff(numpy.concatenate([[0], active.astype(int), [0]]))
    starts, ends = numpy.flatnonzero(changes == 1), numpy.flatnonzero(changes == -1) - 1
    return [(left[a], right[b]) for a, b in zip(starts, ends)]


def show_noise_as_zero(axes, pair, run):
    """Where the contact is closed all along, the gap is what the solver's tolerance leaves: draw it on the scale of u."""
    least = 0.01 * max(float(numpy.abs(body.u).max()) for body in run.bodies)
    largest = float(numpy.abs(pair.gap).max())
    if largest < least:
        axes.set_ylim(-least, least)
        axes.text(0.02, 0.92, f"largest |c − Bu| = {largest:.1e}", transform=axes.transAxes, ha="left", va="top",
                  fontsize=10, color="#555555")


def pieces(pair):
    """The curves of a contact, one after the other with a space between: list of (arclength, contact of its nodes). Nodes between
    facets that are beyond a contact's reach are no curves, if there are any."""
    curves = pair.curves()
    curves = [pair.along(curve) for curve in [curve for curve in curves if len(curve) > 1] or curves]
    total, offset, result = sum(curve.arclength()[-1] for curve in curves), 0.0, []
    for curve in curves:
        result.append((offset + curve.arclength(), curve))
        offset = result[-1][0][-1] + 0.05 * total
    return result


def places_along(curve, points):
    """Arclengths at which points lie across a curve; those beyond its ends are left out."""
    s, found = curve.arclength(), []
    for point in points:
        from_start, step = point - curve.points[:-1], numpy.diff(curve.points, axis=0)
        share = numpy.clip((from_start * step).sum(axis=1) / (step * step).sum(axis=1), 0, 1)
        nearest = int(numpy.argmin(numpy.linalg.norm(from_start - share[:, None] * step, axis=1)))
        place = s[nearest] + share[nearest] * (s[nearest + 1] - s[nearest])
        if 0 < place < s[-1]:
            found.append(place)
    return numpy.array(found)


def draw_meshes(axes, pair, curves):
    """The nodes of both sides, where these are meshed apart."""
    for number, (s, curve) in enumerate(curves):
        if len(s) < 2:
            continue
        facing = s[0] + places_along(curve, pair.facing[0])
        for places, height, color, name in ((s, 0.05, style.BLACK, "nodes of this side"),
                                            (facing, 0.12, style.GREEN, "corners of the other side")):
            axes.plot(places, numpy.full(len(places), height), "|", color=color, markersize=7, markeredgewidth=0.8, clip_on=False,
                      transform=axes.get_xaxis_transform(), label=name if number == 0 else None)


def draw_friction(multiplier, active, curves, dots):
    """The traction beside the pressure, and what slips and sticks. Where all slips they are in the ratio of Coulomb's law."""
    for number, (s, curve) in enumerate(curves):
        multiplier.plot(s, curve.shear(), color=style.BLUE, linewidth=1.6, clip_on=False, **dots,
                        label="friction, along the line" if number == 0 else None)
        active.step(s, curve.friction_state, where="mid", color=style.BLACK, linewidth=1.4)
    multiplier.lines[1].set_label("pressure")
    multiplier.legend(loc="best")
    multiplier.set_ylabel("contact pressure, friction\n[force per area]")
    active.set_yticks([0, 1, 2], ["open", "slips", "sticks"])
    active.set_ylim(-0.5, 2.5)
    active.set_ylabel("")


def figure(run, pair):
    """Gap and multiplier; of elastic bodies the pressure, and friction if there is any."""
    curves = pieces(pair)
    closed = [span for s, curve in curves if len(s) > 1 for span in spans(s, curve.active)]
    dots = dict(marker="o", markersize=3.6) if len(pair.points) <= 130 else {}
    picture, (gap, multiplier, active) = pyplot.subplots(
        3, 1, sharex=True, figsize=(8.2, 7.4), gridspec_kw=dict(height_ratios=[3, 3, 1], hspace=0.14))
    for axes in (gap, multiplier, active):
        for a, b in closed:
            axes.axvspan(a, b, color=style.VERMILLION, alpha=0.10, linewidth=0)

    has_initial = pair.initial_gap is not None and bool(numpy.any(pair.initial_gap != 0))
    for number, (s, curve) in enumerate(curves):
        first = number == 0
        gap.plot(s, curve.gap, color=style.BLUE, linewidth=1.6, clip_on=False, label="remaining gap" if first else None, **dots)
        if has_initial:
            gap.plot(s, curve.initial_gap, color=style.GREY, linewidth=1.2, linestyle="--",
                     label="initial gap" if first else None)
    if has_initial:
        gap.legend(loc="best")
    gap.set_ylabel("gap c − Bu [length]")
    show_noise_as_zero(gap, pair, run)
    if pair.facing is not None:
        draw_meshes(gap, pair, curves)
        gap.legend(loc="best")

    multiplier.axhline(0, color=style.GREY, linewidth=0.8)
    for s, curve in curves:
        multiplier.plot(s, curve.pressure if run.is_elastic() else curve.multiplier, color=style.VERMILLION, linewidth=1.6,
                        clip_on=False, **dots)
        if pair.friction_state is None:
            active.step(s, curve.active.astype(float), where="mid", color=style.BLACK, linewidth=1.4)
    multiplier.set_ylabel("contact pressure\n[force per area]" if run.is_elastic() else "multiplier λ [force a node]")

    active.set_yticks([0, 1], ["open", "closed"])
    active.set_ylim(-0.25, 1.25)
    active.set_ylabel("active set")
    if pair.friction_state is not None:
        draw_friction(multiplier, active, curves, dots)
    active.set_xlabel("arclength along the contact line [length]")
    end = curves[-1][0][-1]
    active.set_xlim(0, end if end > 0 else 1)
    picture.align_ylabels([gap, multiplier, active])
    gap.set_title(f"Contact {pair.name}: {int(pair.active.sum())} of {len(pair.points)} nodes closed, "
                  f"total force {pair.multiplier.sum():.4g} — {run.title}")
    for axes in (gap, multiplier):
        axes.ticklabel_format(axis="y", style="sci", scilimits=(-2, 4))
    return picture
