"""Effects of the probe and its stylus: statics of the tripod with friction and seat compliance, beams, Hertz,
latency. Forces N, moduli GPa."""

from portable import np
from scene import BALL, MATERIALS

from .base import Change, effect, unit

SEATS = np.radians([0, 120, 240])


def tripod_force(azimuth, elevation, length, radius, friction=0.0, gravity=0.0, phase=0.0):
    """Force at the tip, over the spring's, that tips the holder about the easiest of its three edges (Estler
    et al. 1996).

    Moments about the edge k, whose inner normal lies at psi_k: F [ L cos(beta) cos(phi - psi_k) + (R/2)
    sin(beta) ] = Fs R/2 (1 + gravity_k). The edge that gives way first limits the force: 1/cos lobing, twice
    as stiff in the worst direction as in the best. A force beside the normal of the edge slides on the seats:
    friction raises it. gravity: (N, 3) or 0, moment of the weight over that of the spring for each edge."""
    best = np.full(np.shape(azimuth), np.inf)
    for k, seat in enumerate(SEATS):
        towards = np.cos(azimuth - phase - seat)
        lever = length * np.cos(elevation) * towards + radius / 2 * np.abs(np.sin(elevation))
        weight = gravity[:, k] if np.ndim(gravity) else gravity
        spring = radius / 2 * (1 + weight) * (1 + friction * np.abs(np.sin(azimuth - phase - seat)) * np.cos(elevation))
        best = np.where(lever > 1e-9, np.minimum(best, spring / np.maximum(lever, 1e-9)), best)
    return best


def compliance(elevation, length, shaft, young):
    """Deflection of stylus and seats under 1 N against the surface, um."""
    bending = length**3 / (3 * young * np.pi * shaft**4 / 64)
    axial = length / (young * np.pi * shaft**2 / 4)
    return np.cos(elevation) ** 2 * bending + np.sin(elevation) ** 2 * axial + 0.3


def directions(scene):
    """Azimuth and elevation of the push -n in the frame of the head's last link."""
    push = -np.einsum("nji,nj->ni", scene.head, scene.normal)
    return np.arctan2(push[:, 1], push[:, 0]), np.arcsin(np.clip(np.abs(push[:, 2]), 0, 1))


def pretravel(azimuth, elevation, length, shaft, young, p, gravity=0.0):
    return tripod_force(
        azimuth, elevation, length, p["seat_radius_mm"], p["friction"], gravity, p["phase"]
    ) * compliance(elevation, length, shaft, young)


def draw_lobing(scene, rng):
    return {
        "amplitude_um": 1.0,
        "at_length_mm": float(min(s.length for s in scene.styli)),
        "phase": rng.uniform(0, 2 * np.pi / 3),
        "seat_radius_mm": rng.uniform(4, 9),
        "friction": rng.uniform(0, 0.06),
        "gravity_share": rng.uniform(0, 0.1),
    }


def change_lobing(scene, p):
    phi, beta = directions(scene)
    down = np.einsum("nji,j->ni", scene.head, [0, 0, -1.0])
    gravity = p["gravity_share"] * np.column_stack(
        [down[:, 0] * np.cos(k + p["phase"]) + down[:, 1] * np.sin(k + p["phase"]) for k in SEATS]
    )
    value = pretravel(phi, beta, scene.length, scene.shaft, scene.young, p, gravity)
    rng = np.random.Generator(np.random.PCG64(5))
    u = rng.uniform(size=(400, 2))
    out, round_equator = np.zeros(scene.size), np.linspace(0, 2 * np.pi, 720)
    for k in range(len(scene.styli)):
        mine = scene.sensor == k
        if mine.any():  # the mean over the hemisphere of the qualification is part of the tip radius
            one = [v[mine][:1] for v in (scene.length, scene.shaft, scene.young)]
            out[mine] = np.mean(pretravel(2 * np.pi * u[:, 0], np.arcsin(u[:, 1]), *one, p)) - value[mine]
    reference = min(scene.first_styli, key=lambda s: s.length)
    ring = pretravel(
        round_equator, 0 * round_equator, reference.length, reference.shaft, MATERIALS[reference.material][0], p
    )
    return Change(along=p["amplitude_um"] * out / ((ring.max() - ring.min()) / 2))


def draw_bending(scene, rng):
    return {"force_change_N": rng.choice([-1, 1]) * 0.01}


def change_bending(scene, p):
    _, beta = directions(scene)
    return Change(along=-p["force_change_N"] * (compliance(beta, scene.length, scene.shaft, scene.young) - 0.3))


def draw_radius(scene, rng):
    return {"amplitude_um": rng.choice([-1.0, 1.0])}


def change_radius(scene, p):
    return Change(along=np.full(scene.size, p["amplitude_um"]))


def draw_form(scene, rng):
    return {
        "amplitude_um": 1.0,
        "axes": [unit(rng) for _ in range(8)],
        "degrees": [int(v) for v in rng.integers(2, 6, 8)],
        "weights": rng.normal(size=8),
    }


def legendre(degree, x):
    return np.polynomial.legendre.legval(x, np.eye(degree + 1)[degree])


def ball_form(u, p):
    """Smooth form of a ball, rms 1 over it: zonal harmonics of degree 2 to 5 about random axes. u: unit
    vectors (N, 3)."""
    terms = [w / d * legendre(d, u @ a) for a, d, w in zip(p["axes"], p["degrees"], p["weights"])]
    rng = np.random.Generator(np.random.PCG64(6))
    v = rng.normal(size=(2000, 3))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    size = np.sqrt(
        np.mean(sum(w / d * legendre(d, v @ a) for a, d, w in zip(p["axes"], p["degrees"], p["weights"])) ** 2)
    )
    return sum(terms) / size


def change_form(scene, p):
    push = -np.einsum("nji,nj->ni", scene.head, scene.normal)
    return Change(along=p["amplitude_um"] * ball_form(push, p))


def hertz(force, radius, young, poisson=0.28):
    """Approach of a ruby ball of `radius` mm on a plane, um."""
    modulus = 1 / ((1 - 0.27**2) / 380 + (1 - poisson**2) / young)
    return (9 * force**2 / (16 * radius * (modulus * 1e3) ** 2)) ** (1 / 3) * 1e3


def draw_flattening(scene, rng):
    return {"excess": 1.0, "force_N": rng.uniform(0.2, 1.0), "young_GPa": float(rng.choice([70, 200]))}


def change_flattening(scene, p):
    on_ball = 1 / (1 / scene.tip_radius + 1 / BALL)
    return Change(along=-p["excess"] * hertz(p["force_N"], on_ball, p["young_GPa"]))


def draw_delay(scene, rng):
    return {"delay_ms": rng.choice([-1.0, 1.0])}


def change_delay(scene, p):
    """The machine goes on along its path until the signal arrives."""
    return Change(tip=scene.travel * (scene.speed * p["delay_ms"])[:, None])


def draw_cosine(scene, rng):
    return {"share": 1.0}


def change_cosine(scene, p):
    return Change(along=p["share"] * scene.tip_radius * 1e3 * (1 + np.sum(scene.travel * scene.normal, 1)))


def draw_length(scene, rng):
    return {"length_error_um": rng.choice([-1.0, 1.0])}


def change_length(scene, p):
    return Change(tip=p["length_error_um"] * scene.shank)


def draw_step(scene, rng):
    """One stylus in use before and after the jump, not near the ends of its use."""
    often = [k for k in range(len(scene.styli)) if np.sum(scene.sensor == k) >= 15] or [int(scene.sensor[0])]
    k = int(rng.choice(often))
    used = scene.time[scene.sensor == k]
    return {
        "amplitude_um": 1.0,
        "direction": unit(rng),
        "sensor": k,
        "t0_s": float(np.quantile(used, rng.uniform(0.25, 0.75))) + 0.5,
    }


def change_step(scene, p):
    on = (scene.sensor == p["sensor"]) & (scene.time >= p["t0_s"])
    return Change(tip=p["amplitude_um"] * on[:, None] * (scene.head @ np.asarray(p["direction"])))


BODY = ["direction", "head", "sensor"]
HEAD = ("head_A_deg", "head_B_deg", "sensor")
effect("probe.pretravel_lobing", draw_lobing, change_lobing, ["amplitude_um"], 16, BODY)
effect("probe.stylus_bending", draw_bending, change_bending, ["force_change_N"], 0.2, BODY)
effect("probe.tip_radius", draw_radius, change_radius, ["amplitude_um"], 3, ["direction", "sensor", "feature"])
effect("probe.tip_form", draw_form, change_form, ["amplitude_um"], 1.0, BODY, spans=40)  # 32 harmonics
effect(
    "probe.contact_flattening",
    draw_flattening,
    change_flattening,
    ["excess"],
    1.0,
    ["direction", "sensor", "feature"],
    designs="CDE",
)
effect(
    "probe.trigger_delay",
    draw_delay,
    change_delay,
    ["delay_ms"],
    2,
    ["speed", "direction", "sensor", "feature"],
    needs=("speed_mm_s",),
)
effect(
    "probe.cosine_error",
    draw_cosine,
    change_cosine,
    ["share"],
    1.0,
    ["direction", "sensor"],
    needs=("ax", "ay", "az"),
    designs="D",
)
effect(
    "probe.stylus_length",
    draw_length,
    change_length,
    ["length_error_um"],
    10000,
    ["head", "sensor"],
    needs=HEAD,
    designs="CD",
)
effect(
    "probe.step",
    draw_step,
    change_step,
    ["amplitude_um"],
    50,
    ["time", "sensor", "head"],
    needs=("time_s",),
    designs="CD",
)
