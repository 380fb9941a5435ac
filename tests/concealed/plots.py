#!/usr/bin/env python3
"""Draws the results of a round. usage: plots.py results.json OUT/ [--follow follow.json]

Writes one Vega-Lite v6 specification a figure, data inside; docs/figures/render.mjs makes pictures of them. A
figure without data is left out.
"""

import argparse
import json
import pathlib

import plots_detection as detection
import plots_naming as naming
from charts import values_of


def figures(result, follow=None):
    m, rows = result["measures"], [r for r in result["rows"] if r["answered"]]
    return {
        "power": detection.power(m),
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
    given = parser.parse_args(argv)
    follow = json.loads(given.follow.read_text()) if given.follow else None
    written(figures(json.loads(given.results.read_text()), follow), given.out)


if __name__ == "__main__":
    main()
