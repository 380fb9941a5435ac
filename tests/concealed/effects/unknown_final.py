"""Unknown effects of the final round only: none of them resembles those of the development."""

import numpy as np

from .base import Change, Effect, unit, vector

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def draw_leaves(scene, rng):
    soft = rng.choice(np.unique(scene.feature), 3, replace=False)
    return {"amplitude_um": 1.0, "soft_deg": {str(f): rng.uniform(0, 180) for f in soft}}


def change_leaves(scene, p):
    """Three balls stand on upright leaves, each turned its own way: a push along the soft side of a leaf bends it."""
    yielding = np.zeros(scene.size)
    for ball, deg in p["soft_deg"].items():
        push = scene.part_normal @ [np.cos(np.radians(deg)), np.sin(np.radians(deg)), 0]
        yielding += push**2 * [f == ball for f in scene.feature]
    return Change(along=-p["amplitude_um"] * yielding)


def draw_magnet(scene, rng):
    size, aside = np.ptp(scene.target, axis=0), rng.choice([-1.0, 1.0], 3) * rng.uniform(0.1, 0.35, 3)
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "place_mm": scene.target.min(0) + (0.5 + aside) * size,
        "reach_mm": rng.uniform(0.18, 0.28) * float(size[:2].mean()),
    }


def change_magnet(scene, p):
    """A magnet of the fixture draws the steel stylus towards it, or pushes it off: most at some distance, nothing far
    away."""
    away = (scene.target - p["place_mm"]) / p["reach_mm"]
    return Change(tip=-p["amplitude_um"] * away * np.exp(0.5 - 0.5 * np.sum(away**2, 1))[:, None])


def draw_sunbeam(scene, rng):
    axis = int(rng.integers(2))
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "backwards": bool(rng.integers(2)),
        "width_mm": rng.uniform(0.15, 0.25) * float(np.ptp(scene.reading[:, axis])),
        "late": rng.uniform(-0.15, 0.15),
    }


def change_sunbeam(scene, p):
    """A beam of sunlight wanders along a guide in the course of the run: the guide bulges where it falls, and there
    the carriage is lifted."""
    x = scene.reading[:, p["axis"]]
    share = scene.time / scene.duration - p["late"]
    beam = x.min() + np.ptp(x) * (1 - share if p["backwards"] else share)
    return Change(tip=vector([0, 0, 1], p["amplitude_um"] * np.exp(-0.5 * ((x - beam) / p["width_mm"]) ** 2)))


def draw_overhang(scene, rng):
    return {"amplitude_um": 1.0, "qualified_at": rng.uniform(0.4, 0.6)}


def change_overhang(scene, p):
    """The weight of a lying stylus bends the ram to the other side, the more the further the ram is out. At the height
    of the reference sphere the qualification has taken it."""
    out = np.abs(scene.reading[:, 2])
    out = out / out.max()
    level = np.quantile(out, p["qualified_at"])
    side = scene.arm * [1, 1, 0] / scene.length.max()
    return Change(tip=-p["amplitude_um"] * side * (out**2 - level**2)[:, None])


def draw_bellows(scene, rng):
    axis = int(rng.integers(2))
    return {"amplitude_um": 1.0, "axis": axis, "end": rng.choice([-1.0, 1.0]), "direction": unit(rng)}


def change_bellows(scene, p):
    """The air in a bellows escapes too slowly when the machine is fast: it pushes the carriage away near the end where
    the bellows is folded."""
    x = scene.reading[:, p["axis"]]
    folded = np.exp(-3 * (0.5 - p["end"] * ((x - x.min()) / np.ptp(x) - 0.5)))
    return Change(tip=vector(p["direction"], p["amplitude_um"] * folded * (scene.speed / scene.speed.max()) ** 2))


def draw_glue(scene, rng):
    ball = str(rng.choice(np.unique(scene.feature)))
    used = scene.time[[f == ball for f in scene.feature]]
    return {
        "amplitude_um": 1.0,
        "ball": ball,
        "direction": unit(rng),
        "half_life_s": rng.uniform(0.15, 0.4) * float(np.ptp(used)),
        "knocked_s": float(np.quantile(used, rng.uniform(0.15, 0.6))) + 0.5,
    }


def change_glue(scene, p):
    """A ball is knocked aside in its soft glue and creeps back to its place."""
    here = np.array([f == p["ball"] for f in scene.feature])
    since = scene.time - p["knocked_s"]
    left = here * (since >= 0) * 0.5 ** (np.maximum(since, 0) / p["half_life_s"])
    return Change(along=p["amplitude_um"] * left * (scene.part_normal @ np.asarray(p["direction"])))


unknown("leaves", draw_leaves, change_leaves, ["feature", "direction", "position"])
unknown("magnet", draw_magnet, change_magnet, ["position", "feature"])
unknown("sunbeam", draw_sunbeam, change_sunbeam, ["time", "position"])
unknown("overhang", draw_overhang, change_overhang, ["head", "sensor", "position", "feature"], "D")
unknown("bellows", draw_bellows, change_bellows, ["speed", "position", "feature"], "D")
unknown("glue", draw_glue, change_glue, ["feature", "time", "position"])
