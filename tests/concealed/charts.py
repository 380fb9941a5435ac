"""Pieces of Vega-Lite specifications that the figures of a round share, in the looks of the other figures of the
documentation."""

import math

SCHEMA = "https://vega.github.io/schema/vega-lite/v6.json"
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"]
CONFIG = {
    "font": "sans-serif",
    "background": "white",
    "aria": False,
    "title": {"anchor": "start", "fontSize": 13, "subtitleFontSize": 11, "subtitlePadding": 4},
    "axis": {"labelFontSize": 11, "titleFontSize": 11, "titleFontWeight": "normal", "gridColor": "#eeeeee", "labelLimit": 400},
    "legend": {"labelFontSize": 11, "titleFontSize": 11},
    "header": {"labelFontSize": 11, "titleFontSize": 11},
    "range": {"category": COLOURS},
    "point": {"filled": True, "size": 45},
    "view": {"stroke": "#cccccc"},
}
WIDTH, HEIGHT = 480, 260
SNR = "signal-to-noise ratio s (1)"


def axis(field, title, kind="quantitative", **more):
    return {"field": field, "type": kind, "title": title, **more}


def share(field, title):
    """An axis from nought to all."""
    return axis(field, title, scale={"domain": [0, 1]}, axis={"format": "%"})


def panel(values, layers, width=WIDTH, height=HEIGHT, **more):
    out = {"data": {"values": values}, "width": width, "height": height, **more}
    out.update(layers[0] if len(layers) == 1 else {"layer": layers})
    return out


def figure(title, content, subtitle=None):
    """A whole specification; content: a panel, or a list of panels side by side."""
    shown = {"title": {"text": title, **({"subtitle": subtitle} if subtitle else {})}}
    body = {"hconcat": content, "resolve": {"scale": {"color": "independent"}}} if isinstance(content, list) else content
    return {"$schema": SCHEMA, **shown, "config": CONFIG, **body}


def spec(title, values, layers, subtitle=None, **more):
    return figure(title, panel(values, layers, **more), subtitle)


def line(x, y, titles, **more):
    """A curve over the other layers; titles: those of their axes, which a layer would blot out otherwise."""
    return {
        "data": {"values": [{"x": a, "y": b} for a, b in zip(x, y)]},
        "mark": {"type": "line", "strokeDash": [4, 3], "color": "#777777", **more},
        "encoding": {"x": axis("x", titles[0]), "y": axis("y", titles[1])},
    }


def with_limits(x, y, colour=None):
    """Points with their 95 % limits `low`, `high`."""
    shade = {"color": colour} if colour else {}
    upright = {"type": "rule", "opacity": 0.6}
    return [
        {"mark": upright, "encoding": {"x": x, "y": {**y, "field": "low"}, "y2": {"field": "high"}, **shade}},
        {"mark": {"type": "point", "filled": True, "size": 45}, "encoding": {"x": x, "y": y, **shade}},
    ]


def detection(s, critical):
    """Share that a normal statistic of mean s and variance 1 exceeds `critical` in size."""
    upper = lambda x: 0.5 * math.erfc(x / math.sqrt(2))
    return upper(critical - s) + upper(critical + s)


def values_of(part):
    """All data of a specification, to tell an empty figure."""
    if isinstance(part, dict):
        own = part.get("data", {}).get("values") or []
        return list(own) + [v for k, x in part.items() if k in ("hconcat", "vconcat", "spec") for v in values_of(x)]
    return [v for x in part for v in values_of(x)] if isinstance(part, list) else []
