#!/usr/bin/env python3
"""Opens the truths of a round and scores the answers. usage: score.py DIR --out results.json [--markdown]

Every seal is verified first; a truth or a data file that does not fit ends the scoring. results.json: `rows`
(one a case), `measures`, `targets`, `worst`.
"""

import argparse
import json
import pathlib
import sys

try:
    import judge
    import measures
    import seal
    import stories
except ModuleNotFoundError as missing:
    sys.exit(f"score: needs {missing.name} (Debian: python3-numpy)")


METHOD_FIGURES = ("alarms_clean", "alarms_hard", "power", "right", "confident_wrong")
WORST = ("case", "kind", "detail", "design", "mode", "snr", "families", "verdict", "members", "probability", "p_value", "exit")


def badness(r):
    """How wrong an answer is, for the gallery of failures; 0 when it is right."""
    if not r["answered"]:
        return 5.0
    if r["kind"] == "null":
        return 3.0 - (r["p_value"] or 0) + (r["probability"] or 0) if r["false_alarm"] else 0.0
    if r["confident_wrong"]:
        return 4.0 + (r["probability"] or 0)
    if not r["detected"] and r["kind"] in ("single", "unknown") and r["snr"] >= 6:
        return 1.0 + r["snr"] / 10
    return 1.0 + (r["probability"] or 0) if r["detected"] and r["members"] and not r["right"] else 0.0


def worst(rows, count=10):
    bad = sorted((r for r in rows if badness(r) > 0), key=lambda r: (-badness(r), r["case"]))
    return [{**{k: r.get(k) for k in WORST}, "story": stories.story(r)} for r in bad[:count]]


def percent(figure):
    value = figure.get("share") if isinstance(figure, dict) else figure
    return "-" if value is None else f"{100 * value:.1f} %"


def table(head, rows):
    lines = ["| " + " | ".join(map(str, cells)) + " |" for cells in (head, *rows)]
    return "\n".join([lines[0], "|---" * len(head) + "|", *lines[1:]]) + "\n"


def target_row(t):
    limited = t["limits"] and t["n"]
    value = "-" if t["observed"] is None else percent(t["observed"]) if t["limits"] else f"{t['observed']:.2f}"
    limits = f"{percent(t['limits'][0])} to {percent(t['limits'][1])}" if limited else ""
    return [t["name"], t["target"], value, limits, t["n"] or "", {None: "-", True: "yes", False: "no"}[t["met"]]]


def family_row(name, rows):
    mine = [r for r in rows if r["answered"] and r["families"] == [name] and r["kind"] in ("single", "covariance")]
    seen = [r for r in mine if r["detected"]]
    return [f"`{name}`", len(mine), len(seen), sum(r["right"] for r in seen)]


def tables(result):
    """The tables of a round in Markdown, by name."""
    m, rows = result["measures"], result["rows"]
    steps = list(m["power"]["steps"])
    powers = [[d, *(percent(b["steps"].get(s)) for s in steps)] for d, b in m["power_by_design"].items()]
    nulls = [[k, b["n"], percent(b)] for part in ("noise", "design") for k, b in m[f"false_alarms_by_{part}"].items()]
    families = [family_row(f, rows) for f in [*m["power_by_family"], *m["covariance"]]]
    methods = [[name, *(percent(block.get(k)) for k in METHOD_FIGURES)] for name, block in m["compared"].items()]
    return {
        "targets": table(["what", "target", "observed", "95 % limits", "n", "met"], map(target_row, result["targets"])),
        "power by design": table(["design", *(f"s = {s}" for s in steps)], powers),
        "false alarms": table(["noise (hard nulls) or design (all)", "n", "false alarms"], nulls),
        "families": table(["family", "n", "detected", "right, of the detected"], families),
        "other methods": table(["method", "alarms, clean nulls", "alarms, hard nulls", "detected", "right", "confident and wrong"], methods),
        "worst": table(["case", "what happened"], [[w["case"], w["story"]] for w in result["worst"]]),
    }


def markdown(result):
    return "\n".join(f"{name.capitalize()}:\n\n{text}" for name, text in tables(result).items())


def scored(root, sealed=None):
    """Everything that results.json has."""
    rows = []
    for number, truth in (truths := seal.verified(root, sealed)).items():
        path = pathlib.Path(root) / "answers" / f"{number}.json"
        rows.append(judge.row(truth, json.loads(path.read_text()) if path.exists() else {}))
    figures = measures.all_of(rows)
    return {
        "schema": "abbe.concealed/1",
        "seals_verified": len(truths),
        "targets": measures.targets(figures),
        "measures": figures,
        "worst": worst(rows),
        "rows": rows,
    }


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("round", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--sealed", type=pathlib.Path, help="where the truths are, default DIR/sealed")
    parser.add_argument("--markdown", action="store_true", help="print tables, too")
    given = parser.parse_args(argv)
    try:
        result = scored(given.round, given.sealed)
    except ValueError as broken:
        sys.exit(f"score: {broken}")
    given.out.write_text(json.dumps(result, indent=1) + "\n")
    if given.markdown:
        print(markdown(result))


if __name__ == "__main__":
    main()
