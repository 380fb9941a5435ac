"""Unknown effects of the final round only: none of them resembles those of the development."""

import numpy as np

from .base import Change, Effect, vector
from .probe import directions

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def draw_balls(scene, rng):
    return {"amplitude_um": 1.0, "excess": {str(f): float(rng.normal()) for f in np.unique(scene.feature)}}


def change_balls(scene, p):
    """The balls of the part come from several batches: each has a radius of its own."""
    return Change(along=p["amplitude_um"] * np.array([p["excess"][f] for f in scene.feature]))


def draw_gauge(scene, rng):
    return {
        "amplitude_um": 1.0,
        "side": rng.uniform(0, 2 * np.pi),
        "cycles": rng.uniform(1, 2.5),
        "phase": rng.uniform(0, 2 * np.pi),
    }


def change_gauge(scene, p):
    """One of three strain gauges gains and loses sensitivity with its amplifier: touches on its side only come
    early and late by turns."""
    phi, beta = directions(scene)
    side = np.clip(np.cos(phi - p["side"]), 0, None) ** 2 * np.cos(beta) ** 2
    return Change(
        along=p["amplitude_um"] * side * np.sin(2 * np.pi * p["cycles"] * scene.time / scene.duration + p["phase"])
    )


def draw_sunny(scene, rng):
    axis = int(rng.integers(2))
    x = scene.reading[:, axis]
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "side": rng.choice([-1.0, 1.0]),
        "edge_mm": float(np.quantile(x, rng.uniform(0.35, 0.65))),
        "blur_mm": float(0.05 * np.ptp(x)),
    }


def change_sunny(scene, p):
    """The sun falls on one end of the machine: there the thin stylus is warm, and longer by its length."""
    share = 1 / (1 + np.exp(-p["side"] * (scene.reading[:, p["axis"]] - p["edge_mm"]) / p["blur_mm"]))
    return Change(tip=scene.shank * (p["amplitude_um"] * share * scene.length / scene.length.max())[:, None])


def draw_draught(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axis": int(rng.integers(2)),
        "opened_s": np.sort(np.quantile(scene.time, rng.uniform(0, 0.95, 6))),
        "tau_s": rng.uniform(60, 150),
    }


def change_draught(scene, p):
    """The door of the hall opens now and then: a scale, held at its home end, shrinks at once and recovers
    slowly."""
    since = scene.time[:, None] - np.asarray(p["opened_s"])
    cold = np.sum(np.where(since >= 0, np.exp(-np.maximum(since, 0) / p["tau_s"]), 0), 1)
    share = scene.reading[:, p["axis"]] / scene.machine.travel["xyz"[p["axis"]]]
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * cold * share))


def draw_crowding(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "axis": int(rng.integers(2))}


def change_crowding(scene, p):
    """A scale, clamped at five places, expands unevenly between them: with every kelvin its lines crowd in one half
    of a span and spread in the other."""
    name = "xyz"[p["axis"]]
    wave = np.sin(4 * np.pi * scene.reading[:, p["axis"]] / scene.machine.travel[name])
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * (scene.temperature[name] - 20) * wave))


def draw_wobble(scene, rng):
    return {
        "amplitude_um": 1.0,
        "placement": int(rng.choice(np.unique(scene.setup))),
        "diagonal_deg": float(rng.choice([45, 135, 225, 315]) + rng.uniform(-10, 10)),
        "held": rng.uniform(0.05, 0.25),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_wobble(scene, p):
    """In one placement the part stands on four feet, one of them short: a push strong enough about the diagonal tips
    it, and it falls back."""
    a = np.radians(p["diagonal_deg"])
    push = np.cross(scene.part_point / p["half_size_mm"], -scene.part_normal) @ [np.cos(a), np.sin(a), 0]
    return Change(along=-p["amplitude_um"] * push * ((push > p["held"]) & (scene.setup == p["placement"])))


unknown("mixed_balls", draw_balls, change_balls, ["feature", "position"])
unknown("weak_gauge", draw_gauge, change_gauge, ["direction", "time", "head", "sensor"], "D")
unknown("sunny_end", draw_sunny, change_sunny, ["position", "head", "sensor", "feature"])
unknown("draught", draw_draught, change_draught, ["time", "position"])
unknown("crowded_lines", draw_crowding, change_crowding, ["temperature", "position", "feature", "setup"], "D")
unknown("wobble", draw_wobble, change_wobble, ["feature", "direction", "position", "setup"])
