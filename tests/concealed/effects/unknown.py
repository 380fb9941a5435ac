"""Effects that no catalogue names, for development and rehearsal: a diagnosis must say that something is
there and that it cannot name it."""

import numpy as np

from scene import BALL

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
unknown("mixed_balls", draw_balls, change_balls, ["feature", "position"])
unknown("weak_gauge", draw_gauge, change_gauge, ["direction", "time", "head", "sensor"], "D")
unknown("sunny_end", draw_sunny, change_sunny, ["position", "head", "sensor", "feature"])
unknown("draught", draw_draught, change_draught, ["time", "position"])
unknown("crowded_lines", draw_crowding, change_crowding, ["temperature", "position", "feature", "setup"], "D")
unknown("wobble", draw_wobble, change_wobble, ["feature", "direction", "position", "setup"])
unknown("leaves", draw_leaves, change_leaves, ["feature", "direction", "position"])
unknown("magnet", draw_magnet, change_magnet, ["position", "feature"])
unknown("sunbeam", draw_sunbeam, change_sunbeam, ["time", "position"])
unknown("overhang", draw_overhang, change_overhang, ["head", "sensor", "position", "feature"], "D")
unknown("bellows", draw_bellows, change_bellows, ["speed", "position", "feature"], "D")
unknown("glue", draw_glue, change_glue, ["feature", "time", "position"])
unknown("chains", draw_chains, change_chains, ["position", "feature"])
unknown("worn_guide", draw_worn, change_worn, ["position", "direction", "feature"])
unknown("leaking_isolator", draw_leaking, change_leaking, ["time", "position", "head", "sensor"])
unknown("leaning_posts", draw_posts, change_posts, ["feature", "position", "setup"], "D")
unknown("bimetal", draw_bimetal, change_bimetal, ["temperature", "feature", "position"], "D")
unknown("busy_motor", draw_busy, change_busy, ["time", "head", "sensor"], "D")
