#!/usr/bin/env python3
"""A second recording of the machine of a decoy, by the program's own wish. usage: follow.py DIR --abbe build/abbe

A decoy is an effect with a rival that looks the same in the first recording. `next_measurement` of the answer asks for
one change; the same machine, with the same errors, is measured again with it, and the program answers on both files. For
comparison it also gets a change drawn at random from the same menu. DIR/follow.json: {"rows": [{case, truth, wish,
before, wish, random}]}; each answer has a class: "truth alone", "truth in the set" or "other".

What the part and the styli keep, keep their errors: placements unless the part is moved or heated, qualifications unless a stylus
or an orientation is new. The clock goes on.
"""

import argparse
import dataclasses
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import cases
import designs
import files
import run
import seal
import world
from effects import CATALOGUE
from portable import np
from scene import Scene, clock, touches
from score import percent, table
from tallies import share

PAUSE = 600.0  # s between the recordings
MENU = {
    "repeat with probing speed ([\\d.]+) mm/s": "speed",
    "repeat with acceleration ([\\d.]+) mm/s2": "acceleration",
    "repeat with a stylus of ([\\d.]+) mm": "length",
    "repeat with a stylus ball of ([\\d.]+) mm": "ball",
    "repeat with the head turned by B \\+ ([\\d.]+) degrees": "head",
    "repeat with the stylus qualified (anew)": "qualified",
    "repeat with the part clamped (anew)": "clamped",
    "repeat with the part turned by ([\\d.]+) degrees about the vertical": "turned",
    "repeat with the part tilted by ([\\d.]+) degrees about X": "tilted_x",
    "repeat with the part tilted by ([\\d.]+) degrees about Y": "tilted_y",
    "repeat with the part raised by ([\\d.]+) mm": "raised",
    "repeat with the part lowered by ([\\d.]+) mm": "lowered",
    "repeat with part and scales at a temperature ([\\d.]+) K higher": "temperature",
    "repeat with ([\\d.]+) kg more on the table": "load",
    "repeat the whole sequence (once) more": "again",
    "repeat the whole sequence in reverse (order)": "reversed",
}
AT_RANDOM = {"acceleration": 130.0, "head": 60.0, "turned": 90.0, "tilted_x": 20.0, "tilted_y": 20.0, "raised": 200.0}
AT_RANDOM |= {"temperature": 2.0, "load": 200.0, "again": 0.0, "reversed": 0.0, "qualified": 0.0, "clamped": 0.0}
WITHOUT_SIZE = {"again", "reversed", "qualified", "clamped"}
STYLUS = {"length", "head", "ball"}
TURNS = {"turned": 2, "tilted_x": 0, "tilted_y": 1}  # about which axis
LIFTS = {"raised": 1, "lowered": -1}
PLACES_ANEW = TURNS.keys() | LIFTS.keys() | {"temperature", "clamped"}  # for hours a part does not stay put to micrometres


def understood(wish):
    """{what: how much} of a wish, which may ask for two changes at once; None when the generator cannot express it."""
    changes = {}
    for change in (wish or "").split(" and with "):
        change = change if change.startswith("repeat") else "repeat with " + change
        for pattern, what in MENU.items():
            if found := re.fullmatch(pattern, change):
                changes[what] = 0.0 if what in WITHOUT_SIZE else float(found.group(1))
                break
        else:
            return None
    return changes


def at_random(scene, besides, rng):
    """The changes of the menu in random order, without `besides`, each {what: how much}."""
    speed, length = np.median(scene.speed), np.median(scene.length)
    ball = 2 * np.median(scene.tip_radius)
    menu = {**AT_RANDOM, "speed": speed / 3 if speed > 5 else 3 * speed, "length": length / 3 if length > 60 else 2 * length}
    menu["ball"] = ball / 2 if ball > 3 else 2 * ball
    return [{str(what): float(menu[what])} for what in rng.permutation(sorted(menu)) if {what} != set(besides)]


def restyled(stylus, what, value):
    if what == "length":
        return dataclasses.replace(stylus, name=f"{stylus.name}L{value:g}", length=value)
    if what == "ball":
        thin = min(stylus.shaft, 0.75 * value)  # a shaft is thinner than its ball
        return dataclasses.replace(stylus, name=f"{stylus.name}D{value:g}", diameter=value, shaft=thin)
    a, b = stylus.head[0], (stylus.head[1] + value + 180) % 360 - 180
    return dataclasses.replace(stylus, name=f"{stylus.name}B{b:g}", head=(a, b))


def second_scene(first, changes, rng):
    """The scene of the second recording; None when the changes do not fit into the machine."""
    styli, turn, lift = first.styli, np.eye(3), np.zeros(3)
    for what, value in changes.items():
        if what in STYLUS:
            styli = [restyled(s, what, value) for s in styli]
        if what in TURNS:
            turn = designs.axis_rotation(TURNS[what], value) @ turn
        if what in LIFTS:
            lift = np.array([0, 0, LIFTS[what] * value / first.shrink])
    scene = Scene(first.machine, first.design, styli, [(turn @ r, turn @ at + lift) for r, at in first.placements])
    scene.first_styli = first.first_styli
    order = -1 if "reversed" in changes else 1
    motion = {what: value for what, value in changes.items() if what in ("speed", "acceleration")}
    for block in first.blocks[::order]:
        points = None if block.points is None else block.points[::order]
        scene.blocks.append(dataclasses.replace(block, normals=block.normals[::order] @ turn.T, points=points, **motion))
    touches(scene, first.shrink, rng)
    if not designs.fits(scene):
        return None
    clock(scene, rng)
    scene.middle = first.middle
    scene.time = scene.time + first.time[-1] + PAUSE
    scene.visit = scene.visit + first.visit.max()
    scene.run = scene.run + first.run.max()
    scene.setup = scene.setup + (100 if changes.keys() & PLACES_ANEW else 0)
    warmer = changes.get("temperature", 0.0)
    scene.temperature = {k: np.full(scene.size, v[0] + warmer) for k, v in first.temperature.items()}
    scene.logged = {k: np.full(scene.size, v[0] + warmer) for k, v in first.logged.items()}
    scene.load = first.load + changes.get("load", 0.0)
    scene.qualification = np.full(scene.size, 2 if changes.keys() & (STYLUS | {"qualified"}) else 1)
    return scene


def second_recording(stage, truth, changes, rng):
    """(machine.json, CSV) of the same machine with the same effect, measured again; None as above."""
    scene = second_scene(stage.scene, changes, rng)
    if scene is None:
        return None
    base = world.Baseline(scene, stage.geometry, rng, *stage.noise, before=stage.base)
    r = base.r + sum(base.signature(CATALOGUE[e["name"]], e["parameters"]) for e in truth["effects"])
    both = Scene(scene.machine, scene.design, list({s.name: s for s in stage.scene.styli + scene.styli}.values()), [])
    return files.machine_json(both, stage.calibration.scene if stage.known else None), files.recording_csv(scene, r)


def judged(said, truth):
    """What became of the truth in an answer."""
    sets = [e.get("members", []) for e in (said or {}).get("effects", [])]
    name = truth["effects"][0]["name"]
    held = [s for s in sets if name in s]
    kind = "other" if not held else "truth alone" if held[0] == [name] else "truth in the set"
    return {"class": kind, "verdict": (said or {}).get("verdict"), "members": sets[0] if sets else []}


def asked(abbe, case, extra):
    """The answer on the recording of a case and a second one."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "machine.json").write_text(extra[0])
        (folder / "second.csv").write_text(extra[1])
        known = []
        if (case / "calibration.csv").exists():
            known = ["--known", folder / "known.json"]
            learn = [abbe, "diagnose", case / "calibration.csv", "--machine", folder / "machine.json", "--model-out", folder / "known.json"]
            subprocess.run(learn, capture_output=True, check=True)
        words = [abbe, "diagnose", case / "recording.csv", folder / "second.csv", "--machine", folder / "machine.json", *known]
        done = subprocess.run([*words, "--format", "json"], capture_output=True, text=True)
        if done.returncode != 0:
            print(f"follow: case {case.name}: {done.stderr.strip()}", file=sys.stderr)
            return None
        return json.loads(done.stdout)


def row(root, abbe, secret, number, truth):
    """One decoy before and after; without a wish that can be done, the answer stays what it was."""
    said = json.loads((root / f"answers/{number}.json").read_text())["answer"]
    wished = understood(((said or {}).get("next_measurement") or [{}])[0].get("change"))
    out = {"case": number, "truth": truth["effects"][0]["name"], "asked": wished, "before": judged(said, truth)}
    spec = cases.Spec(truth["kind"], "", truth["snr"], truth["detail"])
    rng = seal.generator(secret, "follow", number)
    stage = cases.MAKERS[truth["kind"]](seal.generator(secret, "case", number), spec)[0]
    others = at_random(stage.scene, wished or {}, rng)
    for name, changes in (("wish", [wished] if wished else []), ("random", others)):
        possible = ((c, second_recording(stage, truth, c, rng)) for c in changes)
        change, extra = next(((c, files_) for c, files_ in possible if files_), (None, None))
        out[name] = {**judged(asked(abbe, root / "cases" / number, extra), truth), "change": change} if extra else out["before"]
    return out


def followed(root, abbe):
    """All decoys of a round that was answered by this program; kept in DIR/follow.json. Without a program: what was
    kept."""
    secret, kept = (root / "sealed/secret.txt").read_text().strip(), root / "follow.json"
    if kept.exists():
        return json.loads(kept.read_text())
    if abbe is None:
        return {"rows": []}
    run.frozen(str(abbe), root / "answers")
    decoys = [(n, t) for n, t in seal.verified(root).items() if t["detail"] == "decoy"]
    result = {"rows": [row(root, str(abbe), secret, n, t) for n, t in decoys]}
    kept.write_text(json.dumps(result, indent=1) + "\n")
    return json.loads(kept.read_text())


STAGES = {"before": "the first recording", "wish": "and a second as the program wished", "random": "and a second with a random change"}


def text(result):
    """Markdown: how many decoys a second recording resolves; the last column: of those that the first left open."""
    rows, lines = result["rows"], []
    if not rows:
        return "No decoy of this round was followed.\n"
    for stage, name in STAGES.items():
        alone = [r[stage]["class"] == "truth alone" for r in rows]
        held = [r[stage]["class"] != "other" for r in rows]
        left_open = [a for a, r in zip(alone, rows) if r["before"]["class"] == "truth in the set"]
        lines.append([name, len(rows), percent(share(alone)), percent(share(held)), f"{sum(left_open)} of {len(left_open)}"])
    return table(["answer on", "decoys", "truth alone", "truth in the set", "resolved, of those left open"], lines)


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("round", type=pathlib.Path)
    parser.add_argument("--abbe", type=pathlib.Path, required=True)
    given = parser.parse_args(argv)
    print(text(followed(given.round, given.abbe)))


if __name__ == "__main__":
    main()
