"""One look for all pictures: legible, colour-blind safe, no display needed."""

import os

import matplotlib
import matplotlib.colors

matplotlib.use("Agg")

import matplotlib.pyplot as pyplot  # noqa: E402
from matplotlib.transforms import ScaledTranslation  # noqa: E402

from .errors import PlotError  # noqa: E402

# Okabe and Ito's colours, told apart by nearly everyone.
BLUE, ORANGE, GREEN, VERMILLION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY, BLACK, GREY = "#CC79A7", "#56B4E9", "#1A1A1A", "#7A7A7A"
SERIES = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY]
# The same hues, paled, for areas under lines and text.
AREAS = ["#9CC9E5", "#F5D28A", "#8FD3BC", "#EDB9A0", "#DDB6CC", "#F3EE9E", "#C3C3C3", "#B7A6DB"]
ACTIVE = VERMILLION
# Viridis, lightened so that shades and lines on dark parts are still seen.
STRESS = matplotlib.colors.ListedColormap(0.16 + 0.84 * matplotlib.colormaps["viridis"](range(256))[:, :3], "stress")

matplotlib.rcParams.update({
    "font.size": 11,
    "axes.titlesize": 13,
    "axes.labelsize": 11.5,
    "legend.fontsize": 10,
    "xtick.labelsize": 10,
    "ytick.labelsize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "figure.facecolor": "white",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
})


def below(figure, axes):
    """A transform for legends under the axes: clear of their label, however flat they are."""
    return axes.transAxes + ScaledTranslation(0, -0.55, figure.dpi_scale_trans)


class Canvas:
    """Where pictures go."""

    def __init__(self, directory, extension, dpi):
        self.directory, self.extension, self.dpi = directory, extension, dpi

    def save(self, figure, name):
        """Writes the picture; it appears complete or not at all. Returns its path."""
        picture = self.directory / f"{name}.{self.extension}"
        partial = self.directory / f".{name}.{os.getpid()}.partial"
        try:
            self.directory.mkdir(parents=True, exist_ok=True)
            figure.savefig(partial, format=self.extension, dpi=self.dpi, bbox_inches="tight", pad_inches=0.12)
            os.replace(partial, picture)
        except OSError as error:
            partial.unlink(missing_ok=True) if self.directory.is_dir() else None
            raise PlotError(f"picture '{picture}' cannot be written: {error.strerror or error}.") from error
        finally:
            pyplot.close(figure)
        return picture
