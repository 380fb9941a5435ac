"""What abbe diagnose wants measured next: the proposed program is run on the same machine, and both recordings together decide more."""
import csv
import json
import re

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"


class NextMeasurement(harness.Case):
    def record(self, program, name, *effects, run=1, **changes):
        """A recording; `changes` are functions from the old value of a column to the new one."""
        self.abbe("record", program, "--machine", MACHINE, "-o", name, "--run", run, *(word for e in effects for word in ("--with", e)))
        lines = (self.folder / name).read_text().splitlines()
        comments = [line for line in lines if line.startswith("#")]
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        rows = [row | {column: str(change(row[column])) for column, change in changes.items()} for row in rows]
        body = [",".join(rows[0]), *(",".join(row.values()) for row in rows)]
        return self.write(name, "\n".join([*comments, *body, ""]))

    def diagnosis(self, *recordings):
        return json.loads(self.abbe("diagnose", *recordings, "--machine", MACHINE, "--format", "json").stdout)

    def decided(self, effect, plan, moved=False):
        """The members that are left when the wish for `plan` came true; it must be part of the best change."""
        first = self.record(self.sphere(), "first.csv", effect)
        said = self.diagnosis(first)
        best = said["next_measurement"][0]
        self.assertIn(plan, best["change"])
        self.assertGreater(best["expected_probability"], 1 / len(best["separates"]))
        self.assertGreater(best["minutes"], 1)
        self.write("next.dmi", best["program"])
        second = self.record("next.dmi", "second.csv", effect, run=2, setup=lambda s: 2 if moved else 1)
        self.assertIn("N0708", self.abbe("diagnose", first, second, "--machine", MACHINE, "--design-only").stderr)
        later = self.record("next.dmi", "later.csv", effect, run=2, time_s=lambda t: float(t) + 5000)
        self.assertNotIn("N0708", self.abbe("diagnose", first, later, "--machine", MACHINE, "--design-only").stderr)
        [told] = re.findall("N0708: (.*)", self.abbe("diagnose", later, first, "--machine", MACHINE, "--design-only").stderr)
        self.assertIn("in another order than they were measured in", told)
        return said["effects"][0]["members"], self.diagnosis(first, second)["effects"][0]["members"]

    def test_what_no_run_tells_apart_gets_no_proposal(self):
        first = self.record(PROGRAM, "shifted.csv", "part.shift:amplitude_um=12,t0_s=100,direction=x")
        said = self.diagnosis(first)
        self.assertEqual(set(said["effects"][0]["members"]), {"part.shift", "machine.step"})
        self.assertEqual(said["next_measurement"], [])
        self.assertIn("machine.step: return to a fixed reference sphere", said["otherwise"])
        self.assertIn("No other run", self.abbe("diagnose", first, "--machine", MACHINE).stdout)

    def test_a_second_speed_tells_radius_from_delay(self):
        before, after = self.decided("probe.tip_radius:amplitude_um=2", "probing speed")
        self.assertIn("probe.trigger_delay", before)
        self.assertIn("probe.tip_radius", after)
        self.assertNotIn("probe.trigger_delay", after)
        self.assertLess(len(after), len(before))

    def test_what_was_found_beside_does_not_help(self):
        """A lobing that is known to be there tells nothing about which of the others is there too."""
        radius = "probe.tip_radius:amplitude_um=2"
        alone = self.diagnosis(self.record(PROGRAM, "alone.csv", radius))
        beside = self.diagnosis(self.record(PROGRAM, "beside.csv", radius, "probe.pretravel_lobing:amplitude_um=3"))
        self.assertEqual(beside["effects"][0]["members"], ["probe.pretravel_lobing"])
        self.assertEqual(set(alone["effects"][0]["members"]), set(beside["effects"][1]["members"]))
        how_far = lambda change: re.sub(r"by \d+ degrees", "", change)  # the part is turned is all the same to them
        alone, beside = ({how_far(n["change"]): n["expected_probability"] for n in said["next_measurement"]} for said in (alone, beside))
        both = set(alone) & set(beside)
        self.assertGreaterEqual(len(both), len(alone) - 1)  # of those that say as much, one or the other is shown
        for change in both:
            self.assertAlmostEqual(alone[change], beside[change], delta=0.05)


if __name__ == "__main__":
    harness.main()
