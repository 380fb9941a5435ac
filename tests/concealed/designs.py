"""Measuring plans, from poor to rich, and everything that a real machine would log with them.

A  one ball, one orientation; nearly everything looks alike: 75 touches
C  flat plate of nine balls, five orientations, in sequence: 225
D  nine balls off a plane, three placements (one tilted), seven orientations, two stylus lengths, speeds,
   accelerations and temperatures, blocks in random order, oblique approaches, raw readings: 450 or 1134
E  ISO 10360-2 lengths on seven lines and an ISO 10360-5 sphere, raw readings: 300
"""

import machine as cmm
from portable import np
from scene import MATERIALS, Block, Scene, Stylus, climate, clock, touches

TILTS = ((0, 0), (90, 0), (90, 90), (90, 180), (90, -90), (45, 45), (30, -135))


def axis_rotation(axis, degrees):
    v = np.zeros((1, 3))
    v[0, axis] = np.radians(degrees)
    return np.stack([cmm.rotate(v, e[None])[0] for e in np.eye(3)], -1)


def styli_for(machine, lengths, tilts, rng):
    material = str(rng.choice(list(MATERIALS)))
    out = []
    for length in lengths:
        for a, b in tilts[length]:
            name = f"L{length:g}A{a}B{b}"
            out.append(
                Stylus(
                    name,
                    (a, b),
                    length,
                    4.0 if length == min(lengths) else 6.0,
                    machine.shaft * (1 if length == min(lengths) else 1.25),
                    material,
                )
            )
    return out


def facing(stylus):
    """Unit vector from the tip to the head."""
    a, b = np.radians(stylus.head)
    return cmm.head_rotation(np.array([a]), np.array([b]))[0] @ np.array([0, 0, 1.0])


def hemisphere(axis, count, rng, reach=95):
    """count directions spread evenly over the cap up to `reach` degrees from the axis, turned at random; none
    from far below."""
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
    scene = Scene(
        machine,
        "C",
        styli_for(machine, [length], {length: TILTS[:5]}, rng),
        [(axis_rotation(2, rng.uniform(-8, 8)), np.zeros(3))],
    )
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
    placements = [
        (np.eye(3), np.array([0, 0, -0.15 * half[2]])),
        (turn, np.array([0.1 * half[0], -0.1 * half[1], 0.1 * half[2]])),
        (
            axis_rotation(1, rng.uniform(12, 22)) @ axis_rotation(2, rng.uniform(-50, -30)),
            np.array([-0.1 * half[0], 0.05 * half[1], 0]),
        ),
    ]
    scene = Scene(machine, "D", styli, placements)
    balls = plate(min(half[:2]) * 0.62, rng.permutation(np.linspace(-0.5, 0.5, 9)) * min(half[2], 160))
    per = 5 if size < 900 else 9
    count = max(
        6, round(size / 3 / per / 2)
    )  # blocks in each of six stretches: three placements, each at two temperatures
    for setup in (1, 2, 3):
        combinations = factorial(len(styli), count * 2, rng)
        for half_of, warm in enumerate(((0, 1), (1, 0), (0, 1))[setup - 1]):
            for k, ball, speed, acceleration in combinations[half_of::2]:
                normals = hemisphere(facing(styli[k]), per, rng)
                scene.blocks.append(
                    Block(
                        setup,
                        k,
                        f"BALL{ball + 1}",
                        balls[ball],
                        normals,
                        (2.0, 8.0)[speed],
                        (150.0, 600.0)[acceleration],
                        warm,
                    )
                )
    return scene


def factorial(styli, count, rng):
    """count combinations of stylus, ball, speed, acceleration; each level as often as the others, in random
    order."""

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
                scene.blocks.append(
                    Block(setup, 0, f"LENGTH{i + 1}", np.zeros(3), np.array([-u, u]), 5.0, 400.0, 0, ends)
                )
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


def fits(scene):
    """Is every reading inside the travels?"""
    m = scene.machine
    low, high = np.array([sorted((0, m.direction[a] * m.travel[a])) for a in cmm.AXES]).T
    return (scene.reading > low + 5).all() and (scene.reading < high - 5).all()


def build(design, machine, rng, size=None):
    """A complete scene; its parts shrink towards the middle until every reading is inside the travels."""
    scene = BUILDERS[design](machine, rng, size or SIZES[design])
    for shrink in (1, 0.9, 0.8, 0.7, 0.6, 0.5):
        touches(scene, shrink, np.random.Generator(np.random.PCG64(int(rng.integers(2**62)))))
        if fits(scene):
            break
    else:
        raise ValueError(f"design {design} does not fit into {machine.name}")
    clock(scene, rng)
    climate(scene, rng)
    return scene
