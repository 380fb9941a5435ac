"""The strangers of the thirteenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, vector
from .unknown import unknown


def draw_crane(scene, rng):
    count, turn = int(rng.integers(4, 7)), rng.uniform(0, 2 * np.pi)
    return {
        "amplitude_um": 1.0,
        "way": [float(np.cos(turn)), float(np.sin(turn)), 0.0],
        "passes_s": np.quantile(scene.time, (np.arange(count) + rng.uniform(0.2, 0.8, count)) / count),
        "senses": rng.choice([-1.0, 1.0], count),
        "near_s": rng.uniform(25, 55),
    }


def change_crane(scene, p):
    """A heavy crane drives through the hall, past the machine, and back some time later. The floor leans towards it,
    the slender bridge follows: first to where the crane comes from, then across, then to where it goes. Amplitude
    across, when the crane is nearest."""
    way = np.asarray(p["way"])
    across = np.array([-way[1], way[0], 0.0])
    place = (scene.time[:, None] - np.asarray(p["passes_s"])) * np.asarray(p["senses"]) / p["near_s"]
    lean = 1 / (1 + place**2) ** 1.5
    return Change(tip=p["amplitude_um"] * (vector(across, np.sum(lean, 1)) + vector(way, np.sum(place * lean, 1))))


def draw_commutation(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axis": int(rng.integers(2)),
        "poles_mm": rng.uniform(45, 80),
        "phase": rng.uniform(0, 2 * np.pi),
    }


def change_commutation(scene, p):
    """A linear motor is commutated wrongly, and its carriage goes now faster, now slower than the controller commands,
    from pole to pole of the magnets. The delay of the probe is taken off for the commanded speed: in between, a touch
    along this axis comes too early, at the poles too late, from either side. Amplitude at 8 mm/s along the axis."""
    i = p["axis"]
    faster = np.sin(2 * np.pi * scene.reading[:, i] / p["poles_mm"] + p["phase"])
    return Change(tip=vector(np.eye(3)[i], p["amplitude_um"] * faster * scene.travel[:, i] * scene.speed / 8))


def draw_swarf(scene, rng):
    count = int(rng.integers(4, 6))
    push = -np.einsum("nji,nj->ni", scene.head, scene.normal)
    places = (np.arange(count)[:, None] + np.sort(rng.uniform(0, 1, (count, 2)), 1) * [0.3, 0.2] + [0, 0.75]) / count
    picked = [int(k) for k in places[:, 0] * scene.size]
    lost = [int(k) for k in places[:, 1] * scene.size]
    return {
        "amplitude_um": 1.0,
        "picked_up_s": [float(scene.time[k]) + 0.5 for k in picked],
        "lost_s": [float(scene.time[k]) + 0.5 for k in lost],
        "towards": [push[int(rng.integers(a + 1, b + 1))].tolist() for a, b in zip(picked, lost)],
        "length_mm": [float(scene.length[a + 1]) for a in picked],
        "width_deg": rng.uniform(28, 42),
        "squeezed": rng.uniform(0.02, 0.06),
    }


def change_swarf(scene, p):
    """A curl of swarf clings to the tip and goes with it from ball to ball: who touches with this side of the tip
    touches too early. It is squeezed flatter by every such touch, falls off at last, and some time later the next one
    clings to another side. Amplitude of fresh swarf."""
    push = -np.einsum("nji,nj->ni", scene.head, scene.normal)
    proud = np.zeros(scene.size)
    for since, until, towards, length in zip(p["picked_up_s"], p["lost_s"], p["towards"], p["length_mm"]):
        mine = (scene.time >= since) & (scene.time < until) & (scene.length == length)
        angle = np.degrees(np.arccos(np.clip(push[mine] @ np.asarray(towards), -1, 1)))
        here = np.exp(-0.5 * (angle / p["width_deg"]) ** 2)
        proud[mine] = here * (1 - p["squeezed"]) ** (np.cumsum(here) - here)
    return Change(along=p["amplitude_um"] * proud)


def draw_vacuum(scene, rng):
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "period_s": rng.uniform(110, 320),
        "first_s": rng.uniform(0, 320),
        "pumping": rng.uniform(0.1, 0.25),
        "ridge_deg": rng.uniform(0, 180),
        "ridge": rng.uniform(-0.4, 0.4),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_vacuum(scene, p):
    """The part is held down by a vacuum which leaks: slowly the plate springs up in its middle, until the pump starts
    and draws it flat again within a short while, and so on. The certificate is right half way. Amplitude from there to
    either end, at half the size of the part."""
    q = np.mod((scene.time - p["first_s"]) / p["period_s"], 1)
    leaked = np.where(q < 1 - p["pumping"], q / (1 - p["pumping"]), (1 - q) / p["pumping"])
    u, v, z = scene.part_point.T / p["half_size_mm"]
    a = np.radians(p["ridge_deg"])
    c, s = p["ridge"] * np.cos(2 * a), p["ridge"] * np.sin(2 * a)
    rise = (1 + c) * u**2 + (1 - c) * v**2 + 2 * s * u * v
    slope_u, slope_v = 2 * (1 + c) * u + 2 * s * v, 2 * (1 - c) * v + 2 * s * u
    moved = np.column_stack([-z * slope_u, -z * slope_v, rise - rise.mean()])
    return Change(along=-p["amplitude_um"] * (2 * leaked - 1) * np.sum(moved * scene.part_normal, 1))


def draw_baked(scene, rng):
    return {
        "amplitude_um": 1.0,
        "rises_at": rng.uniform(0, 2 * np.pi),
        "goes": rng.choice([-1.0, 1.0]) * np.radians(rng.uniform(40, 90)),
        "height": np.radians(rng.uniform(15, 40)),
        "clouds_s": np.quantile(scene.time, (np.arange(7) + rng.uniform(0.1, 0.9, 7)) / 7),
        "tau_s": rng.uniform(15, 40),
    }


def change_baked(scene, p):
    """Through a window the sun shines on the stylus from one side, and this side grows: the stylus curls away from the
    sun, by the square of its length, and not when it points at the sun. Clouds come and go, and the sun goes on in the
    course of the run. Amplitude of the longest, across the sun."""
    turn = p["rises_at"] + p["goes"] * scene.time / scene.duration
    low = np.cos(p["height"])
    sun = np.column_stack([low * np.cos(turn), low * np.sin(turn), np.full(scene.size, np.sin(p["height"]))])
    since = scene.time[:, None] - np.asarray(p["clouds_s"])
    warm = np.sum((1 - np.exp(-np.maximum(since, 0) / p["tau_s"])) * [1, -1, 1, -1, 1, -1, 1], 1)
    aside = sun - scene.shank * np.sum(sun * scene.shank, 1, keepdims=True)
    return Change(tip=p["amplitude_um"] * aside * (warm * (scene.length / scene.length.max()) ** 2)[:, None])


def draw_address(scene, rng):
    table = rng.normal(size=(9, 5))
    return {
        "amplitude_um": 1.0,
        "axis": int(rng.integers(2)),
        "coordinate": int(rng.integers(3)),
        "bit": int(rng.choice([2, 4])),
        "table": (table / np.sqrt(np.mean(table**2))).tolist(),
    }


def change_address(scene, p):
    """One line of the address bus of the controller is broken, and a bit of the row number always reads nought: of the
    correction table over x and y, some rows are right, and in place of the others it takes rows from farther down. It
    interpolates between whatever it gets. Amplitude is the root of the mean square of the table."""
    i, table = p["axis"], np.asarray(p["table"])
    low = scene.reading[:, :2].min(0)
    share = (scene.reading[:, :2] - low) / np.ptp(scene.reading[:, :2], axis=0)
    u, v = 8 * share[:, i], 4 * share[:, 1 - i]
    row, column = np.minimum(u.astype(int), 7), np.minimum(v.astype(int), 3)
    u, v = u - row, v - column

    def entry(k, j):
        return table[k & ~p["bit"], j] - table[k, j]

    near = (1 - v) * entry(row, column) + v * entry(row, column + 1)
    far = (1 - v) * entry(row + 1, column) + v * entry(row + 1, column + 1)
    return Change(tip=vector(np.eye(3)[p["coordinate"]], p["amplitude_um"] * ((1 - u) * near + u * far)))


def fetched(scene):
    """How often a module with another length of stylus has been fetched from the rack."""
    return np.cumsum(np.diff(scene.length, prepend=scene.length[0]) != 0)


def draw_burr(scene, rng):
    count, turn, lean = int(fetched(scene).max()) + 1, rng.uniform(0, 2 * np.pi), np.radians(rng.uniform(15, 50))
    return {
        "amplitude_um": 1.0,
        "astride": [bool(k) for k in rng.permutation(count) < round(0.45 * count)],
        "moves": [float(np.cos(lean) * np.cos(turn)), float(np.cos(lean) * np.sin(turn)), float(np.sin(lean))],
    }


def change_burr(scene, p):
    """One of the seats to which the modules of the styli snap has a burr. A module that is fetched from the rack finds
    home or sits astride the burr, as it happens, until the next one is fetched: astride it is lifted and leans to the
    same side of the head in all orientations, a long stylus farther. Amplitude at the longest, if it only leaned."""
    astride = np.asarray(p["astride"], float)[fetched(scene)]
    aside, lifted = np.asarray(p["moves"]) * [1, 1, 0], np.asarray(p["moves"]) * [0, 0, 1]
    moved = np.outer(scene.length / scene.length.max(), aside) + lifted
    return Change(tip=p["amplitude_um"] * astride[:, None] * np.einsum("nij,nj->ni", scene.head, moved))


def draw_oil(scene, rng):
    air = scene.temperature["air"]
    return {"amplitude_um": 1.0, "set_at_C": float((air.min() + air.max()) / 2 + rng.uniform(-0.4, 0.4))}


def change_oil(scene, p):
    """A measuring probe is damped with silicone oil, which is thick in the cold and thin in the warm: its reading limps
    behind the tip by more or less than the software takes off, in proportion to the speed. Along the stylus the probe
    has no oil. Amplitude for 1 K colder, at 8 mm/s across the stylus."""
    across = scene.travel - scene.shank * np.sum(scene.travel * scene.shank, 1, keepdims=True)
    thick = p["set_at_C"] - scene.temperature["air"]
    return Change(tip=-across * (p["amplitude_um"] * thick * scene.speed / 8)[:, None])


unknown("passing_crane", draw_crane, change_crane, ["time"])
unknown("wrong_commutation", draw_commutation, change_commutation, ["position", "direction", "speed", "feature"])
unknown("clinging_swarf", draw_swarf, change_swarf, ["direction", "time", "sensor", "head"])
unknown("leaking_vacuum", draw_vacuum, change_vacuum, ["time", "feature", "position"])
unknown("baked_stylus", draw_baked, change_baked, ["time", "head", "sensor"])
unknown("broken_address", draw_address, change_address, ["position", "feature"])
unknown("burred_module", draw_burr, change_burr, ["time", "sensor", "head"], "D")
unknown("damping_oil", draw_oil, change_oil, ["temperature", "speed", "direction"], "D")
