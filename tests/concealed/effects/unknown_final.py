"""Unknown effects of the final round only: none of them resembles those of the development."""

import numpy as np

from .base import Change, Effect, vector

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def draw_sagging(scene, rng):
    return {
        "amplitude_um": 1.0,
        "spans_mm": rng.uniform(0.6, 0.85, 2) * np.ptp(scene.reading[:, :2], axis=0),
        "first_mm": [float(rng.uniform(*np.quantile(scene.reading[:, i], [0.05, 0.95]))) for i in range(2)],
    }


def change_sagging(scene, p):
    """The table lies on a grid of posts and sags between them, and the carriage follows it: hills and hollows in
    both directions, as in an egg box."""
    waves = np.cos(2 * np.pi * (scene.reading[:, :2] - p["first_mm"]) / p["spans_mm"])
    return Change(tip=vector([0, 0, 1], p["amplitude_um"] * waves[:, 0] * waves[:, 1]))


def draw_ganged(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "right_at_mm_s": rng.uniform(4.4, 5.6)}


def change_ganged(scene, p):
    """Every axis drives at the full speed by itself, so that an approach between the axes is faster than the
    controller believes. The compensation of the delay is right on average, and at one speed in all directions."""
    faster = np.abs(scene.travel).sum(1)
    share = (scene.speed - p["right_at_mm_s"]) / 6
    return Change(along=-p["amplitude_um"] * share * (faster - faster.mean()) / faster.std())


def draw_sinking(scene, rng):
    return {"amplitude_um": 1.0, "towards": rng.uniform(0, 2 * np.pi), "tau_s": rng.uniform(120, 400)}


def change_sinking(scene, p):
    """The fixture stands on a post in its middle and on pads around it. One pad is soft: after every placement it
    sinks for some minutes, and the part tilts about the post. Amplitude at the pad."""
    out = np.array([np.cos(p["towards"]), np.sin(p["towards"]), 0])
    placed = np.array([scene.time[scene.setup == k].min() for k in scene.setup])
    sunk = p["amplitude_um"] * (1 - np.exp(-(scene.time - placed) / p["tau_s"]))
    away = scene.target - scene.target.mean(0)
    angle = np.outer(sunk / np.abs(away @ out).max(), np.cross(out, [0, 0, -1]))
    return Change(tip=np.cross(angle, away))


def draw_hose(scene, rng):
    low, high = np.quantile(scene.target[:, :2], [0.05, 0.95], axis=0)
    return {
        "amplitude_um": 1.0,
        "hung_at_mm": low + rng.uniform(0.3, 0.7, 2) * (high - low),
        "slack": rng.uniform(0.15, 0.35),
    }


def change_hose(scene, p):
    """A hose hangs from the ceiling to the head. Where it is taut it pulls the elbow of a lying stylus towards the
    place below its hook: the wrist turns by the lever."""
    pull = np.asarray(p["hung_at_mm"]) - (scene.target - scene.arm)[:, :2]
    far = np.linalg.norm(pull, axis=1)
    taut = np.clip(far / far.max() - p["slack"], 0, None) / np.maximum(far, 1e-9)
    torque = taut * (scene.shank[:, 1] * pull[:, 0] - scene.shank[:, 0] * pull[:, 1])
    return Change(tip=np.cross([0, 0, 1.0], scene.arm / scene.length.max()) * p["amplitude_um"] * torque[:, None])


def draw_pickup(scene, rng):
    count = int(rng.integers(3, 6))
    return {
        "amplitude_um": 1.0,
        "wiped_s": np.quantile(scene.time, (np.arange(count) + rng.uniform(0.2, 0.8, count)) / count),
    }


def change_pickup(scene, p):
    """A tip picks up metal from the part with every touch and grows, until it is wiped. The qualification has taken
    the mean."""
    layer, wiped = np.zeros(scene.size), np.searchsorted(p["wiped_s"], scene.time)
    for tip in np.unique(scene.length):
        mine = scene.length == tip
        for k in np.unique(wiped[mine]):
            here = mine & (wiped == k)
            layer[here] = np.arange(here.sum())
        layer[mine] -= layer[mine].mean()
    return Change(along=p["amplitude_um"] * layer / np.ptp(layer))


def draw_bar(scene, rng):
    angles = rng.normal(size=len(np.unique(scene.setup)))
    return {
        "amplitude_um": 1.0,
        "across": int(rng.integers(2)),
        "side": rng.choice([-1.0, 1.0]),
        "screw": rng.choice([-1.0, 1.0]) * rng.uniform(1.1, 1.6),
        "turned": (angles - angles.mean()) / angles.std(),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_bar(scene, p):
    """The balls of one side sit on a bar that a single screw holds at its end: whenever the part is placed anew, the
    bar is turned a little about the screw."""
    i, h = p["across"], p["half_size_mm"]
    on_bar = p["side"] * scene.part_point[:, i] > 0.5 * h
    lever = (scene.part_point[:, 1 - i] / h - p["screw"]) / (1 + abs(p["screw"]))
    turned = np.asarray(p["turned"])[np.unique(scene.setup, return_inverse=True)[1]]
    return Change(along=p["amplitude_um"] * on_bar * turned * lever * scene.part_normal[:, i])


unknown("sagging_table", draw_sagging, change_sagging, ["position", "feature"])
unknown("ganged_axes", draw_ganged, change_ganged, ["speed", "direction"], "D")
unknown("sinking_pad", draw_sinking, change_sinking, ["time", "setup", "position", "feature"], "D")
unknown("hanging_hose", draw_hose, change_hose, ["head", "sensor", "position", "feature"], "D")
unknown("metal_pickup", draw_pickup, change_pickup, ["time", "sensor"])
unknown("loose_bar", draw_bar, change_bar, ["feature", "setup", "position"], "D")
