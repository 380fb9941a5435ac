"""Before and after: residuals of a few cases without and with what was named, the named part predicted from the touches
of all other groups.

Which cases are shown is a rule, not a choice: for each kind the first in the round whose effect is at least six times the
noise and whose answer has residuals, whether it is right or wrong; of the single effects the first of each group.
"""

AXES = ("x", "y", "z")


def chosen(rows, most=6):
    """At most six cases: single effects of different groups, a stranger, a decoy."""
    out, groups = [], set()
    for r in sorted(rows, key=lambda r: r["case"]):
        decoy = r["detail"] == "decoy"
        if not (r.get("has_residuals") and r["snr"] >= 6) or r["kind"] not in ("single", "unknown") and not decoy:
            continue
        group = r["kind"] if r["kind"] != "single" else r["families"][0].split(".")[0]
        if group not in groups:
            groups.add(group)
            out.append(r)
    extra = [r for r in out if r["kind"] != "single"]
    return [r for r in out if r["kind"] == "single"][: most - len(extra)] + extra


def abscissa(factor):
    """What the residuals are drawn over: the time where the mismatch lies in time, else the widest axis."""
    return "time_s" if factor in ("time", "run") else None


def shown(r, residuals):
    """Points of one case over two columns, and what to write at them."""
    spans = {a: max(residuals[f"{a}_mm"]) - min(residuals[f"{a}_mm"]) for a in AXES}
    wide = sorted(AXES, key=lambda a: -spans[a])
    u, u_title = f"{wide[0]}_mm", f"{wide[0]} (mm)"
    if abscissa(r.get("factor")):
        u, u_title = "time_s", "time (s)"
    v = f"{wide[1]}_mm" if u != "time_s" else f"{wide[0]}_mm"
    rows = zip(residuals[u], residuals[v], residuals["before_um"], residuals["after_um"])
    said = " or ".join(r["members"][:3]) if r["members"] else "unexplained"
    more = f" and {len(r['members']) - 3} more" if len(r["members"] or []) > 3 else ""
    return {
        "title": f"Case {r['case']}: {', '.join(r['families'])}, s = {r['snr']:g}",
        "subtitle": f"said: {said}{more}; left without it, right with it, predicted from the other groups ({r['scheme']})",
        "u": u_title,
        "v": f"{v[0]} (mm)",
        "points": [{"u": a, "v": b, "before_um": before, "after_um": after} for a, b, before, after in rows],
    }
