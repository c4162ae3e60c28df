"""The plots of a report, by matplotlib, as SVG."""
import io

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

import rows as data  # noqa: E402

matplotlib.rcParams.update({"svg.hashsalt": "dupin", "svg.fonttype": "none", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
                            "axes.spines.top": False, "axes.spines.right": False, "figure.autolayout": True})
COLORS = {"quadric": "#d62728", "auto": "#d62728", "triangles": "#1f77b4", "dp": "#2ca02c", "square": "#9467bd",
          "rectangle": "#8c564b", "ellipse": "#e377c2", "pop": "#ff7f0e", "qsplat": "#bcbd22", "amg": "#17becf"}


def color(primitive):
    return COLORS.get(primitive, "#7f7f7f")


class Plots:
    """Writes each plot to a folder, and returns it as text to stand in a page."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def _finish(self, figure, name):
        buffer = io.StringIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
        figure.savefig(self.folder / f"{name}.png", dpi=110, metadata={"Software": None})
        pyplot.close(figure)
        text = buffer.getvalue()
        (self.folder / f"{name}.svg").write_text(text, encoding="utf-8")
        # The page has many: what one defines must not be taken for another's.
        return text[text.index("<svg"):].replace('id="', f'id="{name}-').replace('"#', f'"#{name}-').replace("url(#", f"url(#{name}-")

    def fronts(self, name, rows):
        """Error against each cost: a line a primitive through its knob's medians, the front of all of them behind."""
        figure, axes = pyplot.subplots(1, 3, figsize=(13, 4.2), sharey=True)
        for axis, (measure, title, unit) in zip(axes, data.MEASURES):
            points = data.knob_points(rows, measure)
            everything = [(c, max(e, 1e-3)) for list_ in points.values() for _, c, e, _ in list_]
            best = data.front(everything)
            axis.step([c for c, _ in best], [e for _, e in best], where="post", color="#bbbbbb", linewidth=5, zorder=0, label="front")
            for primitive, list_ in points.items():
                faint = [(r.number(measure), max(r.number(data.ERROR), 1e-3)) for r in rows
                         if r.primitive == primitive and r.number(measure) and r.number(data.ERROR) is not None]
                axis.plot(*zip(*faint), ".", color=color(primitive), alpha=0.18, markersize=3, zorder=1, rasterized=len(faint) > 500)
                axis.plot([c for _, c, _, _ in list_], [max(e, 1e-3) for _, _, e, _ in list_], "o-", color=color(primitive),
                          label=primitive, zorder=2)
            axis.axhline(3, color="#444444", linewidth=0.8, linestyle=":")
            axis.set(xscale="log", yscale="log", xlabel=title if title == unit else f"{title}, {unit}")
        axes[0].set_ylabel("RMSE over covered pixels, of 255")
        axes[0].legend(fontsize=8)
        return self._finish(figure, name)

    def growth(self, name, rows, measure, title, unit):
        """A cost against the number of primitives, and the fitted exponents."""
        figure, axis = pyplot.subplots(figsize=(6.4, 4.2))
        fits = {}
        for primitive in sorted({row.primitive for row in rows}):
            pairs = [(r.number("primitives"), r.number(measure)) for r in rows
                     if r.primitive == primitive and r.number("primitives") and r.number(measure)]
            if not pairs:
                continue
            fit = data.fitted_exponent(pairs)
            label = primitive
            if fit:
                fits[primitive] = fit
                label += f": n^{fit[0]:.2f}"
                ends = [min(x for x, _ in pairs), max(x for x, _ in pairs)]
                axis.plot(ends, [fit[1] * x ** fit[0] for x in ends], color=color(primitive), linewidth=1.5)
            axis.plot(*zip(*pairs), ".", color=color(primitive), alpha=0.5, label=label, rasterized=len(pairs) > 500)
        axis.set(xscale="log", yscale="log", xlabel="primitives n", ylabel=title if title == unit else f"{title}, {unit}")
        axis.legend(fontsize=8)
        return self._finish(figure, name), fits

    def convergence(self, name, rows, knob):
        """Errors against a knob: a line a model."""
        figure, axes = pyplot.subplots(1, 2, figsize=(11, 3.8))
        for axis, (measure, title) in zip(axes, [(data.ERROR, "RMSE over covered pixels, of 255"), ("depth_p99_px", "depth, 99 %, pixels")]):
            for model in dict.fromkeys(r.model for r in rows):
                for primitive in sorted({r.primitive for r in rows}):
                    pairs = sorted((r.number(knob), max(r.number(measure) or 0, 1e-5)) for r in rows
                                   if r.model == model and r.primitive == primitive and r.number(knob) and r.number(measure) is not None)
                    if len(pairs) > 1:
                        axis.plot(*zip(*pairs), ".-", color=color(primitive), alpha=0.6, linewidth=1)
            axis.set(xscale="log", yscale="log", xlabel=knob, ylabel=title)
        return self._finish(figure, name)
