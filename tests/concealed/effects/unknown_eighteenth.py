"""The strangers of the eighteenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def half_size(scene):
    return float(np.abs(scene.part_point[:, :2]).max())


def draw_corners(scene, rng):
    return {"amplitude_um": 1.0, "right_at": float(rng.uniform(0.8, 1.2))}


def change_corners(scene, p):
    """The software was told that the form is unknown, and does not trust the vectors of the program alone: of the
    touches of a ball it draws a line through the neighbours before and after, and leans the vector of the touch between
    towards the right angle with this line. The tip radius is then corrected a little aslant, with the square of how far
    the line misses the tangent; the first and the last touch of a ball have but one neighbour and are right. The tip
    radius has taken the mean, or nearly. Amplitude of the largest tip, if the line ran straight into the surface."""
    inner = np.flatnonzero((scene.block[1:-1] == scene.block[:-2]) & (scene.block[1:-1] == scene.block[2:])) + 1
    line = scene.target[inner + 1] - scene.target[inner - 1]
    line /= np.maximum(np.linalg.norm(line, axis=1, keepdims=True), 1e-9)
    aslant = np.zeros(scene.size)
    aslant[inner] = np.sum(line * scene.normal[inner], 1) ** 2 * scene.tip_radius[inner] / scene.tip_radius.max()
    return Change(along=p["amplitude_um"] * (aslant - p["right_at"] * aslant.mean()))


def draw_bar(scene, rng):
    low, size = scene.target.min(0), np.ptp(scene.target, axis=0)
    place = low + rng.uniform([-0.1, -0.1, -0.6], [1.1, 1.1, -0.2]) * size
    return {
        "amplitude_um": 1.0,
        "socket_mm": [float(v) for v in place],
        "wave_mm": float(rng.uniform(0.35, 0.6) * size[:2].mean()),
        "phase": float(rng.uniform(0, 2 * np.pi)),
    }


def change_bar(scene, p):
    """The errors of the machine were mapped with a telescopic ball bar, which was swung round a single socket on the
    table. The scale inside the bar has an error that comes and goes with its length, and the map has taken it for one
    of the machine: shells lie round the socket, in which all is off towards the socket and away from it by turns.
    Amplitude of the wave."""
    way = scene.target - np.asarray(p["socket_mm"])
    far = np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1.0)
    return Change(tip=p["amplitude_um"] * np.sin(2 * np.pi * far / p["wave_mm"] + p["phase"]) * way / far)


def draw_frog(scene, rng):
    return {
        "amplitude_um": 1.0,
        "first": float(rng.choice([-1.0, 1.0])),
        "ring": float(rng.choice([rng.uniform(0.55, 0.8), rng.uniform(1.1, 1.25)])),
        "held": float(np.quantile(scene.part_normal[:, 2], rng.uniform(0.75, 0.9))),
        "half_size_mm": half_size(scene),
    }


def change_frog(scene, p):
    """The plate of the part is thin and has been welded under tension: like a tin frog it has two shapes, a dome and a
    bowl, and it lies on a ring. A firm touch from above on a ball inside the ring makes it click into the bowl, one on
    a ball outside the ring back into the dome, and there it stays until it clicks again. The touch itself has triggered
    before. The certificate has what lies between. Amplitude of either shape, at half the size of the part from its
    middle."""
    u, v, z = (scene.part_point / p["half_size_mm"]).T
    middle = centres(scene)[:, :2] / p["half_size_mm"]
    outside = np.linalg.norm(middle, axis=1) > p["ring"]
    firm = scene.part_normal[:, 2] > p["held"]
    shape, state = p["first"], np.empty(scene.size)
    for k in range(scene.size):
        state[k] = shape
        if firm[k]:
            shape = 1.0 if outside[k] else -1.0
    moved = np.column_stack([2 * z * u, 2 * z * v, 0.7 - u**2 - v**2])
    return Change(along=p["amplitude_um"] * state * np.sum(moved * scene.part_normal, 1))


def draw_bench(scene, rng):
    count = int(rng.integers(4, 7))
    began = ((np.arange(count) + rng.uniform(0.05, 0.45, count)) / count * scene.size).astype(int)
    ended = np.minimum(began + (rng.uniform(0.6, 1.4, count) / count * scene.size).astype(int), scene.size - 1)
    half = half_size(scene)
    return {
        "amplitude_um": 1.0,
        "laid_down_s": [float(scene.time[k]) + 0.5 for k in began],
        "taken_away_s": [float(scene.time[k]) + 0.5 for k in ended],
        "placement": [int(scene.setup[k]) for k in began],
        "place_mm": [[float(v) for v in rng.uniform(-0.9, 0.9, 2) * half] for _ in began],
        "weight": [float(v) for v in rng.uniform(0.6, 1, count)],
        "width_mm": float(rng.uniform(0.35, 0.6) * half),
    }


def change_bench(scene, p):
    """While the machine is at work the operator puts down on the part what he happens to have in his hands: a vice, a
    box of gauge blocks, his thermos flask. The plate sinks around each of them, and the balls near by sink and lean
    towards it, until he takes it away again, at the latest when the part is placed anew. Amplitude of the deepest place
    under the heaviest thing."""
    low, lean = np.zeros(scene.size), np.zeros((scene.size, 2))
    things = zip(p["laid_down_s"], p["taken_away_s"], p["placement"], p["place_mm"], p["weight"])
    for since, until, placement, place, weight in things:
        lies = (scene.time >= since) & (scene.time < until) & (scene.setup == placement)
        away = (scene.part_point[:, :2] - np.asarray(place)) / p["width_mm"]
        sunk = weight * lies * np.exp(-0.5 * np.sum(away**2, 1))
        low += sunk
        lean -= sunk[:, None] * away * (scene.part_point[:, 2] / p["width_mm"])[:, None]
    return Change(along=-p["amplitude_um"] * np.sum(np.column_stack([lean, low]) * scene.part_normal, 1))


def draw_resin(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    pulls = rng.normal(size=(len(names), 3))
    pulls -= pulls.mean(0)
    pulls /= np.sqrt(np.mean(pulls**2))
    return {
        "amplitude_um": 1.0,
        "pulls": {f: [float(v) for v in pull] for f, pull in zip(names, pulls)},
        "swells": float(rng.uniform(0.6, 1.4)),
        "hot_s": float(scene.duration * rng.uniform(0.08, 0.2)),
        "hard_s": float(scene.duration * rng.uniform(0.3, 0.7)),
    }


def change_resin(scene, p):
    """The balls have been cast into their sockets with resin only this morning. While it hardens it is hot and swells
    at first, then it cools and shrinks, for hours: every ball is drawn to where its socket has most resin, each another
    way, first away from it and then towards it. Amplitude of the whole shrinkage, the root of the mean square of its
    coordinates."""
    q = scene.time / p["hot_s"]
    drawn = 1 - np.exp(-scene.time / p["hard_s"]) - p["swells"] * q * np.exp(1 - q)
    pulls = np.array([p["pulls"].get(f, (0.0, 0.0, 0.0)) for f in scene.feature])
    return Change(along=p["amplitude_um"] * drawn * np.sum(pulls * scene.part_normal, 1))


def draw_pins(scene, rng):
    placement, turn = int(rng.choice(np.unique(scene.setup))), rng.uniform(0, np.pi)
    warm = scene.temperature["part"]
    return {
        "amplitude_um": float(rng.choice([-1.0, 1.0])),
        "placement": placement,
        "pins": [float(np.cos(turn)), float(np.sin(turn)), 0.0],
        "pressed_in_at_C": float((warm.min() + warm.max()) / 2 + rng.uniform(-0.4, 0.4)),
        "bows": float(rng.uniform(0.5, 1.2)),
        "half_size_mm": half_size(scene),
    }


def change_pins(scene, p):
    """In one placement the part is pressed on two pins of a fixture of another metal, where one pin and a slot would
    be right. With every kelvin the fixture pulls the part apart along the line of the pins, or pushes it together; and
    as it does so from below the plate bows along this line, and gives way across it by a third. Placed otherwise
    the part is free. Amplitude at half the size of the part along the line, for 1 K."""
    a = np.asarray(p["pins"])
    b = np.array([-a[1], a[0], 0.0])
    u, v, z = scene.part_point @ a, scene.part_point @ b, scene.part_point[:, 2]
    u, v, z = u / p["half_size_mm"], v / p["half_size_mm"], z / p["half_size_mm"]
    along, across = scene.part_normal @ a, scene.part_normal @ b
    strained = along * u * (1 - 2 * p["bows"] * z) - 0.3 * across * v + scene.part_normal[:, 2] * p["bows"] * u**2
    warmer = (scene.temperature["part"] - p["pressed_in_at_C"]) * (scene.setup == p["placement"])
    return Change(along=p["amplitude_um"] * warmer * strained)


def draw_wrist(scene, rng):
    return {"amplitude_um": 1.0, "leans": float(rng.uniform(0, 2 * np.pi))}


def change_wrist(scene, p):
    """To save time the head leaves its angle B alone when the stylus shall hang straight down, as B is then without
    meaning: it stays as the orientation before has left it. But the stylus does not hang quite straight, and its tip
    stands somewhere else on a small circle, while the software believes it where it was when B was nought. All other
    orientations are right. Amplitude is the radius of the circle of the longest stylus."""
    _, first, index = np.unique(scene.visit, return_index=True, return_inverse=True)
    left, at = 0.0, np.zeros(len(first))
    for k, touch in enumerate(first):
        hangs = abs(scene.a[touch]) < 1e-6
        left = left if hangs else float(scene.b[touch])
        at[k] = left if hangs else 0.0
    turned = at[index] + p["leans"]
    moved = np.column_stack([np.cos(turned) - np.cos(p["leans"]), np.sin(turned) - np.sin(p["leans"]), 0 * turned])
    return Change(tip=p["amplitude_um"] * moved * (scene.length / scene.length.max())[:, None])


def draw_rubber(scene, rng):
    return {"amplitude_um": 1.0, "rests_s": float(rng.uniform(50, 160))}


def change_rubber(scene, p):
    """The stylus is held by a membrane of rubber. Every touch kneads it, a fast one much more than a slow one, and
    kneaded rubber is soft until it has had its rest: after a series of fast touches a stylus that is touched from the
    side yields more, whatever the speed of this touch itself, after slow ones or a pause less. The tip radius has taken
    the mean. Amplitude from the most rested to the most kneaded, for touches across the stylus."""
    soft, kneaded = 0.0, np.zeros(scene.size)
    for k in range(1, scene.size):
        soft = (soft + (scene.speed[k - 1] / 8) ** 2) * np.exp(-(scene.time[k] - scene.time[k - 1]) / p["rests_s"])
        kneaded[k] = soft
    across = 1 - np.sum(scene.normal * scene.shank, 1) ** 2
    return Change(along=-p["amplitude_um"] * across * (kneaded - kneaded.mean()) / np.ptp(kneaded))


unknown("cut_corners", draw_corners, change_corners, ["direction", "time", "feature", "sensor"])
unknown("swung_bar", draw_bar, change_bar, ["position", "feature"])
unknown("clicking_frog", draw_frog, change_frog, ["time", "feature", "position", "direction"])
unknown("cluttered_bench", draw_bench, change_bench, ["time", "feature", "position"])
unknown("young_resin", draw_resin, change_resin, ["time", "feature", "position"])
unknown("stubborn_pins", draw_pins, change_pins, ["setup", "temperature", "feature", "position"], "D")
unknown("idle_wrist", draw_wrist, change_wrist, ["head", "sensor", "time"], "D")
unknown("kneaded_rubber", draw_rubber, change_rubber, ["speed", "time", "direction"], "D")
