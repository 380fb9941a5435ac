"""The coordinate measuring machine of the concealed cases: exact rigid-body kinematics and random geometry.

Independent of the program under test on purpose: that one is first-order, this one multiplies finite
rotations (Rodrigues), so that an error of sign or of lever in either shows as a disagreement. Model: Van
Gestel, Bleys, Kruth, "CMM hardware error simulation for uncertainty evaluation" (2011), sections 3 and 5.
Positions in mm; translation errors in um, rotation errors in urad; `measured = true + d`.
"""

from dataclasses import dataclass, field

from portable import np

AXES = "xyz"
HARMONICS = 7
ARCSEC = np.pi / 180 / 3600
# Shares (s, c) of the linear and quadratic term, paper Table 1: positioning, straightness, rotation.
SHARES = {"position": (0.8, 0.1), "straight": (0.5, 0.4), "angle": (0.6, 0.0)}


@dataclass(frozen=True)
class Machine:
    """What a data sheet says. offsets: frame of each axis at home in the frame that carries it; each
    coordinate sums to zero."""

    name: str
    travel: dict
    direction: dict
    chain: tuple  # axes from the base to the ram
    offsets: dict
    mount: tuple
    head_length: float  # mount to the crossing of the head's axes, mm
    e_max: float  # um/m
    angle_max: float  # um/m^2
    probe_sd: float  # um
    mpe: tuple  # um, um/m
    tips: tuple  # short and long stylus, mm
    shaft: float  # mm
    head_sd: float = 0.83 * ARCSEC

    @property
    def qualification_sd(self):
        """um, each coordinate of a stylus qualified by some 10 touches of the reference sphere."""
        return 0.6 * self.probe_sd


MACHINES = (
    Machine(
        "bridge-1600",
        dict(x=1600, y=1000, z=800),
        dict(x=1, y=1, z=-1),
        ("x", "y", "z"),
        dict(x=(-120, 1400, -950), y=(0, -1410, 1085), z=(95, -30, 265)),
        (25, 40, -400),
        60,
        7,
        10,
        0.5,
        (5, 5),
        (60, 150),
        4,
    ),
    Machine(
        "bridge-900",
        dict(x=700, y=900, z=600),
        dict(x=1, y=1, z=-1),
        ("y", "x", "z"),
        dict(y=(-100, 0, -500), x=(100, 60, 700), z=(20, -30, 150)),
        (-20, -30, -350),
        50,
        3.5,
        5,
        0.35,
        (2.2, 3),
        (50, 120),
        3,
    ),
    Machine(
        "bridge-500",
        dict(x=500, y=500, z=400),
        dict(x=1, y=1, z=-1),
        ("y", "x", "z"),
        dict(y=(-150, 0, -420), x=(120, 60, 500), z=(30, -40, 120)),
        (0, -20, -200),
        40,
        2.4,
        4,
        0.25,
        (1.2, 2.5),
        (40, 90),
        3,
    ),
)


def head_rotation(a, b):
    """R = Rz(B) Ry(-A), paper eq. 25; shape (N, 3, 3)."""
    ca, sa, cb, sb, zero = np.cos(a), np.sin(a), np.cos(b), np.sin(b), np.zeros_like(a)
    rows = ((ca * cb, -sb, -sa * cb), (ca * sb, cb, -sa * sb), (sa, zero, ca))
    return np.stack([np.stack(row, -1) for row in rows], -2)


def tip_vector(a, b, tip_in_r, head_length):
    """Tip seen from the mounting point, mm."""
    return np.einsum("nij,nj->ni", head_rotation(a, b), tip_in_r) - np.array([0, 0, head_length])


def rotate(w, p):
    """p turned by the rotation vector w (rad), exactly."""
    angle = np.linalg.norm(w, axis=-1, keepdims=True)
    axis = w / np.where(angle > 0, angle, 1)
    along = axis * np.sum(axis * p, -1, keepdims=True)
    return along + np.cos(angle) * (p - along) + np.sin(angle) * np.cross(axis, p)


def tip_error(machine, reading, tip, carriages):
    """d of the tip centre, um. carriages: {axis: (translations um, rotations urad)}, each (N, 3); missing
    axes are perfect."""
    true = np.array(machine.mount, float) + tip
    nominal = true.copy()
    for axis in reversed(machine.chain):
        i = AXES.index(axis)
        origin = np.tile(np.array(machine.offsets[axis], float), (len(reading), 1))
        origin[:, i] += reading[:, i]
        nominal = nominal + origin
        move, turn = carriages.get(axis, (0.0, None))
        true = origin + np.asarray(move) * 1e-3 + (true if turn is None else rotate(turn * 1e-6, true))
    return (true - nominal) * 1e3


def home_offset(machine):
    """Sum of all frames at home: zero for the machines here."""
    return np.sum([machine.offsets[a] for a in machine.chain], axis=0) + np.array(machine.mount, float)


def share_of(axis, motion):
    """motion 0..2: translation along X, Y, Z; 3..5: rotation about them."""
    if motion >= 3:
        return "angle"
    return "position" if AXES[motion] == axis else "straight"


def size_of(machine, axis, motion):
    """Largest error of a component: um, or urad."""
    return (machine.angle_max if motion >= 3 else machine.e_max) * machine.travel[axis] * 1e-3


def normalised(machine, axis, reading):
    """u in [-1, 1], -1 at home."""
    return 2 * machine.direction[axis] * reading / machine.travel[axis] - 1


def harmonic_basis(u):
    """Basis of the paper's functions, each zero at home u = -1; shape (N, 2 + 2 HARMONICS)."""
    n = np.arange(1, HARMONICS + 1) * np.pi
    home = np.where(np.arange(1, HARMONICS + 1) % 2, -1.0, 1.0)
    return np.column_stack([u + 1, 2 * u**2 - 2, np.cos(np.outer(u, n)) - home, np.sin(np.outer(u, n))])


GRID = harmonic_basis(np.linspace(-1, 1, 401))


def draw_harmonics(rng, kind, count):
    """Coefficients (count, 2 + 2 HARMONICS) of functions whose largest value on the axis is a draw of U(-1,
    1); paper section 5."""
    s, c = SHARES[kind]
    a = rng.uniform(size=(count, HARMONICS))
    a *= (1 - s - c) / a.sum(1, keepdims=True)
    phase = rng.uniform(0, 2 * np.pi, (count, HARMONICS))
    k = np.column_stack([np.full(count, s), np.full(count, c), a * np.cos(phase), -a * np.sin(phase)])
    largest = np.abs(GRID @ k.T).max(0)
    return k / largest[:, None] * rng.uniform(-1, 1, (count, 1))


@dataclass
class Geometry:
    """The 18 error functions of one machine; functions[axis][motion] maps u to um or urad."""

    functions: dict = field(default_factory=dict)

    def carriages(self, machine, reading):
        out = {}
        for axis in machine.chain:
            u = normalised(machine, axis, reading[:, AXES.index(axis)])
            values = np.column_stack([f(u) for f in self.functions[axis]])
            out[axis] = (values[:, :3], values[:, 3:])
        return out


def paper_geometry(machine, rng, scale=1.0):
    out = Geometry()
    for axis in machine.chain:
        row = []
        for motion in range(6):
            k = draw_harmonics(rng, share_of(axis, motion), 1)[0] * size_of(machine, axis, motion) * scale
            row.append(lambda u, k=k: harmonic_basis(u) @ k)
        out.functions[axis] = row
    return out


def rough_geometry(machine, rng, scale=1.0):
    """Not the paper's family: a straight line plus a Matern 5/2 process of random range on knots, natural
    cubic spline between; same size."""
    out = Geometry()
    knots = np.linspace(-1, 1, 25)
    for axis in machine.chain:
        row = []
        for motion in range(6):
            reach = rng.uniform(0.25, 1.5)
            h = np.sqrt(5) * np.abs(knots[:, None] - knots) / reach
            root = np.linalg.cholesky((1 + h + h**2 / 3) * np.exp(-h) + 1e-9 * np.eye(len(knots)))
            line = SHARES[share_of(axis, motion)][0]
            y = line * knots * rng.choice([-1, 1]) + (1 - line) * root @ rng.normal(size=len(knots))
            y -= y[0]
            y *= size_of(machine, axis, motion) * scale * rng.uniform(-1, 1) / np.abs(y).max()
            row.append(natural_spline(knots, y))
        out.functions[axis] = row
    return out


def natural_spline(x, y):
    """Cubic spline through equally spaced knots, second derivative zero at the ends; straight beyond them."""
    h, n = x[1] - x[0], len(x)
    matrix = np.diag(np.full(n - 2, 4.0)) + np.diag(np.ones(n - 3), 1) + np.diag(np.ones(n - 3), -1)
    m = np.zeros(n)
    m[1:-1] = np.linalg.solve(matrix, 6 * np.diff(y, 2) / h**2)

    def value(u):
        u = np.clip(u, x[0], x[-1])
        i = np.clip(((u - x[0]) / h).astype(int), 0, n - 2)
        a, b = (x[i + 1] - u) / h, (u - x[i]) / h
        return a * y[i] + b * y[i + 1] + ((a**3 - a) * m[i] + (b**3 - b) * m[i + 1]) * h**2 / 6

    return value
