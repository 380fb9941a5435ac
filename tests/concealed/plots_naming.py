"""Figures about what was said: names, sets, probabilities, parameters, held-out improvement, strangers and decoys."""

from charts import COLOURS, SNR, axis, figure, line, panel, share, spec, with_limits


def confusion(m):
    """Families in the order of the catalogue, so that confusions inside a group lie near the diagonal."""
    rows = m["confusion"]
    totals = {}
    for r in rows:
        totals[r["truth"]] = totals.get(r["truth"], 0) + r["n"]
    rows = [{**r, "share": r["n"] / totals[r["truth"]]} for r in rows]
    said = sorted({r["said"] for r in rows} | set(totals), key=lambda s: (s in ("nothing", "unexplained"), s))
    x = axis("said", "said (first name, or the truth when it is in the set)", "nominal", sort=said, axis={"labelAngle": -60})
    y = axis("truth", "concealed", "nominal", sort=sorted(totals))
    colour = axis("share", "share", scale={"scheme": "blues", "domain": [0, 1]}, legend={"format": "%"})
    boxes = {"mark": "rect", "encoding": {"x": x, "y": y, "color": colour}}
    dark = {"condition": {"test": "datum.share > 0.6", "value": "white"}, "value": "#333333"}
    numbers = {"mark": {"type": "text", "fontSize": 9}, "encoding": {"x": x, "y": y, "text": axis("n", None, "nominal"), "color": dark}}
    return spec("Confusion of single effects, all sizes", rows, [boxes, numbers], "numbers: cases", width={"step": 17}, height={"step": 15})


def reliability(m):
    rows = [{**b, "low": b["limits"][0], "high": b["limits"][1]} for b in m["reliability"]["bins"]]
    titles = "stated probability of the set", "truth in the set"
    x = share("said", titles[0])
    number = {"mark": {"type": "text", "dx": 14, "fontSize": 10}, "encoding": {"x": x, "y": share("right", titles[1]), "text": axis("n", None, "nominal")}}
    layers = [*with_limits(x, share("right", titles[1])), number, line([0, 1], [0, 1], titles)]
    error = m["reliability"]["error"]
    return spec("Reliability of the probability of a name", rows, layers, f"every set told in any case; expected calibration error {error:.3f}; numbers: sets" if rows else None)


def sets(m):
    """Size of the sets and how many of them hold the truth, by signal-to-noise ratio."""
    rows = [{"design": d, "snr": float(k), "size": v["mean_size"], **v} for d, block in m["naming"].items() for k, v in block.items() if v["n"]]
    x, colour = axis("snr", SNR), axis("design", None, "nominal")
    mean = {"mark": {"type": "line", "point": True}, "encoding": {"x": x, "y": axis("size", "members in a set (mean)", scale={"zero": True}), "color": colour}}
    sized = panel([r for r in rows if r["size"]], [mean], width=220)
    held = panel(rows, [*with_limits(x, share("share", "truth in the set, of the detected"), colour), line([0, 16], [0.95, 0.95], (SNR, "truth in the set, of the detected"))], width=220)
    return figure("Sets of names: size, and whether they hold the truth", [sized, held], "dashed: 95 %; rich: design D, poor: A, C, E")


def parameters(m):
    z = [{"z": max(-4.99, min(4.99, v))} for v in m["parameters"]["z"]]
    bars = {
        "mark": {"type": "bar", "color": COLOURS[0]},
        "encoding": {"x": axis("z", "(estimate - truth)/u (1)", bin={"step": 0.5, "extent": [-5, 5]}), "y": {"aggregate": "count", "title": "parameters", "axis": {"tickMinStep": 1}}},
    }
    rows = [{"parameter": k, **v} for k, v in m["parameters"]["by_parameter"].items()]
    y = axis("parameter", None, "nominal", axis={"labelLimit": 400})
    rule = {"mark": {"type": "rule", "opacity": 0.6}, "encoding": {"y": y, "x": {**share("low", "95 % interval holds the truth"), "field": "low"}, "x2": {"field": "high"}}}
    dot = {"mark": {"type": "point", "filled": True}, "encoding": {"y": y, "x": share("share", "95 % interval holds the truth")}}
    spread = m["parameters"]["z_sd"]
    note = f"left: standard deviation {spread:.2f}, 1 is right; beyond 5 in the last bar" if spread is not None else None
    return figure("Parameters against the sealed truth", [panel(z, [bars], width=220), panel(rows, [rule, dot], width=180, height={"step": 14})], note)


def gain(rows):
    values = [
        {"oracle": max(0.3, r["rivals"]["oracle_held_out"]), "gain": max(0.3, r["gain"]), "design": r["design"]}
        for r in rows
        if r["kind"] == "single" and r.get("detected") and r.get("gain") is not None and r["rivals"]["oracle_held_out"] is not None
    ]
    titles = "oracle: shape known, only its size fitted (nats)", "this program (nats)"
    log = {"type": "log", "domain": [0.3, 300], "nice": False, "clamp": True}
    x, y = axis("oracle", titles[0], scale=log), axis("gain", titles[1], scale=log)
    points = {"mark": {"type": "point", "filled": True, "size": 40}, "encoding": {"x": x, "y": y, "color": axis("design", "design", "nominal")}}
    return spec("Held-out log score won by the named model", values, [points, line([0.3, 300], [0.3, 300], titles)], "values below 0.3 nats are drawn there")


def unknown_panel(rows):
    values = [
        {
            "family": f"{r['families'][0]}, s = {r['snr']:g}",
            "answer": {"no_mismatch": "nothing", "unexplained": "unexplained"}.get(r["verdict"], "a name"),
            "place": ("in " + (r["unexplained"] or {}).get("factor", "")) if r["verdict"] == "unexplained" and r["unexplained"] else "",
        }
        for r in sorted(rows, key=lambda r: (r["families"][:1], r["snr"]))
        if r["kind"] == "unknown"
    ]
    colour = axis("answer", "said", "nominal", scale={"domain": ["unexplained", "a name", "nothing"], "range": [COLOURS[2], COLOURS[1], "#bbbbbb"]})
    bars = {"mark": "bar", "encoding": {"y": axis("family", None, "nominal", sort=None), "x": {"aggregate": "count", "title": "cases", "axis": {"tickMinStep": 1}}, "color": colour}}
    return spec("Effects that no catalogue names", values, [bars], "right answer: unexplained", height={"step": 16})


def decoys(follow):
    """Answers on decoys: first recording alone, with a second one by the program's own wish, and by a change drawn at
    random."""
    if not follow or not follow["rows"]:
        return None
    values = []
    for r in follow["rows"]:
        for stage in ("before", "wish", "random"):
            values.append({"stage": {"before": "one recording", "wish": "with the one wished for", "random": "with a random one"}[stage], "resolved": r[stage]["class"]})
    order = ["truth alone", "truth in the set", "other"]
    colour = axis("resolved", "said", "nominal", sort=order, scale={"domain": order, "range": [COLOURS[2], COLOURS[0], COLOURS[1]]})
    y = axis("stage", None, "nominal", sort=["one recording", "with the one wished for", "with a random one"])
    bars = {"mark": "bar", "encoding": {"y": y, "x": {"aggregate": "count", "title": "decoys", "axis": {"tickMinStep": 1}}, "color": colour, "order": {"field": "resolved"}}}
    return spec("Decoys: what a second recording of the same machine decides", values, [bars], height={"step": 30})


def residual_map(shown):
    """Residuals of one case over two coordinates without and with the named effect, which is predicted from the touches
    of all other groups."""
    values = [{**point, "model": model, "um": point[key]} for point in shown["points"] for model, key in (("before", "before_um"), ("after", "after_um"))]
    if not values:
        return None
    limit = sorted(abs(v["um"]) for v in values)[int(0.98 * len(values))]
    colour = axis("um", "residual (um)", scale={"scheme": "redblue", "reverse": True, "domain": [-limit, limit], "clamp": True})
    points = {"mark": {"type": "circle", "size": 22, "opacity": 0.9}, "encoding": {"x": axis("u", shown["u"], scale={"zero": False}), "y": axis("v", shown["v"], scale={"zero": False}), "color": colour}}

    def side(model):
        return {**panel([v for v in values if v["model"] == model], [points], width=220), "title": {"text": model, "fontSize": 11, "anchor": "middle"}}

    return figure(shown["title"], {"hconcat": [side("before"), side("after")]}, shown["subtitle"])
