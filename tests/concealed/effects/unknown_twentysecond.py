"""The strangers of the twenty-second final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change, unit
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def half_size(scene):
    return float(np.abs(scene.part_point[:, :2]).max())


def visits_of(scene):
    """(visit, stylus, time of its first touch) of every indexing, in order."""
    first = np.flatnonzero(np.diff(scene.visit, prepend=-1))
    return [(int(scene.visit[k]), int(scene.sensor[k]), float(scene.time[k])) for k in first]


def draw_rattling(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    loose = rng.permutation(len(names))[: int(rng.integers(len(names) // 3, 2 * len(names) // 3 + 1))]
    return {
        "amplitude_um": 1.0,
        "play": {names[k]: float(rng.uniform(0.5, 1)) for k in sorted(loose)},
        "friction": float(rng.uniform(0.2, 0.4)),
        "weight": float(rng.uniform(0.6, 1.6)),
    }


def change_rattling(scene, p):
    """Some balls have never been glued: they lie in sockets that are a little too wide. A touch that comes from
    the side with more than friction holds pushes the ball over to the far wall of its socket, where it stays
    lying; one from above presses it down, and meets it where an earlier touch has left it. When the part is
    placed anew every ball comes to rest in the middle of its socket. Amplitude is the play of the loosest to
    either side; weight is that of a ball, over the force of a touch."""
    lies, moved, before = {}, np.zeros(scene.size), 0
    for k, feature in enumerate(scene.feature):
        if scene.setup[k] != before:
            lies, before = {}, scene.setup[k]
        n = scene.part_normal[k]
        side = np.sqrt(n[0] ** 2 + n[1] ** 2)
        if side > p["friction"] * (p["weight"] + max(n[2], 0)):
            lies[feature] = -n[:2] / side
        if feature in p["play"] and feature in lies:
            moved[k] = p["play"][feature] * np.sum(n[:2] * lies[feature])
    return Change(along=p["amplitude_um"] * moved)


def draw_knocked(scene, rng):
    level = rng.uniform(0, 2 * np.pi)
    to = np.array([np.cos(level), np.sin(level), rng.uniform(-0.3, 0.3)])
    lasts = [int(v) for v in rng.integers(4, 7, len(scene.styli))]
    used = [int(rng.integers(v)) for v in lasts]
    times = [when for _, _, when in visits_of(scene)]
    return {
        "amplitude_um": 1.0,
        "knocked_at_s": float(times[int(rng.uniform(0.25, 0.6) * len(times))] - 5),
        "to": [float(v) for v in to / np.linalg.norm(to)],
        "lasts": lasts,
        "used": used,
    }


def change_knocked(scene, p):
    """The reference sphere stands at the edge of the table, and somebody knocks against it in passing. Each
    stylus is qualified anew on it after a few uses, one sooner than the other: those whose turn has come since
    are all off by the way that the sphere has moved, those that still live on their old qualification are
    right. For a while both kinds measure the same part by turns; in the end all styli are off alike, and nobody
    notices any more. Amplitude is the way of the sphere."""
    used, off, shifted = list(p["used"]), set(), np.zeros(scene.size)
    for visit, stylus, when in visits_of(scene):
        k = min(stylus, len(used) - 1)
        if used[k] >= p["lasts"][k]:
            used[k] = 0
            if when > p["knocked_at_s"]:
                off.add(stylus)
        used[k] += 1
        if stylus in off:
            shifted[scene.visit == visit] = 1.0
    return Change(tip=p["amplitude_um"] * np.outer(shifted, p["to"]))


def draw_foot(scene, rng):
    turn = rng.uniform(0, 2 * np.pi) + np.array([0, 2.1, 4.2]) + rng.uniform(-0.25, 0.25, 3)
    feet = rng.uniform(0.7, 1.0) * half_size(scene) * np.column_stack([np.cos(turn), np.sin(turn)])
    warm = scene.temperature["part"]
    return {
        "amplitude_um": 1.0,
        "feet_mm": [[float(v) for v in foot] for foot in feet],
        "height_mm": float(centres(scene)[:, 2].min() - rng.uniform(0.2, 0.5) * half_size(scene)),
        "level_at_C": float(warm.min() + rng.uniform(0, 1) * np.ptp(warm)),
    }


def change_foot(scene, p):
    """The part has three feet, and one of them has been lost; in its place there is a stud of nylon, which grows
    ten times as much as the steel of the others. With every kelvin this corner of the part rises, the whole part
    turns about the line through the two good feet, and all that stands high on it goes over to the other side.
    Nothing is bent, and a part that is cold again lies as before. Amplitude at the stud, for 1 K."""
    stud, one, other = np.asarray(p["feet_mm"])
    line = np.append(other - one, 0.0) / np.linalg.norm(other - one)
    away = centres(scene) - np.append(one, p["height_mm"])
    lever = np.cross(line, np.append(stud - one, 0.0))[2]
    rises = np.cross(line, away) / lever * (scene.temperature["part"] - p["level_at_C"])[:, None]
    return Change(along=p["amplitude_um"] * np.sum(rises * scene.part_normal, 1))


def draw_pump(scene, rng):
    i = int(rng.integers(2))
    shots, now = [], float(rng.uniform(-300, 200))
    every = rng.uniform(300, 800)
    while now < scene.duration:
        shots.append(now)
        now += float(every * rng.uniform(0.95, 1.05))
    aside = 0.5 * unit(rng)
    return {
        "amplitude_um": 1.0,
        "axis": "xy"[i],
        "shots_s": shots,
        "squeezed_mm": float(rng.uniform(1.5, 5) * np.ptp(scene.reading[:, i])),
        "seeps_s": float(rng.uniform(400, 1200)),
        "lifts": [float(aside[0]), float(aside[1]), 1.0],
    }


def change_pump(scene, p):
    """The guide of one axis is lubricated by a pump, which gives it a shot of oil from time to time, whether it
    needs it or not. At once the carriage floats higher on the film, and somewhat to one side, for the pads do not
    get the same; and it comes back as it wipes the oil out to both ends, on every millimetre of its way, and a
    little by itself when it stands. Amplitude of the rise after one fresh shot."""
    i = "xyz".index(p["axis"])
    way = np.cumsum(np.abs(np.diff(scene.reading[:, i], prepend=scene.reading[0, i])))
    film = np.zeros(scene.size)
    for shot in p["shots_s"]:
        later = scene.time >= shot
        gone = np.maximum(way - np.interp(shot, scene.time, way), 0) / p["squeezed_mm"]
        film += later * np.exp(-gone - np.maximum(scene.time - shot, 0) / p["seeps_s"])
    return Change(tip=p["amplitude_um"] * np.outer(film, p["lifts"]))


def draw_gauge(scene, rng):
    return {
        "amplitude_um": 1.0,
        "stiff": float(rng.uniform(0.05, 0.25)),
        "mapped_at_mm_per_s": float(rng.uniform(3, 6)),
    }


def change_gauge(scene, p):
    """So that it does not drift, the probe takes its strain gauges back to nought all the time, slowly. When a
    touch comes slowly, and the long stylus gives way to it from the side so that the strain rises slowly as well,
    a part of the strain has been taken back before the threshold is reached, and the tip must go farther: with
    one over the speed, and with the square of how easily the stylus bends. The map of the tip has taken what there
    was at the speed of its qualification. Amplitude of the softest stylus, from 2 mm/s to very fast."""
    across = 1 - np.sum(scene.normal * scene.shank, 1) ** 2
    bends = scene.length**3 / (scene.shaft**4 * scene.young)
    bends = (across + p["stiff"]) * bends / bends.max()
    late = 2 / scene.speed - 2 / p["mapped_at_mm_per_s"]
    return Change(along=-p["amplitude_um"] * bends**2 * late)


def draw_map(scene, rng):
    size = np.ptp(scene.target, axis=0)
    waves = rng.normal(size=(3, 3, 2)) * np.array([1.0, 0.6])
    waves /= np.sqrt(np.sum(waves**2) / 2)
    return {
        "amplitude_um": 1.0,
        "lengths_mm": [float(v) for v in rng.uniform(0.7, 1.4, 3) * size.max()],
        "waves": waves.tolist(),
        "phases": rng.uniform(0, 2 * np.pi, (3, 3, 2)).tolist(),
    }


def change_map(scene, p):
    """The correction of the guides is not done by the controller any more but by the software, after it has
    turned the points into the coordinates of the part: it looks up the table with these, as if the part lay at
    the home of the machine and straight. Each ball gets the same correction in whatever placement, along the
    axes of the machine, instead of that of the place where it is. Amplitude is the root of the mean square of
    the table."""
    waves, phases = np.asarray(p["waves"]), np.asarray(p["phases"])

    def table(place):
        out = np.zeros((scene.size, 3))
        for k in range(3):
            for m in range(2):
                angle = 2 * np.pi * (m + 1) * place[:, k] / p["lengths_mm"][k]
                out += waves[k, :, m] * np.cos(angle[:, None] + phases[k, :, m])
        return out

    return Change(tip=p["amplitude_um"] * (table(scene.reading) - table(scene.part_point)))


def draw_sling(scene, rng):
    setups = np.unique(scene.setup)
    turn, out = rng.uniform(0, 2 * np.pi), rng.uniform(0.1, 0.6) * half_size(scene)
    sways = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "setup": int(rng.choice(setups)),
        "eye_mm": [float(np.cos(turn) * out), float(np.sin(turn) * out)],
        "wide_mm": float(rng.uniform(0.3, 0.6) * half_size(scene)),
        "sways": [float(np.cos(sways)), float(np.sin(sways))],
        "period_s": float(rng.uniform(3.0, 7.0)),
        "phase": float(rng.uniform(0, 2 * np.pi)),
        "share": float(rng.uniform(0.3, 0.7)),
    }


def change_sling(scene, p):
    """In one placement the operator has forgotten to take off the sling. The hook of the crane still draws at the
    eye bolt, and lifts the plate round about it; and as the hook swings to and fro on its long rope, as a
    pendulum does, it draws now more and now less, and takes the part along in its feet. Amplitude of the lift at
    the eye bolt."""
    here = scene.setup == p["setup"]
    way = centres(scene)[:, :2] - np.asarray(p["eye_mm"])
    dome = 1 / (1 + np.sum(way**2, 1) / p["wide_mm"] ** 2)
    slope = -2 * way * (dome**2 / p["wide_mm"] ** 2)[:, None]
    swing = np.sin(2 * np.pi * scene.time / p["period_s"] + p["phase"])
    lift = np.column_stack([-slope * centres(scene)[:, 2:], dome])
    lift *= (1 + 0.5 * p["share"] * swing)[:, None]
    pulled = np.outer(p["share"] * swing, np.append(p["sways"], 0.0))
    moved = np.sum(scene.part_normal * lift, 1) + np.sum(scene.normal * pulled, 1)
    return Change(along=p["amplitude_um"] * here * moved)


def draw_carriage(scene, rng):
    return {
        "amplitude_um": 1.0,
        "tips_at": float(rng.uniform(0.1, 0.35)),
        "beam_mm": float(scene.target[:, 2].max() + rng.uniform(0.3, 1.0) * np.ptp(scene.target[:, 2])),
        "first": int(rng.choice([-1, 1])),
    }


def change_carriage(scene, p):
    """The carriage on the beam has lost the preload of its bearings, and has play. The weight of a lying head
    tips it over to the side to which the stylus points across the beam, and there it stays, also when the stylus
    stands upright or lies along the beam, until one on the other side tips it back. Amplitude at the lowest
    touch, to either side."""
    i = "xyz".index(scene.machine.chain[0])
    weighs = scene.arm[:, i] / scene.length.max()
    state, leans = float(p["first"]), np.zeros(scene.size)
    for k in range(scene.size):
        if abs(weighs[k]) > p["tips_at"]:
            state = float(np.sign(weighs[k]))
        leans[k] = state
    below = p["beam_mm"] - scene.target[:, 2]
    moved = np.zeros((scene.size, 3))
    moved[:, i] = below / below.max()
    moved[:, 2] = scene.tip[:, i] / below.max()
    return Change(tip=p["amplitude_um"] * moved * leans[:, None])


unknown("rattling_balls", draw_rattling, change_rattling, ["feature", "direction", "time"])
unknown("knocked_reference", draw_knocked, change_knocked, ["time", "sensor", "head"], "D")
unknown("nylon_stud", draw_foot, change_foot, ["temperature", "feature", "setup"], "D")
unknown("oiling_pump", draw_pump, change_pump, ["time", "position"])
unknown("forgetful_zero", draw_gauge, change_gauge, ["speed", "direction", "sensor", "head"], "D")
unknown("misplaced_lookup", draw_map, change_map, ["feature", "setup", "position"], "D")
unknown("forgotten_sling", draw_sling, change_sling, ["setup", "feature", "time", "position"])
unknown("lolling_carriage", draw_carriage, change_carriage, ["head", "position", "time", "sensor"], "D")
