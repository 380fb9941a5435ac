"""Measuring plans, from poor to rich, and everything that a real machine would log with them.

    A  one ball, one orientation                      75 touches; nearly everything looks alike
    C  flat plate of nine balls, five orientations   225, in sequence
    D  nine balls off a plane, three placements (one tilted), seven orientations, two stylus lengths, speeds, accelerations and temperatures,
       blocks in random order                        450 or 1125; oblique approaches, raw readings
    E  ISO 10360-2 lengths on seven lines and an ISO 10360-5 sphere, 300, raw readings

A Scene is a column per logged or true quantity. What the machine logs is not what is true: temperatures carry the noise of their sensors.
"""
from dataclasses import dataclass

import numpy as np

import machine as cmm

BALL = 12.5              # radius of the balls, mm
APPROACH = 3.0           # mm of slow motion before a touch
MATERIALS = {"tungsten carbide": (620.0, 5.0), "steel": (200.0, 11.5), "ceramic": (370.0, 7.5)}   # GPa, ppm/K
TILTS = ((0, 0), (90, 0), (90, 90), (90, 180), (90, -90), (45, 45), (30, -135))


@dataclass
class Stylus:
    name: str
    head: tuple
    length: float
    diameter: float
    shaft: float
    material: str


@dataclass
class Block:
    """Touches of one feature in one go."""
    setup: int
    stylus: int
    feature: str
    centre: np.ndarray     # in the part, mm
    normals: np.ndarray    # in the machine
    speed: float
    acceleration: float
    warm: int = 0
    points: np.ndarray = None   # in the part; for flat faces instead of a ball


class Scene:
    """One measuring plan on one machine; arrays over its touches. Frame: machine coordinates unless the name says part."""

    def __init__(self, machine, design, styli, placements):
        self.machine, self.design, self.styli, self.placements = machine, design, styli, placements
        self.blocks, self.logged_temperatures, self.logs_readings = [], False, design in "DE"

    @property
    def duration(self):
        return self.time[-1]


def axis_rotation(axis, degrees):
    v = np.zeros((1, 3))
    v[0, axis] = np.radians(degrees)
    return np.stack([cmm.rotate(v, e[None])[0] for e in np.eye(3)], -1)


def styli_for(machine, lengths, tilts, rng):
    material = str(rng.choice(list(MATERIALS)[:2]))
    out = []
    for length in lengths:
        for a, b in tilts[length]:
            name = f"L{length:g}A{a}B{b}"
            out.append(Stylus(name, (a, b), length, 4.0 if length == min(lengths) else 6.0, machine.shaft * (1 if length == min(lengths) else 1.25), material))
    return out


def facing(stylus):
    """Unit vector from the tip to the head."""
    a, b = np.radians(stylus.head)
    return cmm.head_rotation(np.array([a]), np.array([b]))[0] @ np.array([0, 0, 1.0])


def hemisphere(axis, count, rng, reach=95):
    """count directions spread evenly over the cap up to `reach` degrees from the axis, turned at random; none from far below."""
    golden = np.pi * (3 - np.sqrt(5))
    start, lowest = rng.uniform(0, 2 * np.pi), np.cos(np.radians(reach))
    helper = np.cross(axis, [0, 0, 1]) if abs(axis[2]) < 0.9 else np.array([1.0, 0, 0])
    e1 = np.cross(axis, helper) / np.linalg.norm(np.cross(axis, helper))
    e2 = np.cross(axis, e1)
    out, k, total = [], 0, 4 * count + 8
    order = rng.permutation(total)
    while len(out) < count:
        i = order[k % total]
        z = 1 - (1 - lowest) * (i + 0.5) / total
        phi, r = start + golden * i, np.sqrt(max(0.0, 1 - z * z))
        n = z * axis + r * (np.cos(phi) * e1 + np.sin(phi) * e2)
        if n[2] > -0.6:
            out.append(n)
        k += 1
    return np.array(out)


def plate(spacing, heights):
    grid = np.array([(x, y) for y in (-1, 0, 1) for x in (-1, 0, 1)], float)
    return np.column_stack([grid * spacing, heights])


def spread(machine):
    """Half extents that leave room for the longest stylus at every orientation, mm."""
    room = max(machine.tips) + 40
    return np.array([machine.travel[a] / 2 - room for a in cmm.AXES])


def design_a(machine, rng, size=75):
    length = machine.tips[0] * 1.5
    scene = Scene(machine, "A", styli_for(machine, [length], {length: [(0, 0)]}, rng), [(np.eye(3), np.zeros(3))])
    directions = hemisphere(np.array([0, 0, 1.0]), 25, rng)
    for _ in range(max(1, size // 25)):
        scene.blocks.append(Block(1, 0, "BALL1", np.zeros(3), directions, 5.0, 400.0))
    return scene


def design_c(machine, rng, size=225):
    half = spread(machine)
    length = machine.tips[0] * 1.5
    scene = Scene(machine, "C", styli_for(machine, [length], {length: TILTS[:5]}, rng), [(axis_rotation(2, rng.uniform(-8, 8)), np.zeros(3))])
    balls = plate(min(half[:2]) * 0.9, np.zeros(9))
    per = max(2, size // 45)
    for k, stylus in enumerate(scene.styli):
        for i, ball in enumerate(balls):
            scene.blocks.append(Block(1, k, f"BALL{i + 1}", ball, hemisphere(facing(stylus), per, rng), 5.0, 400.0))
    return scene


def design_d(machine, rng, size=450):
    half = spread(machine)
    short, long = machine.tips
    styli = styli_for(machine, [short, long], {short: TILTS, long: (TILTS[0], TILTS[2], TILTS[5])}, rng)
    turn = axis_rotation(2, rng.uniform(70, 110))
    placements = [(np.eye(3), np.array([0, 0, -0.15 * half[2]])), (turn, np.array([0.1 * half[0], -0.1 * half[1], 0.1 * half[2]])),
                  (axis_rotation(1, rng.uniform(12, 22)) @ axis_rotation(2, rng.uniform(-50, -30)), np.array([-0.1 * half[0], 0.05 * half[1], 0]))]
    scene = Scene(machine, "D", styli, placements)
    balls = plate(min(half[:2]) * 0.62, rng.permutation(np.linspace(-0.5, 0.5, 9)) * min(half[2], 160))
    per = 5 if size < 900 else 9
    count = max(6, round(size / 3 / per / 2))   # blocks in each of six stretches: three placements, each at two temperatures
    for setup in (1, 2, 3):
        combinations = factorial(len(styli), count * 2, rng)
        for half_of, warm in enumerate(((0, 1), (1, 0), (0, 1))[setup - 1]):
            for k, ball, speed, acceleration in combinations[half_of::2]:
                normals = hemisphere(facing(styli[k]), per, rng)
                scene.blocks.append(Block(setup, k, f"BALL{ball + 1}", balls[ball], normals, (2.0, 8.0)[speed], (150.0, 600.0)[acceleration], warm))
    return scene


def factorial(styli, count, rng):
    """count combinations of stylus, ball, speed, acceleration; each level as often as the others, in random order."""
    def level(n):
        return rng.permutation(np.arange(count) % n)
    return list(zip(level(styli), level(9), level(2), level(2)))


def design_e(machine, rng, size=300):
    half = spread(machine)
    length = machine.tips[0] * 1.5
    styli = styli_for(machine, [length], {length: TILTS[:5]}, rng)
    lines = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)], float) * half
    placements = [(np.eye(3), np.zeros(3)) for _ in range(8)]
    scene = Scene(machine, "E", styli, placements)
    repeats = max(1, round(size * 0.7 / 70))
    for setup, line in enumerate(lines, 1):
        reach = 2 * 0.9 * np.linalg.norm(line)
        u = line / np.linalg.norm(line)
        for _ in range(repeats):
            for i, bar in enumerate(np.linspace(25, reach, 5)):
                ends = np.array([-reach / 2 * u, (bar - reach / 2) * u])
                scene.blocks.append(Block(setup, 0, f"LENGTH{i + 1}", np.zeros(3), np.array([-u, u]), 5.0, 400.0, 0, ends))
    per = max(5, round(size * 0.3 / 5))
    for k in rng.permutation(5):
        scene.blocks.append(Block(8, int(k), "SPHERE", np.zeros(3), hemisphere(facing(styli[k]), per, rng), 5.0, 400.0))
    return scene


def design_k(machine, rng, size=450):
    """The calibration of a known machine: as D, in one temperature and with one way of probing."""
    scene = design_d(machine, rng, size)
    scene.design = "K"
    for block in scene.blocks:
        block.warm, block.speed, block.acceleration = 0, 5.0, 400.0
    return scene


BUILDERS = {"A": design_a, "C": design_c, "D": design_d, "E": design_e, "K": design_k}
SIZES = {"A": 75, "C": 225, "D": 450, "E": 300, "K": 450}
ARTEFACTS = {"A": "ball", "C": "ball plate", "D": "ball frame", "E": "step gauges and sphere", "K": "ball frame"}


def build(design, machine, rng, size=None):
    """A complete scene; its parts shrink towards the middle until every reading is inside the travels."""
    scene = BUILDERS[design](machine, rng, size or SIZES[design])
    for shrink in (1, 0.9, 0.8, 0.7, 0.6, 0.5):
        touches(scene, shrink, np.random.Generator(np.random.PCG64(int(rng.integers(2**62)))))
        low, high = np.array([sorted((0, machine.direction[a] * machine.travel[a])) for a in cmm.AXES]).T
        if (scene.reading > low + 5).all() and (scene.reading < high - 5).all():
            break
    else:
        raise ValueError(f"design {design} does not fit into {machine.name}")
    clock(scene, rng)
    climate(scene, rng)
    return scene


def touches(scene, shrink, rng):
    """Fills what follows from the blocks: geometry of every touch."""
    m, s = scene.machine, scene
    middle = np.array([m.direction[a] * m.travel[a] / 2 for a in cmm.AXES])
    count = [len(b.normals) for b in s.blocks]
    def each(values):
        return np.repeat(np.array(values), count, axis=0)
    s.size = int(np.sum(count))
    s.setup, s.block = each([b.setup for b in s.blocks]), each(np.arange(len(s.blocks)))
    s.feature = [b.feature for b in s.blocks for _ in b.normals]
    s.sensor = each([b.stylus for b in s.blocks])
    used = [s.styli[k] for k in s.sensor]
    s.a, s.b = np.radians([u.head for u in used]).T
    s.length, s.shaft = np.array([u.length for u in used]), np.array([u.shaft for u in used])
    s.tip_radius = np.array([u.diameter / 2 for u in used])
    s.young, s.stylus_cte = np.array([MATERIALS[u.material] for u in used]).T
    s.tip_in_r = np.column_stack([np.zeros((s.size, 2)), -s.length])
    s.head = cmm.head_rotation(s.a, s.b)
    s.arm = np.einsum("nij,nj->ni", s.head, s.tip_in_r)
    s.tip = s.arm - np.array([0, 0, m.head_length])
    s.shank = -s.arm / np.linalg.norm(s.arm, axis=1, keepdims=True)   # tip to head
    s.normal = np.vstack([b.normals for b in s.blocks])
    s.turn = np.stack([s.placements[k - 1][0] for k in s.setup])
    s.part_normal = np.einsum("nji,nj->ni", s.turn, s.normal)
    ball = np.array([b.points is None for b in s.blocks])
    centre = np.vstack([np.tile(b.centre, (len(b.normals), 1)) if b.points is None else b.points for b in s.blocks]) * shrink
    s.part_point = centre + np.where(each(ball), BALL, 0.0)[:, None] * s.part_normal
    rest = middle + cmm.home_offset(m) + np.array([0, 0, -m.head_length - 0.35 * max(u.length for u in s.styli)])
    place = np.stack([s.placements[k - 1][1] for k in s.setup]) * shrink + rest
    s.target = np.einsum("nij,nj->ni", s.turn, s.part_point) + place + s.tip_radius[:, None] * s.normal
    s.reading = s.target - cmm.home_offset(m) - s.tip
    s.travel = oblique(s, rng)


def oblique(scene, rng):
    """Direction of travel at the touch: against the normal; in the rich design a third of the touches up to 6 degrees off."""
    tilt = rng.normal(size=(scene.size, 3))
    tilt -= scene.normal * np.sum(tilt * scene.normal, 1, keepdims=True)
    tilt /= np.linalg.norm(tilt, axis=1, keepdims=True)
    angle = np.radians(6) * rng.uniform(0.3, 1, scene.size) * (rng.uniform(size=scene.size) < 1 / 3) * (scene.design == "D")
    return -(np.cos(angle)[:, None] * scene.normal + np.sin(angle)[:, None] * tilt)


def clock(scene, rng):
    """Times, indexing visits, speeds; the path between touches for what remembers it."""
    s, now, visit, times, visits = scene, 20.0, 0, [], []
    last = None
    for block in s.blocks:
        if last is not None:
            now += 12 + rng.uniform(0, 4)
            now += 1500 if block.setup != last.setup and s.design in "CDK" else 90 if block.setup != last.setup else 0
            now += 2700 if block.warm != last.warm else 0
        if last is None or block.stylus != last.stylus:
            visit, now = visit + 1, now + 10
        for _ in block.normals:
            now += rng.uniform(4.0, 5.5)
            times.append(now)
            visits.append(visit)
        last = block
    s.time, s.visit = np.round(times, 2), np.array(visits)
    s.speed = np.array([s.blocks[k].speed for k in s.block])
    s.acceleration = np.array([s.blocks[k].acceleration for k in s.block])
    s.start = s.reading - s.travel * APPROACH
    s.qualification = np.ones(s.size, int)
    s.run = s.block + 1 if s.design == "A" else np.ones(s.size, int)


def climate(scene, rng):
    """True temperatures and what the sensors say of them. One temperature: the log is one constant per sensor."""
    s = scene
    warm = np.array([s.blocks[k].warm for k in s.block])
    names = ("part", "x", "y", "z", "air")
    if s.design == "D":
        low, rise = rng.uniform(19.6, 20.4), rng.uniform(2.5, 4)
        share = dict(part=0.9, x=0.75, y=0.85, z=0.95, air=1.0)
        wander = rng.uniform(0, 2 * np.pi, 5)
        s.temperature = {n: low + warm * rise * share[n] + 0.1 * np.sin(s.time / 2400 + wander[i]) for i, n in enumerate(names)}
        minute = np.unique(s.time // 60, return_inverse=True)[1]
        noise = {n: rng.normal(0, 0.1, minute.max() + 1)[minute] for n in names}
        s.logged = {n: np.round(s.temperature[n] + noise[n], 2) for n in names}
    else:
        level = np.round(rng.uniform(19.5, 23.5), 1)
        s.temperature = {n: np.full(s.size, level) for n in names}
        s.logged = {n: np.full(s.size, level) for n in names}
    heavy = round(float(rng.uniform(0.3, 0.6)) * s.machine.travel["x"] / 1600 * 1000)
    s.load = np.where((s.setup == 2) & (s.design == "D"), heavy, 20.0)
