"""Unknown effects of the final round only: none of them resembles those of the development."""

import numpy as np

from .base import Change, Effect, unit, vector

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


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


unknown("bearing_dip", draw_dip, change_dip, ["position", "feature"])
unknown("chirp", draw_chirp, change_chirp, ["time"])
unknown("creep", draw_creep, change_creep, ["head", "time", "sensor"], "D")
unknown("sawtooth", draw_sawtooth, change_sawtooth, ["position", "feature"])
unknown("wedge", draw_wedge, change_wedge, ["position", "feature"])
unknown("telegraph", draw_telegraph, change_telegraph, ["time"])
