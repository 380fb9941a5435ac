#!/usr/bin/env python3
"""Draws the results of a round. usage: plots.py results.json OUT/

Writes one Vega-Lite v6 specification a figure, data inside; docs/figures/render.mjs makes pictures of them. A
figure without data is left out.
"""

import argparse
import json
import math
import pathlib

from tallies import normal_cdf

SCHEMA = "https://vega.github.io/schema/vega-lite/v6.json"
LEVEL = 2.5758  # two-sided 1 % point of the normal distribution


def axis(field, title, kind="quantitative", **more):
    return {"field": field, "type": kind, "title": title, **more}


def spec(title, values, layers, width=420, height=280, **more):
    out = {"$schema": SCHEMA, "title": title, "data": {"values": values}, "width": width, "height": height, **more}
    out.update(layers[0] if len(layers) == 1 else {"layer": layers})
    return out


def line(x, y, titles, **more):
    """A curve over the other layers; titles: those of their axes, which a layer would blot out otherwise."""
    return {
        "data": {"values": [{"x": a, "y": b} for a, b in zip(x, y)]},
        "mark": {"type": "line", "strokeDash": [4, 3], "color": "#777777", **more},
        "encoding": {"x": axis("x", titles[0]), "y": axis("y", titles[1])},
    }


def with_limits(rows, x, y, colour=None):
    """Points with their 95 % limits `low`, `high`."""
    shade = {"color": colour} if colour else {}
    return [
        {
            "mark": {"type": "rule"},
            "encoding": {"x": x, "y": axis("low", y["title"]), "y2": {"field": "high"}, **shade},
        },
        {"mark": {"type": "point", "filled": True, "size": 45}, "encoding": {"x": x, "y": y, **shade}},
    ]


def oracle_power(s):
    """Of the statistic that knows the shape of the effect, at the 1 % level."""
    return normal_cdf(s - LEVEL) + normal_cdf(-s - LEVEL)


def power(m):
    grid = [i / 10 for i in range(0, 161)]
    rows = [{"snr": float(k), **v} for k, v in m["power"]["steps"].items() if v["n"]]
    titles = "signal-to-noise ratio", "detected"
    layers = [
        *with_limits(rows, axis("snr", titles[0]), axis("share", titles[1])),
        line(grid, [oracle_power(s) for s in grid], titles),
    ]
    curve = m["power"]["curve"]
    if curve:
        layers.append(
            line(
                grid,
                [0.01 + 0.99 / (1 + math.exp(-min(700, curve["a"] + curve["b"] * s))) for s in grid],
                titles,
                strokeDash=[1, 0],
                color="#1f5fa8",
            )
        )
    return spec("Detected, all single effects; fitted curve and, dashed, knowing the family", rows, layers)


def power_by_family(m):
    rows = [
        {"family": f, "snr": float(k), "detected": v["share"], "oracle": oracle_power(float(k))}
        for f, block in m["power_by_family"].items()
        for k, v in block["steps"].items()
        if v["n"]
    ]
    x = axis("snr", "SNR")
    return {
        "$schema": SCHEMA,
        "title": "Detected by family; dashed: knowing the family",
        "data": {"values": rows},
        "facet": {"field": "family", "type": "nominal", "title": None},
        "columns": 6,
        "spec": {
            "width": 110,
            "height": 70,
            "layer": [
                {
                    "mark": {"type": "line", "strokeDash": [4, 3], "color": "#777777"},
                    "encoding": {"x": x, "y": axis("oracle", None)},
                },
                {"mark": {"type": "line", "point": True}, "encoding": {"x": x, "y": axis("detected", None)}},
            ],
        },
    }


def confusion(m):
    rows = m["confusion"]
    if not rows:
        return None
    layers = [
        {
            "mark": "rect",
            "encoding": {
                "x": axis("said", "said", "nominal"),
                "y": axis("truth", "truth", "nominal"),
                "color": axis("n", "cases", scale={"scheme": "blues"}),
            },
        }
    ]
    return spec("What was said, against what was concealed", rows, layers, width=640, height=560)


def reliability(m):
    rows = [{**b, "low": b["limits"][0], "high": b["limits"][1]} for b in m["reliability"]["bins"]]
    return spec(
        "Reliability of the probability of a name",
        rows,
        [
            *with_limits(rows, axis("said", "stated probability"), axis("right", "share right")),
            line([0, 1], [0, 1], ("stated probability", "share right")),
        ],
    )


def sets(m):
    rows = [
        {"design": d, "snr": float(k), "size": v["mean_size"]}
        for d, block in m["naming"].items()
        for k, v in block.items()
        if v["mean_size"]
    ]
    return spec(
        "Mean size of a 95 % set",
        rows,
        [
            {
                "mark": {"type": "line", "point": True},
                "encoding": {
                    "x": axis("snr", "signal-to-noise ratio"),
                    "y": axis("size", "members"),
                    "color": axis("design", "design", "nominal"),
                },
            }
        ],
    )


def naming(m):
    rows = [{"design": d, "snr": float(k), **v} for d, block in m["naming"].items() for k, v in block.items() if v["n"]]
    return spec(
        "Named rightly, of the detected",
        rows,
        with_limits(
            rows, axis("snr", "signal-to-noise ratio"), axis("share", "right"), axis("design", "design", "nominal")
        ),
    )


def null_p(m):
    rows = [
        {"nulls": kind, "expected": (i + 0.5) / len(p), "observed": v}
        for kind, p in m["null_p"].items()
        for i, v in enumerate(p)
    ]
    return spec(
        "p-values of the nulls",
        rows,
        [
            {
                "mark": {"type": "point", "size": 14},
                "encoding": {
                    "x": axis("expected", "uniform quantile", scale={"type": "log"}),
                    "y": axis("observed", "p-value", scale={"type": "log"}),
                    "color": axis("nulls", "nulls", "nominal"),
                },
            },
            line([0.001, 1], [0.001, 1], ("uniform quantile", "p-value")),
        ],
    )


def scores(m):
    rows = [{"z": max(-5, min(5, z))} for z in m["parameters"]["z"]]
    bars = {
        "mark": "bar",
        "encoding": {
            "x": axis("z", "(estimate - truth)/u", bin={"step": 0.5, "extent": [-5, 5]}),
            "y": {"aggregate": "count", "title": "parameters"},
        },
    }
    return spec("Parameters against the sealed truth", rows, [bars])


def gain(rows):
    values = [
        {"oracle": r["rivals"]["oracle_held_out"], "gain": r["gain"], "design": r["design"]}
        for r in rows
        if r["kind"] == "single"
        and r.get("gain") is not None
        and r["rivals"]["oracle_held_out"] is not None
        and r["detected"]
    ]
    largest = max([v["oracle"] for v in values], default=1)
    return spec(
        "Held-out log score won, nats, against knowing the shape",
        values,
        [
            {
                "mark": "point",
                "encoding": {
                    "x": axis("oracle", "knowing the family"),
                    "y": axis("gain", "held out"),
                    "color": axis("design", "design", "nominal"),
                },
            },
            line([0, largest], [0, largest], ("knowing the family", "held out")),
        ],
    )


def compared(m):
    rows = []
    for method, block in m["compared"].items():
        rows += [{"method": method, "figure": k.replace("_", " "), **v} for k, v in block.items() if v["n"]]
    bars = {
        "mark": "bar",
        "encoding": {
            "y": axis("method", None, "nominal"),
            "x": axis("share", "share"),
            "row": axis("figure", None, "nominal"),
        },
    }
    return spec(
        "The same cases, other methods", rows, [bars], height={"step": 14}, resolve={"scale": {"y": "independent"}}
    )


def predicted(m):
    titles = "size over the smallest said to be detectable", "detected"
    rows = m["predicted"]
    return spec(
        "Detected, against the program's own prediction",
        rows,
        [
            *with_limits(rows, axis("ratio", titles[0], scale={"type": "log"}), axis("share", titles[1])),
            line([1, 1], [0, 0.8], titles),
        ],
    )


def unknown_panel(rows):
    values = [
        {"case": r["case"], "family": r["families"][0], "snr": r["snr"], "verdict": r["verdict"]}
        for r in rows
        if r["kind"] == "unknown" and r["answered"]
    ]
    return spec(
        "What was said of effects that no catalogue names",
        values,
        [
            {
                "mark": "bar",
                "encoding": {
                    "y": axis("family", None, "nominal"),
                    "x": {"aggregate": "count", "title": "cases"},
                    "color": axis("verdict", "verdict", "nominal"),
                },
            }
        ],
        height={"step": 22},
    )


def failures(result):
    values = [
        {
            "rank": i + 1,
            "text": f"{w['case']}  {w['kind']} {w['design']} SNR {w['snr']:g}: {', '.join(w['families']) or 'nothing'}  ->  {w['verdict']} "
            f"{', '.join((w['members'] or [])[:3])}",
        }
        for i, w in enumerate(result["worst"])
    ]
    return spec(
        "The worst answers",
        values,
        [
            {
                "mark": {"type": "text", "align": "left", "x": 0},
                "encoding": {"y": axis("rank", None, "ordinal"), "text": {"field": "text", "type": "nominal"}},
            }
        ],
        width=640,
        height={"step": 18},
    )


def figures(result):
    m, rows = result["measures"], [r for r in result["rows"] if r["answered"]]
    return {
        "power": power(m),
        "power_by_family": power_by_family(m),
        "confusion": confusion(m),
        "reliability": reliability(m),
        "set_size": sets(m),
        "naming": naming(m),
        "predicted": predicted(m),
        "null_p_values": null_p(m),
        "parameter_z": scores(m),
        "gain_and_oracle": gain(rows),
        "other_methods": compared(m),
        "unknown": unknown_panel(rows),
        "worst": failures(result),
    }


def has_data(figure):
    return figure is not None and bool(figure["data"]["values"])


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    given = parser.parse_args(argv)
    given.out.mkdir(parents=True, exist_ok=True)
    for name, figure in figures(json.loads(given.results.read_text())).items():
        if has_data(figure):
            (given.out / f"{name}.vl.json").write_text(json.dumps(figure, indent=1) + "\n")


if __name__ == "__main__":
    main()
