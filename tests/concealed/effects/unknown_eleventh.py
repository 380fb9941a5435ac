"""The strangers of the eleventh final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change, vector
from .unknown import unknown


def draw_screw(scene, rng):
    axis = "xyz".index(scene.machine.chain[1])
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "held_end": rng.choice([-1.0, 1.0]),
        "from_mm": float(scene.reading[:, axis].min()),
        "to_mm": float(scene.reading[:, axis].max()),
        "tau_s": rng.uniform(80, 240),
    }


def change_screw(scene, p):
    """The carriage on the bridge has no scale but a ball screw with an encoder on its shaft. The screw warms wherever
    the nut runs to and fro, piece by piece, and cools in the pauses. All warm pieces between the nut and the bearing
    that holds one end push the nut away from this end, farther than the encoder says. Amplitude where and when this
    is most."""
    x, edges = scene.reading[:, p["axis"]], np.linspace(p["from_mm"], p["to_mm"], 41)
    low, high, piece = edges[:-1], edges[1:], edges[1] - edges[0]
    heat, grown = np.zeros(len(low)), np.zeros(scene.size)
    for k in range(1, scene.size):
        run = np.minimum(high, max(x[k - 1], x[k])) - np.maximum(low, min(x[k - 1], x[k]))
        heat = heat * np.exp(-(scene.time[k] - scene.time[k - 1]) / p["tau_s"]) + np.maximum(run, 0)
        between = high - x[k] if p["held_end"] > 0 else x[k] - low
        grown[k] = np.sum(heat * np.clip(between / piece, 0, 1))
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * p["held_end"] * grown / grown.max()))


def draw_oil(scene, rng):
    return {"amplitude_um": 1.0, "width_deg": rng.uniform(14, 22), "wiped": rng.uniform(0.5, 0.8)}


def change_oil(scene, p):
    """The balls have been oiled against rust. The tip rides on the film, and wipes a good part of it off around the
    place that it touches: a touch that comes near the place of an earlier one, on the same ball, goes deeper. The tip
    radius has taken the mean. Amplitude of the whole film."""
    names, film = np.array(scene.feature), np.ones(scene.size)
    for ball in np.unique(names):
        mine = np.flatnonzero(names == ball)
        for k in range(1, len(mine)):
            near = scene.part_normal[mine[:k]] @ scene.part_normal[mine[k]]
            away = np.degrees(np.arccos(np.clip(near, -1, 1))) / p["width_deg"]
            film[mine[k]] = np.prod(1 - p["wiped"] * np.exp(-0.5 * away**2))
    return Change(along=p["amplitude_um"] * (film - film.mean()))


def draw_sleepy(scene, rng):
    return {"amplitude_um": 1.0, "awake_s": rng.uniform(6, 9), "tau_s": rng.uniform(4, 12)}


def change_sleepy(scene, p):
    """A radio probe saves its battery and falls asleep when nothing is touched for some seconds, the deeper the longer.
    The first touch after the way to another ball wakes it: its signal is late, and the machine goes on meanwhile. All
    other touches are right. Amplitude at 8 mm/s after a long sleep."""
    rest = np.diff(scene.time, prepend=scene.time[0] - 60) - p["awake_s"]
    asleep = 1 - np.exp(-np.maximum(rest, 0) / p["tau_s"])
    return Change(tip=scene.travel * (p["amplitude_um"] * asleep * scene.speed / 8)[:, None])


def draw_fibres(scene, rng):
    return {
        "amplitude_um": 1.0,
        "fibres_deg": rng.uniform(0, 180),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_fibres(scene, p):
    """The frame of the part is of carbon fibre, and grows with every kelvin across the fibres only. The software knows
    the mean of both expansions: across the fibres the part is longer than it believes, along them shorter. Amplitude
    at the end of the part, for 1 K away from 20 degrees."""
    a = np.radians(p["fibres_deg"])
    along, across = np.array([np.cos(a), np.sin(a), 0.0]), np.array([-np.sin(a), np.cos(a), 0.0])
    longer = (scene.part_point @ across) * (scene.part_normal @ across)
    shorter = (scene.part_point @ along) * (scene.part_normal @ along)
    warmer = scene.temperature["part"] - 20
    return Change(along=p["amplitude_um"] * warmer * (longer - shorter) / p["half_size_mm"])


def draw_press(scene, rng):
    turn = rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "direction": [float(np.cos(turn)), float(np.sin(turn)), 0.0],
        "period_s": rng.uniform(40, 90),
        "first_s": rng.uniform(0, 40),
        "tau_s": rng.uniform(5, 10),
    }


def change_press(scene, p):
    """A large press works in the next hall, stroke after stroke. Each one makes the floor give way to the same side,
    the machine swings over on its soft feet and creeps back within seconds: only a touch soon after a stroke is off.
    Amplitude right after a stroke."""
    since = np.mod(scene.time - p["first_s"], p["period_s"])
    return Change(tip=vector(p["direction"], p["amplitude_um"] * np.exp(-since / p["tau_s"])))


def draw_forgotten(scene, rng):
    return {"amplitude_um": 1.0, "phase": rng.uniform(0, 2 * np.pi)}


def change_forgotten(scene, p):
    """The machine had a fixed probe with three lobes before it got its head. The controller still corrects every touch
    for these, by the direction of the approach in the machine, however the head stands now; the new probe has none.
    Amplitude of the lobes for horizontal touches."""
    azimuth = np.arctan2(scene.normal[:, 1], scene.normal[:, 0])
    return Change(along=p["amplitude_um"] * np.cos(3 * azimuth + p["phase"]) * (1 - scene.normal[:, 2] ** 2))


def draw_struck(scene, rng):
    return {"amplitude_um": 1.0, "foot_mm": rng.uniform(10, 30)}


def change_struck(scene, p):
    """The balls stand on thin posts of unequal height. The tip strikes them, and until the probe has triggered the post
    bends: with the cube of its height, with the speed, and for touches from the side only; then it springs back.
    Amplitude at the tallest post, from the side, at 8 mm/s."""
    height = (scene.part_point - BALL * scene.part_normal)[:, 2]
    height = height - height.min() + p["foot_mm"]
    sideways = 1 - scene.part_normal[:, 2] ** 2
    return Change(along=-p["amplitude_um"] * (height / height.max()) ** 3 * sideways * scene.speed / 8)


def draw_sister(scene, rng):
    other = rng.normal(size=(9, 3)) * [1, 1, 0.5]
    return {
        "amplitude_um": 1.0,
        "placement": int(rng.choice(np.unique(scene.setup))),
        "other_places": (other / np.sqrt(np.mean(other**2))).tolist(),
    }


def change_sister(scene, p):
    """There are two parts of the same kind, and in one placement the operator takes the sister from the shelf by
    mistake. Its balls are not quite where the certificate of the first one has them, each by its own small vector.
    Amplitude is the root of the mean square of these."""
    ball = [int(f.removeprefix("BALL")) - 1 for f in scene.feature]
    away = np.sum(np.asarray(p["other_places"])[ball] * scene.part_normal, 1)
    return Change(along=p["amplitude_um"] * away * (scene.setup == p["placement"]))


unknown("warm_screw", draw_screw, change_screw, ["time", "position", "feature"])
unknown("wiped_oil", draw_oil, change_oil, ["feature", "direction", "time"])
unknown("sleepy_probe", draw_sleepy, change_sleepy, ["time", "speed"])
unknown("fibre_frame", draw_fibres, change_fibres, ["temperature", "feature", "position", "setup"], "D")
unknown("stamping_press", draw_press, change_press, ["time"])
unknown("forgotten_lobes", draw_forgotten, change_forgotten, ["direction", "head", "sensor"])
unknown("struck_posts", draw_struck, change_struck, ["feature", "speed", "direction"], "D")
unknown("sister_part", draw_sister, change_sister, ["setup", "feature", "position"], "D")
