"""Sets one answer against one truth: a flat row of what was right, what was wrong, and by how much.
docs/results.md has the answer's keys.

Rules, fixed before any final round (but for the last, which became stricter after the twelfth): something is *detected*
when the verdict is a mismatch. A name is *right* when the truth is among the members of the first effect (of any effect,
for a pair). It is *confidently wrong* when an effect with a probability above 0.95 has no truth among its members, nor
what the truth cannot be told from. Of a null, whatever is told is a *false alarm*, by any verdict: a pattern, or a name,
but for noise properties that a hard null really has.
"""

INDISTINCT = 0.95  # correlation, as where effects are put into one class
MISMATCH = ("named", "one_of", "unexplained")


def names_of(said):
    return [e.get("members", []) for e in said.get("effects", [])]


def parameters(truth, said):
    """Rows {effect, parameter, truth, value, u, z, covered, relative} for parameters with one meaning, of
    effects named alone or first."""
    out = []
    for effect in truth["effects"]:
        for reported in said.get("effects", []):
            if reported.get("members", [None])[0] != effect["name"]:
                continue
            for key, true in effect["fixed"].items():
                got = reported.get("parameters", {}).get(key)
                if not isinstance(got, dict) or "value" not in got:
                    continue
                low, high = got.get(
                    "interval95", [got["value"] - 1.96 * got.get("u", 0), got["value"] + 1.96 * got.get("u", 0)]
                )
                u = got.get("u") or None
                out.append(
                    {
                        "effect": effect["name"],
                        "parameter": key,
                        "truth": true,
                        "value": got["value"],
                        "u": u,
                        "z": (got["value"] - true) / u if u else None,
                        "covered": low <= true <= high,
                        "relative": abs(got["value"] - true) / abs(true) if true else None,
                    }
                )
    return out


def over_detectable(truth, said):
    """Size of the concealed effect over the smallest that the program says it would have detected, both in the
    unit of the parameter; None when it does not say."""
    for entry in said.get("smallest_detectable") or []:
        for effect in truth["effects"]:
            size = effect["parameters"].get(entry.get("parameter"))
            if entry.get("effect") == effect["name"] and isinstance(size, (int, float)) and entry.get("detect"):
                return abs(size) / entry["detect"]
    return None


def places(truth):
    """Factors in which the effect may rightly be located. In design A the runs follow each other: there a run is a
    stretch of time."""
    allowed = {f for e in truth["effects"] for f in e["factors"]}
    return allowed | {"run"} if truth["design"] == "A" and "time" in allowed else allowed


def rivals(truth, said):
    """What simpler methods make of the same case."""
    names = {e["name"] for e in truth["effects"]}
    given = said.get("rivals") or {}
    best, steps = given.get("best_bayes_factor") or {}, given.get("stepwise_bic") or {}
    z = truth.get("oracle", {}).get("z")
    return {
        "chi2_p": (given.get("chi2") or {}).get("p"),
        "stepwise_members": steps.get("members"),
        "stepwise_right": bool(names & set(steps.get("members") or [])),
        "best_members": best.get("members"),
        "best_probability": best.get("probability"),
        "best_right": bool(names & set((best.get("members") or [])[:1])),
        "oracle_detected": z is not None and abs(z) > 2.5758,
        "oracle_gain": truth.get("oracle", {}).get("log_likelihood_ratio"),
        "oracle_held_out": truth.get("oracle", {}).get("held_out_gain"),
    }


def likenesses(truth):
    """Catalogue effects that a stranger cannot be told from: to name these is not wrong, though no name is better."""
    return {name for name, correlation in truth.get("nearest") or [] if correlation > INDISTINCT}


def told(truth, said):
    """Each set of names told, {probability, right}: right when a truth is among its members, or when it is nothing but what
    the noise of a null really has."""
    names, tolerated, out = {e["name"] for e in truth["effects"]}, set(truth.get("tolerated", [])), []
    for effect in said.get("effects", []):
        members = set(effect.get("members", []))
        right = bool(names & members) or bool(members) and members <= tolerated
        out.append({"probability": effect.get("probability", 0), "right": right})
    return out


def row(truth, stored):
    """Everything that the scorer counts, of one case."""
    said = stored.get("answer")
    out = {k: truth[k] for k in ("case", "kind", "detail", "snr", "design", "touches", "machine", "mode")}
    out.update(
        families=[e["name"] for e in truth["effects"]],
        expected=truth["verdict"],
        seconds=stored.get("seconds"),
        exit=stored.get("exit"),
        noise=truth["nuisance"]["noise"],
        answered=said is not None,
    )
    if said is None:
        return out
    sets, names = names_of(said), set(out["families"])
    first = said["effects"][0] if said.get("effects") else {}
    located = said.get("location") or []
    improvement = said.get("improvement") or {}
    out.update(
        verdict=said.get("verdict"),
        p_value=said.get("p_value"),
        detected=said.get("verdict") in MISMATCH,
        members=sets[0] if sets else [],
        all_members=sets,
        told=told(truth, said),
        probability=first.get("probability"),
        right=bool(sets)
        and (bool(names & set(sets[0])) if truth["kind"] != "pair" else all(any(n in s for s in sets) for n in names)),
        confident_wrong=any(
            e.get("probability", 0) > 0.95 and not (names | likenesses(truth)) & set(e.get("members", []))
            for e in said.get("effects", [])
        ),
        factor=located[0].get("factor") if located else None,
        located=bool(located) and located[0].get("factor") in places(truth),
        gain=improvement.get("log_score_gain"),
        gain_se=improvement.get("se"),
        scheme=improvement.get("scheme"),
        has_residuals=bool(said.get("residuals")),
        over_detectable=over_detectable(truth, said),
        bias=improvement.get("bias_um"),
        unexplained=said.get("unexplained"),
        cannot_judge=[e.get("effect") for e in said.get("cannot_judge", [])],
        parameters=parameters(truth, said),
        rivals=rivals(truth, said),
        nearest=truth.get("nearest"),
        runner_up=(said.get("runner_up") or {}).get("members"),
        other_names=[r[0] for r in truth.get("rivals", [])],
        next_measurement=[m.get("change") for m in said.get("next_measurement", [])][:1],
    )
    pattern = bool(said.get("unexplained"))
    alarm = out["detected"] or bool(sets) or pattern  # cannot_judge may have names; where nothing can be judged, it has none
    harmless = bool(sets) and all(t["right"] for t in out["told"]) and not pattern
    out.update(alarm=alarm, false_alarm=truth["kind"] == "null" and alarm and not harmless)
    return out
