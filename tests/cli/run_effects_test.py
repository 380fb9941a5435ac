"""abbe run: effects of the machine file, left in or corrected."""
import json

import harness
from harness import LENGTH


def with_effects(effects):
    """The machine of the other tests with `effects`, as the text of a machine file."""
    machine = json.loads((harness.ROOT / "examples/machines/coord3-mc16.json").read_text())
    return json.dumps(machine | {"name": "with effects", "effects": effects})


class Effects(harness.Case):
    def setUp(self):
        super().setUp()
        self.write("length.dmi", LENGTH)
        self.write("tip.json", with_effects([{"name": "probe.tip_radius", "parameters": {"amplitude_um": {"value": 2, "u": 0.5}}}]))

    def test_left_in_or_corrected(self):
        def report(*options):
            return self.run_json("length.dmi", "--machine", "tip.json", "--machines", 200, *options)
        plain, left_in, corrected = report(), report("--effects", "left-in"), report("--effects", "corrected")
        self.assertEqual(plain, left_in)
        self.assertEqual((left_in["effects_use"], corrected["effects_use"]), ("left-in", "corrected"))
        left_in, corrected = left_in["characteristics"][0], corrected["characteristics"][0]
        self.assertAlmostEqual(left_in["mean"] - corrected["mean"], 0.004, delta=1e-8)   # 2 um at either end
        self.assertAlmostEqual(left_in["u"], corrected["u"], delta=1e-9)
        done = self.abbe("run", "length.dmi", "--machine", "tip.json", "--machines", 20, "--effects", "corrected")
        self.assertIn("\neffects corrected\n", done.stdout)

    def test_without_effects_nothing_is_named(self):
        self.assertIsNone(self.run_json("length.dmi", "--machines", 20, "--effects", "corrected")["effects_use"])
        self.assertNotIn("\neffects", self.abbe("run", "length.dmi", "--machines", 20).stdout)

    def test_two_settings_of_one_effect_are_independent(self):
        scale = {"name": "machine.scale", "parameters": {"scale_um_per_m": {"value": 0, "u": 500}, "axis": "x"}}
        lengths = []
        for effects in ([scale, scale], [scale]):
            self.write("scales.json", with_effects(effects))
            lengths.append(self.run_json("length.dmi", "--machine", "scales.json", "--machines", 4000)["characteristics"][0])
        two, one = lengths
        self.assertEqual([name for name in two["contributions"] if name.startswith("machine.")], ["machine.scale", "machine.scale #2"])
        for length in lengths:
            self.assertAlmostEqual(sum(length["contributions"].values()), 1, delta=1e-9)
        # The same numbers in both would give 2. Three standard errors from so many machines.
        self.assertAlmostEqual(two["u"] / one["u"], 2 ** 0.5, delta=0.05)

    def test_an_effect_that_moves_no_touch_models_nothing(self):
        """Sizes of 0, and an expansion at 20 degrees C."""
        self.write("idle.json", with_effects([{"name": "thermal.drift"}, {"name": "thermal.part_expansion", "parameters": {"cte_error_ppm_per_K": 5}},
                                              {"name": "probe.tip_radius", "parameters": {"amplitude_um": {"value": 0, "u": 0.5}}}]))
        self.write("warm.json", json.dumps({"schema": "abbe.workpiece/1", "name": "warm", "material": {"cte_ppm_per_K": 11.5},
                                            "temperature": {"part_C": 22}}))
        def told(*options):
            report = self.run_json("length.dmi", "--machine", "idle.json", "--machines", 50, *options)
            status = {i["name"]: i["status"] for i in report["influences"]}
            return ([m["message"].split(":")[0] for m in report["messages"] if m["code"] == "W0615"],
                    [status[name] for name in ("thermal drift", "part temperature", "tip size and form")])
        self.assertEqual(told(), (["thermal.drift", "thermal.part_expansion"], ["not modelled", "not modelled", "modelled"]))
        self.assertEqual(told("--workpiece", "warm.json"), (["thermal.drift"], ["not modelled", "modelled", "modelled"]))

    def test_a_change_that_comes_after_the_program_is_told_as_that(self):
        self.write("crash.json", with_effects([{"name": "probe.step", "parameters": {"amplitude_um": 5, "t0_s": 742}}]))
        told = self.abbe("run", "length.dmi", "--machine", "crash.json", "--machines", 20).stderr
        self.assertIn("it begins 742 s after the start of a program: of what happened before this program, set its t0_s to 0", told)

    def test_what_is_there_in_another_setup_is_told_as_that(self):
        self.write("bent.json", with_effects([{"name": "part.clamping", "parameters": {"bow_um": 50, "setup": 2}}]))
        told = self.abbe("run", "length.dmi", "--machine", "bent.json", "--machines", 20).stderr
        self.assertIn("it is there in setup 2 alone, and a program is run in setup 1: where the part is placed as in setup 2, set its setup to 0", told)

    def test_another_word_is_refused(self):
        self.assertIn("corrected", self.refused("E0609", "run", "length.dmi", "--effects", "removed"))


if __name__ == "__main__":
    harness.main()
