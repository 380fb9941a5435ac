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
except ModuleNotFoundError as missing:
    sys.exit(f"score: needs {missing.name} (Debian: python3-numpy)")


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
    keys = (
        "case",
        "kind",
        "detail",
        "design",
        "mode",
        "snr",
        "families",
        "verdict",
        "members",
        "probability",
        "p_value",
        "exit",
    )
    bad = sorted((r for r in rows if badness(r) > 0), key=lambda r: (-badness(r), r["case"]))
    return [{k: r.get(k) for k in keys} for r in bad[:count]]


def percent(value):
    return "-" if value is None else f"{100 * value:.1f} %"


def shown(target):
    if target["observed"] is None:
        return "-"
    return percent(target["observed"]) if target["limits"] else f"{target['observed']:.2f}"


def markdown(result):
    """The table of targets, power and naming by design, and the gallery."""
    m, out = result["measures"], ["| what | target | observed | 95 % limits | n | met |", "|---|---|---|---|---|---|"]
    for t in result["targets"]:
        limits = f"{percent(t['limits'][0])} to {percent(t['limits'][1])}" if t["limits"] and t["n"] else ""
        out.append(
            f"| {t['name']} | {t['target']} | {shown(t)} | {limits} | {t['n'] or ''} | {'-' if t['met'] is None else 'yes' if t['met'] else 'no'} |"
        )
    steps = list(m["power"]["steps"])
    out += [
        "",
        "Detected, by design and signal-to-noise ratio:",
        "",
        "| design | " + " | ".join(steps) + " |",
        "|---" * (len(steps) + 1) + "|",
    ]
    for design, block in m["power_by_design"].items():
        out.append(f"| {design} | " + " | ".join(percent(block["steps"].get(s, {}).get("share")) for s in steps) + " |")
    out += [
        "",
        "Detected and named rightly, by family:",
        "",
        "| family | n | detected | right, of the detected |",
        "|---|---|---|---|",
    ]
    for family in m["power_by_family"]:
        mine = [r for r in result["rows"] if r["kind"] == "single" and r["families"] == [family] and r["answered"]]
        seen = [r for r in mine if r["detected"]]
        out.append(f"| `{family}` | {len(mine)} | {len(seen)} | {sum(r['right'] for r in seen)} |")
    out += [
        "",
        "Worst answers:",
        "",
        "| case | what | design | SNR | truth | verdict | said | probability |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for r in result["worst"]:
        chance = "" if r["probability"] is None else f"{r['probability']:.2f}"
        out.append(
            f"| {r['case']} | {r['kind']} {r['detail']} | {r['design']} {r['mode']} | {r['snr']:g} | {', '.join(r['families'])} | {r['verdict']} | "
            f"{', '.join(r['members'] or [])} | {chance} |"
        )
    return "\n".join(out) + "\n"


def scored(root):
    truths, rows = seal.verified(root), []
    for number, truth in truths.items():
        path = pathlib.Path(root) / "answers" / f"{number}.json"
        rows.append(
            judge.row(
                truth,
                json.loads(path.read_text()) if path.exists() else {"answer": None, "seconds": None, "exit": None},
            )
        )
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
    parser.add_argument("--markdown", action="store_true", help="print tables, too")
    given = parser.parse_args(argv)
    try:
        result = scored(given.round)
    except ValueError as broken:
        sys.exit(f"score: {broken}")
    given.out.write_text(json.dumps(result, indent=1) + "\n")
    if given.markdown:
        print(markdown(result))


if __name__ == "__main__":
    main()
