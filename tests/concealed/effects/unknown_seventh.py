"""The strangers of the seventh final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import APPROACH

from .base import Change, vector
from .probe import directions
from .unknown import unknown


def draw_cable(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0])}


def change_cable(scene, p):
    """The head turns without end and takes the short way. A cable, laid outside, winds up and unwinds by
    the whole turns that are left over, and twists the wrist about the vertical. Amplitude for one turn at
    the longest lying stylus."""
    visit, first = np.unique(scene.visit, return_index=True)
    turns = np.cumsum(np.round(np.diff(scene.b[first], prepend=0) / (2 * np.pi)))
    wound = turns[np.searchsorted(visit, scene.visit)]
    lying = np.cross([0, 0, 1.0], scene.arm / scene.length.max())
    return Change(tip=p["amplitude_um"] * wound[:, None] * lying)


def draw_pushed(scene, rng):
    return {"amplitude_um": 1.0, "held": rng.uniform(0.2, 0.5)}


def change_pushed(scene, p):
    """The part lies unclamped. Every touch that comes from the side, and more than friction holds, pushes
    it on a little, the faster the farther, and it stays there until it is placed anew. Amplitude at the
    farthest."""
    sideways = -scene.normal * [1, 1, 0]
    push = np.linalg.norm(sideways, axis=1)
    slip = sideways * (np.clip(push - p["held"], 0, None) / np.maximum(push, 1e-9) * scene.speed)[:, None]
    moved = np.zeros((scene.size, 3))
    for k in np.unique(scene.setup):
        mine = scene.setup == k
        moved[mine] = np.cumsum(slip[mine], 0) - slip[mine]
    return Change(tip=p["amplitude_um"] * moved / np.linalg.norm(moved, axis=1).max())


def draw_entry(scene, rng):
    x, y = scene.reading[rng.integers(scene.size), :2]
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "coordinate": int(rng.integers(3)),
        "node_mm": [float(x), float(y)],
        "mesh_mm": rng.uniform(0.25, 0.4, 2) * np.ptp(scene.reading[:, :2], axis=0),
    }


def change_entry(scene, p):
    """One entry of the correction table over x and y is mistyped: one coordinate is wrong at this node,
    and, by the interpolation, in the four meshes around it."""
    away = np.abs(scene.reading[:, :2] - p["node_mm"]) / p["mesh_mm"]
    share = np.clip(1 - away, 0, None).prod(1)
    return Change(tip=vector(np.eye(3)[p["coordinate"]], p["amplitude_um"] * share))


def draw_odd(scene, rng):
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "along": int(rng.integers(2)),
        "side": rng.choice([-1.0, 1.0]),
        "held_end": rng.choice([-1.0, 1.0]),
        "built_at_C": float(np.mean(scene.temperature["part"]) + rng.uniform(-0.4, 0.4)),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_odd(scene, p):
    """The balls of one side sit on a bar of another metal, which is held at one end and slides in the
    frame at the other: it grows past the frame with every kelvin, along itself. Amplitude at the free
    end, for 1 K."""
    i, h = p["along"], p["half_size_mm"]
    on_bar = p["side"] * scene.part_point[:, 1 - i] > 0.5 * h
    share = (1 - p["held_end"] * scene.part_point[:, i] / h) / 2
    warmer = scene.temperature["part"] - p["built_at_C"]
    return Change(along=p["amplitude_um"] * on_bar * warmer * share * scene.part_normal[:, i])


def draw_whip(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0]), "decay_s": rng.uniform(0.3, 1.0)}


def change_whip(scene, p):
    """A stylus still swings from the acceleration, crosswise only, when it touches: the wider the longer
    it is, the less the longer the approach takes. The tip radius has taken the mean. Amplitude from rest
    to the hardest."""
    swing = scene.acceleration * np.exp(-APPROACH / scene.speed / p["decay_s"])
    across = 1 - np.sum(scene.travel * scene.shank, 1) ** 2
    wide = across * (scene.length / scene.length.max()) ** 3
    return Change(along=p["amplitude_um"] * wide * (swing - swing.mean()) / swing.max())


def draw_skid(scene, rng):
    return {"amplitude_um": 1.0}


def change_skid(scene, p):
    """A tip that comes obliquely skids along the surface before it trips. Friction drags it towards the
    head or away from it: the seats are unloaded or loaded, and it trips early or late. Amplitude for a
    skid along the shank."""
    skid = scene.travel - scene.normal * np.sum(scene.travel * scene.normal, 1, keepdims=True)
    upward = np.sum(skid * scene.shank, 1) / np.maximum(np.linalg.norm(skid, axis=1), 0.02)
    _, beta = directions(scene)
    return Change(along=p["amplitude_um"] * upward * np.cos(beta) ** 2 * scene.length / scene.length.max())


unknown("wound_cable", draw_cable, change_cable, ["head", "sensor", "time"], "D")
unknown("pushed_part", draw_pushed, change_pushed, ["time", "setup"])
unknown("mistyped_entry", draw_entry, change_entry, ["position", "feature"])
unknown("odd_bar", draw_odd, change_odd, ["temperature", "feature", "position"], "D")
unknown(
    "whipping_stylus", draw_whip, change_whip, ["acceleration", "speed", "direction", "sensor", "head"], "D"
)
unknown("skidding_tip", draw_skid, change_skid, ["direction", "sensor", "head"], "D")
