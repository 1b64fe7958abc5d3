"""The one door to matplotlib, typed: figures of panels, drawn without pyplot and without its global state.

Only what our pictures need is let through. matplotlib is an optional package; it is imported when a canvas is made.
Colours are those of Okabe and Ito (2008), which colour-blind readers can tell apart, and viridis or cividis where a
scale is needed.
"""
# matplotlib's signatures take keyword arguments of unknown type
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError, MissingDependencyError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

FORMATS: dict[str, dict[str, None]] = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
"""Known suffixes and the metadata that is left out, so that a picture does not depend on the day it was drawn."""

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#F0E442")
"""Okabe and Ito's colours, the strongest on white first."""

GREY = "#8A8A8A"
_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
_LINES = ("-", "--", "-.", ":", "--", "-.", "-", ":")
_DOTS_PER_INCH = 150
_PAGE_DOTS_PER_INCH = 80
"""Of a picture in a notebook, where it stands beside text."""
_LINE_PT = 12.5
"""Height of a line of labels at the ends of curves."""
_PLAIN = {"boxstyle": "square,pad=0.03", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
"""Ground for words that lines may cross."""


def check_suffix(path: Path) -> str:
    """The suffix of a picture's file, or an :class:`InputError` that lists those that can be written."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise InputError(f"a picture is written as {', '.join(FORMATS)}; got {path.name!r}: change the suffix")
    return suffix


def require_matplotlib() -> None:
    """Raise :class:`MissingDependencyError` where matplotlib is not installed, before work is done in vain."""
    try:
        import matplotlib.figure  # noqa: F401  # pyright: ignore[reportUnusedImport]
    except ImportError as error:
        raise MissingDependencyError("matplotlib", "plot", "drawing a picture") from error


class Canvas:
    """A figure of ``rows`` × ``columns`` panels, counted row by row; ``heights`` are the rows', relative."""

    def __init__(
        self,
        *,
        rows: int = 1,
        columns: int = 1,
        width_in: float,
        height_in: float,
        heights: Sequence[float] | None = None,
    ) -> None:
        require_matplotlib()
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.figure: Figure = Figure(figsize=(width_in, height_in), dpi=_DOTS_PER_INCH, layout="constrained")
        FigureCanvasAgg(self.figure)
        self.figure.get_layout_engine().set(w_pad=0.08, h_pad=0.08)  # pyright: ignore[reportOptionalMemberAccess, reportCallIssue]
        grid: Sequence[Axes] = self.figure.subplots(
            rows, columns, squeeze=False, height_ratios=heights
        ).ravel().tolist()  # fmt: skip
        self.panels: tuple[Panel, ...] = tuple(Panel(axes) for axes in grid)

    def title(self, *lines: str) -> None:
        self.figure.suptitle("\n".join(lines), fontsize=12 if len(lines) == 1 else 11)

    def legend_below(self, panel: Panel, *, columns: int) -> None:
        """What is labelled in ``panel``, in one legend below all panels."""
        handles, labels = panel.axes.get_legend_handles_labels()
        self.figure.legend(
            handles, labels, fontsize=9, ncols=columns, loc="outside lower center", frameon=False, columnspacing=1.6
        )

    def save(self, path: Path | str) -> None:
        """Write the picture as PNG, SVG or PDF by its suffix, whole or not at all."""
        path = Path(path)
        suffix = check_suffix(path)
        write_atomically(path, lambda stream: self.figure.savefig(stream, format=suffix[1:], metadata=FORMATS[suffix]))

    def _repr_html_(self) -> str:
        """The picture for a notebook: on white ground, whatever the page's, with two dots for each of the page."""
        stream = BytesIO()
        self.figure.savefig(stream, format="png", dpi=2 * _PAGE_DOTS_PER_INCH)
        data = b64encode(stream.getvalue()).decode("ascii")
        width = round(self.figure.get_figwidth() * _PAGE_DOTS_PER_INCH)
        style = "max-width:100%;height:auto;border-radius:4px"
        return f'<img alt="picture" width="{width}" style="{style}" src="data:image/png;base64,{data}">'


class Panel:
    """One pair of axes."""

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self._curves: list[tuple[Line2D, str]] = []
        axes.tick_params(labelsize=9)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)

    def describe(self, title: str, x_label: str, y_label: str) -> None:
        self.axes.set_title(title, fontsize=11, loc="left")
        self.axes.set_xlabel(x_label, fontsize=10)
        self.axes.set_ylabel(y_label, fontsize=10)

    def grid(self) -> None:
        self.axes.grid(visible=True, color="#DDDDDD", linewidth=0.6)
        self.axes.set_axisbelow(True)

    def scales(self, *, x: Literal["linear", "log"] | None = None, y: Literal["linear", "log"] | None = None) -> None:
        """Set scales, which takes ticks back to the usual ones; an axis that is not named stays as it is."""
        if x is not None:
            self.axes.set_xscale(x)
        if y is not None:
            self.axes.set_yscale(y)

    def limits(self, *, x: tuple[float, float] | None = None, y: tuple[float, float] | None = None) -> None:
        if x is not None:
            self.axes.set_xlim(x)
        if y is not None:
            self.axes.set_ylim(y)

    def ticks(
        self, axis: Literal["x", "y"], at: Sequence[float], labels: Sequence[str], *, slanted: bool = False
    ) -> None:
        """Ticks with these labels and no others, in between neither; slanted ones end at their tick."""
        if axis == "x":
            self.axes.set_xticks(
                list(at), list(labels), rotation=45 if slanted else 0, ha="right" if slanted else "center",
                rotation_mode="anchor" if slanted else "default",
            )  # fmt: skip
            self.axes.set_xticks([], minor=True)
        else:
            self.axes.set_yticks(list(at), list(labels))
            self.axes.set_yticks([], minor=True)

    def curve(
        self,
        x: ArrayLike,
        y: ArrayLike,
        *,
        label: str,
        style: int,
        between: tuple[FloatArray, FloatArray] | None = None,
        marked: bool = True,
        joined: bool = True,
        dodge_pt: float = 0.0,
    ) -> None:
        """A curve in the palette's colour and marker number ``style``; beyond the palette, colours meet other markers.

        Error bars reach from a lower to an upper value of each point, ``between``. What would lie on other curves is
        drawn ``dodge_pt`` beside its place.
        """
        from matplotlib.transforms import ScaledTranslation

        turn = style // len(PALETTE)
        error = None
        if between is not None:  # percentiles of few draws may miss the figure itself
            ends = np.asarray(y, dtype=float) - between[0], between[1] - np.asarray(y, dtype=float)
            error = np.maximum(np.stack(ends), 0.0)
        drawn = self.axes.errorbar(
            np.asarray(x, dtype=float),
            np.asarray(y, dtype=float),
            yerr=error,
            label=label,
            color=PALETTE[style % len(PALETTE)],
            linestyle=_LINES[(style + turn) % len(_LINES)] if joined else "none",
            marker=_MARKERS[(style + 3 * turn) % len(_MARKERS)] if marked else "none",
            markersize=5,
            linewidth=1.6,
            elinewidth=1.0,
            capsize=2.5,
        )
        shift = ScaledTranslation(dodge_pt / 72.0, 0.0, self._figure().dpi_scale_trans)
        for artist in drawn.get_children():
            artist.set_transform(artist.get_transform() + shift)
        self._curves.append((drawn.lines[0], label))

    def bars(
        self,
        x: ArrayLike,
        height: ArrayLike,
        *,
        width: float,
        colour: str | Sequence[str],
        label: str | None = None,
        between: tuple[FloatArray, FloatArray] | None = None,
    ) -> None:
        tops = np.asarray(height, dtype=float)
        self.axes.bar(
            np.asarray(x, dtype=float),
            tops,
            width=width,
            color=colour,
            label=label,
            yerr=None if between is None else np.maximum(np.stack([tops - between[0], between[1] - tops]), 0.0),
            capsize=2.5,
            edgecolor="#333333" if width > 0.2 and np.size(x) <= 64 else "none",
            linewidth=0.4,
        )

    def columns(self, x: ArrayLike, bottom: ArrayLike, top: ArrayLike, *, colour: str, label: str) -> None:
        """Columns from ``bottom`` to ``top``, for stacking, on a logarithmic axis too."""
        start, end = np.asarray(bottom, dtype=float), np.asarray(top, dtype=float)
        self.axes.bar(
            np.asarray(x, dtype=float), end - start, bottom=start, width=0.9, color=colour, label=label, linewidth=0.0
        )  # fmt: skip

    def path(self, x: ArrayLike, y: ArrayLike, *, colour: str, label: str | None = None) -> None:
        """A plain line."""
        self.axes.plot(np.asarray(x, dtype=float), np.asarray(y, dtype=float), color=colour, linewidth=1.5, label=label)

    def strip(self, x: ArrayLike, colours: Sequence[str], *, below: float) -> None:
        """A row of coloured fields from ``below``, a negative value, almost up to zero, and room for it."""
        positions = np.asarray(x, dtype=float)
        self.axes.bar(positions, np.full(positions.size, -0.8 * below), bottom=below, width=1.0, color=colours)
        self.axes.set_ylim(bottom=1.2 * below)

    def marks(self, x: ArrayLike, y: ArrayLike, *, size_pt: float, shape: str, colour: str, label: str | None) -> None:
        """Separate marks with a thin edge, so that they show on light and dark ground."""
        self.axes.plot(
            np.asarray(x, dtype=float),
            np.asarray(y, dtype=float),
            linestyle="none",
            marker=shape,
            markersize=size_pt,
            markerfacecolor=colour,
            markeredgecolor="black",
            markeredgewidth=min(0.8, size_pt / 5),
            label=label,
        )

    def level(self, y: float, *, label: str, colour: str = "black") -> None:
        """A dashed line across the panel."""
        self.axes.axhline(y, color=colour, linestyle="--", linewidth=1.3, label=label)

    def upright(self, x: float, *, label: str) -> None:
        """A dashed line from bottom to top."""
        self.axes.axvline(x, color="black", linestyle="--", linewidth=1.3, label=label)

    def span(self, x_from: float, x_to: float, y: float, *, colour: str, label: str | None) -> None:
        """A line at the height ``y`` with a stroke across its end ``x_to``."""
        self.axes.plot([x_from, x_to], [y, y], color=colour, linewidth=2.0, label=label)
        self.axes.plot([x_to], [y], color=colour, marker="|", markersize=11, markeredgewidth=2.0)

    def tag(self, x: float, y: float, text: str) -> None:
        """A few words above a mark, to that side of it where there is room."""
        at = self.axes.transAxes.inverted().transform(self.axes.transData.transform((x, y)))[0]
        side: Literal["left", "center", "right"] = "left" if at < 0.15 else "right" if at > 0.85 else "center"
        offset = {"left": -4, "center": 0, "right": 4}[side]
        self.axes.annotate(
            text, (x, y), xytext=(offset, 7.5), textcoords="offset points", ha=side, va="bottom", fontsize=8.5,
            bbox=_PLAIN,
        )  # fmt: skip

    def caption(self, y: float, text: str) -> None:
        """A few words at the height ``y`` instead of a mark."""
        self.axes.text(
            0.02, y, text, transform=self.axes.get_yaxis_transform(), ha="left", va="center", fontsize=8.5,
            color="#555555", style="italic", bbox=_PLAIN,
        )  # fmt: skip

    def corner(self, text: str) -> None:
        """A few words in the upper left corner."""
        self.axes.text(
            0.02, 0.98, text, transform=self.axes.transAxes, ha="left", va="top", fontsize=8.5, color="#555555",
            style="italic", bbox=_PLAIN,
        )  # fmt: skip

    def band(self, low: float, high: float, *, label: str) -> None:
        """A shaded band across the panel."""
        self.axes.axhspan(low, high, color="#F6D9C4", linewidth=0.0, label=label, zorder=0.5)

    def ribbon(self, x: ArrayLike, low: ArrayLike, high: ArrayLike, *, colour: str, label: str) -> None:
        """A shaded area between two curves."""
        self.axes.fill_between(
            np.asarray(x, dtype=float), np.asarray(low, dtype=float), np.asarray(high, dtype=float),
            color=colour, alpha=0.25, linewidth=0.0, label=label,
        )  # fmt: skip

    def guide(self, x: ArrayLike, y: ArrayLike, *, label: str) -> None:
        """A thin dashed curve to compare others with."""
        drawn = self.axes.plot(
            np.asarray(x, dtype=float), np.asarray(y, dtype=float),
            color="black", linestyle="--", linewidth=1.0, label=label,
        )  # fmt: skip
        self._curves.append((drawn[0], label))

    def segments(self, x_from: ArrayLike, x_to: ArrayLike, y: ArrayLike, *, label: str) -> None:
        self.axes.hlines(np.asarray(y), np.asarray(x_from), np.asarray(x_to), color="black", linewidth=1.8, label=label)

    def matrix(self, values: FloatArray, *, limits: tuple[float, float], clipped: bool, colour_label: str) -> None:
        """A (row, column) image with its colour scale; NaN entries show as hatched grey."""
        self.axes.patch.set(facecolor="#D9D9D9", edgecolor="#8A8A8A", hatch="//////", linewidth=0.0)
        image = self.axes.imshow(
            np.ma.masked_invalid(values), aspect="auto", interpolation="nearest", cmap="viridis",
            vmin=limits[0], vmax=limits[1],
        )  # fmt: skip
        for side in ("top", "right"):
            self.axes.spines[side].set_visible(True)
        bar = self._figure().colorbar(image, ax=self.axes, extend="min" if clipped else "neither", pad=0.02)
        bar.set_label(colour_label, fontsize=10)
        bar.ax.tick_params(labelsize=9)

    def fade(self, where: BoolArray) -> None:
        """Make these entries of the matrix paler, for matrices too fine for marks."""
        self.axes.imshow(
            np.where(where[..., np.newaxis], (1.0, 1.0, 1.0, 0.5), 0.0), aspect="auto", interpolation="nearest"
        )

    def colour_scale(self, count: int, *, label: str) -> tuple[str, ...]:
        """``count`` colours along cividis, with their scale (1 … count) beside the panel."""
        from matplotlib import colormaps
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize, to_hex

        scale = ScalarMappable(Normalize(1, count), colormaps["cividis"])
        bar = self._figure().colorbar(scale, ax=self.axes, pad=0.02)
        bar.set_label(label, fontsize=10)
        bar.ax.tick_params(labelsize=9)
        return tuple(to_hex(rgba) for rgba in colormaps["cividis"](np.linspace(0.0, 1.0, count)).tolist())

    def swatch(self, colour: str, label: str) -> None:
        """An entry in the legend for a colour, without anything drawn."""
        self.axes.bar([np.nan], [np.nan], color=colour, edgecolor="#333333", linewidth=0.4, label=label)

    def note(self, text: str) -> None:
        """Text in the middle of a panel that has nothing to draw, instead of its axes."""
        self.axes.set_axis_off()
        self.axes.text(
            0.5, 0.5, text, transform=self.axes.transAxes, ha="center", va="center", fontsize=10,
            bbox={"boxstyle": "round,pad=0.5", "facecolor": "white", "edgecolor": "#8A8A8A"},
        )  # fmt: skip

    def legend(self, *, columns: int = 1, place: Literal["best", "upper left", "upper center"] = "best") -> None:
        """The legend, where it covers least unless a place is named; nothing where nothing has a label."""
        handles, labels = self.axes.get_legend_handles_labels()
        if labels:
            self.axes.legend(
                handles, labels, fontsize=8.5, ncols=columns, framealpha=0.9, loc=place,
                columnspacing=0.9, handlelength=1.4, handletextpad=0.5,
            )  # fmt: skip

    def label_ends(self, texts: Mapping[str, str] | None = None) -> None:
        """Each curve's label, or its text of these, beside its last point, apart from the others; when all is drawn.

        A legend that covers nothing, and tells apart the curves that end in one place.
        """
        curves = [(line, texts[label] if texts else label) for line, label in self._curves]
        self.axes.autoscale_view()
        ends = [self._end_of(line) for line, _ in curves]
        heights = [_LINE_PT * (1 + text.count("\n")) / self.size_pt()[1] for _, text in curves]
        for (line, text), end, at in zip(curves, ends, apart([y for _, y in ends], heights), strict=True):
            colour = line.get_color()
            self.axes.annotate(
                text, end, xytext=(1.075, at), xycoords="axes fraction", textcoords="axes fraction", va="center",
                fontsize=9, annotation_clip=False, linespacing=1.1,
                arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.9, "shrinkA": 3.0, "shrinkB": 3.0,
                            "relpos": (0.0, 0.5)},
            )  # fmt: skip
            self.axes.plot(
                [1.055], [at], marker=line.get_marker(), color=colour, markersize=5, transform=self.axes.transAxes,
                clip_on=False,
            )  # fmt: skip

    def _end_of(self, line: Line2D) -> tuple[float, float]:
        """The last known point of a curve, in fractions of the panel."""
        points = np.asarray(line.get_xydata(), dtype=float)
        last = points[np.isfinite(points).all(axis=1)][-1:]
        x, y = self.axes.transAxes.inverted().transform(line.get_transform().transform(last))[0].tolist()
        return float(x), min(max(float(y), 0.0), 1.0)

    def percent(self, axis: Literal["x", "y"]) -> None:
        """Shares written in percent."""
        from matplotlib.ticker import PercentFormatter

        chosen = self.axes.xaxis if axis == "x" else self.axes.yaxis
        chosen.set_major_formatter(PercentFormatter(1.0, symbol=""))

    def plain_ticks(self, axis: Literal["x", "y"], at: Sequence[float]) -> None:
        """Ticks at these values, written out, on a logarithmic axis too."""
        self.ticks(axis, at, [f"{value:g}" for value in at])

    def top(self) -> float:
        """The upper end of the y axis."""
        return float(self.axes.get_ylim()[1])

    def size_pt(self) -> tuple[float, float]:
        """Width and height of the panel in points, roughly, before the layout is made."""
        box = self.axes.get_position()
        width, height = self._figure().get_size_inches()
        return 72.0 * width * box.width, 72.0 * height * box.height

    def _figure(self) -> Figure:
        figure = self.axes.get_figure(root=True)
        assert figure is not None
        return figure


def apart(centres: Sequence[float], heights: Sequence[float]) -> list[float]:
    """Places on [0, 1] as near as can be to the centres, at which things of these heights do not overlap.

    Least squares in the order of the centres: neighbours that would overlap move together, by as much (pool adjacent
    violators).

    >>> [round(place, 3) for place in apart([0.5, 0.5, 0.9], [0.1, 0.1, 0.1])]
    [0.45, 0.55, 0.9]
    """
    order = sorted(range(len(centres)), key=lambda one: centres[one])
    stacks: list[list[int]] = []

    def start(stack: list[int]) -> float:
        """Where a stack begins whose members stand on each other, within [0, 1] where it fits."""
        below, wanted = 0.0, 0.0
        for one in stack:
            wanted += centres[one] - below - heights[one] / 2.0
            below += heights[one]
        return max(min(wanted / len(stack), 1.0 - below), 0.0)

    def end(stack: list[int]) -> float:
        return start(stack) + sum(heights[one] for one in stack)

    for one in order:
        stacks.append([one])
        while len(stacks) > 1 and end(stacks[-2]) > start(stacks[-1]) + 1e-12:
            stacks[-2:] = [stacks[-2] + stacks[-1]]
    places = [0.0] * len(centres)
    for stack in stacks:
        edge = start(stack)
        for one in stack:
            places[one] = edge + heights[one] / 2.0
            edge += heights[one]
    return places


def can_show(text: str) -> bool:
    """Whether the font that matplotlib brings has every character of ``text``."""
    from matplotlib import font_manager

    font = font_manager.get_font(font_manager.findfont("DejaVu Sans"))
    return text.isprintable() and "$" not in text and all(font.get_char_index(ord(c)) != 0 for c in text)
