"""What a recording looks like when nothing is left out: the covariance of its residuals, and the
signal-to-noise ratio of an effect.

The residuals r = n . (measured - target) of a machine of the paper's model are linear in random numbers: 18 x
16 coefficients of the error functions, two angles for every indexing visit of the head, an offset for every
qualified stylus, the probe; each placement of the part adds six unknowns of its pose, which have no prior.
The covariance of the coefficients is taken from draws, because the paper's normalisation by the largest value
has no closed form.

    s = sqrt(d' P d)     P = C^-1 - C^-1 X (X' C^-1 X)^-1 X' C^-1

is the signal-to-noise ratio of a shift d: the best statistic that knows its shape is normal with mean s and
variance 1. P is applied through the matrix inversion lemma; the pose enters as a prior so wide (0.3 mm, where
the parts lie within 3 um) that it is none.
"""

import functools

import machine as cmm
from portable import np

POSE = 300.0  # um, and um per metre


@functools.lru_cache(maxsize=None)
def coefficient_root(kind):
    """Lower root of the second moments of the coefficients for e_tot = 1."""
    k = cmm.draw_harmonics(np.random.Generator(np.random.PCG64(20110601)), kind, 6000)
    return np.linalg.cholesky(k.T @ k / len(k) + 1e-12 * np.eye(k.shape[1]))


def geometry_columns(scene):
    """Columns (N, 18 x 16) whose product with their transpose is the covariance of the geometric errors, um."""
    machine, out = scene.machine, []
    lever = np.tile(np.array(machine.mount, float), (scene.size, 1)) + scene.tip
    levers = {}
    for axis in reversed(machine.chain):
        levers[axis] = lever
        lever = lever + np.array(machine.offsets[axis], float)
        lever[:, cmm.AXES.index(axis)] += scene.reading[:, cmm.AXES.index(axis)]
    for axis in machine.chain:
        basis = cmm.harmonic_basis(cmm.normalised(machine, axis, scene.reading[:, cmm.AXES.index(axis)]))
        turn = np.cross(levers[axis], scene.normal) * 1e-3  # n . (w x l) = w . (l x n)
        for motion in range(6):
            weight = turn[:, motion - 3] if motion >= 3 else scene.normal[:, motion]
            root = coefficient_root(cmm.share_of(axis, motion)) * cmm.size_of(machine, axis, motion)
            out.append(weight[:, None] * (basis @ root))
    return np.hstack(out)


def indexing_columns(scene):
    """Two columns for each indexing visit: how the recording moves with one standard deviation of A and of
    B."""
    h = 1e-5

    def sensitivity(da, db):
        plus = np.einsum("nij,nj->ni", cmm.head_rotation(scene.a + da, scene.b + db), scene.tip_in_r)
        return np.sum(scene.normal * (plus - scene.arm), 1) / h * scene.machine.head_sd * 1e3

    return grouped(scene.visit, np.column_stack([sensitivity(h, 0), sensitivity(0, h)]))


def grouped(labels, columns):
    """The columns once for each label, zero elsewhere."""
    _, index = np.unique(labels, return_inverse=True)
    out = np.zeros((len(labels), index.max() + 1, columns.shape[1]))
    out[np.arange(len(labels)), index] = columns
    return out.reshape(len(labels), -1)


def pose_columns(scene):
    centre = scene.target - scene.target.mean(0)
    return grouped(scene.setup, np.hstack([scene.normal, np.cross(centre, scene.normal) * 1e-3])) * POSE


class Null:
    """The precision P of a recording, together with the calibration of the same machine when there is one."""

    def __init__(self, scene, calibration=None):
        scenes = [scene] if calibration is None else [scene, calibration]
        self.size = scene.size
        geometry = np.vstack([geometry_columns(s) for s in scenes])
        own = [
            np.hstack([indexing_columns(s), grouped(s.sensor, s.normal) * s.machine.qualification_sd, pose_columns(s)])
            for s in scenes
        ]
        rows, blocks = len(geometry), [geometry]
        for i, block in enumerate(own):
            wide = np.zeros((rows, block.shape[1]))
            wide[: self.size] = block if i == 0 else wide[: self.size]
            wide[self.size :] = block if i == 1 else wide[self.size :]
            blocks.append(wide)
        self.variance = scene.machine.probe_sd**2
        self.z = np.hstack(blocks)
        information = np.eye(self.z.shape[1]) + self.z.T @ self.z / self.variance
        self.inverse = np.linalg.inv(information)

    def times(self, y):
        """P y; y has the rows of the recording, or of recording and calibration."""
        y = np.asarray(y, float)
        full = np.zeros((len(self.z),) + y.shape[1:])
        full[: len(y)] = y
        out = full - self.z @ (self.inverse @ (self.z.T @ full)) / self.variance
        return out / self.variance

    def snr(self, d):
        return float(np.sqrt(max(0.0, d @ self.times(d)[: self.size])))

    def correlation(self, d, others):
        """Largest correlation that a combination of the columns `others` has with d, after the null has taken
        its part."""
        stack = np.column_stack([d, others])
        gram = stack.T @ self.times(stack)[: self.size]
        if gram[0, 0] <= 0:
            return 0.0
        rest = np.linalg.pinv(gram[1:, 1:], rcond=1e-9, hermitian=True)
        return float(np.sqrt(min(1.0, max(0.0, gram[0, 1:] @ rest @ gram[1:, 0] / gram[0, 0]))))

    def held_out_gain(self, y, d, groups):
        """Log score, in nats, won by knowing the shape d when each group is predicted from all others: its
        size is fitted to these.

        With w = P y, v = P d and Q the inverse of the group's block of P, the group given the rest has mean
        error Q w_g and covariance Q; leaving it out takes v_g' Q v_g from the information on the size and
        v_g' Q w_g from its estimate."""
        w, v = self.times(y)[: self.size], self.times(d)[: self.size]
        information, estimate, gain = d @ v, d @ w, 0.0
        for k in np.unique(groups):
            g = np.flatnonzero(groups == k)
            z = self.z[g]
            q = np.linalg.inv((np.eye(len(g)) - z @ self.inverse @ z.T / self.variance) / self.variance)
            e, f = q @ w[g], q @ v[g]
            rest = information - v[g] @ f
            if rest < 1e-6 * information:
                continue  # the others say nothing of the size
            size, seen = (estimate - v[g] @ e) / rest, v[g] @ f
            left = w[g] - size * v[g]  # precision times what the shape leaves
            gain += 0.5 * (w[g] @ e - left @ q @ left + (f @ left) ** 2 / (rest + seen) - np.log1p(seen / rest))
        return float(gain)

    def covariance(self):
        """C of the recording alone, pose included."""
        z = self.z[: self.size]
        return z @ z.T + self.variance * np.eye(self.size)
