"""A round in one paragraph and one table, for the head of docs/evidence.md."""

from score import table
from tallies import share


def of(figure):
    return f"{figure['k']} of {figure['n']}"


def headline(result):
    m = result["measures"]
    clean, hard = m["false_alarms"]["clean"], m["false_alarms"]["hard"]
    six, rich, poor, unknown = m["power"]["steps"].get("6", share([])), m["strong"]["rich"], m["strong"]["poor"], m["unknown"]
    return (
        f"**Of {clean['n'] + hard['n']} simulated machines without a fault {clean['k'] + hard['k']} were accused. Of faults six times as large as the\n"
        f"uncertainty with which the recording shows them {of(six)} were found; of the {rich['n'] + poor['n']} of this size and larger that were found\n"
        f"{rich['k'] + poor['k']} were named rightly. Faults that are not in the catalogue are the weak point: of {unknown['detected']['n']} large ones\n"
        f"{unknown['detected']['k']} were seen, and {unknown['falsely_named']['k']} of these got a wrong name.**\n"
    )


def in_short(result, followed):
    """One row for each question of the targets; `met` as there."""
    m = result["measures"]
    targets = {t["name"]: t for t in result["targets"]}

    def met(*names, called=()):
        hits = [bool(targets[n]["met"]) for n in names]
        only = [word for word, hit in zip(called, hits) if hit]
        return "yes" if all(hits) else " and ".join(only) or "no"

    curve, rich, poor, unknown = m["power"]["curve"] or {}, m["strong"]["rich"], m["strong"]["poor"], m["unknown"]
    unlike = unknown["unlike"]
    settled = {
        stage: [r[stage]["class"] == "truth alone" for r in followed["rows"] if r["before"]["class"] == "truth in the set"]
        for stage in ("wish", "random")
    }
    decoys = " / ".join(f"{sum(hits)} of {len(hits)}" for hits in settled.values())
    size = m["naming"]["rich"].get("6", {}).get("mean_size")
    alarms, sizes = ("false alarms, clean", "false alarms, hard"), ("detected at 50 %: SNR", "detected at 90 %: SNR")
    names = ("named rightly, rich, SNR >= 6", "named rightly, poor, SNR >= 6")
    strangers = ("unknown, detected at SNR >= 10", "unknown, called unexplained", "unknown, falsely named")
    figure = lambda value, digits=1: "-" if value is None else f"{value:.{digits}f}"
    return table(
        ["question", "answer", "target", "met"],
        [
            [
                "false alarms, clean / hard nulls",
                " / ".join(of(m["false_alarms"][k]) for k in ("clean", "hard")),
                "1 % / 2 %",
                met(*alarms, called=("clean", "hard")),
            ],
            ["s at which 50 % / 90 % are detected", f"{figure(curve.get('at50'))} / {figure(curve.get('at90'))}", "3.7 / 5.2", met(*sizes, called=("50 %", "90 %"))],
            ["right name, of those detected at s >= 6, rich / poor", f"{of(rich)} / {of(poor)}", "97 % / 90 %", met(*names, called=("rich", "poor"))],
            ["names in a set, s = 6, rich", figure(size, 2), "1.5", met("mean size of a set, rich, SNR 6")],
            ["right factor, of those detected at s >= 6", of(m["strong"]["located"]), "95 %", met("right factor, SNR >= 6, of the detected")],
            ["the set holds the truth", of(m["named_set_contains_truth"]), "93 to 98 %", met("95 % sets contain the truth")],
            ["the 95 % interval of a parameter holds the truth", of(m["parameters"]["coverage"]), "92 to 98 %", met("95 % intervals of parameters")],
            ["confident and wrong", of(m["confident_wrong"]), "1 %", met("confident and wrong")],
            [
                "stranger, s >= 10: seen / of these, unlike the catalogue, called unexplained / falsely named",
                f"{of(unknown['detected'])} / {of(unlike['unexplained'])} / {of(unlike['falsely_named'])}",
                "80 % / 90 % / 5 %",
                met(*strangers, called=("seen", "unexplained", "falsely named")),
            ],
            ["decoy settled by the proposed second measurement / by a random one", decoys, "-", "-"],
        ],
    )
