"""How far a solve is, on one line of a terminal or a notebook."""

import contextlib
import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any


class Line:
    """A bar that fills from a projected gradient of 1 to one of 1e-6; nothing of runs shorter than a second."""

    def __init__(self):
        self.began, self.width = time.monotonic(), 0

    def __call__(self, what: str, iteration: int, gradient: float, products: int) -> None:
        if time.monotonic() - self.began < 1:
            return
        text = what
        if products > 0:
            filled = round(20 * min(max(-math.log10(gradient), 0), 6) / 6) if gradient > 0 else 20
            text = f"[{'#' * filled:20}] step {iteration}, projected gradient {gradient:.1e}, {products} products"
        self.write(text)

    def write(self, text: str) -> None:
        sys.stderr.write("\r" + text.ljust(self.width))
        sys.stderr.flush()
        self.width = len(text)


_turn = threading.RLock()  # one thread at a time; what a solve calls may solve something itself


@contextlib.contextmanager
def shown(progress: bool | Callable | None, comm: Any) -> Iterator[Callable | None]:
    """What a solve is to call, once those of other threads have ended; clears the line after it."""
    with _turn, _line(progress, comm) as tell:
        yield tell


@contextlib.contextmanager
def _line(progress: bool | Callable | None, comm: Any) -> Iterator[Callable | None]:
    if callable(progress) or progress is False:
        yield progress or None
        return
    if progress is None and not (sys.stderr.isatty() or "ipykernel" in sys.modules) or (comm is not None and comm.Get_rank() > 0):
        yield None
        return
    line = Line()
    try:
        yield line
    finally:
        if line.width:
            line.write("")
            sys.stderr.write("\r")
