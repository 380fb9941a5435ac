"""Unknown effects of the final round only: none of them resembles those of the development."""

import numpy as np

from .base import Change, Effect, unit, vector
from .probe import directions

UNKNOWN = {}


def unknown(name, draw, change, factors, designs="CD"):
    UNKNOWN[name] = Effect(name, draw, change, ("amplitude_um",), 20.0, tuple(factors), designs=designs)


def draw_refitted(scene, rng):
    return {"amplitude_um": 1.0, "turned": unit(rng), "placement": int(rng.choice(np.unique(scene.setup)[1:]))}


def change_refitted(scene, p):
    """Before one placement the head is taken off and put on again, a little turned on its mount, and nobody qualifies
    the styli: each tip is off by its lever, until the head is put right. Amplitude at the longest lever."""
    lever = scene.tip / np.linalg.norm(scene.tip, axis=1).max()
    moved = np.cross(p["turned"], lever) * (scene.setup == p["placement"])[:, None]
    return Change(tip=p["amplitude_um"] * moved)


def draw_dust(scene, rng):
    turn, lean = rng.uniform(0, 2 * np.pi), np.radians(rng.uniform(20, 40))
    return {
        "amplitude_um": 1.0,
        "towards": [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)],
        "width_deg": rng.uniform(18, 28),
    }


def change_dust(scene, p):
    """Dust of a grinding machine settles on the balls where they are flat, a little to the side it comes from. The
    layer grows until the part is placed anew and wiped. Amplitude in the longest placement."""
    placed = np.array([scene.time[scene.setup == k].min() for k in scene.setup])
    layer = (scene.time - placed) / np.max(scene.time - placed)
    angle = np.degrees(np.arccos(np.clip(scene.normal @ np.asarray(p["towards"]), -1, 1)))
    return Change(along=p["amplitude_um"] * layer * np.exp(-0.5 * (angle / p["width_deg"]) ** 2))


def draw_grease(scene, rng):
    air = scene.temperature["air"]
    return {"amplitude_um": 1.0, "qualified_at_C": float((air.min() + air.max()) / 2 + rng.uniform(-0.4, 0.4))}


def change_grease(scene, p):
    """The grease of the probe's seats is stiff in the cold: it takes a larger moment to tip them than when the styli
    were qualified, and a stylus touched from the side bends more, by the square of its length. The warm probe is the
    other way round."""
    _, beta = directions(scene)
    bent = np.cos(beta) ** 2 * (scene.length / scene.length.max()) ** 2
    return Change(along=p["amplitude_um"] * (scene.temperature["air"] - p["qualified_at_C"]) * bent)


def draw_leg(scene, rng):
    along = "xyz".index(scene.machine.chain[0])
    return {
        "amplitude_um": 1.0,
        "along": along,
        "driven_end": rng.choice([-1.0, 1.0]),
        "freed_after_mm": rng.uniform(0.1, 0.2) * float(np.ptp(scene.reading[:, along])),
    }


def change_leg(scene, p):
    """The bridge is driven at one leg; the other one drags and stays behind in the sense of the last long way. A short
    approach does not free it. Amplitude at the far leg."""
    i, held = p["along"], p["freed_after_mm"]
    state, behind = scene.start[0, i], np.empty(scene.size)
    for k, way in enumerate(np.column_stack([scene.start[:, i], scene.reading[:, i]])):
        for x in way:
            state = min(max(state, x - held), x + held)
        behind[k] = (way[1] - state) / held
    x = scene.target[:, 1 - i]
    far = 0.5 - p["driven_end"] * (x - (x.min() + x.max()) / 2) / np.ptp(x)
    return Change(tip=vector(np.eye(3)[i], p["amplitude_um"] * behind * far))


def draw_battery(scene, rng):
    return {
        "amplitude_um": 1.0,
        "low_s": float(np.quantile(scene.time, rng.uniform(0.3, 0.5))),
        "changed_s": float(np.quantile(scene.time, rng.uniform(0.75, 0.95))) + 0.5,
    }


def change_battery(scene, p):
    """The battery of a radio probe runs low: its message must be repeated more and more often, and the machine goes on
    meanwhile. Then the battery is changed. Amplitude at 8 mm/s."""
    low = np.clip((scene.time - p["low_s"]) / (p["changed_s"] - p["low_s"]), 0, 1) * (scene.time < p["changed_s"])
    return Change(tip=scene.travel * (p["amplitude_um"] * low * scene.speed / 8)[:, None])


def draw_certificate(scene, rng):
    excess = rng.normal(size=(3, 3, 3)) * [1, 1, 0.5]
    swapped = excess - excess.transpose(1, 0, 2)
    return {"amplitude_um": 1.0, "excess": (swapped / np.sqrt(np.mean(swapped**2))).reshape(9, 3)}


def change_certificate(scene, p):
    """The certificate counts the balls by columns, the operator types its deviations in by rows: balls on both sides of
    the diagonal have each other's deviations, and are off by opposite amounts, in height by less."""
    ball = [int(f.removeprefix("BALL")) - 1 for f in scene.feature]
    return Change(along=p["amplitude_um"] * np.sum(np.asarray(p["excess"])[ball] * scene.part_normal, 1))


unknown("refitted_head", draw_refitted, change_refitted, ["setup", "head", "sensor", "time"], "D")
unknown("falling_dust", draw_dust, change_dust, ["direction", "time"], "D")
unknown("cold_grease", draw_grease, change_grease, ["temperature", "direction", "sensor"], "D")
unknown("dragging_leg", draw_leg, change_leg, ["position", "feature"])
unknown("weak_battery", draw_battery, change_battery, ["speed", "time"], "D")
unknown("swapped_certificate", draw_certificate, change_certificate, ["feature", "position"])
