"""The page of a report."""
import base64
import html

import plots as plotting
import rows as data

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 1180px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.7em; } h2 { margin-top: 2em; border-bottom: 1px solid #ddd; } h3 { margin-bottom: .3em; }
table { border-collapse: collapse; font-size: 13px; } th, td { padding: .2em .7em; border-bottom: 1px solid #e4e4e4; text-align: right; }
th:first-child, td:first-child { text-align: left; } th { background: #f6f6f6; vertical-align: bottom; }
.ahead { color: #176b2c; } .behind { color: #a31515; font-weight: 600; } .wide { overflow-x: auto; } svg { max-width: 100%; height: auto; }
figure { display: inline-block; margin: 0 6px 12px 0; width: 216px; vertical-align: top; } figure img { width: 216px; border: 1px solid #ddd; }
figcaption { font-size: 11.5px; line-height: 1.35; } code { font-size: 12px; } summary { cursor: pointer; }
"""
LIMITS = (8, 5, 3, 2, 1)
MOST_TABLE_ROWS = 2000


def text(value):
    return html.escape(str(value))


def number(x):
    if x is None:
        return "–"
    if x == 0 or 1e-3 <= abs(x) < 1e5:
        return f"{x:.4g}"
    return f"{x:.2e}"


def table(head, lines):
    cells = lambda tag, line: "".join(f"<{tag}>{c}</{tag}>" for c in line)  # noqa: E731
    body = "\n".join(f"<tr>{cells('td', line)}</tr>" for line in lines)
    return f'<div class="wide"><table><thead><tr>{cells("th", head)}</tr></thead><tbody>{body}</tbody></table></div>'


def short(model):
    return model.rsplit("/", 1)[-1]


def heading(study):
    machine = study.machine
    facts = [f"{len(study.rows)} rows", f"{len({r.model for r in study.rows})} models",
             f"version {machine.get('version', '?')}, commit {', '.join(study.commits) or '?'}",
             f"{machine.get('cpu', '?')}, {machine.get('cores', '?')} cores, {machine.get('memory', '?')}",
             machine.get("system", "?"), machine.get("gl_renderer") or "nothing drawn", machine.get("compiler", "?")]
    failed = [row for row in study.rows if row.failed]
    parts = [f"<h1>{text(study.title)}</h1><p>{text(' · '.join(facts))}</p>"]
    if failed:
        items = "".join(f"<li>{text(short(r.model))}, {text(r.view)}, {text(r.primitive)} {text(r.knob)}: {text(r.cells['status'])}</li>"
                        for r in failed[:200])
        parts.append(f"<details><summary>{len(failed)} rows failed</summary><ul>{items}</ul></details>")
    return "\n".join(parts)


def ratio_cell(standing, measure):
    median = standing.median(measure)
    if median is None:
        return "–"
    kind = "ahead" if median > 1 else "behind"
    return f'<span class="{kind}">{median:.2f}×</span> ({standing.ahead(measure)} of {standing.both})'


def verdict(study):
    """Where quadric stands, in numbers and in plain words."""
    lines, behind = [], []
    for limit in LIMITS:
        for other, s in data.standings(study.good, limit).items():
            if s.pictures == 0:
                continue
            lines.append([f"{limit} of 255", text(other), s.pictures, s.only_quadric, s.only_other, s.neither]
                         + [ratio_cell(s, m) for m, _, _ in data.MEASURES]
                         + [f"{s.ahead_at_once} of {s.pictures - s.neither}"])
            slow = [title for m, title, _ in data.MEASURES if s.median(m) is not None and s.median(m) <= 1]
            if limit <= 3 and slow:
                behind.append(f"At an RMSE of {limit} at most, quadric is behind {other} in the median on {' and '.join(slow)}.")
    if not lines:
        return ""
    words = "".join(f'<li class="behind">{text(sentence)}</li>' for sentence in behind)
    summary = (f"<p>Where quadric is not ahead:</p><ul>{words}</ul>" if behind
               else '<p class="ahead">From an RMSE of 3 down quadric is ahead in the median on all three, of every other primitive.</p>')
    explain = ("<p>Of each picture (a model, a view, a size) and each primitive, the rows count whose RMSE over covered pixels is within the limit. "
               "Ratios are the other's least over quadric's least, medians over pictures that both reach (and in how many of them quadric is ahead); "
               "above 1 quadric is ahead. At once: one quadric row is ahead of the other's best on frame time, bytes and preparation together, or only quadric gets there.</p>")
    head = ["error at most", "against", "pictures", "only quadric gets there", "only the other", "neither", "frame time", "bytes", "preparation", "ahead at once"]
    return "<h2>Where quadric stands</h2>" + summary + explain + table(head, lines)


def fronts(study, plots):
    parts = ["<h2>Error against time and bytes</h2><p>Lines join a primitive's knob, medians over the models; dots are single rows; "
             "gray: the front, which nothing is better than in both. Dotted: an RMSE of 3.</p>"]
    timed = [row for row in study.good if row.number("frame_ms") and row.number(data.ERROR) is not None]
    for i, (view, size) in enumerate(study.scenes()):
        rows = [row for row in timed if (row.view, row.size) == (view, size)]
        if rows:
            parts.append(f"<h3>{text(view)}, {text(size)}</h3>" + plots.fronts(f"front-{i}", rows))
            parts.append("<details><summary>Medians</summary>" + medians(rows) + "</details>")
    return "\n".join(parts) if len(parts) > 1 else ""


def medians(rows):
    by_measure = {m: {(p, knob): (cost, error, n) for p, list_ in data.knob_points(rows, m).items() for knob, cost, error, n in list_}
                  for m, _, _ in data.MEASURES}
    lines = []
    for key, (cost, error, n) in sorted(by_measure["frame_ms"].items()):
        others = [by_measure[m].get(key, (None, None, None))[0] for m in ("bytes", "prepare_s")]
        lines.append([text(key[0]), text(key[1]), n, number(error), number(cost)] + [number(x) for x in others])
    return table(["primitive", "knob", "models", "RMSE", "frame, ms", "bytes", "preparation, s"], lines)


def growth(study, plots):
    parts = []
    scene = next(iter(study.scenes()), None)  # frames of other sizes grow otherwise
    for measure, title, unit in data.MEASURES:
        rows = [row for row in study.good if (row.view, row.size) == scene and row.number(measure) and row.number("primitives")]
        if len({row.number("primitives") for row in rows}) < 3:
            continue
        svg, fits = plots.growth(f"growth-{measure}", rows, measure, title, unit)
        lines = [[text(p), f"{e:.3f}", number(f)] for p, (e, f) in fits.items()]
        parts.append(f"<h3>{title}</h3>" + svg + table(["primitive", "exponent", f"factor, {unit}"], lines))
    return f"<h2>Growth with the number of primitives</h2><p>{text(', '.join(scene))}: dots are models and knobs.</p>" + "\n".join(parts) if parts else ""


def convergence(study, plots):
    parts = []
    for knob in ("deflection", "tolerance", "normal-tolerance", "epsilon", "grid"):
        rows = [row for row in study.good if row.number(data.ERROR) is not None and row.cells.get(knob)]
        if len({row.cells[knob] for row in rows}) > 2:
            parts.append(f"<h3>{knob}</h3>" + plots.convergence(f"convergence-{knob}", rows, knob))
    return "<h2>Error against the knobs</h2><p>A line a model.</p>" + "\n".join(parts) if parts else ""


def programs(study):
    if not study.programs:
        return ""
    names = list(study.programs[0])
    return ("<h2>Whole processes</h2><p>From the file to the picture, as a user would run them.</p>"
            + table(names, [[text(row[name]) for name in names] for row in study.programs]))


def image(folder, name):
    return "data:image/png;base64," + base64.b64encode((folder / name).read_bytes()).decode()


def pictures(study, most):
    scenes = {}
    for row in study.good:
        if row.pictures and all((study.folder / name).exists() for name in row.pictures.values()):
            scenes.setdefault((row.model, row.view, row.size), []).append(row)
    if not scenes:
        return ""
    # Spread over what there is.
    keys = list(scenes)
    chosen = [keys[i * len(keys) // min(most, len(keys))] for i in range(min(most, len(keys)))]
    parts = [f"<h2>Pictures</h2><p>{len(chosen)} of {len(keys)} scenes. Differences: black is none, white the largest FLIP error; blue is covered by the reference alone, green by the picture alone.</p>"]
    for model, view, size in chosen:
        parts.append(f"<h3>{text(short(model))}, {text(view)}, {text(size)}</h3>")
        group = scenes[model, view, size]
        reference = next((row.pictures["reference"] for row in group if "reference" in row.pictures), None)
        if reference:
            parts.append(figure(image(study.folder, reference), "the reference"))
        for row in group:
            caption = f"{row.primitive} {row.knob}: RMSE {number(row.number(data.ERROR))}, FLIP {number(row.number('flip'))}, {number(row.number('frame_ms'))} ms, {number(row.number('bytes'))} bytes"
            parts.append(figure(image(study.folder, row.pictures["picture"]), caption))
            if "difference" in row.pictures:
                parts.append(figure(image(study.folder, row.pictures["difference"]), f"{row.primitive} {row.knob}: the difference"))
    return "\n".join(parts)


def figure(source, caption):
    return f'<figure><img src="{source}" alt="{text(caption)}"><figcaption>{text(caption)}</figcaption></figure>'


def all_rows(study):
    names = ["model", "view", "width"] + study.keys + ["status", "primitives", "bytes", "bound_px", "prepare_s", "frame_ms", "frame_p10_ms", "frame_p90_ms",
                                                      "rmse_covered", "rmse", "psnr", "ssim", "flip", "silhouette_px", "depth_p99_px", "normal_p99_degrees", "holes_px"]

    def cell(row, name):
        value = row.cells.get(name, "")
        try:
            return number(float(value))
        except ValueError:
            return text(short(value) if name == "model" else value)

    lines = [[cell(row, name) for name in names] for row in study.rows[:MOST_TABLE_ROWS]]
    more = f"<p>The first {MOST_TABLE_ROWS}; timed.csv has all.</p>" if len(study.rows) > MOST_TABLE_ROWS else ""
    return f"<h2>Rows</h2><details><summary>All {len(study.rows)} rows</summary>{more}{table(names, lines)}</details>"


def build(study, most_pictures):
    plots = plotting.Plots(study.folder / "plots")
    body = [heading(study), verdict(study), fronts(study, plots), growth(study, plots), convergence(study, plots), programs(study),
            pictures(study, most_pictures), all_rows(study)]
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{text(study.title)}</title><style>{STYLE}</style></head>\n<body>'
            + "\n".join(part for part in body if part) + "\n</body></html>\n")
