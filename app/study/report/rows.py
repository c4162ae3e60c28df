"""Rows of a study's folder, and what is asked of them: medians, fronts, fitted exponents."""
import collections
import csv
import json
import math
import pathlib
import statistics

MEASURES = [("frame_ms", "frame time", "ms"), ("bytes", "bytes", "bytes"), ("prepare_s", "preparation", "s")]
ERROR = "rmse_covered"
# Two rows of a primitive with the same values of these differ in nothing but their model, view and size.
NO_KNOBS = {"primitive", "color", "background"}


class Row:
    def __init__(self, cells, keys, line):
        self.cells = cells
        self.primitive = cells.get("primitive") or "quadric"
        self.model, self.view = cells["model"], cells["view"]
        self.size = f"{cells['width']}×{cells['height']}"
        self.knob = " ".join(f"{k}={cells[k]}" for k in keys if k not in NO_KNOBS and cells.get(k))
        self.failed = cells["status"] != "ok"
        self.pictures, self.command = line.get("pictures", {}), line.get("command", "")
        self.machine = line.get("machine", {})

    def number(self, name):
        """None where the row has no such number."""
        text = self.cells.get(name, "")
        return float(text) if text else None


class Study:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        with open(self.folder / "timed.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
            names = list(table[0]) if table else []
        self.keys = names[names.index("height") + 1:names.index("status")] if table else []
        lines = self._lines()
        self.rows = [Row(cells, self.keys, lines.get(self._identity(cells), {})) for cells in table]
        self.good = [row for row in self.rows if not row.failed]
        self.title = next((line.get("study", "") for line in lines.values()), "") or self.folder.name
        self.machine = next((row.machine for row in self.good), {})
        self.commits = sorted({row.cells.get("commit", "") for row in self.good})
        self.programs = self._programs()

    def _identity(self, cells):
        return (cells["model"], cells["view"], cells["width"], cells["height"],
                tuple((k, cells[k]) for k in self.keys if cells[k]))

    def _lines(self):
        lines = {}
        for path in sorted(self.folder.glob("*.jsonl")):
            for text in path.read_text(encoding="utf-8", errors="replace").splitlines():
                try:
                    line = json.loads(text)
                except ValueError:
                    continue
                if not isinstance(line, dict) or "options" not in line:
                    continue
                cells = {"model": line["model"], "view": line["view"], "width": str(line["width"]), "height": str(line["height"])}
                cells |= {k: line["options"].get(k, "") for k in self.keys}
                lines[self._identity(cells)] = line
        return lines

    def _programs(self):
        path = self.folder / "programs.csv"
        if not path.exists():
            return []
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def scenes(self):
        """View and size, as the study has them."""
        return list(dict.fromkeys((row.view, row.size) for row in self.good))

    def primitives(self):
        return sorted({row.primitive for row in self.good}, key=lambda p: (p not in ("quadric", "auto"), p != "triangles", p))


def knob_points(rows, measure):
    """Per primitive: (knob, median cost, median error, models) over models, from cheap to dear."""
    groups = collections.defaultdict(list)
    for row in rows:
        cost, error = row.number(measure), row.number(ERROR)
        if cost is not None and error is not None and cost > 0:
            groups[row.primitive, row.knob].append((cost, error))
    points = collections.defaultdict(list)
    for (primitive, knob), pairs in groups.items():
        points[primitive].append((knob, statistics.median(c for c, _ in pairs), statistics.median(e for _, e in pairs), len(pairs)))
    return {primitive: sorted(list_, key=lambda p: p[1]) for primitive, list_ in points.items()}


def front(points):
    """Of (cost, error): those that none is better than in both, by cost."""
    best, kept = math.inf, []
    for cost, error in sorted(points):
        if error < best:
            best = error
            kept.append((cost, error))
    return kept


def fitted_exponent(pairs):
    """(exponent, factor) of y = factor · x^exponent through the logarithms; None with less than three different x."""
    logs = [(math.log(x), math.log(y)) for x, y in pairs if x > 0 and y > 0]
    if len({x for x, _ in logs}) < 3:
        return None
    mean_x, mean_y = statistics.fmean(x for x, _ in logs), statistics.fmean(y for _, y in logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    exponent = sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread
    return exponent, math.exp(mean_y - exponent * mean_x)


class Standing:
    """Quadric beside one other primitive where the error must not exceed a limit: over the pictures of a study."""

    def __init__(self):
        self.pictures = self.both = self.neither = self.only_quadric = self.only_other = self.ahead_at_once = 0
        self.ratios = {measure: [] for measure, _, _ in MEASURES}  # other's / quadric's

    def add(self, quadric, other):
        self.pictures += 1
        if not quadric or not other:
            self.only_quadric += bool(quadric)
            self.only_other += bool(other)
            self.neither += not quadric and not other
            self.ahead_at_once += bool(quadric)
            return
        self.both += 1
        least = {m: min(row.number(m) for row in other) for m in self.ratios}
        for measure, ratios in self.ratios.items():
            ratios.append(least[measure] / min(row.number(measure) for row in quadric))
        # One of its rows, on all three, against the other's best on each.
        self.ahead_at_once += any(all(row.number(m) < least[m] for m in least) for row in quadric)

    def median(self, measure):
        return statistics.median(self.ratios[measure]) if self.ratios[measure] else None

    def ahead(self, measure):
        return sum(ratio > 1 for ratio in self.ratios[measure])


def standings(rows, limit):
    """Per other primitive: a Standing, over every model, view and size."""
    pictures = collections.defaultdict(lambda: collections.defaultdict(list))
    others = set()
    for row in rows:
        if any(row.number(name) in (None, 0) for name in ("frame_ms", "bytes", "prepare_s")) or row.number(ERROR) is None:
            continue
        primitive = "quadric" if row.primitive == "auto" else row.primitive
        others.add(primitive)
        found = pictures[row.model, row.view, row.size][primitive]
        if row.number(ERROR) <= limit:
            found.append(row)
    result = {}
    for other in sorted(others - {"quadric"}, key=lambda p: (p != "triangles", p)):
        standing = Standing()
        for by_primitive in pictures.values():
            if "quadric" in by_primitive and other in by_primitive:
                standing.add(by_primitive["quadric"], by_primitive[other])
        result[other] = standing
    return result
