"""Effects that no catalogue names, for development and rehearsal: a diagnosis must say that something is
there and that it cannot name it."""

import numpy as np

from .base import Change, Effect, unit, vector
from .probe import directions

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def draw_saddle(scene, rng):
    return {"amplitude_um": 1.0}


def change_saddle(scene, p):
    """The table is twisted: height with the product of x and y."""
    u = scene.reading[:, 0] / scene.machine.travel["x"] * 2 - 1
    v = scene.reading[:, 1] / scene.machine.travel["y"] * 2 - 1
    return Change(tip=vector([0, 0, 1], p["amplitude_um"] * u * v))


def draw_lobes(scene, rng):
    return {"amplitude_um": 1.0, "phase": rng.uniform(0, 2 * np.pi)}


def change_lobes(scene, p):
    phi, beta = directions(scene)
    return Change(along=p["amplitude_um"] * np.cos(5 * phi + p["phase"]) * np.cos(beta) ** 2)


def draw_rocking(scene, rng):
    return {"amplitude_um": 1.0, "phase": rng.uniform(0, 2 * np.pi), "cycles": 6}


def change_rocking(scene, p):
    """The part turns to and fro about the vertical, six times in the run; amplitude at 500 mm."""
    angle = p["amplitude_um"] / 500 * np.sin(2 * np.pi * p["cycles"] * scene.time / scene.duration + p["phase"])
    return Change(tip=np.cross(np.outer(angle, [0, 0, 1]), scene.target - scene.target.mean(0)))


def draw_dent(scene, rng):
    ball = str(rng.choice(np.unique(scene.feature)))
    mine = [i for i, f in enumerate(scene.feature) if f == ball]
    return {
        "amplitude_um": -1.0,
        "ball": ball,
        "towards": scene.part_normal[rng.choice(mine)],
        "width_deg": rng.uniform(25, 45),
    }


def change_dent(scene, p):
    angle = np.degrees(np.arccos(np.clip(scene.part_normal @ np.asarray(p["towards"]), -1, 1)))
    here = np.array([f == p["ball"] for f in scene.feature])
    return Change(along=p["amplitude_um"] * here * np.exp(-0.5 * (angle / p["width_deg"]) ** 2))


def draw_loosening(scene, rng):
    return {"amplitude_um": 1.0, "directions": [unit(rng) for _ in scene.styli]}


def change_loosening(scene, p):
    """Each orientation wanders its own way, in proportion to time."""
    share = scene.time / scene.duration - 0.5
    return Change(tip=p["amplitude_um"] * np.array(p["directions"])[scene.sensor] * share[:, None])


def draw_dip(scene, rng):
    axis = int(rng.integers(2))
    return {
        "amplitude_um": 1.0,
        "direction": unit(rng),
        "axis": axis,
        "start_mm": float(np.quantile(scene.reading[:, axis], rng.uniform(0.15, 0.55))),
    }


def change_dip(scene, p):
    """An air bearing loses its film over a stretch of the guide, and recovers."""
    x = scene.reading[:, p["axis"]]
    width = 0.3 * np.ptp(x)
    return Change(tip=vector(p["direction"], p["amplitude_um"] * ((x > p["start_mm"]) & (x < p["start_mm"] + width))))


def draw_chirp(scene, rng):
    return {"amplitude_um": 1.0, "direction": unit(rng), "phase": rng.uniform(0, 2 * np.pi)}


def change_chirp(scene, p):
    u = scene.time / scene.duration
    return Change(tip=vector(p["direction"], p["amplitude_um"] * np.sin(2 * np.pi * (2 * u + 7 * u**2) + p["phase"])))


def draw_creep(scene, rng):
    return {"amplitude_um": 1.0, "directions": [unit(rng) for _ in scene.styli]}


def change_creep(scene, p):
    """After each indexing the joint settles with the logarithm of time."""
    first = np.array([scene.time[scene.visit == v].min() for v in scene.visit])
    return Change(
        tip=p["amplitude_um"] * np.array(p["directions"])[scene.sensor] * np.log1p((scene.time - first) / 3)[:, None]
    )


def draw_sawtooth(scene, rng):
    axis = int(rng.integers(2))
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "period_mm": rng.uniform(0.25, 0.4) * np.ptp(scene.reading[:, axis]),
        "phase": rng.uniform(),
    }


def change_sawtooth(scene, p):
    """Stick-slip of a cover: the force builds up along the travel and is released."""
    q = np.mod(scene.reading[:, p["axis"]] / p["period_mm"] + p["phase"], 1)
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * (q - 0.5)))


def draw_wedge(scene, rng):
    return {"amplitude_um": 1.0, "octant": rng.choice([-1.0, 1.0], 3), "direction": unit(rng)}


def change_wedge(scene, p):
    """Cubic in the distance from the middle, in one octant of the volume."""
    away = (scene.reading - scene.reading.mean(0)) / np.ptp(scene.reading, axis=0) * 2 * p["octant"]
    return Change(
        tip=vector(p["direction"], p["amplitude_um"] * np.sum(np.clip(away, 0, None) ** 3, 1) * (away > -0.1).all(1))
    )


def draw_telegraph(scene, rng):
    switches = np.sort(rng.uniform(0, scene.duration, 9))
    return {"amplitude_um": 1.0, "direction": unit(rng), "switches_s": switches}


def change_telegraph(scene, p):
    level = np.searchsorted(p["switches_s"], scene.time) % 2
    return Change(tip=vector(p["direction"], p["amplitude_um"] * (level - 0.5)))


unknown("saddle", draw_saddle, change_saddle, ["position", "feature", "setup"], "D")
unknown("five_lobes", draw_lobes, change_lobes, ["direction", "head", "sensor"], "ACD")
unknown("rocking", draw_rocking, change_rocking, ["time", "position"])
unknown("dent", draw_dent, change_dent, ["feature", "direction", "position"], "CD")
unknown("loosening", draw_loosening, change_loosening, ["head", "time", "sensor"], "D")
unknown("bearing_dip", draw_dip, change_dip, ["position", "feature"])
unknown("chirp", draw_chirp, change_chirp, ["time"])
unknown("creep", draw_creep, change_creep, ["head", "time", "sensor"], "D")
unknown("sawtooth", draw_sawtooth, change_sawtooth, ["position", "feature"])
unknown("wedge", draw_wedge, change_wedge, ["position", "feature"])
unknown("telegraph", draw_telegraph, change_telegraph, ["time"])
