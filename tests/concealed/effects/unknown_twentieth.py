"""The strangers of the twentieth final round, which everybody knows now. They register themselves with those of
`unknown.py`."""

from portable import np
from scene import BALL

from .base import Change, unit
from .unknown import unknown


def centres(scene):
    """Middle of the ball that is touched, in the part."""
    return scene.part_point - BALL * scene.part_normal


def half_size(scene):
    return float(np.abs(scene.part_point[:, :2]).max())


def draw_insert(scene, rng):
    half = half_size(scene)
    turn, out = rng.uniform(0, 2 * np.pi), rng.uniform(0.3, 0.8) * half
    begins = np.arange(int(0.25 * scene.size), int(0.6 * scene.size))
    soon = np.minimum(begins + 40, scene.size - 1)
    busy = np.flatnonzero(scene.time[soon] - scene.time[begins] < 700)  # no long pause soon after it
    busy = busy if len(busy) else np.arange(len(begins))
    return {
        "amplitude_um": 1.0,
        "place_mm": [float(np.cos(turn) * out), float(np.sin(turn) * out)],
        "width_mm": float(rng.uniform(0.2, 0.3) * half),
        "spreads_mm2_per_s": float(rng.uniform(0.5, 0.9)),
        "cools_s": float(rng.uniform(1200, 2500)),
        "shrunk_in_s": float(rng.choice(scene.time[begins[busy]])) + 0.5,
    }


def change_insert(scene, p):
    """The plate of the part is of stone. In the course of the run somebody finds that an insert of steel is
    loose in it, and shrinks it in again, red-hot. The heat spreads in the plate as it does in a sheet, and is
    lost to the air bit by bit: the balls are pushed away from the insert, in the hot spot in proportion to
    their distance, outside of it with one over the distance. Amplitude at the edge of the hot spot, when the
    insert has just been put in."""
    away = centres(scene)[:, :2] - np.asarray(p["place_mm"])
    far = np.maximum(np.linalg.norm(away, axis=1), 1.0)
    since = np.maximum(scene.time - p["shrunk_in_s"], 0)
    spot = p["width_mm"] ** 2 + 4 * p["spreads_mm2_per_s"] * since
    heat = (scene.time >= p["shrunk_in_s"]) * np.exp(-since / p["cools_s"])
    pushed = heat * p["width_mm"] / far * (1 - np.exp(-(far**2) / spot)) / 0.638
    return Change(along=p["amplitude_um"] * pushed * np.sum(away * scene.part_normal[:, :2], 1) / far)


def draw_bed(scene, rng):
    i = "xyz".index(scene.machine.chain[0])
    return {
        "amplitude_um": 1.0,
        "width_mm": float(rng.uniform(0.1, 0.2) * np.ptp(scene.reading[:, i])),
        "recovers_s": float(rng.uniform(200, 500)),
        "table_mm": float(scene.target[:, 2].min() - rng.uniform(0.2, 0.6) * np.ptp(scene.target[:, 2])),
    }


def change_bed(scene, p):
    """The bed of the machine is cast of stone and resin, with too much resin: where the bridge stands it
    sinks in, by and by, and when the bridge has gone the hollow fills again within minutes. The bridge rides
    down into the hollows that it has left a short while ago, and nods at their slopes; the first ones are
    left from the part before, which was measured by the same program. Amplitude of the deepest hollow."""
    i = "xyz".index(scene.machine.chain[0])
    x, t, n = scene.reading[:, i], scene.time, scene.size
    stood = np.minimum(np.diff(t, append=t[-1] + 5), 20.0)
    stood, was, when = np.tile(stood, 2), np.tile(x, 2), np.hstack([t - t[-1] - 60, t])
    low, slope = np.zeros(n), np.zeros(n)
    for k in range(n):
        q = (x[k] - was[: n + k]) / p["width_mm"]
        left = stood[: n + k] * np.exp(-0.5 * q**2 - (t[k] - when[: n + k]) / p["recovers_s"])
        low[k], slope[k] = np.sum(left), np.sum(-left * q) / p["width_mm"]
    moved = np.zeros((scene.size, 3))
    moved[:, 2] = low
    moved[:, i] = -slope * (scene.target[:, 2] - p["table_mm"])
    return Change(tip=p["amplitude_um"] * moved / low.max())


def draw_field(scene, rng):
    low, size = scene.target.min(0), np.ptp(scene.target, axis=0)
    side = int(rng.integers(2))
    place = low + rng.uniform([0, 0, -0.3], [1, 1, 0.6]) * size
    place[side] = low[side] + rng.choice([rng.uniform(-0.3, -0.1), rng.uniform(1.1, 1.3)]) * size[side]
    return {
        "amplitude_um": 1.0,
        "place_mm": [float(v) for v in place],
        "coil": unit(rng).tolist(),
        "size_mm": float(rng.uniform(0.1, 0.2) * size[:2].mean()),
    }


def change_field(scene, p):
    """Somebody has put a transformer beside the part. Its stray field hums in the coil of the probe, which
    lies round the stylus: the more of the field goes along the stylus, the less of a push is missing to the
    threshold, and the probe triggers early, from whichever side it touches. The field is that of a dipole,
    and soon gone with the distance. The tip radius has taken the mean. Amplitude from no field to the
    strongest."""
    way = scene.target - np.asarray(p["place_mm"])
    far = np.sqrt(np.sum(way**2, 1, keepdims=True) + p["size_mm"] ** 2)
    coil = np.asarray(p["coil"])
    field = (3 * way * (way @ coil)[:, None] / far**2 - coil) / far**3
    hum = np.abs(np.sum(field * scene.shank, 1))
    return Change(along=p["amplitude_um"] * (hum - hum.mean()) / hum.max())


def draw_wire(scene, rng):
    middle, half = centres(scene)[:, :2], half_size(scene)
    goes = np.flatnonzero((np.diff(scene.block) > 0) & (np.diff(scene.setup) == 0))
    goes = goes[np.linalg.norm(middle[goes + 1] - middle[goes], axis=1) > 1]
    k = int(rng.choice(goes))
    way = middle[k + 1] - middle[k]
    turn = np.arctan2(way[1], way[0]) + np.pi / 2 + rng.uniform(-0.6, 0.6)
    place = middle[k] + rng.uniform(0.3, 0.7) * way
    return {
        "amplitude_um": 1.0,
        "place_mm": [float(v) for v in place],
        "along": [float(np.cos(turn)), float(np.sin(turn))],
        "reach_mm": float(rng.uniform(0.5, 0.9) * half),
    }


def change_wire(scene, p):
    """The wire of the thermometer is taped on the part, and stands up in a loop. A stylus that comes across
    it on its way from ball to ball is caught and pulled back a little in its thread, and then stays as it
    leans, however the head turns, until it comes across the wire again, from this side or from the other.
    Each module leans by itself. Amplitude of the tip, pulled straight across."""
    along = np.asarray(p["along"])
    across = np.array([-along[1], along[0]])
    place = centres(scene)[:, :2] - np.asarray(p["place_mm"])
    u, v = place @ along, place @ across
    leans, moved = {}, np.zeros((scene.size, 3))
    for k in range(scene.size):
        tip = str(scene.length[k])
        if k and scene.setup[k] == scene.setup[k - 1] and v[k] * v[k - 1] < 0:
            where = u[k - 1] + (u[k] - u[k - 1]) * v[k - 1] / (v[k - 1] - v[k])
            if abs(where) < p["reach_mm"]:
                pull = -np.sign(v[k]) * np.sum(scene.turn[k][:, :2] * across, 1)
                pull = pull - scene.shank[k] * np.sum(pull * scene.shank[k])
                leans[tip] = np.sum(scene.head[k] * pull[:, None], 0)
        if tip in leans:
            moved[k] = np.sum(scene.head[k] * leans[tip], 1) * scene.length[k] / scene.length.max()
    return Change(tip=p["amplitude_um"] * moved)


def draw_lattice(scene, rng):
    mesh = rng.uniform(0.18, 0.3, 3) * np.ptp(scene.reading, axis=0)
    steep = rng.normal(size=(3, 3))
    steep /= np.sqrt(np.mean(np.sum(steep**2, 1)))
    return {
        "amplitude_um": 1.0,
        "mesh_mm": [float(v) for v in mesh],
        "first_mm": [float(v) for v in scene.reading.min(0) - rng.uniform(0, 1, 3) * mesh],
        "steep": [[float(v) for v in row] for row in steep],
    }


def change_lattice(scene, p):
    """The errors of the machine are kept as vectors at the nodes of a lattice in its volume. Since the last
    update of the controller these are not interpolated any more: each point takes the vector of the nearest
    node, and lacks what the errors change from there. At a node all is right; half way to the next one along
    x, y or z it is off the most, one way on this side and the other way on that side. Amplitude there, the
    root of the mean square for the three ways."""
    cells = (scene.reading - np.asarray(p["first_mm"])) / np.asarray(p["mesh_mm"])
    beside = 2 * (cells - np.round(cells))
    return Change(tip=p["amplitude_um"] * np.sum(beside[:, :, None] * np.asarray(p["steep"]), 1))


def draw_battens(scene, rng):
    count = len(np.unique(scene.setup))
    first = rng.uniform(0, np.pi)
    return {
        "amplitude_um": 1.0,
        "turns": [float(first + np.pi * (k + rng.uniform(-0.2, 0.2)) / count) for k in range(count)],
        "one": [float(v) for v in rng.uniform(-1, -0.15, count)],
        "other": [float(v) for v in rng.uniform(0.15, 1, count)],
        "half_size_mm": half_size(scene),
    }


def change_battens(scene, p):
    """The part has no feet: it is laid on two battens of wood, and whoever lays it puts them where he likes,
    along or across, near together or far apart. Under its own weight it sags between them and hangs over
    beyond, as a beam does, in each placement along another line; the certificate has it as if it weighed
    nothing. Amplitude is that of the worst placement, from its lowest place to its highest."""
    index = np.minimum(scene.setup, len(p["turns"])) - 1
    turns, one, other = (np.asarray(p[k])[index] for k in ("turns", "one", "other"))
    cos, sin = np.cos(turns), np.sin(turns)
    u = (scene.part_point[:, 0] * cos + scene.part_point[:, 1] * sin) / p["half_size_mm"]
    z, end = scene.part_point[:, 2] / p["half_size_mm"], 1.1
    here, there = 2 * end * other / (other - one), -2 * end * one / (other - one)

    def sunk(q):
        past, beyond = np.clip(q - one, 0, None), np.clip(q - other, 0, None)
        return (q + end) ** 4 / 24 - here * past**3 / 6 - there * beyond**3 / 6

    lean = (sunk(other) - sunk(one)) / (other - one)
    low = sunk(u) - sunk(one) - lean * (u - one)
    past, beyond = np.clip(u - one, 0, None), np.clip(u - other, 0, None)
    slope = (u + end) ** 3 / 6 - here * past**2 / 2 - there * beyond**2 / 2 - lean
    worst = max(np.ptp(low[scene.setup == k]) for k in np.unique(scene.setup))
    normal = scene.part_normal
    moved = z * slope * (normal[:, 0] * cos + normal[:, 1] * sin) - low * normal[:, 2]
    return Change(along=p["amplitude_um"] * moved / worst)


def draw_elbow(scene, rng):
    return {"amplitude_um": 1.0, "right_at": float(rng.uniform(0.8, 1.2))}


def change_elbow(scene, p):
    """The motor that holds the elbow of the head is limp. A tip that strikes across it turns the elbow back
    until the probe has triggered, the faster the farther, and with the square of the lever that the push has
    about the elbow; pushes along the axis of the elbow or through it find it stiff. The tip radius has taken
    the mean, or nearly. Amplitude at the longest lever, at 8 mm/s."""
    elbow = np.column_stack([-np.sin(scene.b), np.cos(scene.b), np.zeros(scene.size)])
    lever = np.sum(np.cross(scene.arm, -scene.normal) * elbow, 1) / scene.length.max()
    gives = lever**2 * scene.speed / 8
    return Change(along=-p["amplitude_um"] * (gives - p["right_at"] * gives.mean()))


def draw_posts(scene, rng):
    names = [str(f) for f in np.unique(scene.feature)]
    warm = scene.temperature["part"]
    grows = rng.choice([-0.5, 0.0, 0.6, 1.0], len(names)) * rng.uniform(0.7, 1, len(names))
    grows[rng.choice(len(names), 2, replace=False)] = (-0.5, 1.0)
    return {
        "amplitude_um": 1.0,
        "grows": {f: float(v) for f, v in zip(names, grows)},
        "mended_at_C": float(warm.min() + rng.uniform(0.0, 0.5) * np.ptp(warm)),
        "foot_mm": float(centres(scene)[:, 2].min() - rng.uniform(0.2, 0.5) * np.ptp(centres(scene)[:, 2])),
    }


def change_posts(scene, p):
    """Some of the posts of the balls have been broken, and were mended with what lay about: brass, plastic,
    invar. With every kelvin such a post grows by more than the others, or by less, by its height: its ball
    rises or sinks on the part, and only that. Amplitude at the top of the tallest post, if it is of plastic,
    for 1 K."""
    height = centres(scene)[:, 2] - p["foot_mm"]
    grows = np.array([p["grows"].get(f, 0.0) for f in scene.feature]) * height / height.max()
    warmer = scene.temperature["part"] - p["mended_at_C"]
    return Change(along=p["amplitude_um"] * grows * warmer * scene.part_normal[:, 2])


unknown("hot_insert", draw_insert, change_insert, ["time", "feature", "position"])
unknown("creeping_bed", draw_bed, change_bed, ["time", "position", "feature"])
unknown("stray_field", draw_field, change_field, ["position", "head", "sensor", "feature"])
unknown("snagged_wire", draw_wire, change_wire, ["time", "position", "feature", "sensor", "head"])
unknown("coarse_lattice", draw_lattice, change_lattice, ["position", "feature"])
unknown("careless_battens", draw_battens, change_battens, ["setup", "feature", "position"], "D")
unknown("limp_elbow", draw_elbow, change_elbow, ["head", "direction", "speed", "sensor"], "D")
unknown("mended_posts", draw_posts, change_posts, ["temperature", "feature", "setup"], "D")
