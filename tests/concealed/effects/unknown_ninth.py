"""The strangers of the ninth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, unit, vector
from .probe import directions
from .unknown import unknown


def draw_chip(scene, rng):
    often = [k for k in range(len(scene.styli)) if np.sum(scene.sensor == k) >= 15]
    turn, sinks = rng.uniform(0, 2 * np.pi), rng.uniform(0.4, 0.8)
    aside = np.array([np.cos(turn), np.sin(turn), 0.0])
    return {
        "amplitude_um": 1.0,
        "sensor": int(rng.choice(often)),
        "aside": aside,
        "moves": np.sqrt(1 - sinks**2) * aside + [0, 0, sinks],
        "held": rng.uniform(0.15, 0.4),
    }


def change_chip(scene, p):
    """A chip lies in the serration of the head at one orientation, and the wrist rocks on it. A touch from one side
    tips it over: it leans aside and is pressed in, until a touch from the other side or the next indexing brings it
    back. Amplitude between the two rests."""
    push = np.sum(scene.normal * (scene.head @ np.asarray(p["aside"])), 1)
    visit, over, tipped = None, False, np.zeros(scene.size)
    for k in np.flatnonzero(scene.sensor == p["sensor"]):
        over = push[k] > 0 if abs(push[k]) > p["held"] else over and scene.visit[k] == visit
        visit, tipped[k] = scene.visit[k], over
    return Change(tip=-p["amplitude_um"] * tipped[:, None] * (scene.head @ np.asarray(p["moves"])))


def draw_beating(scene, rng):
    return {
        "amplitude_um": 1.0,
        "direction": unit(rng),
        "period_s": rng.uniform(60, 240),
        "phase": rng.uniform(0, np.pi),
    }


def change_beating(scene, p):
    """Two compressors shake the machine, and their vibrations beat. Where they add up, the tip swings against the
    surface and trips early, on either side. The qualification has taken the mean. Amplitude between silence and the
    strongest, along the vibration."""
    swell = np.abs(np.cos(np.pi * scene.time / p["period_s"] + p["phase"]))
    return Change(along=p["amplitude_um"] * (swell - swell.mean()) * np.abs(scene.normal @ np.asarray(p["direction"])))


def draw_shadow(scene, rng):
    size, middle = np.ptp(scene.target, axis=0), (scene.target.min(0) + scene.target.max(0)) / 2
    corner = rng.choice([-1.0, 1.0], 2) * rng.uniform(0.7, 1.1, 2)
    return {
        "amplitude_um": 1.0,
        "receiver_mm": middle + np.append(corner * size[:2], rng.uniform(0.2, 0.6) * size[0]),
        "lamp": rng.uniform(0, 2 * np.pi),
        "shadowed": rng.uniform(0.25, 0.4),
    }


def change_shadow(scene, p):
    """An optical probe sends its signal from a lamp on its side. Where this is turned away from the receiver, and far
    from it, the signal is weak and detected late, and the machine goes on meanwhile. Amplitude in the dark, at
    8 mm/s."""
    sight = np.asarray(p["receiver_mm"]) - (scene.target - scene.arm)
    far = np.linalg.norm(sight, axis=1)
    facing = np.sum(sight * (scene.head @ [np.cos(p["lamp"]), np.sin(p["lamp"]), 0.0]), 1) / far
    signal = (1.05 + facing) / far**2
    weak = np.clip(1 - signal / np.quantile(signal, p["shadowed"]), 0, 1)
    return Change(tip=scene.travel * (p["amplitude_um"] * weak * scene.speed / 8)[:, None])


def draw_wheel(scene, rng):
    axis, turn, around = int(rng.integers(2)), rng.uniform(0, 2 * np.pi), rng.uniform(55, 110)
    way = float(np.abs(np.diff(scene.reading[:, axis])).sum())
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "direction": np.roll([0.0, np.cos(turn), np.sin(turn)], axis),
        "circumference_mm": around,
        "slip": rng.choice([-1.0, 1.0]) * rng.uniform(1.5, 4) * around / way,
        "phase": rng.uniform(0, 2 * np.pi),
    }


def change_wheel(scene, p):
    """The friction wheel that drives an axis is out of true: in every turn it pushes the carriage aside and back. It
    slips on its bar in proportion to the way, so that the wave wanders along the guide in the course of the run."""
    x = scene.reading[:, p["axis"]]
    way = np.cumsum(np.abs(np.diff(x, prepend=x[0])))
    turned = 2 * np.pi * (x + p["slip"] * way) / p["circumference_mm"] + p["phase"]
    return Change(tip=vector(p["direction"], p["amplitude_um"] * np.sin(turned)))


def draw_misread(scene, rng):
    waves = rng.normal(size=(3, 2))
    return {"amplitude_um": 1.0, "axis": int(rng.integers(2)), "waves": waves / np.sqrt(np.sum(waves**2) / 2)}


def change_misread(scene, p):
    """The software reads the correction of a scale at the place of the tip, not of the carriage: a stylus that lies
    along this axis gets the correction of another place, by its length. Amplitude of the correction where its waves
    add up."""
    i = p["axis"]
    x, span = scene.reading[:, i], np.ptp(scene.reading[:, i])

    def correction(place):
        q = np.outer(2 * np.pi * (place - x.min()) / span, np.arange(1, 4))
        return np.sum(np.asarray(p["waves"])[:, 0] * np.sin(q) + np.asarray(p["waves"])[:, 1] * np.cos(q), 1)

    error = correction(x + scene.arm[:, i]) - correction(x)
    return Change(tip=vector(np.eye(3)[i], p["amplitude_um"] * error))


def draw_braking(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "spring": rng.uniform(0, np.pi)}


def change_braking(scene, p):
    """A measuring probe is read when the machine has braked, and takes its own deflection off. One of its springs has
    a wrong gain: the point is off by a share of the braking distance. The tip radius has taken the mean. Amplitude
    along this spring, from no distance to the longest."""
    phi, beta = directions(scene)
    brake = scene.speed**2 / scene.acceleration
    share = (np.cos(phi - p["spring"]) * np.cos(beta)) ** 2
    return Change(along=p["amplitude_um"] * share * (brake - brake.mean()) / brake.max())


def draw_gap(scene, rng):
    axis = int(rng.integers(2))
    warm = scene.temperature["xy"[axis]]
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "axis": axis,
        "aside": int(rng.choice([k for k in range(3) if k != axis])),
        "set_at_C": float((warm.min() + warm.max()) / 2 + rng.uniform(-0.4, 0.4)),
        "held": rng.uniform(0.05, 0.2),
    }


def change_gap(scene, p):
    """A light carriage grips its rail, and its air gaps open in the heat. The drive pulls a little obliquely and
    presses it to one side in one sense, to the other side in the other. The controller takes this off as it was on the
    day it was set. Amplitude to either side, for 1 K."""
    warmer = scene.temperature["xy"[p["axis"]]] - p["set_at_C"]
    sense = np.clip(scene.travel[:, p["axis"]] / p["held"], -1, 1)
    return Change(tip=vector(np.eye(3)[p["aside"]], p["amplitude_um"] * warmer * sense))


def draw_vice(scene, rng):
    return {
        "amplitude_um": 1.0,
        "placement": int(rng.choice(np.unique(scene.setup))),
        "across": int(rng.integers(2)),
        "jaws_at": rng.uniform(-0.8, 0.8),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_vice(scene, p):
    """In one placement the part is held in a narrow vice: between the jaws it is shorter, beside them it is not.
    Amplitude at a jaw."""
    i = p["across"]
    u, v = scene.part_point[:, i] / p["half_size_mm"], scene.part_point[:, 1 - i] / p["half_size_mm"]
    held = (scene.setup == p["placement"]) * np.exp(-0.5 * ((v - p["jaws_at"]) / 0.4) ** 2)
    return Change(along=-p["amplitude_um"] * held * u * scene.part_normal[:, i])


unknown("chipped_serration", draw_chip, change_chip, ["head", "sensor", "direction", "time"])
unknown("beating_compressors", draw_beating, change_beating, ["time", "direction"])
unknown("shadowed_lamp", draw_shadow, change_shadow, ["head", "sensor", "position", "feature", "speed"])
unknown("slipping_wheel", draw_wheel, change_wheel, ["position", "time", "feature"])
unknown("misread_table", draw_misread, change_misread, ["head", "sensor", "position", "feature"])
unknown(
    "braking_distance", draw_braking, change_braking, ["speed", "acceleration", "direction", "head", "sensor"], "D"
)
unknown("opening_gap", draw_gap, change_gap, ["temperature", "direction"], "D")
unknown("narrow_vice", draw_vice, change_vice, ["setup", "feature", "position"], "D")
