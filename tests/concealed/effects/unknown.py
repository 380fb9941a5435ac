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


unknown("saddle", draw_saddle, change_saddle, ["position", "feature", "setup"], "D")
unknown("five_lobes", draw_lobes, change_lobes, ["direction", "head", "sensor"], "ACD")
unknown("rocking", draw_rocking, change_rocking, ["time", "position"])
unknown("dent", draw_dent, change_dent, ["feature", "direction", "position"], "CD")
unknown("loosening", draw_loosening, change_loosening, ["head", "time", "sensor"], "D")
