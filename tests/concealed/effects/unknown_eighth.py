"""The strangers of the eighth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, vector
from .unknown import unknown


def draw_unloaded(scene, rng):
    since, until = np.quantile(scene.time, [rng.uniform(0.2, 0.45), rng.uniform(0.65, 0.9)]) + 0.5
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "guide": int(rng.integers(2)),
        "coordinate": int(rng.integers(3)),
        "waves": rng.normal(size=(4, 2)) / np.arange(1, 5)[:, None],
        "stopped_s": float(since),
        "loaded_s": float(until),
    }


def change_unloaded(scene, p):
    """After an emergency stop the controller starts without the correction of one guide, until somebody loads it: the
    guide shows its own shape meanwhile. Amplitude where it is farthest from its middle."""
    x = scene.reading[:, p["guide"]]
    q = np.outer(np.pi * (x - (x.min() + x.max()) / 2) / np.ptp(x), np.arange(1, 5))
    shape = np.sum(np.asarray(p["waves"])[:, 0] * np.sin(q) + np.asarray(p["waves"])[:, 1] * (np.cos(q) - 1), 1)
    off = (scene.time >= p["stopped_s"]) & (scene.time < p["loaded_s"])
    return Change(tip=vector(np.eye(3)[p["coordinate"]], p["amplitude_um"] * off * shape / np.abs(shape).max()))


def draw_lazy(scene, rng):
    return {"amplitude_um": 1.0, "kept": rng.uniform(0, 0.4)}


def change_lazy(scene, p):
    """The seats of the probe are sticky: the stylus does not come home from the side that the touch before has pushed
    it to. The long way to another feature shakes it home. Amplitude at the tip of the longest."""
    left = np.zeros((scene.size, 3))
    for k in range(1, scene.size):
        if scene.block[k] == scene.block[k - 1]:
            push, shank = scene.normal[k - 1], scene.shank[k - 1]
            left[k] = p["kept"] * left[k - 1] + (1 - p["kept"]) * (push - shank * (push @ shank))
    return Change(tip=-p["amplitude_um"] * left * (scene.length / scene.length.max())[:, None])


def draw_snapped(scene, rng):
    return {"amplitude_um": 1.0, "within_deg": rng.uniform(18, 28)}


def change_snapped(scene, p):
    """The software takes a normal that is near an axis of the part for this axis, and corrects the tip radius along
    it: too little, the more the farther, and nothing beyond a limit. Amplitude of the largest tip at the limit."""
    aside = np.arccos(np.clip(np.abs(scene.part_normal).max(1), 0, 1)) / np.radians(p["within_deg"])
    return Change(along=p["amplitude_um"] * aside**2 * (aside < 1) * scene.tip_radius / scene.tip_radius.max())


def draw_cleaned(scene, rng):
    return {"amplitude_um": 1.0, "tau_s": rng.uniform(6, 12)}


def change_cleaned(scene, p):
    """Every ball is cleaned with alcohol right before it is measured: its post is cold and short, and is as warm as
    the part again after some touches. Amplitude at the first."""
    first = np.array([scene.time[scene.block == b].min() for b in scene.block])
    cold = np.exp(-(scene.time - first) / p["tau_s"])
    return Change(along=-p["amplitude_um"] * cold * scene.part_normal[:, 2])


def draw_beam(scene, rng):
    warm = scene.temperature[scene.machine.chain[1]]
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "straight_at_C": float((warm.min() + warm.max()) / 2 + rng.uniform(-0.4, 0.4)),
        "held_at": rng.uniform(-0.5, 0.5),
    }


def change_beam(scene, p):
    """The rail on the side of the beam is of another metal: with every kelvin the beam is twisted about itself, from
    where it is held, and the carriage with it. Amplitude at 500 mm below the end of the beam, for 1 K."""
    axis = scene.machine.chain[1]
    i = "xyz".index(axis)
    x = scene.reading[:, i]
    turn = np.zeros((scene.size, 3))
    away = (x - (x.min() + x.max()) / 2) / np.ptp(x) * 2 - p["held_at"]
    turn[:, i] = p["amplitude_um"] / 0.5 * (scene.temperature[axis] - p["straight_at_C"]) * away
    return Change({axis: (np.zeros((scene.size, 3)), turn)})


def draw_wiper(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    return {"amplitude_um": 1.0, "side": [np.cos(turn), np.sin(turn), 0.0], "bearing": rng.uniform(0.1, 0.4)}


def change_wiper(scene, p):
    """A wiper runs dry on one side of the ram: it brakes, with the speed, when the ram goes up or down, and turns the
    ram in its bearing. Amplitude at 8 mm/s straight down, at the longest reach."""
    out = np.abs(scene.reading[:, 2])
    reach = (out / out.max() + p["bearing"]) / (1 + p["bearing"])
    return Change(tip=vector(p["side"], -p["amplitude_um"] * scene.travel[:, 2] * scene.speed / 8 * reach))


unknown("unloaded_map", draw_unloaded, change_unloaded, ["time", "position", "feature"])
unknown("lazy_seats", draw_lazy, change_lazy, ["direction", "head", "sensor", "time"])
unknown("snapped_vectors", draw_snapped, change_snapped, ["direction", "sensor", "setup"])
unknown("cleaned_balls", draw_cleaned, change_cleaned, ["time", "feature", "direction"])
unknown("twisting_beam", draw_beam, change_beam, ["temperature", "position", "feature", "setup"], "D")
unknown("dry_wiper", draw_wiper, change_wiper, ["speed", "direction", "position"], "D")
