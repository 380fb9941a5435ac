"""The strangers of the fourteenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change, vector
from .unknown import unknown


def draw_tape(scene, rng):
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "axis": int(rng.integers(2)),
        "loose_end": rng.choice([-1.0, 1.0]),
        "since_s": float(np.quantile(scene.time, rng.uniform(0.2, 0.5))),
        "depth": rng.uniform(0.45, 0.7),
    }


def change_tape(scene, p):
    """The tape of a scale is glued on under tension, and peels off from one end in the course of the run. Where it has
    come off it shrinks, or hangs slack, while the piece that still holds is right: the carriage is wrong beyond the
    place to which it has peeled, by the length of loose tape up to there. Amplitude at the loose end, when the run
    ends."""
    x = scene.reading[:, p["axis"]]
    from_end = 0.5 - p["loose_end"] * (x - (x.min() + x.max()) / 2) / np.ptp(x)
    peeled = p["depth"] * np.clip((scene.time - p["since_s"]) / (scene.duration - p["since_s"]), 0, 1)
    loose = np.maximum(peeled - from_end, 0) / p["depth"]
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * loose))


def draw_unscrewing(scene, rng):
    return {
        "amplitude_um": 1.0,
        "stands_at": {str(f): rng.uniform(0, 2 * np.pi) for f in np.unique(scene.feature)},
        "turns": {str(f): rng.uniform(0.3, 1.2) for f in np.unique(scene.feature)},
        "rise": rng.uniform(0.3, 0.8),
    }


def change_unscrewing(scene, p):
    """The balls are screwed on their posts without glue, and no thread is quite in the middle of its ball. Every touch
    turns the ball a little farther off its thread, one ball more easily than another: its centre goes round the post,
    and rises. Amplitude is the distance of the thread from the middle of the ball."""
    names, moved = np.array(scene.feature), np.zeros((scene.size, 3))
    for ball, start in p["stands_at"].items():
        mine = names == ball
        turned = 2 * np.pi * p["turns"][ball] * np.arange(mine.sum()) / mine.sum()
        aside = np.cos(start + turned) - np.cos(start), np.sin(start + turned) - np.sin(start)
        moved[mine] = np.column_stack([*aside, p["rise"] * turned / np.pi])
    return Change(along=p["amplitude_um"] * np.sum(moved * scene.part_normal, 1))


def draw_bent(scene, rng):
    lengths = np.unique(scene.length)
    return {
        "amplitude_um": 1.0,
        "length_mm": float(rng.choice(lengths)),
        "turns": rng.choice([-1.0, 1.0]) * rng.uniform(1.5, 3.5),
        "phase": rng.uniform(0, 2 * np.pi),
    }


def change_bent(scene, p):
    """A stylus is bent, and has come loose in its thread: from touch to touch it turns on a little about its own axis,
    and its tip goes round on a circle, seen from the head. The other module is tight. Amplitude is the radius of the
    circle."""
    mine = scene.length == p["length_mm"]
    turned = 2 * np.pi * p["turns"] * np.cumsum(mine) / mine.sum() + p["phase"]
    aside = np.column_stack([np.cos(turned), np.sin(turned), np.zeros(scene.size)]) * mine[:, None]
    return Change(tip=p["amplitude_um"] * np.einsum("nij,nj->ni", scene.head, aside))


def draw_lever(scene, rng):
    waves = rng.normal(size=(3, 2))
    return {
        "amplitude_um": 1.0,
        "axis": int(rng.integers(2)),
        "about": np.eye(3)[rng.integers(3)],
        "waves": waves / np.sqrt(np.sum(waves**2) / 2),
    }


def change_lever(scene, p):
    """The controller corrects the rotation of a carriage along its guide with the lever to the end of the ram, and
    has forgotten what hangs below: head and stylus add their own lever, another one for each orientation. Amplitude at
    the longest lever across the rotation, where its waves add up."""
    x = scene.reading[:, p["axis"]]
    q = np.outer(2 * np.pi * (x - x.min()) / np.ptp(x), np.arange(1, 4))
    rotation = np.sum(np.asarray(p["waves"])[:, 0] * np.sin(q) + np.asarray(p["waves"])[:, 1] * np.cos(q), 1)
    lever = np.cross(p["about"], scene.tip)
    return Change(tip=p["amplitude_um"] * rotation[:, None] * lever / np.linalg.norm(lever, axis=1).max())


def draw_curling(scene, rng):
    warm, turn = scene.temperature["z"], rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "direction": [float(np.cos(turn)), float(np.sin(turn)), 0.0],
        "straight_at_C": float((warm.min() + warm.max()) / 2 + rng.uniform(-0.4, 0.4)),
        "qualified_at": rng.uniform(0.4, 0.6),
    }


def change_curling(scene, p):
    """One side of the carbon fibre ram has been mended with another resin: with every kelvin the ram curls to one side,
    with the square of how far it is out, and the styli with it by their levers. At the height of the reference sphere
    the qualification, made anew after every pause, has taken it. Amplitude at the end of the ram where it is farthest
    out, for 1 K, before the qualification."""
    out = np.abs(scene.reading[:, 2])
    level = np.quantile(out, p["qualified_at"])
    curl = p["amplitude_um"] * (scene.temperature["z"] - p["straight_at_C"]) / out.max() ** 2
    aside = np.outer(curl * (out**2 - level**2), p["direction"])
    tilt = np.outer(2 * curl * (out - level), np.cross(p["direction"], [0, 0, 1.0]))
    return Change(tip=aside + np.cross(tilt, scene.tip))


def draw_pallet(scene, rng):
    turn = rng.uniform(0, np.pi)
    return {
        "amplitude_um": 1.0,
        "placement": int(rng.choice(np.unique(scene.setup))),
        "rollers": [float(np.cos(turn)), float(np.sin(turn)), 0.0],
    }


def change_pallet(scene, p):
    """In one placement the part stands on a pallet with rollers that nobody has locked. A touch along the rollers rolls
    it away until the probe has triggered, the faster the farther; a spring brings it home again. Amplitude along
    the rollers, at 8 mm/s."""
    along = (scene.normal @ np.asarray(p["rollers"])) ** 2
    return Change(along=-p["amplitude_um"] * along * scene.speed / 8 * (scene.setup == p["placement"]))


def draw_thrown(scene, rng):
    axis = int(rng.integers(2))
    ways = np.abs(np.diff(scene.reading[:, axis]))[np.diff(scene.block) != 0]
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "leaves_after_mm": float(np.quantile(ways, rng.uniform(0.2, 0.4))),
        "first_side": rng.choice([-1.0, 1.0]),
    }


def change_thrown(scene, p):
    """The reading head of a scale has play in its holder. When the carriage brakes hard at the end of a long way, the
    reading head flies on to the front stop, and stays there, through all gentle moves, until another hard braking in
    the other sense throws it back. Amplitude to either side."""
    x, hard = scene.reading[:, p["axis"]], scene.acceleration >= scene.acceleration.max()
    side, thrown = p["first_side"], np.empty(scene.size)
    for k in range(scene.size):
        if k and hard[k] and abs(x[k] - x[k - 1]) > p["leaves_after_mm"]:
            side = np.sign(x[k] - x[k - 1])
        thrown[k] = side
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * thrown))


def draw_charged(scene, rng):
    height = (scene.part_point - BALL * scene.part_normal)[:, 2]
    return {
        "amplitude_um": 1.0,
        "reach_mm": rng.uniform(0.25, 0.5) * float(np.ptp(height)),
        "tau_s": rng.uniform(400, 1200),
    }


def change_charged(scene, p):
    """The frame of the part is of plastic, and is wiped with a dry cloth whenever it has been placed: its charge draws
    the thin stylus down to it, when this lies, with the cube of its length. Low balls suffer most, high ones
    are out of reach, and the charge leaks off in the course of the placement. Amplitude at the longest lying stylus, at
    the lowest ball, right after wiping."""
    height = (scene.part_point - BALL * scene.part_normal)[:, 2]
    placed = np.array([scene.time[scene.setup == k].min() for k in scene.setup])
    charge = np.exp(-(scene.time - placed) / p["tau_s"] - (height - height.min()) / p["reach_mm"])
    up = scene.turn[:, :, 2]
    across = up - scene.shank * np.sum(up * scene.shank, 1, keepdims=True)
    return Change(tip=p["amplitude_um"] * across * (charge * (scene.length / scene.length.max()) ** 3)[:, None])


unknown("peeling_tape", draw_tape, change_tape, ["time", "position", "feature"])
unknown("unscrewing_balls", draw_unscrewing, change_unscrewing, ["feature", "time", "position"])
unknown("turning_stylus", draw_bent, change_bent, ["time", "sensor", "head"])
unknown("forgotten_lever", draw_lever, change_lever, ["position", "head", "sensor", "feature"])
unknown("curling_ram", draw_curling, change_curling, ["temperature", "position", "feature", "setup"], "D")
unknown("unlocked_pallet", draw_pallet, change_pallet, ["setup", "speed", "direction"], "D")
unknown("thrown_reader", draw_thrown, change_thrown, ["acceleration", "time", "position"], "D")
unknown("charged_frame", draw_charged, change_charged, ["time", "head", "sensor", "feature", "setup"], "D")
