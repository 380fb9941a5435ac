"""What ideal.json says of the best possible search (`ideal.py`): the table of the page and a curve of its figure."""

import json
import pathlib
from collections import Counter

from portable import np
from score import percent, table

RESULT = pathlib.Path(__file__).resolve().with_name("ideal.json")


def rows():
    """The committed result."""
    return json.loads(RESULT.read_text())["rows"]


def weighted(rows, cases):
    """[(s, share)] of the search, for the mixture of designs and modes of the cases; those not computed are left out."""
    weight = Counter((c["design"], c["mode"]) for c in cases)
    mine = [(weight[r["design"], r["mode"]], r["steps"]) for r in rows]
    total = sum(w for w, _ in mine)
    return [(float(s), sum(w * steps[s]["search"] for w, steps in mine) / total) for s in rows[0]["steps"]] if total else []


def at(points, share):
    """The s at which the share is reached, by straight lines; None when it is not."""
    s, y = zip(*points)
    return float(np.interp(share, np.maximum.accumulate(y), s)) if y[0] <= share <= max(y) else None


def text(rows):
    """The table of the page."""
    head = ["design", "mode", "plans", "families", "shapes", "knows", *(f"s = {s}" for s in rows[0]["steps"]), "50 % at", "90 % at"]

    def row(r, key):
        points = [(float(s), v[key]) for s, v in r["steps"].items()]
        reached = ["-" if (s := at(points, y)) is None else f"{s:.1f}" for y in (0.5, 0.9)]
        known = {"shape": "the shape", "family": "the family", "search": "the catalogue"}[key]
        return [*(r[k] for k in ("design", "mode", "stages", "families", "shapes")), known, *(percent(y) for _, y in points), *reached]

    return table(head, [row(rows[0], "shape"), row(rows[0], "family"), *(row(r, "search") for r in rows)])
