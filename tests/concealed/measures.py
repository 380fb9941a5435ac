"""The figures of a round from its rows, and the targets that they are held against."""

from portable import np
from tallies import area, calibration, logistic, share

RICH, POOR = "D", ("A", "C", "E")


def pick(rows, **equal):
    """Rows whose entries equal what is asked, or are among it when it is a tuple."""

    def fits(r):
        return all(r.get(k) in v if isinstance(v, tuple) else r.get(k) == v for k, v in equal.items())

    return [r for r in rows if fits(r)]


def flags(rows, key):
    return [bool(r.get(key)) for r in rows]


def power(rows):
    """Share detected at each signal-to-noise ratio, and the fitted curve."""
    steps = {}
    for snr in sorted({r["snr"] for r in rows}):
        steps[f"{snr:g}"] = share(flags(pick(rows, snr=snr), "detected"))
    return {"steps": steps, "curve": logistic([r["snr"] for r in rows], flags(rows, "detected"))}


def naming(rows):
    """Of the detected: right names, sizes of the sets, by signal-to-noise ratio."""
    out = {}
    for snr in sorted({r["snr"] for r in rows}):
        mine = [r for r in pick(rows, snr=snr) if r.get("detected")]
        sizes = [len(r["members"]) for r in mine if r["members"]]
        out[f"{snr:g}"] = {**share(flags(mine, "right")), "mean_size": float(np.mean(sizes)) if sizes else None}
    return out


def confusion(rows):
    """[{truth, said, n}]: first member of the first effect, 'unexplained' or 'nothing'."""
    table = {}
    for r in rows:
        said = r["members"][0] if r.get("members") else "unexplained" if r.get("detected") else "nothing"
        for family in r["families"][:1]:
            said_class = family if family in r.get("members", []) else said
            table[family, said_class] = table.get((family, said_class), 0) + 1
    return [{"truth": t, "said": s, "n": n} for (t, s), n in sorted(table.items())]


def of_parameters(rows):
    """Coverage and z-scores of every parameter with one meaning."""
    entries = [p for r in rows for p in r.get("parameters", [])]
    z = [p["z"] for p in entries if p["z"] is not None]
    by = {}
    for p in entries:
        by.setdefault(p["effect"] + " " + p["parameter"], []).append(p["covered"])
    return {
        "coverage": share([p["covered"] for p in entries]),
        "z_sd": float(np.std(z)) if z else None,
        "z": z,
        "relative_error_median": float(np.median([p["relative"] for p in entries if p["relative"] is not None]))
        if entries
        else None,
        "by_parameter": {k: share(v) for k, v in sorted(by.items())},
    }


def p_values(rows):
    return sorted(r["p_value"] for r in rows if r.get("p_value") is not None)


def compared(rows):
    """The same cases, judged by simpler methods and by one that knows the family. Nulls: every alarm counts, also one
    that says what the noise really has, for the others cannot say it."""
    nulls, singles = pick(rows, kind="null"), pick(rows, kind="single")

    def r(case, key):
        return (case.get("rivals") or {}).get(key)

    def alarms(alarm):
        return {f"alarms_{d}": share([bool(alarm(c)) for c in pick(nulls, detail=d)]) for d in ("clean", "hard")}

    chi2 = lambda case: (r(case, "chi2_p") if r(case, "chi2_p") is not None else 1) < 0.01
    return {
        "chi2": {**alarms(chi2), "power": share([chi2(c) for c in singles])},
        "stepwise_bic": {
            **alarms(lambda c: r(c, "stepwise_members")),
            "right": share([bool(r(c, "stepwise_right")) for c in singles]),
        },
        "best_bayes_factor": {
            "right": share([bool(r(c, "best_right")) for c in singles]),
            "confident_wrong": share(
                [(r(c, "best_probability") or 0) > 0.95 and not r(c, "best_right") for c in singles]
            ),
        },
        "this": {
            **alarms(lambda c: c["alarm"]),
            "right": share(flags(singles, "right")),
            "confident_wrong": share(flags(singles, "confident_wrong")),
            "power": share(flags(singles, "detected")),
        },
        "oracle": {"power": share([bool(r(c, "oracle_detected")) for c in singles])},
    }


def by(rows, key, count):
    """count(rows of one value) for each value of key."""
    values = sorted({key(r) for r in rows})
    return {f"{v:g}" if isinstance(v, (int, float)) else v: count([r for r in rows if key(r) == v]) for v in values}


def family(r):
    return r["families"][0]


def snr(r):
    return r["snr"]


def of_nulls(nulls):
    def alarms(rows):
        return share(flags(rows, "false_alarm"))

    hard = pick(nulls, detail="hard")
    return {
        "false_alarms": {d: alarms(pick(nulls, detail=d)) for d in ("clean", "hard")},
        "false_alarms_by_noise": by(hard, lambda r: r["noise"], alarms),
        "false_alarms_by_design": {d: alarms(pick(nulls, design=d)) for d in "ACDE"},
        "null_p": {d: p_values(pick(nulls, detail=d)) for d in ("clean", "hard")},
    }


def of_detection(nulls, singles):
    against = [1 - p for p in p_values(nulls)]
    return {
        "power": power(singles),
        "power_by_design": {d: power(pick(singles, design=d)) for d in "ACDE"},
        "power_by_family": by(singles, family, power),
        "auc": by(singles, snr, lambda rows: area(against, [1 - p for p in p_values(rows)])),
        "predicted": predicted(singles),
    }


def reliability(rows):
    """Of every set told in any answer: of two effects, strangers, nulls and doubted by half as well."""
    sets = [t for r in rows for t in r["told"]]
    return calibration([t["probability"] for t in sets], flags(sets, "right"))


def of_names(singles):
    named = [r for r in singles if r["verdict"] in ("named", "one_of")]
    return {
        "naming": {"rich": naming(pick(singles, design=RICH)), "poor": naming(pick(singles, design=POOR))},
        "named_set_contains_truth": share(flags(named, "right")),
        "strong": of_strong([r for r in singles if r["snr"] >= 6 and r["detected"]]),
        "location": by(pick(singles, detected=True), snr, lambda rows: share(flags(rows, "located"))),
        "parameters": of_parameters(singles),
        "confusion": confusion(singles),
        **of_improvement(named),
    }


def of_strong(rows):
    """Of what was detected at a ratio of 6 or more: named rightly, located rightly."""
    return {
        "rich": share(flags(pick(rows, design=RICH), "right")),
        "poor": share(flags(pick(rows, design=POOR), "right")),
        "located": share(flags(rows, "located")),
    }


def of_improvement(named):
    biased = [r["bias"] for r in named if r.get("bias") and r["bias"].get("before")]
    strong = [r for r in named if r["gain"] is not None and r["snr"] >= 6 and (r["rivals"]["oracle_held_out"] or 0) > 1]
    return {
        "gain_positive": share([(r["gain"] or 0) > 0 for r in named]),
        "share_of_oracle_gain": median([r["gain"] / r["rivals"]["oracle_held_out"] for r in strong]),
        "bias_left": median([b["after"] / b["before"] for b in biased]),
    }


def of_pairs(rows):
    decoys = pick(rows, detail="decoy")
    return {
        "pairs": {d: share(flags(pick(rows, detail=d), "right")) for d in ("separable", "decoy", "masking")},
        "decoy_wrongly_alone": share([r["verdict"] == "named" and not r["right"] for r in decoys]),
    }


def all_of(rows):
    """Every figure of the round."""
    answered = [r for r in rows if r["answered"]]
    nulls, singles = pick(answered, kind="null"), pick(answered, kind="single")
    seconds = [r["seconds"] for r in answered]
    return {
        "cases": len(rows),
        "answered": len(answered),
        "seconds": {"median": median(seconds), "largest": max(seconds, default=None)},
        "confident_wrong": share([r["confident_wrong"] for r in answered if r["kind"] != "null"]),
        **of_nulls(nulls),
        **of_detection(nulls, singles),
        **of_names(singles),
        "reliability": reliability(answered),
        **of_pairs(pick(answered, kind="pair")),
        "unknown": of_unknown(pick(answered, kind="unknown")),
        "missing": of_missing(pick(answered, kind="missing")),
        "covariance": by(pick(answered, kind="covariance"), family, lambda some: share(flags(some, "right"))),
        "compared": compared(answered),
    }


def predicted(rows):
    """Detected, by the size of the effect over the smallest that was said to be detectable (at 80 %)."""
    out = []
    for low, high in ((0, 0.5), (0.5, 0.8), (0.8, 1.25), (1.25, 2), (2, 4), (4, 1e9)):
        mine = [r for r in rows if r.get("over_detectable") is not None and low <= r["over_detectable"] < high]
        if mine:
            out.append(
                {
                    "from": low,
                    "ratio": float(np.median([r["over_detectable"] for r in mine])),
                    **share(flags(mine, "detected")),
                }
            )
    return out


def median(values):
    return float(np.median(values)) if len(values) else None


def of_unknown(rows):
    strong = [r for r in rows if r["snr"] >= 10]
    found = [r for r in strong if r["detected"]]
    near = [r for r in found if r.get("nearest") and r["nearest"][0][1] > 0.7]
    far = [r for r in found if r not in near]

    def block(some):
        return {
            "unexplained": share([r["verdict"] == "unexplained" for r in some]),
            "falsely_named": share([bool(r["members"]) for r in some]),
            "confidently_named": share(flags(some, "confident_wrong")),
        }

    return {
        "detected": share(flags(strong, "detected")),
        **block(found),
        "alike": {"n": len(near), **block(near)},
        "unlike": {"n": len(far), **block(far)},
    }


def of_missing(rows):
    """What cannot be judged follows from the columns alone, so that it is listed by construction. Right is who lists it and
    invents nothing: tells no set without the truth with more than one half."""
    listed = [bool(set(r["families"]) & set(r["cannot_judge"])) for r in rows]
    invented = [any(t["probability"] > 0.5 and not t["right"] for t in r["told"]) for r in rows]
    return {
        "listed": share(listed),
        "invented": share(invented),
        "right": share([a and not b for a, b in zip(listed, invented)]),
        "confident_wrong": share(flags(rows, "confident_wrong")),
    }


def targets(m):
    """[{name, target, observed, limits, n, met}]: what a round is held against."""
    out = []

    def add(name, target, figure, met):
        value = figure.get("share") if isinstance(figure, dict) else figure
        limits = [figure["low"], figure["high"]] if isinstance(figure, dict) and "low" in figure else None
        out.append(
            {
                "name": name,
                "target": target,
                "observed": value,
                "limits": limits,
                "n": figure.get("n") if isinstance(figure, dict) else None,
                "met": None if value is None else bool(met(value)),
            }
        )

    at_least, at_most = lambda t: lambda v: v >= t, lambda t: lambda v: v <= t
    none = {"share": None, "low": 0, "high": 1, "n": 0}
    add("false alarms, clean", "<= 1 %", m["false_alarms"]["clean"], at_most(0.01))
    add("false alarms, hard", "<= 2 %", m["false_alarms"]["hard"], at_most(0.02))
    curve = m["power"]["curve"] or {}
    add("detected at 50 %: SNR", "<= 3.7", curve.get("at50"), at_most(3.7))
    add("detected at 90 %: SNR", "<= 5.2", curve.get("at90"), at_most(5.2))
    add("detected at SNR 6", ">= 98 %", m["power"]["steps"].get("6", none), at_least(0.98))
    add("named rightly, rich, SNR 4.5", ">= 90 %", m["naming"]["rich"].get("4.5", none), at_least(0.90))
    add("named rightly, rich, SNR >= 6", ">= 97 %", m["strong"]["rich"], at_least(0.97))
    add("named rightly, poor, SNR >= 6", ">= 90 %", m["strong"]["poor"], at_least(0.90))
    add("95 % sets contain the truth", "93 to 98 %", m["named_set_contains_truth"], lambda v: 0.93 <= v <= 0.98)
    add("mean size of a set, rich, SNR 6", "<= 1.5", m["naming"]["rich"].get("6", {}).get("mean_size"), at_most(1.5))
    add("confident and wrong", "<= 1 %", m["confident_wrong"], at_most(0.01))
    add("right factor, SNR >= 6, of the detected", ">= 95 %", m["strong"]["located"], at_least(0.95))
    add("95 % intervals of parameters", "92 to 98 %", m["parameters"]["coverage"], lambda v: 0.92 <= v <= 0.98)
    add("held-out gain above 0 among named", ">= 97 %", m["gain_positive"], at_least(0.97))
    add("unknown, detected at SNR >= 10", ">= 80 %", m["unknown"]["detected"], at_least(0.80))
    unlike = m["unknown"]["unlike"]  # what resembles a catalogue effect (correlation above 0.7) is counted apart
    add("unknown, called unexplained", ">= 90 %", unlike["unexplained"], at_least(0.90))
    add("unknown, falsely named", "<= 5 %", unlike["falsely_named"], at_most(0.05))
    add("missing covariate, listed, no wrong name", ">= 95 %", m["missing"]["right"], at_least(0.95))
    add("pairs, both named (separable)", ">= 95 %", m["pairs"]["separable"], at_least(0.95))
    add("decoys, truth in the set", ">= 95 %", m["pairs"]["decoy"], at_least(0.95))
    return out
