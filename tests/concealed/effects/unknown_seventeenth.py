"""The strangers of the seventeenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, unit, vector
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - 12.5 * scene.part_normal


def draw_drum(scene, rng):
    return {
        "amplitude_um": 1.0,
        "period_s": float(rng.uniform(31, 67)),
        "batch_s": float(scene.duration * rng.uniform(0.12, 0.3)),
        "filled": float(rng.uniform(0.5, 0.75)),
        "begun": float(rng.uniform(0, 1)),
        "phase": float(rng.uniform(0, 2 * np.pi)),
        "across": float(rng.uniform(0.5, 1) * rng.choice([-1, 1])),
    }


def change_drum(scene, p):
    """In the next hall a drum turns slowly round an upright axis, with all of its load on one side. The floor leans
    after the load, and the slender machine follows: the tip goes round on an ellipse, once in less than a minute or
    somewhat more. Between two batches the drum is empty and stands. Amplitude is the longer half axis of the
    ellipse."""
    angle = 2 * np.pi * scene.time / p["period_s"] + p["phase"]
    on = np.mod(scene.time / p["batch_s"] + p["begun"], 1) < p["filled"]
    path = np.column_stack([np.cos(angle), p["across"] * np.sin(angle), np.zeros(scene.size)])
    return Change(tip=p["amplitude_um"] * on[:, None] * path)


def draw_stations(scene, rng):
    angle = rng.uniform(np.radians(25), np.radians(65)) + rng.integers(4) * np.pi / 2
    return {
        "amplitude_um": 1.0,
        "border": [float(np.cos(angle)), float(np.sin(angle)), float(rng.uniform(-0.4, 0.4))],
        "shift": unit(rng).tolist(),
        "turn": unit(rng).tolist(),
        "half_size_mm": float(np.abs(scene.target - scene.middle).max()),
    }


def change_stations(scene, p):
    """The errors of the machine were mapped with a laser tracker from two places, near opposite corners of the table.
    Each point takes its correction from the nearer place. At the second one the tracker was not quite where it was
    believed to be: beyond the plane half way between both, which lies obliquely, all is shifted and turned. Amplitude
    of the shift, and of what the turn adds at half the size of the part."""
    away = (scene.target - scene.middle) / p["half_size_mm"]
    beyond = away @ np.asarray(p["border"]) > 0
    moved = np.asarray(p["shift"]) + np.cross(np.asarray(p["turn"]), away)
    return Change(tip=p["amplitude_um"] * beyond[:, None] * moved)


def draw_crack(scene, rng):
    half = float(np.abs(centres(scene)[:, :2]).max())
    return {
        "amplitude_um": float(rng.choice([-1.0, 1.0])),
        "end_mm": [float(v) for v in half * rng.uniform(-0.4, 0.4, 2)],
        "angle": float(rng.uniform(0, 2 * np.pi)),
        "t0_s": float(scene.duration * rng.uniform(0.1, 0.35)),
        "t1_s": float(scene.duration),
        "half_size_mm": half,
    }


def change_crack(scene, p):
    """The plate of the part has a crack that runs from its edge to somewhere near the middle, and it opens in the
    course of the run, slowly at first: the balls on one side of the crack turn in the plane about its end, away from
    the other ones, which stay as they are in the certificate. Amplitude at half the size of the part, when the run
    ends."""
    away = centres(scene)[:, :2] - np.asarray(p["end_mm"])
    piece = away @ np.array([np.cos(p["angle"]), np.sin(p["angle"])]) > 0
    opened = np.clip((scene.time - p["t0_s"]) / (p["t1_s"] - p["t0_s"]), 0, 1.5) ** 2
    aside = np.column_stack([-away[:, 1], away[:, 0], np.zeros(scene.size)]) / p["half_size_mm"]
    return Change(along=p["amplitude_um"] * piece * opened * np.sum(aside * scene.part_normal, 1))


def draw_ram(scene, rng):
    return {"amplitude_um": 1.0, "at_home": float(rng.uniform(0.2, 0.6))}


def change_ram(scene, p):
    """The air cylinder that carries the weight of the ram leaks. The ram goes down faster than the controller commands,
    and up more slowly, all the more the farther it is out, while the delay of the probe is taken off for the commanded
    speed: touched from above and from below alike the tip is read too low. Level touches are right. Amplitude straight
    down or up at 8 mm/s, with the ram right out."""
    out = np.abs(scene.reading[:, 2]) / scene.machine.travel["z"]
    weight = p["at_home"] + (1 - p["at_home"]) * out
    low = scene.speed / 8 * np.abs(scene.travel[:, 2]) * weight
    return Change(tip=vector(np.array([0, 0, -1.0]), p["amplitude_um"] * low))


def draw_legs(scene, rng):
    return {"amplitude_um": float(rng.choice([-1.0, 1.0])), "turned": float(rng.uniform(-0.5, 0.5))}


def change_legs(scene, p):
    """One leg of the bridge has been replaced by one of another metal: with every kelvin one end of the beam rises
    above the other, and as the new leg is also held at another place the beam turns a little about the vertical. All
    that hangs on it turns with it, as one rigid body. The styli are qualified anew after every pause, in the middle of
    the table, where all is right. Amplitude at the end of the beam, for 1 K."""
    first, second = (scene.machine.chain[k] for k in (0, 1))
    about = np.eye(3)["xyz".index(first)] + p["turned"] * np.array([0, 0, 1.0])
    lever = (scene.target - scene.middle) / (scene.machine.travel[second] / 2)
    warmer = scene.temperature["y"] - 20
    return Change(tip=p["amplitude_um"] * warmer[:, None] * np.cross(about, lever))


def draw_departure(scene, rng):
    return {"amplitude_um": 1.0}


def change_departure(scene, p):
    """The controller is impatient: when the last touch of a ball has triggered it sets out for the next ball at once,
    and reads the scales a moment too late. This touch is off towards the next ball, in proportion to the acceleration;
    after all other touches the machine backs off in good order. Before a new placement it waits, too. Amplitude at
    600 mm/s^2."""
    last = np.flatnonzero(np.diff(scene.block) != 0)
    last = last[scene.setup[last] == scene.setup[last + 1]]
    way = scene.start[last + 1] - scene.reading[last]
    tip = np.zeros((scene.size, 3))
    tip[last] = way / np.linalg.norm(way, axis=1, keepdims=True) * scene.acceleration[last, None] / 600
    return Change(tip=p["amplitude_um"] * tip)


def draw_frames(scene, rng):
    drift = rng.normal(size=(len(scene.styli), 3))
    drift -= drift.mean(0)
    return {"amplitude_um": 1.0, "moved": (drift / np.sqrt(np.mean(drift**2))).tolist()}


def change_frames(scene, p):
    """A routine checks the styli now and then, and hands on by what small vector each tip has moved since it was
    qualified. The software adds these vectors in the frame of the part, where they belong in that of the machine: as
    long as the part lies straight nothing is wrong, but where it is turned or tilted each vector points elsewhere.
    Amplitude is the root of the mean square of the coordinates of these vectors."""
    moved = np.asarray(p["moved"])[scene.sensor % len(p["moved"])]
    wrong = np.einsum("nij,nj->ni", scene.turn, moved) - moved
    return Change(tip=p["amplitude_um"] * wrong)


def draw_width(scene, rng):
    names = sorted(set(scene.feature))
    return {
        "amplitude_um": 1.0,
        "axes": {n: unit(rng).tolist() for n in names},
        "phases": {n: float(rng.uniform(0, 2 * np.pi)) for n in names},
        "lobes": {n: int(rng.choice([3, 5])) for n in names},
    }


def change_width(scene, p):
    """The balls were ground without centres, and have three or five lobes around an axis that lies in each as it was
    screwed on. Whoever takes a micrometer finds the same diameter everywhere, as a hill is always opposite a hollow:
    nobody has noticed. Towards the two poles the lobes die away. Amplitude of the lobes at the equator of the ball."""
    out = np.zeros(scene.size)
    for name in sorted(set(scene.feature)):
        if name not in p["axes"]:
            continue
        mine = np.array([f == name for f in scene.feature])
        axis = np.asarray(p["axes"][name])
        e1 = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
        e1 /= np.linalg.norm(e1)
        u, v = scene.part_normal[mine] @ e1, scene.part_normal[mine] @ np.cross(axis, e1)
        m = p["lobes"][name]
        out[mine] = np.hypot(u, v) ** m * np.cos(m * np.arctan2(v, u) + p["phases"][name])
    return Change(along=p["amplitude_um"] * out)


unknown("lopsided_drum", draw_drum, change_drum, ["time"])
unknown("two_stations", draw_stations, change_stations, ["position", "feature"])
unknown("cracked_plate", draw_crack, change_crack, ["time", "feature", "position"])
unknown("sinking_ram", draw_ram, change_ram, ["speed", "direction"], "D")
unknown("unequal_legs", draw_legs, change_legs, ["temperature", "position", "feature", "setup"], "D")
unknown("early_departure", draw_departure, change_departure, ["time", "feature"])
unknown("confused_frames", draw_frames, change_frames, ["setup", "sensor", "head"], "D")
unknown("constant_width", draw_width, change_width, ["feature", "direction"])
