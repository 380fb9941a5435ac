"""One sentence for a wrong answer, from the truth and what was said of it."""


def said_of(r):
    chance = "" if r.get("probability") is None else f" with probability {r['probability']:.2f}"
    if r.get("members"):
        names = ", ".join(r["members"][:3]) + (f" and {len(r['members']) - 3} more" if len(r["members"]) > 3 else "")
        beside = " beside a pattern" if r.get("unexplained") else ""
        return ("one of " if len(r["members"]) > 1 else "") + names + chance + beside
    return "unexplained" if r.get("verdict") == "unexplained" else "nothing"


def resemblance(r):
    """Why it might be: a likeness that the generator computed, or a size that the program calls too small."""
    near = [n for n in r.get("nearest") or [] if n[0] in (r.get("members") or [])]
    if near:
        return f" Combinations of {near[0][0]} imitate it with correlation {near[0][1]:.2f}."
    if not r.get("detected") and r.get("over_detectable"):
        return f" It is {r['over_detectable']:.1f} times what the program calls detectable."
    if r.get("runner_up") and set(r["runner_up"]) & set(r["families"]):
        return " The truth was the runner-up."
    return ""


def story(r):
    where = f"design {r['design']}, {r['touches']} touches, {r['mode']} {r['machine']}"
    if not r["answered"]:
        return f"No answer ({where}): exit code {r['exit']}."
    p = "" if r.get("p_value") is None else f" (p = {r['p_value']:.2g})"
    if r["kind"] == "null":
        return f"Nothing was concealed ({where}; {r['detail']}, noise {r['noise']}), but {said_of(r)} was said{p}."
    truth = " and ".join(r["families"])
    seen = f"was called {said_of(r)}" if r.get("detected") else f"was not seen{p}"
    size = f" of s = {r['snr']:g}" if r["snr"] else ""
    return f"{truth}{size} ({where}) {seen}.{resemblance(r)}"
