"""Finds the files and draws every picture that they allow."""

from . import (accuracy, accuracy_peers, contact, convergence, friction, hertz, heterogeneity, mesh, part, plane, pressure, qp,
               scaling, space, spectra, stability, subdomains, surface, table, tables, targets)
from .errors import PlotError
from .run import read_run
from .style import Canvas

STUDIES = ("accuracy.csv", "tables.csv", "qp.csv", "scaling.csv", "stability.csv", "heterogeneity.csv", "hertz.csv",
           "spectra.csv", "targets.csv", "meshes.csv", "friction_traction.csv", "friction_loop.csv", "friction_joint.csv")


def draw(source, output, extension, dpi, box=None, step=None):
    """Yields the path of each picture once it is written."""
    files = find(source)
    for file in files:
        canvas = Canvas(output if output is not None else file.parent, extension, dpi)
        if file.suffix == ".csv":
            yield from draw_table(file, canvas)
        else:
            yield from draw_run(file, canvas, box, step)


def find(source):
    if not source.exists():
        raise PlotError(f"'{source}' does not exist; name an HDF5 file, a CSV table or a directory that holds such.")
    if not source.is_dir():
        return [source]
    found = [file for file in sorted(source.glob("*.h5")) if not file.name.startswith(".")]
    found += [source / name for name in (*STUDIES, "history.csv") if (source / name).is_file()]
    if "history.csv" in [file.name for file in found] and any(file.suffix == ".h5" for file in found):
        found = [file for file in found if file.name != "history.csv"]  # the HDF5 file holds the same history
    if not found:
        raise PlotError(f"directory '{source}' holds neither *.h5 nor {', '.join(STUDIES)}; name the directory of a run "
                        "or study.")
    return found


def draw_run(file, canvas, box, step):
    run = read_run(file, step)
    shown = run if box is None else part.of(run, box)
    stem = run.stem
    in_space = not run.is_plane()
    if run.is_elastic():
        yield canvas.save(space.figure(shown) if in_space else plane.figure(shown, box), f"{stem}_deformed")
    else:
        yield canvas.save(surface.figure(shown), f"{stem}_deflection")
    yield canvas.save(space.decomposition(run) if in_space else subdomains.figure(run), f"{stem}_decomposition")
    if mesh.can_draw(run):
        yield canvas.save(mesh.figure(shown), f"{stem}_mesh")
    for pair in run.contacts:
        if len(pair.points) > 0:
            drawn = pressure.figure(run, pair) if in_space or pair.is_surface() else contact.figure(run, pair)
            yield canvas.save(drawn, f"{stem}_contact_{pair.group}")
    if convergence.can_draw(run.history):
        yield canvas.save(convergence.figure(run.history, run.title), f"{stem}_convergence")


def draw_table(file, canvas):
    rows = table.read(file)
    if table.has(rows, tables.COLUMNS):
        yield canvas.save(tables.figure(rows), file.stem)
    elif table.has(rows, accuracy.COLUMNS):
        for name, picture in accuracy.figures(file, rows):
            yield canvas.save(picture, f"{file.stem}_{name}")
    elif table.has(rows, qp.COLUMNS):
        yield canvas.save(qp.figure(file, rows), file.stem)
    elif table.has(rows, scaling.COLUMNS):
        yield canvas.save(scaling.figure(file, rows), file.stem)
    elif table.has(rows, stability.COLUMNS):
        yield canvas.save(stability.figure(file, rows), file.stem)
    elif table.has(rows, heterogeneity.COLUMNS):
        yield canvas.save(heterogeneity.figure(file, rows), file.stem)
    elif table.has(rows, spectra.COLUMNS):
        yield canvas.save(spectra.figure(file, rows), file.stem)
    elif table.has(rows, hertz.COLUMNS):
        yield canvas.save(hertz.figure(file, rows), file.stem)
    elif table.has(rows, accuracy_peers.COLUMNS):
        yield canvas.save(accuracy_peers.figure(file, rows), file.stem)
    elif table.has(rows, targets.COLUMNS):
        yield canvas.save(targets.figure(file, rows), file.stem)
    elif table.has(rows, targets.MESHES):
        yield canvas.save(targets.meshes(file, rows), file.stem)
    elif table.has(rows, friction.TRACTION):
        yield canvas.save(friction.tractions(file, rows), file.stem)
    elif table.has(rows, friction.LOOP):
        yield canvas.save(friction.loop(file, rows), file.stem)
    elif table.has(rows, convergence.COLUMNS):
        history = convergence.history_of_table(file, rows)
        if not convergence.can_draw(history):
            raise PlotError(f"'{file}' holds no step with a residual to draw.")
        yield canvas.save(convergence.figure(history, file.stem), f"{file.stem}_convergence")
    else:
        raise PlotError(f"'{file}' has neither the columns of tables.csv ({', '.join(tables.COLUMNS)}) "
                        f"nor those of accuracy.csv ({', '.join(accuracy.COLUMNS)}) "
                        f"nor those of qp.csv ({', '.join(qp.COLUMNS)}) "
                        f"nor those of scaling.csv ({', '.join(scaling.COLUMNS)}) "
                        f"nor those of stability.csv ({', '.join(stability.COLUMNS)}) "
                        f"nor those of heterogeneity.csv ({', '.join(heterogeneity.COLUMNS)}) "
                        f"nor those of spectra.csv ({', '.join(spectra.COLUMNS)}) "
                        f"nor those of hertz.csv ({', '.join(hertz.COLUMNS)}) "
                        f"nor those of targets.csv ({', '.join(targets.COLUMNS)}) "
                        f"nor those of meshes.csv ({', '.join(targets.MESHES)}) "
                        f"nor those of friction_traction.csv ({', '.join(friction.TRACTION)}) "
                        f"nor those of friction_loop.csv ({', '.join(friction.LOOP)}) "
                        f"nor those of history.csv ({', '.join(convergence.COLUMNS)}).")
