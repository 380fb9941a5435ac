"""What one recording consists of, touch by touch: geometry, clock and climate of a measuring plan on one machine.

A Scene is an array for every logged or true quantity. What the machine logs is not what is true: temperatures
carry the noise of their sensors. Frame: machine coordinates unless the name says part. mm, rad, s, C.
"""

from dataclasses import dataclass

import machine as cmm
from portable import np

BALL = 12.5  # radius of the balls, mm
APPROACH = 3.0  # mm of slow motion before a touch
MATERIALS = {"tungsten carbide": (620.0, 5.0), "steel": (200.0, 11.5)}  # GPa, ppm/K


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
    centre: np.ndarray  # in the part, mm
    normals: np.ndarray  # in the machine
    speed: float
    acceleration: float
    warm: int = 0
    points: np.ndarray = None  # in the part; for flat faces instead of a ball


class Scene:
    """One measuring plan on one machine; arrays over its touches. Frame: machine coordinates unless the name
    says part."""

    def __init__(self, machine, design, styli, placements):
        self.machine, self.design, self.styli, self.placements = machine, design, styli, placements
        self.blocks, self.logs_readings = [], design in "DE"
        self.first_styli = styli  # sizes of effects refer to these, also when another stylus is mounted later

    @property
    def duration(self):
        return self.time[-1]


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
    s.shank = -s.arm / np.linalg.norm(s.arm, axis=1, keepdims=True)  # tip to head
    s.normal = np.vstack([b.normals for b in s.blocks])
    s.turn = np.stack([s.placements[k - 1][0] for k in s.setup])
    s.part_normal = np.einsum("nji,nj->ni", s.turn, s.normal)
    ball = np.array([b.points is None for b in s.blocks])
    centre = (
        np.vstack([np.tile(b.centre, (len(b.normals), 1)) if b.points is None else b.points for b in s.blocks]) * shrink
    )
    s.part_point = centre + np.where(each(ball), BALL, 0.0)[:, None] * s.part_normal
    rest = middle + cmm.home_offset(m) + np.array([0, 0, -m.head_length - 0.35 * max(u.length for u in s.styli)])
    place = np.stack([s.placements[k - 1][1] for k in s.setup]) * shrink + rest
    s.target = np.einsum("nij,nj->ni", s.turn, s.part_point) + place + s.tip_radius[:, None] * s.normal
    s.reading = s.target - cmm.home_offset(m) - s.tip
    s.middle, s.shrink = s.target.mean(0), shrink
    s.travel = oblique(s, rng)


def oblique(scene, rng):
    """Direction of travel at the touch: against the normal; in the rich design a third of the touches up to 6
    degrees off."""
    tilt = rng.normal(size=(scene.size, 3))
    tilt -= scene.normal * np.sum(tilt * scene.normal, 1, keepdims=True)
    tilt /= np.linalg.norm(tilt, axis=1, keepdims=True)
    angle = (
        np.radians(6) * rng.uniform(0.3, 1, scene.size) * (rng.uniform(size=scene.size) < 1 / 3) * (scene.design == "D")
    )
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
    """True temperatures and what the sensors say of them. One temperature: the log is one constant per
    sensor."""
    s = scene
    warm = np.array([s.blocks[k].warm for k in s.block])
    names = ("part", "x", "y", "z", "air")
    if s.design == "D":
        low, rise = rng.uniform(19.6, 20.4), rng.uniform(2.5, 4)
        share = dict(part=0.9, x=0.75, y=0.85, z=0.95, air=1.0)
        wander = rng.uniform(0, 2 * np.pi, 5)
        s.temperature = {
            n: low + warm * rise * share[n] + 0.1 * np.sin(s.time / 2400 + wander[i]) for i, n in enumerate(names)
        }
        minute = np.unique(s.time // 60, return_inverse=True)[1]
        noise = {n: rng.normal(0, 0.1, minute.max() + 1)[minute] for n in names}
        s.logged = {n: np.round(s.temperature[n] + noise[n], 2) for n in names}
    else:
        level = np.round(rng.uniform(19.5, 23.5), 1)
        s.temperature = {n: np.full(s.size, level) for n in names}
        s.logged = {n: np.full(s.size, level) for n in names}
    heavy = round(float(rng.uniform(0.3, 0.6)) * s.machine.travel["x"] / 1600 * 1000)
    s.load = np.where((s.setup == 2) & (s.design == "D"), heavy, 20.0)
