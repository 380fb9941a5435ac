#!/usr/bin/env python3
"""Draws the results of a round. usage: plots.py results.json OUT/ [--follow follow.json] [--answers DIR/answers]

Writes one Vega-Lite v6 specification a figure, data inside; docs/figures/render.mjs makes pictures of them. A
figure without data is left out.
"""

import argparse
import json
import pathlib

import ceiling
import plots_detection as detection
import plots_naming as naming
import showcases
from charts import values_of


def figures(result, follow=None):
    m, rows = result["measures"], [r for r in result["rows"] if r["answered"]]
    return {
        "power": detection.power(m, rows, ceiling.rows()),
        "power_by_family": detection.power_by_family(m),
        "predicted": detection.predicted(m),
        "null_p_values": detection.null_p(m, rows),
        "false_alarms": detection.null_rates(m),
        "other_methods": detection.compared(m),
        "confusion": naming.confusion(m),
        "reliability": naming.reliability(m),
        "sets": naming.sets(m),
        "parameters": naming.parameters(m),
        "held_out": naming.gain(rows),
        "unknown": naming.unknown_panel(rows),
        "decoys": naming.decoys(follow),
    }


def residual_maps(result, answers):
    """before_after_1 ...: cases chosen by rule, with the residuals of their answers."""
    out = {f"before_after_{i}": None for i in range(1, 7)}
    cases = showcases.chosen(result["rows"])
    for i, r in enumerate(cases, 1):
        residuals = json.loads((answers / f"{r['case']}.json").read_text())["answer"]["residuals"]
        out[f"before_after_{i}"] = naming.residual_map(showcases.shown(r, residuals))
    return out


def title_of(specification):
    return specification["title"]["text"] if specification else ""


def written(specifications, folder):
    """Writes those that have data as NAME.vl.json; returns their names."""
    folder.mkdir(parents=True, exist_ok=True)
    names = [name for name, figure in specifications.items() if figure and values_of(figure)]
    for name in names:
        (folder / f"{name}.vl.json").write_text(json.dumps(specifications[name], indent=1) + "\n")
    return names


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--follow", type=pathlib.Path, help="results of follow.py")
    parser.add_argument("--answers", type=pathlib.Path, help="for the residuals of some cases before and after")
    given = parser.parse_args(argv)
    follow, result = json.loads(given.follow.read_text()) if given.follow else None, json.loads(given.results.read_text())
    maps = residual_maps(result, given.answers) if given.answers else {}
    written({**figures(result, follow), **maps}, given.out)


if __name__ == "__main__":
    main()
