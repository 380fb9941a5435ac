"""Figures about detection: power, the program's own prediction of it, nulls, other methods."""

import math

import ceiling
from charts import COLOURS, SNR, axis, detection, figure, line, panel, share, spec, with_limits

LEVEL = 2.5758  # two-sided 1 % point of the normal distribution
SAID_AT = 4.5  # signal-to-noise ratio that the program calls the smallest detectable, at 80 %
GRID = [i / 10 for i in range(0, 161)]
TITLES = SNR, "detected"


def fitted(curve):
    return [0.01 + 0.99 / (1 + math.exp(-min(700, curve["a"] + curve["b"] * s))) for s in GRID]


def power(m, rows=(), best=()):
    """best: rows of ideal.json, mixed like the single cases of the round."""
    singles = [r for r in rows if r["kind"] == "single"]
    shares = [{"snr": float(k), **v} for k, v in m["power"]["steps"].items() if v["n"]]
    layers = with_limits(axis("snr", SNR), share("share", "detected"))
    layers.append(line(GRID, [detection(s, LEVEL) for s in GRID], TITLES))
    if m["power"]["curve"]:
        layers.append(line(GRID, fitted(m["power"]["curve"]), TITLES, strokeDash=[1, 0], color=COLOURS[0]))
    rich = [r for r in singles if r["design"] == "D"]
    for cases, colour in ((singles, COLOURS[1]), (rich, COLOURS[2])):
        if points := ceiling.weighted(best, cases):
            layers.append(line(*zip(*points), TITLES, strokeDash=[2, 3], color=colour))
    subtitle = "line: fitted; dashed: an oracle that knows the shape; bars: 95 % limits"
    search = "dotted: the best possible search of the catalogue, for all cases (orange) and the rich design (green)"
    return spec("Power: single effects detected", shares, layers, [subtitle, search])


def power_by_family(m):
    rows = [
        {"family": f, "snr": k, "text": f"{v['k']}/{v['n']}", **v}
        for f, block in sorted(m["power_by_family"].items())
        for k, v in block["steps"].items()
        if v["n"]
    ]
    x = axis("snr", SNR, "ordinal", sort=sorted({r["snr"] for r in rows}, key=float), axis={"labelAngle": 0})
    y = axis("family", None, "nominal")
    colour = axis("share", "detected", scale={"scheme": "blues", "domain": [0, 1]}, legend={"format": "%"})
    boxes = {"mark": "rect", "encoding": {"x": x, "y": y, "color": colour}}
    dark = {"condition": {"test": "datum.share > 0.6", "value": "white"}, "value": "#333333"}
    numbers = {"mark": {"type": "text", "fontSize": 9}, "encoding": {"x": x, "y": y, "text": axis("text", None, "nominal"), "color": dark}}
    return spec("Power by family", rows, [boxes, numbers], "detected/concealed", width=300, height={"step": 14})


def predicted(m):
    titles = "size over the smallest said to be detectable (1)", "detected"
    grid = [10 ** (i / 50 - 1) for i in range(101)]
    foretold = [detection(SAID_AT * r, SAID_AT - 0.8416) for r in grid]
    x = axis("ratio", titles[0], scale={"type": "log", "domain": [0.1, 10], "clamp": True})
    layers = [*with_limits(x, share("share", titles[1])), line(grid, foretold, titles)]
    return spec("Observed against the program's own prediction", m["predicted"], layers, "dashed: what `smallest_detectable` promises, 80 % at 1")


def null_p(m, rows):
    def quantiles(some, name):
        p = sorted(r["p_value"] for r in some if r.get("p_value") is not None)
        return [{"nulls": f"{name} ({len(p)})", "expected": (i + 0.5) / len(p), "observed": v} for i, v in enumerate(p)]

    nulls = [r for r in rows if r["kind"] == "null"]
    left = [v for d in ("clean", "hard") for v in quantiles([r for r in nulls if r["detail"] == d], d)]
    kinds = sorted({r["noise"] for r in nulls})
    right = [v for k in kinds for v in quantiles([r for r in nulls if r["detail"] == "hard" and r["noise"] == k], k)]
    titles = "uniform quantile (1)", "p-value (1)"

    def qq(values):
        log = {"type": "log", "domain": [0.0003, 1], "nice": False, "clamp": True}
        x, y = axis("expected", titles[0], scale=log), axis("observed", titles[1], scale=log)
        shade = axis("nulls", None, "nominal", scale={"range": [*COLOURS, "#E69F00", "#555555"]})
        points = {"mark": {"type": "point", "size": 18, "filled": True}, "encoding": {"x": x, "y": y, "color": shade}}
        return panel(values, [points, line([0.003, 1], [0.003, 1], titles)], width=230)

    return figure("p-values of the nulls, against their quantiles", [qq(left), qq(right)], "left: all; right: hard nulls by kind of noise; below the line: false alarms")


def null_rates(m):
    rows = [{"nulls": f"{d}", **v} for d, v in m["false_alarms"].items()]
    rows += [{"nulls": f"hard, {k}", **v} for k, v in m["false_alarms_by_noise"].items()]
    rows = [{**r, "nulls": f"{r['nulls']} ({r['n']})"} for r in rows if r["n"]]
    y = axis("nulls", None, "nominal", sort=None)
    bar = {"mark": {"type": "rule", "opacity": 0.6}, "encoding": {"y": y, "x": {**share("low", "false alarms"), "scale": {}}, "x2": {"field": "high"}}}
    dot = {"mark": {"type": "point", "filled": True, "size": 45}, "encoding": {"y": y, "x": axis("share", "false alarms", axis={"format": "%"})}}
    return spec("False alarms", rows, [bar, dot], "bars: 95 % limits; number of cases in brackets", height={"step": 20})


def compared(m):
    rows = []
    for method, block in m["compared"].items():
        for figure, v in block.items():
            if v["n"]:
                rows.append({"what": f"{figure.replace('_', ' ')}: {method.replace('_', ' ')}", "method": method, **v})
    x, y = share("share", "share of the cases"), axis("what", None, "nominal")
    shade = {"condition": {"test": "datum.method == 'this'", "value": COLOURS[0]}, "value": "#bbbbbb"}
    layers = [
        {"mark": "bar", "encoding": {"y": y, "x": x, "color": shade}},
        {"mark": "rule", "encoding": {"y": y, "x": {**x, "field": "low"}, "x2": {"field": "high"}}},
    ]
    return spec("The same cases, other methods", rows, layers, "lines: 95 % limits", width=360, height={"step": 17})
