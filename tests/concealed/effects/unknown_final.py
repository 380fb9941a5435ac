"""Unknown effects of the final round only: none of them resembles those of the development."""

import numpy as np

from scene import BALL

from .base import Change, Effect, vector

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def draw_chains(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "falling": rng.choice([-1.0, 1.0]),
        "aside": rng.choice([-1.0, 1.0]) * rng.uniform(0, 0.35),
        "width": rng.uniform(0.12, 0.2),
        "direction": [np.cos(turn), np.sin(turn), 0.0],
    }


def change_chains(scene, p):
    """The cable chains of two axes rub against each other where their loops meet, on a line across the table: there
    the carriage is pushed aside."""
    low, high = scene.reading.min(0), scene.reading.max(0)
    u, v, _ = ((scene.reading - (low + high) / 2) / (high - low)).T
    away = u - p["falling"] * v - p["aside"]
    return Change(tip=vector(p["direction"], p["amplitude_um"] * np.exp(-0.5 * (away / p["width"]) ** 2)))


def draw_worn(scene, rng):
    along, across = rng.permutation(2)
    x = scene.reading[:, along]
    return {
        "amplitude_um": 1.0,
        "guide": int(along),
        "across": int(across),
        "middle_mm": float(np.quantile(x, rng.uniform(0.2, 0.8))),
        "width_mm": rng.uniform(0.12, 0.2) * float(np.ptp(x)),
    }


def change_worn(scene, p):
    """Where a guide is worn the air gap is wide: the carriage yields to the probing force across the guide, on either
    side. The tip radius has taken the mean."""
    away = (scene.reading[:, p["guide"]] - p["middle_mm"]) / p["width_mm"]
    wide = np.exp(-0.5 * away**2)
    return Change(along=-p["amplitude_um"] * scene.normal[:, p["across"]] ** 2 * (wide - wide.mean()))


def draw_leaking(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "direction": [np.cos(turn), np.sin(turn), 0.0],
        "pumped_s": np.quantile(scene.time, (np.arange(5) + rng.uniform(0.15, 0.85, 5)) / 5),
        "tau_s": rng.uniform(0.5, 1) * float(np.ptp(scene.time)) / 6,
    }


def change_leaking(scene, p):
    """An isolator under the machine leaks, and is pumped up when it has sunk too far: meanwhile the column leans, and
    the tip is off by its height. The calibration has taken the mean."""
    moments = np.concatenate([[0.0], p["pumped_s"]])
    since = scene.time - moments[np.searchsorted(moments, scene.time, side="right") - 1]
    sunk = 1 - np.exp(-since / p["tau_s"])
    height = (scene.reading[:, 2] - scene.reading[:, 2].mean()) / np.ptp(scene.reading[:, 2])
    return Change(tip=vector(p["direction"], p["amplitude_um"] * 2 * (sunk - sunk.mean()) * height))


def draw_posts(scene, rng):
    return {"amplitude_um": 1.0, "foot_mm": rng.uniform(5, 25), "power": rng.uniform(3, 4)}


def change_posts(scene, p):
    """The balls stand on thin posts: in a tilted placement these bend under the weight, the tall ones far more than
    the short."""
    height = (scene.part_point - BALL * scene.part_normal)[:, 2]
    height = height - height.min() + p["foot_mm"]
    down = -scene.turn[:, 2, :] * [1, 1, 0]
    return Change(
        along=p["amplitude_um"] * (height / height.max()) ** p["power"] * np.sum(scene.part_normal * down, 1) / 0.3
    )


def draw_bimetal(scene, rng):
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "flat_at_C": float(np.mean(scene.temperature["part"]) + rng.uniform(-0.4, 0.4)),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
        "strip_deg": rng.uniform(0, 180),
    }


def change_bimetal(scene, p):
    """A strip of another metal is screwed under the plate: the plate is straight at one temperature, and bows along
    the strip above and below it, about the supports."""
    a = np.radians(p["strip_deg"])
    axis = np.array([np.cos(a), np.sin(a), 0])
    u, z = scene.part_point @ axis / p["half_size_mm"], scene.part_point[:, 2] / p["half_size_mm"]
    bow = scene.part_normal[:, 2] * (u**2 - np.mean(u**2)) - scene.part_normal @ axis * 2 * u * z
    return Change(along=p["amplitude_um"] * (scene.temperature["part"] - p["flat_at_C"]) * bow)


def draw_busy(scene, rng):
    return {"amplitude_um": 1.0, "tau_s": rng.uniform(250, 600)}


def change_busy(scene, p):
    """The motor of the head warms with every indexing and cools in the pauses: the joint grows towards the tip. The
    qualification was made at a mean heat."""
    turned = np.array([scene.time[scene.visit == v].min() for v in np.unique(scene.visit)])
    since = scene.time[:, None] - turned
    heat = np.sum(np.where(since >= 0, np.exp(-np.maximum(since, 0) / p["tau_s"]), 0), 1)
    return Change(tip=-scene.shank * (p["amplitude_um"] * (heat - heat.mean()) / np.ptp(heat))[:, None])


unknown("chains", draw_chains, change_chains, ["position", "feature"])
unknown("worn_guide", draw_worn, change_worn, ["position", "direction", "feature"])
unknown("leaking_isolator", draw_leaking, change_leaking, ["time", "position", "head", "sensor"])
unknown("leaning_posts", draw_posts, change_posts, ["feature", "position", "setup"], "D")
unknown("bimetal", draw_bimetal, change_bimetal, ["temperature", "feature", "position"], "D")
unknown("busy_motor", draw_busy, change_busy, ["time", "head", "sensor"], "D")
