"""Effects that no catalogue names, for development and rehearsal: a diagnosis must say that something is
there and that it cannot name it."""

from portable import np

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
