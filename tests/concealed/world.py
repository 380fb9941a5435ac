"""One machine measures: everything that acts on a recording, added up; and the size of an effect for a wanted
signal-to-noise ratio."""

import machine as cmm
from effects import noise
from portable import np

LADDER = (2, 3, 4.5, 6, 9, 15)
IMPLAUSIBLE = 3  # times the range that the literature gives


def short(value):
    """Six digits: what goes into the data must not hang on the last bits of the linear algebra that sized it."""
    return float(f"{value:.6g}")


def placed(scene, poses, rng):
    """The true part is not where the alignment says: 3 um and 10 urad for each placement; um along the normal. poses:
    {setup: (shift um, turn rad)}, those that are missing are drawn."""
    out = np.zeros(scene.size)
    for k in np.unique(scene.setup):
        if k not in poses:
            poses[k] = (rng.normal(0, 3, 3), rng.normal(0, 1e-5, 3))
        mine, (shift, turn) = scene.setup == k, poses[k]
        centre = scene.target[mine] - scene.middle
        move = shift + cmm.rotate(np.tile(turn, (mine.sum(), 1)), centre) * 1e3 - centre * 1e3
        out[mine] = np.sum(scene.normal[mine] * move, 1)
    return out


def along_normal(scene, carriages, change=None):
    """n . d of geometry, with a Change on top of it, through the exact kinematics."""
    total = dict(carriages)
    for axis, (move, turn) in (change.carriages if change else {}).items():
        total[axis] = (total[axis][0] + move, total[axis][1] + turn)
    d = cmm.tip_error(scene.machine, scene.reading, scene.tip, total)
    return np.sum(scene.normal * d, 1) + (np.sum(scene.normal * change.tip, 1) + change.along if change else 0)


def indexing(scene, rng):
    """Two angles for every indexing visit, exactly turned."""
    index = np.unique(scene.visit, return_inverse=True)[1]
    error = rng.normal(0, scene.machine.head_sd, (index.max() + 1, 2))[index]
    turned = np.einsum("nij,nj->ni", cmm.head_rotation(scene.a + error[:, 0], scene.b + error[:, 1]), scene.tip_in_r)
    return np.sum(scene.normal * (turned - scene.arm), 1) * 1e3


class Baseline:
    """A recording without any effect: residuals r in um, and what effects need to be added to it.

    before: the Baseline of an earlier recording of the same machine; placements and qualified styli that it has keep
    their errors. Each stylus was qualified on the reference sphere with its own small error of place, um."""

    def __init__(self, scene, geometry, rng, kind="white", noise_scale=1.0, before=None):
        self.scene, self.kind = scene, kind
        self.carriages = geometry.carriages(scene.machine, scene.reading)
        self.geometric = along_normal(scene, self.carriages)
        self.noise = noise.probe_noise(scene, rng, kind, noise_scale)
        self.r = self.geometric + indexing(scene, rng)
        same_styli = before is not None and before.scene.styli == scene.styli and before.scene.qualification[0] == scene.qualification[0]
        self.offsets = before.offsets if same_styli else rng.normal(0, scene.machine.qualification_sd, (len(scene.styli), 3))
        self.r = self.r + np.sum(scene.normal * self.offsets[scene.sensor], 1)
        self.poses = dict(before.poses) if before is not None else {}
        self.r = self.r + placed(scene, self.poses, rng) + self.noise
        scene.raw = scene.reading + self.r[:, None] * 1e-3 * scene.normal

    def signature(self, effect, parameters):
        """What the effect adds to r."""
        return along_normal(self.scene, self.carriages, effect.change(self.scene, parameters)) - self.geometric


def scaled(effect, baseline, null, parameters, target):
    """Parameters and signature for which the signal-to-noise ratio is the target; None when that takes an
    implausible size."""
    p = dict(parameters)
    for _ in range(4):
        d = baseline.signature(effect, p)
        s = null.snr(d)
        if s < 1e-6:
            return None
        if abs(s / target - 1) < 1e-6:
            break
        for key in effect.scale:
            p[key] = p[key] * target / s
        if max(abs(p[key]) for key in effect.scale[:1]) > IMPLAUSIBLE * effect.largest:
            return None
    p.update({key: short(p[key]) for key in effect.scale})
    return p, baseline.signature(effect, p)
