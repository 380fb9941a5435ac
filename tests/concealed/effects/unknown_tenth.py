"""The strangers of the tenth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np

from .base import Change, vector
from .unknown import unknown


def draw_latch(scene, rng):
    return {
        "amplitude_um": 1.0,
        "late": rng.permutation([-1.0, 0.0, 1.0]),
        "qualified_at_mm_s": rng.uniform(4.4, 5.6),
    }


def change_latch(scene, p):
    """The controller latches the three scales one after another, not at once: the first axis is read too early, the
    last one too late, in proportion to the speed. The map of the tip has taken what there was at the speed of its
    qualification. Amplitude along these axes, from the slowest to the fastest."""
    faster = (scene.speed - p["qualified_at_mm_s"]) / 6
    return Change(tip=scene.travel * np.outer(p["amplitude_um"] * faster, p["late"]))


def draw_counts(scene, rng):
    axis = int(rng.integers(2))
    x = scene.reading[:, axis]
    spot = float(np.quantile(x, rng.uniform(0.35, 0.65)))
    ways = np.abs(np.diff(x))[(x[1:] > spot) != (x[:-1] > spot)]
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "spot_mm": spot,
        "mark_mm": float(np.quantile(x, rng.choice([rng.uniform(0.1, 0.2), rng.uniform(0.8, 0.9)]))),
        "fast_beyond_mm": float(np.quantile(ways, rng.uniform(0.3, 0.6))),
    }


def change_counts(scene, p):
    """There is dirt on a scale. On a long way the carriage is at full speed when it comes there, and loses a count: it
    reads too low after a way up and too high after a way down. Short ways lose nothing, so that the counts do not
    balance. A reference mark farther on puts it right whenever it is passed. Amplitude for one count."""
    x, spot, mark = scene.reading[:, p["axis"]], p["spot_mm"], p["mark_mm"]
    lost, balance = np.zeros(scene.size), 0.0
    for k in range(1, scene.size):
        way = x[k] - x[k - 1]
        at_spot, at_mark = ((x[k] > place) != (x[k - 1] > place) for place in (spot, mark))
        if at_mark:
            balance = 0.0
        if at_spot and abs(way) > p["fast_beyond_mm"] and not (at_mark and way * (mark - spot) > 0):
            balance -= np.sign(way)
        lost[k] = balance
    return Change(tip=vector(np.eye(3)[p["axis"]], p["amplitude_um"] * lost))


def draw_swapped(scene, rng):
    return {"amplitude_um": 1.0, "swapped": [int(k) for k in rng.permutation(2)]}


def change_swapped(scene, p):
    """The temperature sensors of x and y are plugged in the wrong way round. Each scale, held in its middle, is
    corrected for the temperature of the other one: where one is read too long, the other is read too short.
    Amplitude at the ends of the longer scale, for a difference of 1 K."""
    warmer = scene.temperature["xyz"[p["swapped"][0]]] - scene.temperature["xyz"[p["swapped"][1]]]
    away = scene.reading - (scene.reading.min(0) + scene.reading.max(0)) / 2
    longer = np.abs(away[:, p["swapped"]]).max()
    tip = np.zeros((scene.size, 3))
    for k, sign in zip(p["swapped"], (-1, 1)):
        tip[:, k] = sign * p["amplitude_um"] * warmer * away[:, k] / longer
    return Change(tip=tip)


def draw_levelling(scene, rng):
    along = "xyz".index(scene.machine.chain[0])
    turn = rng.uniform(np.pi / 3, 2 * np.pi / 3)
    direction = np.array([np.cos(turn), np.sin(turn), 0.0])
    return {
        "amplitude_um": rng.choice([-1.0, 1.0]),
        "along": along,
        "direction": direction if along == 0 else direction[[1, 0, 2]],
        "tau_s": rng.uniform(15, 40),
    }


def change_levelling(scene, p):
    """The machine floats on three air springs, two at one end. When its heavy bridge goes to another place the table
    sinks, mostly to one side, and the ram swings across, until the valves have levelled it: slowly, so that the first
    touches after a long way suffer most. Amplitude right after a way over the whole part."""
    x = scene.reading[:, p["along"]]
    level, lean = x[0], np.zeros(scene.size)
    for k in range(1, scene.size):
        level = x[k - 1] + (level - x[k - 1]) * np.exp(-(scene.time[k] - scene.time[k - 1]) / p["tau_s"])
        lean[k] = (x[k] - level) / np.ptp(x)
    return Change(tip=vector(p["direction"], p["amplitude_um"] * lean))


def draw_hands(scene, rng):
    return {
        "amplitude_um": 1.0,
        "across": int(rng.integers(2)),
        "side": rng.choice([-1.0, 1.0]),
        "tau_s": rng.uniform(200, 600),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_hands(scene, p):
    """The operator takes the part by one side whenever it is placed: this side is warm and long, the other one is not,
    and the part is bent in its plane until the heat has spread. The software knows the temperature of the middle.
    Amplitude at the corners, right after placing."""
    i, j = 1 - p["across"], p["across"]
    u, v, w = scene.part_point[:, i], p["side"] * scene.part_point[:, j], scene.part_point[:, 2]
    u, v, w = u / p["half_size_mm"], v / p["half_size_mm"], w / p["half_size_mm"]
    moved = np.zeros((scene.size, 3))
    moved[:, i], moved[:, j], moved[:, 2] = u * v, p["side"] * (v**2 - u**2 - w**2) / 2, w * v
    placed = np.array([scene.time[scene.setup == k].min() for k in scene.setup])
    warm = np.exp(-(scene.time - placed) / p["tau_s"])
    return Change(along=p["amplitude_um"] * warm * np.sum(moved * scene.part_normal, 1))


def draw_plume(scene, rng):
    axis = int(rng.integers(2))
    x = scene.reading[:, axis]
    return {
        "amplitude_um": 1.0,
        "axis": axis,
        "laser_end": rng.choice([-1.0, 1.0]),
        "heater_mm": float(np.quantile(x, rng.uniform(0.35, 0.65))),
        "width_mm": 0.06 * float(np.ptp(x)),
        "switched_s": np.quantile(scene.time, (np.arange(6) + rng.uniform(0.1, 0.9, 6)) / 6),
        "tau_s": rng.uniform(40, 120),
    }


def change_plume(scene, p):
    """One axis is measured with a laser, and a heater that stands under its beam is switched on and off. The light goes
    faster through the warm air that rises there, but only where the carriage is beyond it; nearer to the laser all is
    well. Amplitude beyond a heater that has been on for long."""
    since = scene.time[:, None] - np.asarray(p["switched_s"])
    warm = np.sum((1 - np.exp(-np.maximum(since, 0) / p["tau_s"])) * [1, -1, 1, -1, 1, -1], 1)
    away = p["laser_end"] * (scene.reading[:, p["axis"]] - p["heater_mm"]) / p["width_mm"]
    beyond = 1 / (1 + np.exp(away))
    return Change(tip=vector(np.eye(3)[p["axis"]], p["laser_end"] * p["amplitude_um"] * warm * beyond))


def draw_rubber(scene, rng):
    return {
        "amplitude_um": 1.0,
        "twist": rng.uniform(0.3, 1),
        "half_size_mm": float(np.abs(scene.part_point[:, :2]).max()),
    }


def change_rubber(scene, p):
    """The part stands on rubber feet, and every touch tips and twists it a little: the surface yields with the square
    of the lever that the touch has about the middle, and comes back. The tip radius has taken the mean. Amplitude at a
    lever of half the part."""
    moment = np.cross(scene.part_point / p["half_size_mm"], scene.part_normal)
    yields = moment[:, 0] ** 2 + moment[:, 1] ** 2 + p["twist"] * moment[:, 2] ** 2
    return Change(along=-p["amplitude_um"] * (yields - yields.mean()))


def draw_clutch(scene, rng):
    return {"amplitude_um": 1.0, "held": rng.uniform(0.05, 0.25)}


def change_clutch(scene, p):
    """The clutch of the head slips. Every touch that comes from the side of a lying stylus, with a larger moment about
    the vertical than friction holds, turns the head on a little; only the next indexing brings it back. Amplitude at
    the longest stylus, where it has slipped farthest."""
    lying = np.cross([0, 0, 1.0], scene.arm / scene.length.max())
    moment = -np.sum(lying * scene.normal, 1)
    slip = np.sign(moment) * np.maximum(np.abs(moment) - p["held"], 0)
    turned = np.zeros(scene.size)
    for k in np.unique(scene.visit):
        mine = scene.visit == k
        turned[mine] = np.cumsum(slip[mine]) - slip[mine]
    return Change(tip=-p["amplitude_um"] * (turned / np.abs(turned).max())[:, None] * lying)


unknown("staggered_latch", draw_latch, change_latch, ["speed", "direction"], "D")
unknown("lost_counts", draw_counts, change_counts, ["time", "position"], "D")
unknown("swapped_sensors", draw_swapped, change_swapped, ["temperature", "position", "feature", "setup"], "D")
unknown("slow_levelling", draw_levelling, change_levelling, ["time", "position", "feature"])
unknown("warm_hands", draw_hands, change_hands, ["time", "feature", "position", "setup"])
unknown("heat_plume", draw_plume, change_plume, ["time", "position", "feature"])
unknown("rubber_feet", draw_rubber, change_rubber, ["feature", "direction", "position"])
unknown("slipping_clutch", draw_clutch, change_clutch, ["head", "sensor", "time", "direction"])
