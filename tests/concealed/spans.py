"""The shapes that a family of the catalogue can have on one plan: its prior, as sets of columns.

Parameters in which an effect is linear (direction, phase, free terms) span a set; the others (moment, period, time
constant, sensor, axis) are drawn, and each draw has a set of its own."""

from portable import np

DRAWS = 60
MANY = {"probe.step": 220, "machine.map_scallops": 240, "head.axis_errors": 120, "probe.tip_form": 120, "thermal.drift": 16}  # draws of a family with many moments, places or terms


def directed(signature, variants):
    """Any direction and size of some variants."""
    return [signature({**p, "direction": v}) for p in variants for v in np.eye(3)]


def spans(stage, effect, rng):
    """The prior of the shape: sets of columns; the combinations of each are shapes."""
    sign = lambda p, **more: stage.base.signature(effect, {**p, **more})
    drawn = [effect.draw(stage.scene, rng) for _ in range(MANY.get(effect.name, DRAWS))]
    quadrature = (0.0, np.pi / 2)

    def different(*keys):
        return {tuple(p[k] for k in keys): p for p in drawn}.values()

    if effect.name == "thermal.cycle":
        periods = 1 / np.linspace(*(1 / f(p["period_s"] for p in drawn) for f in (max, min)), DRAWS)
        return [directed(sign, [{**drawn[0], "period_s": t, "phase_deg": v} for v in (0, 90)]) for t in periods]
    if isinstance(drawn[0].get("direction"), np.ndarray):
        return [directed(sign, [p]) for p in drawn]
    if effect.name == "machine.scale_interpolation":  # 0.23: root mean square of the share of the second harmonic
        base = [{**p, "phase": 0.0, "second_share": 0.0} for p in different("axis", "period_um")]
        second = lambda p: [0.23 * (sign(p, second_share=1.0, second_phase=v) - sign(p)) for v in quadrature]
        return [[*(sign(p, phase=v) for v in quadrature), *second(p)] for p in base]
    if effect.name == "machine.map_scallops":  # 0.12: that of the uneven part, in either phase
        base = [{**p, "uneven": 0.0} for p in different("axis", "spacing_mm", "direction")]
        return [[sign(p), *(0.12 * (sign(p, uneven=1.0, phase=v) - sign(p)) for v in quadrature)] for p in base]
    if effect.spans > 4 or len(effect.scale) > 1:  # sums of many free terms
        return [[d / max(stage.null.snr(d), 1e-9) for d in map(sign, drawn)]]
    return [[sign(p)] for p in drawn]
